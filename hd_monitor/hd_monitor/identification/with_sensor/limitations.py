"""What weakens an identification with a sensor, and what forbids naming a part on it."""

import math
from collections.abc import Iterator, Mapping

import numpy as np
from scipy.special import chdtri

from ...limitation import Limitation, LimitationCode, blocker, doubt
from ...reducer import LinePair
from ..fit.gauss_newton import Fit, FitStatus
from ..fit.indexes import Indexes, stiffness_indexes
from ..fit.score_test import ScoreTest, score_tests
from ..fit.unknowns import TORQUE_LINES
from .context import Context
from .state import State

CONTRADICTION = 4.5
"""Standard deviations by which data must contradict what was given before it is estimated, or said."""

_LEAST_TRAVEL = math.radians(85.0)  # of the output: half of what separates the lines by Fourier means, and less
_LEAST_MOTION = 3.4  # s, below which other solutions have not been looked for yet
_TRUSTED_FREQUENCY, _TRUSTED_DAMPING = 0.05, 0.3  # relative errors of what was given, twice which a name must survive
_VAGUE = 0.5  # standard deviation of both indexes over the warn limit from which nothing can be said
_NOTABLE = 0.1  # change of the logarithm of the indexes' ratio that matters
_WIDENED = 2.25  # inflation of the variances that is worth mentioning
_UNEXPLAINED = 0.15  # amplitude left at the lines, relative to what is explained, that forbids a name
_WIND_UP = 0.25  # rad; no reducer takes it
_CORRECTED_FREQUENCY, _CORRECTED_DAMPING, _CORRECTED_TORQUE = 0.02, 0.3, 0.25
_CORRECTED_DELAY = 1e-3  # s
_CHANCE = 1e-3  # of noise alone to reach what counts as a line
_BELIEVED_FREQUENCY = 0.3  # of ln fn, beyond which a first-order estimate of it means nothing


def limitations_of(context: Context, state: State, fit: Fit, indexes: Indexes) -> tuple[Limitation, ...]:
    """Return what limits a state's newest fit, the most serious first among those that forbid naming a part."""
    u = context.unknowns
    questioned = (u.frequency, u.damping, u.torque, u.delay)
    tests = score_tests(questioned, context.known(state), fit.values, state.active, u.given_std())
    found = [*_contradictions(context, state, fit, tests), *_other_parts(context, state, fit)]
    if state.inflation > _WIDENED:
        if state.residual.unexplained > _UNEXPLAINED:
            percent = 100.0 * state.residual.unexplained
            found.append(blocker(LimitationCode.LINES_UNEXPLAINED, unexplained_percent=percent))
        else:
            found.append(doubt(LimitationCode.UNCERTAINTY_WIDENED, factor=math.sqrt(state.inflation)))
    missing = _absurd(context, state) or _missing(context, state, fit, indexes)
    if missing is None and _is_fragile(context, state, fit, indexes, tests):
        missing = blocker(LimitationCode.NEAR_RESONANCE, given_hz=context.given.natural_frequency)
    return (*found, missing) if missing is not None else tuple(found)


def _absurd(context: Context, state: State) -> Limitation | None:
    """Return that no reducer withstands the torque."""
    torque = state.setup.reference_torque
    if torque > _WIND_UP * context.given.stiffness and not state.relative:
        wind_up = math.degrees(torque / context.given.stiffness)
        return blocker(LimitationCode.TORQUE_ABSURD, torque_nm=torque, wind_up_deg=wind_up)
    return None


def _missing(context: Context, state: State, fit: Fit, indexes: Indexes) -> Limitation | None:
    """Return what motion or signal is missing before anything can be named."""
    coverage, warn_index = state.coverage, context.settings.diagnosis.warn_index
    if coverage.span < _LEAST_TRAVEL:
        travel, needed = math.degrees(coverage.span), math.degrees(_LEAST_TRAVEL)
        return blocker(
            LimitationCode.TRAVEL_TOO_SHORT,
            travel_deg=travel,
            needed_deg=needed,
            missing_deg=math.ceil(needed - travel),
        )
    if coverage.time < _LEAST_MOTION:
        return blocker(LimitationCode.MOTION_TOO_SHORT, motion_s=coverage.time, needed_s=_LEAST_MOTION)
    scale = max(warn_index, *indexes.index) if state.relative else warn_index
    std, rpm, heard = _index_std(context, state, fit, indexes), _mean_rpm(context, state), _pairs_heard(context, state)
    if heard < context.unknowns.harmonics and max(std) > _VAGUE * scale:
        limit = state.recent[-1].low_pass.limit
        if not heard:
            return blocker(LimitationCode.LINES_BEYOND_BANDWIDTH, speed_rpm=rpm, limit_hz=limit)
        return blocker(LimitationCode.LINES_PARTLY_HEARD, speed_rpm=rpm, limit_hz=limit, k=heard + 1, heard=heard)
    if min(std) > _VAGUE * scale:
        return blocker(LimitationCode.LINES_TOO_WEAK, speed_rpm=rpm, signal_to_noise_db=fit.signal_to_noise)
    return blocker(LimitationCode.LINES_ABSENT) if _are_absent(context, state, fit) else None


def _pairs_heard(context: Context, state: State) -> int:
    """Line pairs within the sensor's bandwidth at the mean speed."""
    highest = context.settings.reducer.line_frequencies(_mean_rpm(context, state)).flexspline
    return math.floor(state.recent[-1].low_pass.limit / highest)


