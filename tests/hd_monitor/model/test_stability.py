"""Floquet stability: independently computed thresholds and growth rates, and the identities of the theory."""

import math

import numpy as np
import pytest
from tests.oracle import table_1

from hd_monitor.errors import ParameterError
from hd_monitor.model import (
    Dynamics,
    Oscillator,
    ParametricModel,
    StiffnessSeries,
    gauss_times,
    growth_rate,
    scale_defects,
    stability_chart,
)

PRINCIPAL = 3300.0
"""rpm at which the circular spline's first line is at 2 fn for 55 Hz."""


def model(flexspline=(), circular_spline=(), damping_ratio=0.023):
    return ParametricModel(
        dynamics=Dynamics(damping_ratio=damping_ratio),
        flexspline=StiffnessSeries(flexspline),
        circular_spline=StiffnessSeries(circular_spline),
    )


@pytest.mark.parametrize(
    ("flexspline", "circular_spline", "damping_ratio", "expected"),
    [
        ((0.14,), (), 0.023, 4.14),
        ((0.14,), (), 0.027, 2.76),
        ((0.14,), (0.10,), 0.023, 5.46),
        ((0.14,), (0.10,), 0.027, 4.08),
    ],
)
def test_largest_growth_rates_of_the_papers_sweeps(flexspline, circular_spline, damping_ratio, expected):
    """The sweep cases of section 3.4 near ωo2 = 2 ωn, printed to three digits."""
    speeds = np.arange(3210.0, 3300.0, 2.0)
    largest = max(growth_rate(model(flexspline, circular_spline, damping_ratio), float(s)) for s in speeds)
    assert largest == pytest.approx(expected, abs=0.006)


@pytest.mark.parametrize("damping_ratio", [0.023, 0.027])
@pytest.mark.parametrize("spline", ["flexspline", "circular_spline"])
def test_a_single_index_is_unstable_above_four_times_the_damping(damping_ratio, spline):
    """The principal tongue of Mathieu's equation: 0.092 for ζ = 0.023 and 0.108 for 0.027."""
    speed = PRINCIPAL if spline == "circular_spline" else PRINCIPAL * 160 / 162
    threshold = 4 * damping_ratio

    def rate(beta: float) -> float:
        return growth_rate(model(**{spline: (beta,)}, damping_ratio=damping_ratio), speed)

    assert rate(0.998 * threshold) < 0.0 < rate(1.002 * threshold)


def test_without_a_defect_vibration_decays_with_the_damping():
    for speed in (400.0, 1650.0, 3300.0):
        assert growth_rate(model(), speed) == pytest.approx(-0.023 * math.tau * 55.0, rel=1e-9)


def test_table_1_is_stable_where_the_paper_simulates_it():
    assert growth_rate(table_1(), 750.0) < 0.0


def test_grows_in_time_as_it_says():
    """The envelope of a free vibration, integrated over whole periods, follows the Floquet exponent."""
    unstable = model(circular_spline=(0.14,))
    rate = growth_rate(unstable, PRINCIPAL)
    omega = math.tau * PRINCIPAL / 60.0 / 80.0
    period, periods, steps = math.tau / 160.0 / omega, 400, 64
    times = np.linspace(0.0, periods * period, periods * steps + 1)
    oscillator = Oscillator(
        unstable.dynamics, unstable.stiffness_fluctuation(omega * gauss_times(times)), np.diff(times)
    )
    x, v = oscillator.respond(np.zeros((2, periods * steps)), (1e-6, 0.0))
    size = np.hypot(x, v / unstable.dynamics.angular_frequency)
    early, late = size[200 * steps], size[400 * steps]
    assert math.log(late / early) / (200 * period) == pytest.approx(rate, rel=1e-3)


def test_phases_do_not_matter():
    """A shift of the origin turns one spline's phase into the other's, and stability has no origin."""
    shifted = ParametricModel(
        flexspline=StiffnessSeries((0.10,), (1.0,)), circular_spline=StiffnessSeries((0.08,), (2.5,))
    )
    straight = ParametricModel(flexspline=StiffnessSeries((0.10,)), circular_spline=StiffnessSeries((0.08,)))
    assert growth_rate(shifted, 3280.0) == pytest.approx(growth_rate(straight, 3280.0), abs=1e-3)


def test_direction_does_not_matter():
    assert growth_rate(table_1(), -1300.0) == growth_rate(table_1(), 1300.0)


def test_nothing_decays_without_damping():
    """Below the tongues an undamped oscillator neither grows nor decays (Liouville)."""
    undamped = model(flexspline=(0.03,), damping_ratio=0.0)
    assert growth_rate(undamped, 1000.0) == pytest.approx(0.0, abs=1e-6)


def test_fast_decay_does_not_underflow():
    """At a low speed a period is long, and the transition matrix smaller than any number."""
    damped = model(flexspline=(0.05,), damping_ratio=0.3)
    assert growth_rate(damped, 20.0) == pytest.approx(-0.3 * math.tau * 55, rel=1e-3)


def test_the_chart_is_the_growth_rate_at_each_place():
    base = model(circular_spline=(0.10,))
    chart = stability_chart(base, [3200.0, 3300.0], [0.5, 1.0, 1.5])
    assert chart.shape == (3, 2)
    assert chart[2, 1] == growth_rate(scale_defects(base, 1.5), 3300.0)
    assert np.all(np.diff(chart[:, 1]) > 0.0)


def test_scaling_keeps_phases():
    scaled = scale_defects(ParametricModel(flexspline=StiffnessSeries((0.1, 0.2), (0.3, 0.4))), 2.0)
    assert scaled.flexspline == StiffnessSeries((0.2, 0.4), (0.3, 0.4))


@pytest.mark.parametrize("speed", [0.0, math.nan])
def test_a_speed_without_a_period_is_refused(speed):
    with pytest.raises(ParameterError, match="speed"):
        growth_rate(table_1(), speed)
