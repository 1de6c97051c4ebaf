"""Foreign tones are found away from the lines and ignored on them."""

import math

import numpy as np
import pytest

from hd_monitor.orders.regression import line_columns
from hd_monitor.orders.tones import MOST_TONES, foreign_tones

PERIOD, COUNT = 1e-3, 3000
TIMES = np.arange(COUNT) * PERIOD
LINES = np.array([[33.3, 33.8], [66.7, 67.5]])  # Hz, lowest and highest of each pair


def noise(seed):
    return np.random.default_rng(seed).standard_normal(COUNT)


def tone(frequency, amplitude):
    return amplitude * np.cos(2.0 * np.pi * frequency * TIMES + 0.7)


@pytest.mark.parametrize("frequency", [50.0, 50.123, 117.77, 301.5])
def test_a_tone_is_found_to_a_small_part_of_a_bin(frequency):
    found = foreign_tones(noise(1) + tone(frequency, 1.0), PERIOD, LINES, 1.0)
    assert found.size >= 1
    # a bin is 0.33 Hz wide; the Cramér-Rao bound of this frequency is 0.004 Hz
    assert found[0] == pytest.approx(frequency, abs=0.03)


def test_the_strongest_come_first_and_only_so_many():
    frequencies = 110.0 + 31.0 * np.arange(MOST_TONES + 2)
    signal = noise(2) + sum(tone(f, 1.0 + 0.3 * i) for i, f in enumerate(frequencies))
    found = foreign_tones(signal, PERIOD, LINES, 1.0)
    assert found == pytest.approx(frequencies[::-1][:MOST_TONES], abs=0.05)


@pytest.mark.parametrize("frequency", [33.4, 67.0, 68.0])
def test_lines_and_their_possible_side_lines_never_count_as_tones(frequency):
    assert foreign_tones(noise(3) + tone(frequency, 5.0), PERIOD, LINES, 1.0).size == 0


def test_noise_holds_no_tones():
    found = sum(foreign_tones(noise(seed), PERIOD, LINES, 1.0).size for seed in range(50))
    assert found == 0


def test_a_segment_that_is_too_short_has_no_tones():
    assert foreign_tones(tone(50.0, 5.0)[:150], PERIOD, LINES, 1.0).size == 0


def test_the_columns_remove_a_tone_of_any_phase():
    columns = line_columns(math.tau * PERIOD * np.arange(COUNT), [50.123])
    signal = tone(50.123, 2.0)
    rest = signal - columns @ np.linalg.lstsq(columns, signal, rcond=None)[0]
    assert np.abs(rest).max() < 1e-9
