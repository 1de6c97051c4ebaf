"""What weakens an identification with a sensor, and what forbids naming a part on it."""

import math
from collections.abc import Iterator

import numpy as np
import scipy

from ...arrays import FloatArray
from ...limitation import Limitation, LimitationCode, blocker, doubt
from ..fit.gauss_newton import Fit, FitStatus
from ..fit.unknowns import TORQUE_LINES
from .context import Context
from .state import State

SURE = 3.0
"""Standard deviations by which a value must differ from the one given before that is said."""

_DISPUTED = 19.0  # inflation from which a wandering inertia, which can follow much, names no part
_CONFIRMED = 2.0  # motion in all, over that on which a wandering inertia was found: as much again must agree with it
_WIDENED = 2.25  # inflation of the variances that is worth mentioning
_WIND_UP = 0.25  # rad; no reducer takes it
_CORRECTED_FREQUENCY, _CORRECTED_DAMPING, _CORRECTED_TORQUE = 0.02, 0.3, 0.25
_CORRECTED_DELAY = 1e-3  # s
_FEWEST = 15.0  # values of the spectrum for each unknown
_UNSEEN = 0.05  # standard deviation of a β from which its line was not heard at any speed
_CHANCE = 1e-3  # of noise alone to reach what counts as a line
_STARTS = 2.0  # by how much the best of several starts explains more of noise
_GAUSSIAN = 8.0  # times what chance explains, from which the likelihood is as good as Gaussian


def limitations_of(context: Context, state: State, fit: Fit, covariance: FloatArray) -> tuple[Limitation, ...]:
    """Return what limits a state's newest fit, whose unknowns have this covariance."""
    std = np.sqrt(np.maximum(covariance.diagonal(), 0.0))
    found = [*_corrections(context, state, fit, std), *_other_parts(context, state, fit, std)]
    if state.inflation > _WIDENED:
        left = state.residual.unexplained
        found.append(doubt(LimitationCode.UNCERTAINTY_WIDENED, factor=math.sqrt(state.inflation), unexplained=left))
    if state.setup.wanders:
        if state.seconds < _CONFIRMED * state.setup.moving_since:
            found.append(blocker(LimitationCode.INERTIA_MOVES))
        elif state.inflation > _DISPUTED:
            found.append(blocker(LimitationCode.SEGMENTS_DISAGREE, factor=math.sqrt(state.inflation)))
    missing = _absurd(context, state) or _too_weak(context, state, fit) or _too_few(context, state)
    found.extend(one for one in (missing, _unheard(context, state, std)) if one is not None)
    return tuple(found)


def _absurd(context: Context, state: State) -> Limitation | None:
    """Return that no reducer withstands the torque."""
    torque = state.setup.reference_torque
    if torque > _WIND_UP * context.given.stiffness and not state.relative:
        wind_up = math.degrees(torque / context.given.stiffness)
        return blocker(LimitationCode.TORQUE_ABSURD, torque_nm=torque, wind_up_deg=wind_up)
    return None


def _too_few(context: Context, state: State) -> Limitation | None:
    """Return that there are too few values beyond those that the unknowns take up: no misfit would show yet."""
    if state.floor is not None and float(state.floor.freedom.sum()) < _FEWEST * context.unknowns.size:
        return blocker(LimitationCode.VALUES_TOO_FEW)
    return None


def _unheard(context: Context, state: State, std: FloatArray) -> Limitation | None:
    """Return what lies beyond the sensor's bandwidth."""
    u, rpm, heard = context.unknowns, _mean_rpm(context, state), _pairs_heard(context, state)
    if heard >= u.harmonics:
        return None
    limit = state.recent[-1].low_pass.limit
    if not heard:
        return blocker(LimitationCode.LINES_BEYOND_BANDWIDTH, speed_rpm=rpm, limit_hz=limit)
    if float(std[u.stiffness].max()) < _UNSEEN:
        return None  # at other speeds they were heard
    return doubt(LimitationCode.LINES_PARTLY_HEARD, speed_rpm=rpm, limit_hz=limit, k=heard + 1, heard=heard)


