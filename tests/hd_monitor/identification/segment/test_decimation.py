"""Decimation: a reduced rate keeps what matters and lets nothing fold into it."""

import numpy as np
import pytest

from hd_monitor.identification.segment.decimation import PASS_BAND, decimate

RATE = 4000.0
TIMES = np.arange(16_000) / RATE
LINE, NATURAL = 100.0, 69.0  # Hz: 442 samples a second would do


def tone(frequency, phase=0.3):
    return np.cos(2.0 * np.pi * frequency * TIMES + phase)


def amplitude(values, times, frequency):
    columns = np.exp(2j * np.pi * frequency * times)
    return abs(np.linalg.lstsq(np.stack([columns.real, columns.imag], axis=1), values, rcond=None)[0] @ [1, 1j])


def test_a_rate_far_higher_than_needed_is_reduced_and_the_pass_band_kept():
    result = decimate(tone(LINE), 1.0 / RATE, LINE, NATURAL)
    assert result.factor > 4
    assert result.highest_frequency == pytest.approx(PASS_BAND * RATE / result.factor)
    times = (result.first + result.factor * np.arange(result.values.size)) / RATE
    # samples are where they claim to be: no delay, no loss
    assert result.values == pytest.approx(np.cos(2.0 * np.pi * LINE * times + 0.3), abs=2e-3)


def test_the_whole_trusted_band_passes_to_a_thousandth():
    highest = decimate(tone(LINE), 1.0 / RATE, LINE, NATURAL).highest_frequency
    for frequency in np.linspace(2.0, highest, 12):
        result = decimate(tone(frequency), 1.0 / RATE, LINE, NATURAL)
        times = (result.first + result.factor * np.arange(result.values.size)) / RATE
        assert amplitude(result.values, times, frequency) == pytest.approx(1.0, abs=1.5e-3)


def test_nothing_folds_into_the_trusted_band():
    factor = decimate(tone(LINE), 1.0 / RATE, LINE, NATURAL).factor
    reduced = RATE / factor
    for target in np.linspace(10.0, PASS_BAND * reduced, 8):
        result = decimate(tone(reduced - target), 1.0 / RATE, LINE, NATURAL)
        assert np.abs(result.values).max() < 2e-3


def test_a_rate_that_is_just_enough_is_kept():
    raw = np.random.default_rng(1).standard_normal(2000)
    result = decimate(raw, 1.0 / 450.0, LINE, NATURAL)
    assert result.factor == 1
    assert result.first == 0
    assert np.array_equal(result.values, raw)
    assert result.highest_frequency == pytest.approx(225.0)


def test_a_sample_lost_here_and_there_is_bridged_and_a_hole_is_left_out():
    raw = tone(60.0)
    raw[5000] = np.nan
    bridged = decimate(raw, 1.0 / RATE, LINE, NATURAL)
    assert bridged.used.all()
    times = (bridged.first + bridged.factor * np.arange(bridged.values.size)) / RATE
    assert bridged.values == pytest.approx(np.cos(2.0 * np.pi * 60.0 * times + 0.3), abs=2e-3)
    raw[8000:8100] = np.nan
    holed = decimate(raw, 1.0 / RATE, LINE, NATURAL)
    centres = holed.first + holed.factor * np.arange(holed.values.size)
    assert not holed.used[(centres >= 8000) & (centres < 8100)].any()
    assert holed.used[(centres < 7900) | (centres > 8200)].all()
    assert not holed.values[~holed.used].any()
