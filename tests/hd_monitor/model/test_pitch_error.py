import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hd_monitor.errors import ParameterError
from hd_monitor.model.pitch_error import MESHED_FRACTION, PitchErrors

LOBE = np.linspace(0.0, 2.0 * np.pi, 400, endpoint=False)
ERRORS = st.lists(st.floats(-1e-4, 1e-4), min_size=8, max_size=200)


def test_interference_of_an_eccentric_gear_is_its_double_eccentricity_averaged_over_the_zone():
    gear = PitchErrors.of_eccentric_gear(162, 20e-6)
    zone = np.sinc(MESHED_FRACTION / 2.0)
    assert gear.interference(LOBE) == pytest.approx(np.abs(40e-6 * zone * np.cos(LOBE)), abs=1e-12)
    assert gear.total == pytest.approx(40e-6, rel=1e-3)


@given(ERRORS)
def test_interference_repeats_twice_a_revolution_and_never_pulls(errors):
    gear = PitchErrors(tuple(errors))
    here = gear.interference(LOBE)
    assert (here >= 0.0).all()
    assert gear.interference(LOBE + np.pi) == pytest.approx(here, abs=1e-15)


@given(ERRORS, st.floats(-1e-3, 1e-3))
def test_the_first_tooth_counted_does_not_matter(errors, offset):
    moved = PitchErrors(tuple(e + offset for e in errors))
    assert moved.interference(LOBE) == pytest.approx(PitchErrors(tuple(errors)).interference(LOBE), abs=1e-15)


def test_series_rebuilds_the_stiffness():
    gear = PitchErrors.of_eccentric_gear(162, 20e-6, scatter=1e-6)
    series = gear.stiffness_series(4000.0, harmonics=40)
    stiffness = 1.0 + 4000.0 * gear.interference(LOBE)
    relative = stiffness / stiffness.mean() - 1.0
    assert series(2.0 * LOBE) == pytest.approx(relative, abs=2e-3)


def test_half_the_error_is_half_the_fluctuation_for_a_small_one():
    large, small = (PitchErrors.of_eccentric_gear(162, e).stiffness_series(100.0) for e in (2e-6, 1e-6))
    assert small.index / large.index == pytest.approx(0.5, rel=1e-3)


def test_a_gear_whose_errors_repeat_every_half_turn_does_not_fluctuate():
    places = 2.0 * np.pi * np.arange(160) / 160
    oval = PitchErrors(tuple(20e-6 * np.cos(2.0 * places)))
    assert oval.stiffness_series(4000.0).index < 1e-12


def test_the_same_seed_makes_the_same_gear():
    first, again, other = (PitchErrors.of_eccentric_gear(160, 1e-5, scatter=1e-6, seed=s) for s in (1, 1, 2))
    assert first == again
    assert first != other


@pytest.mark.parametrize("errors", [(0.0, 1.0), (0.0, 0.0, float("nan"), 0.0)])
def test_impossible_errors_are_refused(errors):
    with pytest.raises(ParameterError, match="are not those of a spline"):
        PitchErrors(errors)


@pytest.mark.parametrize("sensitivity", [-1.0, float("inf")])
def test_impossible_stiffening_is_refused(sensitivity):
    with pytest.raises(ParameterError, match="not a stiffening"):
        PitchErrors.of_eccentric_gear(160, 1e-5).stiffness_series(sensitivity)
