"""The anti-aliasing filter does what its analog prototype says, above half the sampling rate too."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import signal

from hd_monitor.model import ParametricModel
from hd_sim_node.drive.rig import Rig
from hd_sim_node.motion.programme import SpeedProgramme
from hd_sim_node.sensing.filter import AntiAliasing, FilterSettings

RATE = 1000.0
QUIET = SpeedProgramme(times=[0.0, 1.0], speeds=[0.0, 0.0])


def tone(chunk, frequency):
    return replace(chunk, acceleration=np.cos(2 * np.pi * frequency * chunk.times))


def response(frequency, *, seconds=2.0, **chosen):
    """Complex amplitude that a tone of amplitude 1 has in the samples, and the analog filter's response."""
    settings = FilterSettings(**chosen)
    stages = AntiAliasing(settings, rate=RATE)
    rig = Rig(ParametricModel(), QUIET, rate=RATE * stages.oversampling)
    seen = stages.thin(tone(rig.advance(round(seconds * RATE) * stages.oversampling), frequency))
    assert len(seen) == round(seconds * RATE)
    half = slice(len(seen) // 2, None)  # the start has died away; whole periods remain
    t = seen.times[half]
    waves = np.stack([np.cos(2 * np.pi * frequency * t), -np.sin(2 * np.pi * frequency * t)], axis=1)
    real, imaginary = np.linalg.lstsq(waves, seen.acceleration[half], rcond=None)[0]
    b, a = signal.butter(settings.filter_order, 2 * np.pi * settings.bandwidth, analog=True)
    return complex(real, imaginary), signal.freqs(b, a, worN=[2 * np.pi * frequency])[1][0]


@pytest.mark.parametrize("order", [1, 2, 4, 8])
@pytest.mark.parametrize("share", [0.1, 0.5, 0.9, 1.0, 1.5])
def test_magnitude_and_phase_are_the_analog_filters(order, share):
    got, wanted = response(200.0 * share, bandwidth=200.0, filter_order=order)
    # The bilinear transform moves a frequency by at most (pi/64)²/3 * |share² - 1| of it: steep filters feel it most.
    shift = (np.pi / 64) ** 2 / 3 * max(abs(share**2 - 1.0), 0.01)
    assert abs(got / wanted - 1.0) < 2.0 * order * shift + 1e-3


@pytest.mark.parametrize(("frequency", "alias"), [(700.0, 300.0), (1300.0, 300.0), (2100.0, 100.0)])
def test_what_is_above_half_the_sampling_rate_folds_down_as_much_as_the_filter_lets_through(frequency, alias):
    got, wanted = response(frequency, bandwidth=300.0, filter_order=2)
    assert abs(got) == pytest.approx(abs(wanted), rel=0.02 * (frequency / 1000.0) ** 2)
    assert abs(got) < (300.0 / frequency) ** 2
    stages = AntiAliasing(FilterSettings(bandwidth=300.0), rate=RATE)
    rig = Rig(ParametricModel(), QUIET, rate=RATE * stages.oversampling)
    spectrum = np.abs(
        np.fft.rfft(stages.thin(tone(rig.advance(2000 * stages.oversampling), frequency)).acceleration[1000:])
    )
    assert np.argmax(spectrum) == alias


def test_without_a_bandwidth_nothing_is_filtered():
    stages = AntiAliasing(FilterSettings(), rate=RATE)
    chunk = Rig(ParametricModel(), QUIET, rate=RATE).advance(100)
    assert stages.oversampling == 1
    assert stages.thin(chunk) is chunk


@pytest.mark.parametrize("rate", [50.0, 1000.0, 6667.0])
@pytest.mark.parametrize("bandwidth", [1.0, 0.4 * 1000.0, 5000.0])
def test_it_runs_fast_enough_for_the_filter_and_for_what_it_stops(rate, bandwidth):
    factor = FilterSettings(bandwidth=bandwidth).oversampling(rate)
    assert factor == int(factor) >= 16
    assert factor * rate >= 64 * bandwidth


def test_it_starts_in_its_steady_state():
    stages = AntiAliasing(FilterSettings(bandwidth=5.0, filter_order=3), rate=RATE)
    rig = Rig(ParametricModel(), QUIET, rate=RATE * stages.oversampling, start_angle=0.7)
    chunk = rig.advance(100 * stages.oversampling)
    seen = stages.thin(replace(chunk, acceleration=np.full(len(chunk), 3.0)))
    np.testing.assert_allclose(seen.acceleration, 3.0, rtol=1e-9)
    np.testing.assert_allclose(seen.angle, 0.7, rtol=1e-9)


@settings(max_examples=25)
@given(
    st.lists(st.integers(1, 60), min_size=1, max_size=6),
    st.floats(0.1, 900.0),
    st.integers(1, 10),
    st.floats(1.0, 3000.0),
)
def test_cuts_do_not_change_the_samples(cuts, bandwidth, order, frequency):
    chosen = FilterSettings(bandwidth=bandwidth, filter_order=order)

    def samples(pieces):
        stages = AntiAliasing(chosen, rate=RATE)
        rig = Rig(ParametricModel(), QUIET, rate=RATE * stages.oversampling)
        thinned = [stages.thin(tone(rig.advance(n * stages.oversampling), frequency)) for n in pieces]
        assert [c.first for c in thinned] == np.cumsum([0, *pieces[:-1]]).tolist()
        return np.concatenate([c.acceleration for c in thinned]), np.concatenate([c.times for c in thinned])

    (cut, times), (whole, _) = samples(cuts), samples([sum(cuts)])
    np.testing.assert_array_equal(cut, whole)
    np.testing.assert_allclose(times, np.arange(sum(cuts)) / RATE, rtol=1e-14)