def _are_absent(context: Context, state: State, fit: Fit) -> bool:
    """Whether noise alone explains all that was found at both splines' lines: no lines are no proof of health."""
    u = context.unknowns
    lines = u.mask(u.stiffness, u.displacement)
    # What the lines change in the prediction, in standard deviations of the noise
    found, information = fit.values[lines], state.information.matrix[np.ix_(lines, lines)]
    return float(found @ information @ found) < state.inflation * float(chdtri(found.size, _CHANCE))


def _index_std(context: Context, state: State, fit: Fit, indexes: Indexes) -> LinePair:
    """Standard deviations of the indexes, were there no transmission error: its likeness does not make lines weak."""
    u = context.unknowns
    if not u.transmission_error:
        return indexes.std
    active = state.active & ~u.mask(u.displacement)
    return stiffness_indexes(u, fit.values, state.inflation * context.known(state).covariance(active)).std


def _mean_rpm(context: Context, state: State) -> float:
    return state.coverage.mean_speed * context.settings.reducer.reduction * 60.0 / math.tau


def _contradictions(context: Context, state: State, fit: Fit, tests: Mapping[int, ScoreTest]) -> Iterator[Limitation]:
    """Yield where the data contradict what was given."""
    u, given, values, active = context.unknowns, context.given, fit.values, state.active
    names = {u.frequency: "natural frequency", u.damping: "damping ratio", u.torque: "torque", u.delay: "clock offset"}
    bound = {place for place in names if active[place] and abs(values[place]) >= u.bounds()[place]}
    if fit.status is FitStatus.ON_BOUND:
        yield doubt(LimitationCode.VALUE_ON_BOUND, names=" and ".join(names[place] for place in sorted(bound)))
    frequency, test = given.natural_frequency, tests[u.frequency]
    if active[u.frequency]:
        if abs(values[u.frequency]) > _CORRECTED_FREQUENCY and u.frequency not in bound:
            fitted = frequency * math.exp(values[u.frequency])
            yield doubt(LimitationCode.NATURAL_FREQUENCY_CORRECTED, fitted_hz=fitted, given_hz=frequency)
    elif test.significance > CONTRADICTION and abs(test.value) > _CORRECTED_FREQUENCY:
        shift = float(np.clip(test.value, -_BELIEVED_FREQUENCY, _BELIEVED_FREQUENCY))
        yield blocker(
            LimitationCode.NATURAL_FREQUENCY_CONTRADICTED, fitted_hz=frequency * math.exp(shift), given_hz=frequency
        )
    if active[u.damping] and abs(values[u.damping]) > _CORRECTED_DAMPING and u.damping not in bound:
        damping = given.damping_ratio
        yield doubt(LimitationCode.DAMPING_CORRECTED, fitted=damping * math.exp(values[u.damping]), given=damping)
    if active[u.delay] and abs(values[u.delay]) > _CORRECTED_DELAY and u.delay not in bound:
        motion_lags = values[u.delay] > 0.0
        code = LimitationCode.MOTION_STAMPS_LAG if motion_lags else LimitationCode.VIBRATION_STAMPS_LAG
        yield doubt(code, delay_ms=1e3 * abs(float(values[u.delay])))
    test = tests[u.torque]
    # What the lines' coupling says of the torque is wrong where lines are not heard
    audible = _pairs_heard(context, state) >= u.harmonics
    if audible and not state.relative and test.significance > CONTRADICTION and abs(test.value) > _CORRECTED_TORQUE:
        yield blocker(LimitationCode.TORQUE_TOO_SMALL if test.value > 0.0 else LimitationCode.TORQUE_TOO_LARGE)


def _other_parts(context: Context, state: State, fit: Fit) -> Iterator[Limitation]:
    """Yield the parts besides the splines whose lines stand out."""
    u, unit = context.unknowns, state.setup.reference_torque
    for order in u.load_orders:
        if part := TORQUE_LINES.get(order):
            place = u.load_line(order)
            size = float(np.linalg.norm(fit.values[place]))
            std = math.sqrt(state.inflation * float(np.mean(fit.covariance[place, place])))
            if size > CONTRADICTION * std:
                yield doubt(LimitationCode.OTHER_PART, part=part, order=order, torque_nm=unit * size, std_nm=unit * std)


def _is_fragile(context: Context, state: State, fit: Fit, indexes: Indexes, tests: Mapping[int, ScoreTest]) -> bool:
    """Whether an error in natural frequency or damping, unseen by the data, could change the name."""
    u, index = context.unknowns, indexes.index
    if min(index) <= 0.0 or (max(index) < context.settings.diagnosis.warn_index and not state.relative):
        return False
    shift = 0.0
    for place, trusted in ((u.frequency, _TRUSTED_FREQUENCY), (u.damping, _TRUSTED_DAMPING)):
        if not state.active[place]:
            test = tests[place]
            error = 1.0 / math.sqrt(1.0 / trusted**2 + 1.0 / test.std**2)
            # change of the logarithm of each spline's index per unit of the unknown
            slopes = [
                float(fit.values[part] @ test.response[part]) / size**2
                for part, size in ((u.flexspline, index.flexspline), (u.circular_spline, index.circular_spline))
            ]
            shift += (2.0 * error * (slopes[0] - slopes[1])) ** 2
    shift = math.sqrt(shift)
    return shift >= _NOTABLE and abs(math.log(index.flexspline / index.circular_spline)) <= shift
