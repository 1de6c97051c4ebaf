"""The bound that the calibration is held against: two other ways to it agree."""

from dataclasses import replace

import numpy as np
import pytest
from tests.oracle import table_1
from tests.studies import calibration, cramer_rao

from hd_monitor.model import StiffnessSeries, steady_state
from hd_monitor.model.simulation import constant_speed, simulate

SEED = 4711


def test_the_bounds_simulation_is_the_models():
    model, rate = table_1(), 1000.0
    angle = constant_speed(model.reducer, calibration.SPEED)
    slope = angle(np.array(1.0))
    truth = np.zeros(cramer_rao.SIZE)
    series = model.circular_spline.phasors, model.flexspline.phasors
    truth[cramer_rao.STIFFNESS] = np.concatenate([part for p in series for part in (p.real, p.imag)])
    ours = cramer_rao.acceleration(model, np.array([slope, 0.0]), truth[None], 2000, rate)[1000:, 0]
    theirs = simulate(model, angle, duration=2.0, rate=rate).acceleration[1000:]
    # both have forgotten the start by then: exp(-ζ ωn · 1 s) = 4e-4
    assert ours == pytest.approx(theirs, abs=2e-3 * np.abs(theirs).max())


def test_the_bound_for_stiffness_alone_is_that_of_the_harmonic_balance():
    """With loads and start known, the information is that of the steady lines' amplitudes."""
    model = table_1()
    samples = int(calibration.DURATION * calibration.RATE)
    only = np.zeros(cramer_rao.SIZE, dtype=np.bool_)
    only[cramer_rao.STIFFNESS] = True
    slope = float(np.asarray(constant_speed(model.reducer, calibration.SPEED)(np.array(1.0))))
    bound = cramer_rao.bound(
        model, [slope, 0.0], samples=samples, rate=calibration.RATE, noise=calibration.NOISE, unknown=only
    )

    def lines(change):
        phasors = [s.phasors for s in (model.circular_spline, model.flexspline)]
        moved = [p + c[:3] + 1j * c[3:] for p, c in zip(phasors, np.split(change, 2), strict=True)]
        series = [StiffnessSeries.from_phasors(p) for p in moved]
        state = steady_state(replace(model, circular_spline=series[0], flexspline=series[1]), calibration.SPEED)
        positive = 2.0 * state.acceleration[state.orders > 0]
        return np.concatenate([positive.real, positive.imag])

    columns = np.stack([(lines(1e-5 * unit) - lines(-1e-5 * unit)) / 2e-5 for unit in np.eye(12)], axis=1)
    covariance = np.linalg.inv(columns.T @ columns) * 2.0 * calibration.NOISE**2 / samples
    # two output turns are not quite whole, so the lines are not quite orthogonal, and the start is not a steady state
    assert bound.covariance[:12, :12].diagonal() == pytest.approx(covariance.diagonal(), rel=0.03)


def test_an_unknown_load_costs_information():
    least = calibration.steady_bound()
    only = np.zeros(cramer_rao.SIZE, dtype=np.bool_)
    only[cramer_rao.STIFFNESS] = True
    information = least.jacobian.T @ least.jacobian / least.noise**2
    known = np.linalg.inv(information[np.ix_(only, only)])
    assert np.all(least.covariance.diagonal()[:12] >= known.diagonal())
    assert np.any(least.covariance.diagonal()[:12] > 1.03 * known.diagonal())


def test_the_efficient_estimate_has_the_bound_as_its_covariance():
    least = calibration.steady_bound()
    errors = np.array([least.efficient_error(calibration.steady_noise(number, SEED)) for number in range(400)])[:, :12]
    squares = np.einsum("ni,ij,nj->n", errors, np.linalg.inv(least.covariance[:12, :12]), errors)
    # chi-square of 12 x 400: 2 % by chance
    assert squares.mean() / 12.0 == pytest.approx(1.0, abs=0.07)
