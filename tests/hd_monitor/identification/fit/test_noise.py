"""The noise floor: right on noise of known density, before and after a fit has taken its part of the noise."""

import numpy as np
import pytest
from scipy.signal import freqz, lfilter

from hd_monitor.acquisition.record import Record
from hd_monitor.identification.fit.noise import EDGES, NoiseFloor
from hd_monitor.identification.segment.segment import SegmentBuilder
from hd_monitor.reducer import Reducer

RATE, STD = 400.0, 0.7  # Hz, too low to be reduced; rad/s²
DENSITY = 2.0 * STD**2 / RATE  # (rad/s²)²/Hz, one-sided
BUILDER = SegmentBuilder(reducer=Reducer(), harmonics=2, load_orders=(2,), natural_frequency=55.0)


def segment(values):
    angle = 2.0 * np.arange(values.size) / RATE
    record = Record(
        start=0.0,
        period=1.0 / RATE,
        acceleration=values,
        angle=angle,
        speed=np.full(values.size, 2.0),
        torque=np.full(values.size, 10.0),
    )
    return BUILDER.build([record], None)


def floor_of(*signals):
    floor = NoiseFloor()
    for values in signals:
        item = segment(values)
        residual = item.transform(item.acceleration[:, None])[:, 0]
        floor = floor.updated(item, residual, np.zeros(residual.size))
    return floor


def white(seed, count=1600):
    return STD * np.random.default_rng(seed).standard_normal(count)


def test_white_noise_has_its_density_at_every_frequency():
    floor = floor_of(*(white(seed) for seed in range(40)))
    frequencies = np.geomspace(10.0, 180.0, 40)
    # 40 segments of 4 s: 300 degrees of freedom a hertz, so some 5 % by chance in the narrowest band
    assert floor.density(frequencies) == pytest.approx(DENSITY, rel=0.12)
    assert floor.mean == pytest.approx(DENSITY, rel=0.02)


def test_coloured_noise_has_the_filters_density():
    filtered = [lfilter([1.0], [1.0, -0.8], white(seed, 2000))[400:] for seed in range(40)]
    frequencies = np.geomspace(10.0, 150.0, 15)
    truth = DENSITY * np.abs(freqz([1.0], [1.0, -0.8], frequencies, fs=RATE)[1]) ** 2
    # quarter octaves: the density falls by up to a quarter within a band, and is straight in logarithms between them
    assert floor_of(*filtered).density(frequencies) == pytest.approx(truth, rel=0.15)


def test_missing_samples_do_not_lower_the_floor():
    rng = np.random.default_rng(5)
    holed = [np.where(rng.random(1600) < 0.3, np.nan, white(seed)) for seed in range(20)]
    assert floor_of(*holed).mean == pytest.approx(DENSITY, rel=0.04)


def test_a_fit_that_follows_the_lines_does_not_lower_the_floor_there():
    """Least squares on 8 columns in the band around 50 Hz takes 8 of its some 60 degrees of freedom away."""
    times = np.arange(1600) / RATE
    lines = np.concatenate([[np.cos(f * times), np.sin(f * times)] for f in 2.0 * np.pi * np.arange(48.0, 52.0)]).T
    corrected, naive = NoiseFloor(), NoiseFloor()
    for seed in range(60):
        item = segment(white(seed))
        columns = item.transform(np.column_stack([item.acceleration, lines]))
        basis = np.linalg.qr(columns[:, 1:])[0]
        residual = columns[:, 0] - basis @ (basis.T @ columns[:, 0])
        leverage = np.einsum("ij,ij->i", basis, basis)
        corrected = corrected.updated(item, residual, leverage)
        naive = naive.updated(item, residual, np.zeros(residual.size))
    band = int(np.searchsorted(EDGES, 50.0)) - 1

    def around(floor):
        return floor.power[band] / floor.freedom[band]

    # 60 segments leave some 3500 degrees of freedom in the band: 2.5 % by chance
    assert around(corrected) == pytest.approx(DENSITY, rel=0.075)
    assert around(naive) < 0.92 * DENSITY


def test_information_weighted_by_an_estimated_floor_is_not_exaggerated():
    """Student: over many short segments, 1/density of the floor each one measures on itself averages to the truth."""
    frequencies = np.array([40.0, 80.0, 120.0])
    weights = np.mean([1.0 / floor_of(white(seed)).density(frequencies) for seed in range(300)], axis=0)
    # bands of at least 60 degrees of freedom: 300 segments leave 1 % by chance
    assert weights * DENSITY == pytest.approx(1.0, abs=0.035)


def test_fading_keeps_the_level_and_pooling_adds_the_evidence():
    one, other = floor_of(white(1)), floor_of(2.0 * white(2))
    faded = one.faded(0.5) + other.faded(0.5)
    assert faded.mean == pytest.approx((one + other).mean)
    assert one.mean < faded.mean < other.mean
    assert NoiseFloor.white(3.0).density(np.array([50.0])) == pytest.approx(3.0)


def test_nothing_is_said_before_anything_is_seen():
    with pytest.raises(ValueError, match="noise floor is unknown"):
        NoiseFloor().density(np.array([50.0]))