def _pairs_heard(context: Context, state: State) -> int:
    """Line pairs within the sensor's bandwidth at the mean speed."""
    highest = context.settings.reducer.line_frequencies(_mean_rpm(context, state)).flexspline
    return math.floor(state.recent[-1].low_pass.limit / highest)


def _too_weak(context: Context, state: State, fit: Fit) -> Limitation | None:
    """Return that chance alone explains what is explained of the vibration, or might: no lines are no proof of health.

    So near the noise the likelihood is not the Gaussian that decisions are read from.
    """
    chance = float(scipy.special.chdtri(context.unknowns.size, _CHANCE))
    if state.heard < _STARTS * chance:
        return blocker(LimitationCode.LINES_ABSENT)
    if state.heard < _GAUSSIAN * chance:
        rpm, ratio = _mean_rpm(context, state), fit.signal_to_noise
        return blocker(LimitationCode.LINES_TOO_WEAK, speed_rpm=rpm, signal_to_noise_db=ratio)
    return None


def _mean_rpm(context: Context, state: State) -> float:
    return state.coverage.mean_speed * context.settings.reducer.reduction * 60.0 / math.tau


def _corrections(context: Context, state: State, fit: Fit, std: FloatArray) -> Iterator[Limitation]:
    """Yield where the data say something else than what was given."""
    u, given, values = context.unknowns, context.given, fit.values
    names = {u.frequency: "natural frequency", u.damping: "damping ratio", u.torque: "torque", u.delay: "clock offset"}
    bound = {place for place in names if abs(values[place]) >= u.bounds()[place]}
    if fit.status is FitStatus.ON_BOUND and bound:
        yield blocker(LimitationCode.VALUE_ON_BOUND, names=" and ".join(names[place] for place in sorted(bound)))

    def differs(place: int, least: float) -> bool:
        return place not in bound and abs(values[place]) > max(least, SURE * std[place])

    if differs(u.frequency, _CORRECTED_FREQUENCY):
        frequency = given.natural_frequency
        fitted = frequency * math.exp(values[u.frequency])
        yield doubt(LimitationCode.NATURAL_FREQUENCY_CORRECTED, fitted_hz=fitted, given_hz=frequency)
    if differs(u.damping, _CORRECTED_DAMPING):
        damping = given.damping_ratio
        yield doubt(LimitationCode.DAMPING_CORRECTED, fitted=damping * math.exp(values[u.damping]), given=damping)
    if state.coverage.speed_varies and differs(u.delay, _CORRECTED_DELAY):
        motion_lags = values[u.delay] > 0.0
        code = LimitationCode.MOTION_STAMPS_LAG if motion_lags else LimitationCode.VIBRATION_STAMPS_LAG
        yield doubt(code, delay_ms=1e3 * abs(float(values[u.delay])))
    if state.setup.nominal_torque is None and differs(u.torque, _CORRECTED_TORQUE):
        factor = math.exp(values[u.torque])
        if context.contradicts_torque(state.setup, values):
            yield blocker(LimitationCode.TORQUE_CONTRADICTED, factor=factor)
        else:
            yield doubt(LimitationCode.TORQUE_CORRECTED, factor=factor)


def _other_parts(context: Context, state: State, fit: Fit, std: FloatArray) -> Iterator[Limitation]:
    """Yield the parts besides the splines whose lines stand out."""
    u, unit = context.unknowns, state.setup.reference_torque
    for order in u.load_orders:
        if part := TORQUE_LINES.get(order):
            place = u.load_line(order)
            size, own = float(np.linalg.norm(fit.values[place])), float(np.linalg.norm(std[place])) / math.sqrt(2.0)
            if size > SURE * own:
                yield doubt(LimitationCode.OTHER_PART, part=part, order=order, torque_nm=unit * size, std_nm=unit * own)
