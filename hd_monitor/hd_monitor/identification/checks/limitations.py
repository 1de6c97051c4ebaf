"""What weakens an identification, and what forbids naming a part on it: in words for a technician."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ...arrays import BoolArray, FloatArray
from ...reducer import LinePair
from ...settings import JointSettings
from ..fit.linearisation import Predictor
from ..fit.score_test import ScoreTest
from ..fit.unknowns import Unknowns
from ..with_sensor.indexes import Indexes
from .coverage import Coverage

LEAST_TRAVEL = math.radians(85.0)
"""Output travel [rad] below which no part is named: half of what separates the lines by Fourier means, and less."""

LEAST_MOTION = 3.4
"""Motion [s] below which other solutions have not been looked for yet."""

CONTRADICTION = 4.5
"""Standard deviations by which data must contradict what was given before that is said."""

TRUSTED_FREQUENCY, TRUSTED_DAMPING = 0.05, 0.3
"""Relative errors of the given natural frequency and damping ratio, twice which a name must survive."""

_VAGUE = 0.5  # standard deviation of both indexes over the warn limit from which nothing can be said
_NOTABLE = 0.1  # change of the logarithm of the indexes' ratio that matters
_WIDENED = 2.25  # inflation of the variances that is worth mentioning
_UNEXPLAINED = 0.15  # amplitude left at the lines, relative to what is explained, that forbids a name
_WIND_UP = 0.25  # rad; no reducer takes it
_BAND = 0.9  # of half the sampling rate
_CORRECTED_FREQUENCY, _CORRECTED_DAMPING, _CORRECTED_TORQUE = 0.02, 0.3, 0.25
_CORRECTED_DELAY = 1e-3  # s


@dataclass(frozen=True, slots=True, kw_only=True)
class Findings:
    """Doubts and blockers, see :class:`hd_monitor.identification.result.Identification`."""

    doubts: tuple[str, ...] = ()
    blockers: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Suspect:
    """The result that is to be examined.

    Attributes
    ----------
    predictor : Predictor
    values : ndarray, shape (unknowns,)
    active : ndarray of bool, shape (unknowns,)
        Unknowns that were fitted.
    indexes : Indexes
    scores : mapping of int to ScoreTest
        What the data alone say of natural frequency, damping, torque and delay.
    inflation : float
        Factor on the variances by which the model's misfit widened them.
    unexplained : float
        Amplitude of what the model leaves at the lines over that of what it explains.
    highest_frequency : float
        [Hz] that the sensor's rate shows.
    coverage : Coverage
    signal_to_noise : float
        [dB]
    relative : bool
        Whether nobody knows the torque.
    """

    predictor: Predictor
    values: FloatArray
    active: BoolArray
    indexes: Indexes
    scores: Mapping[int, ScoreTest]
    inflation: float
    unexplained: float
    highest_frequency: float
    coverage: Coverage
    signal_to_noise: float
    relative: bool

    @property
    def unknowns(self) -> Unknowns:
        """Layout of the values."""
        return self.predictor.unknowns


class Scrutiny:
    """Examines results.

    Parameters
    ----------
    settings : JointSettings
    """

    def __init__(self, settings: JointSettings) -> None:
        self._reducer = settings.reducer
        self._warn = settings.diagnosis.warn_index
        self._refine = settings.refine_dynamics

    def examine(self, suspect: Suspect) -> Findings:
        """Return what is doubtful about a result."""
        doubts, blockers = self._given(suspect)
        missing = self._unseen(suspect) or self._missing(suspect)
        fragile = "" if missing else self._fragile(suspect)
        if suspect.inflation > _WIDENED:
            widened = f"{math.sqrt(suspect.inflation):.1f} times"
            if suspect.unexplained > _UNEXPLAINED:
                blockers.append(
                    f"{100.0 * suspect.unexplained:.0f} % of the vibration at the lines is not explained by the model: "
                    "check teeth, mount, natural frequency and torque, and look for another source of vibration near "
                    "the lines (mains hum, a neighbouring machine)"
                )
            else:
                doubts.append(f"the model explains the lines only in part, so the uncertainties are widened {widened}")
        blockers += [text for text in (missing, fragile) if text]
        return Findings(doubts=tuple(doubts), blockers=tuple(blockers))

    def _unseen(self, suspect: Suspect) -> str:
        """Say whether the sensor's rate hides what matters, or the torque is absurd; empty if neither."""
        highest, frequency = suspect.highest_frequency, suspect.predictor.given.natural_frequency
        if frequency > _BAND * highest:
            return (
                f"The natural frequency given, {frequency:g} Hz, lies beyond what {2.0 * highest:.0f} samples a second "
                "show: sample faster, or correct dynamics.natural_frequency"
            )
        torque, stiffness = suspect.predictor.reference_torque, suspect.predictor.given.stiffness
        if torque > _WIND_UP * stiffness and not suspect.relative:
            return (
                f"A torque of {torque:.3g} N·m would wind the reducer up by {math.degrees(torque / stiffness):.0f}°: "
                "check the effort's unit, dynamics.inertia and dynamics.natural_frequency"
            )
        rpm = suspect.coverage.mean_speed * self._reducer.reduction * 60.0 / math.tau
        if self._reducer.line_frequencies(rpm).flexspline > _BAND * highest:
            return (
                f"At {rpm:.0f} rpm the lines lie beyond what {2.0 * highest:.0f} samples a second show: sample faster, "
                "or turn more slowly"
            )
        return ""

    def _missing(self, suspect: Suspect) -> str:
        """Say what motion or signal is missing before anything can be named; empty if nothing is."""
        coverage, std = suspect.coverage, suspect.indexes.std
        travel = math.degrees(coverage.span)
        if coverage.span < LEAST_TRAVEL:
            least = math.degrees(LEAST_TRAVEL)
            return (
                f"Only {travel:.0f}° of output travel seen: at least {least:.0f}° are needed to tell the two splines' "
                f"lines apart, {math.ceil(least - travel):d}° more"
            )
        if coverage.time < LEAST_MOTION:
            return (
                f"Only {coverage.time:.0f} s of motion seen: {LEAST_MOTION:.0f} s are needed to rule out other causes"
            )
        scale = max(self._warn, *suspect.indexes.index) if suspect.relative else self._warn
        if min(std) <= _VAGUE * scale:
            return ""
        rpm = coverage.mean_speed * self._reducer.reduction * 60.0 / math.tau
        return (
            f"The lines are too weak against the noise at {rpm:.0f} rpm (signal to noise {suspect.signal_to_noise:.0f} "
            "dB): turn faster, load the joint more, or go on longer"
        )

    def _given(self, suspect: Suspect) -> tuple[list[str], list[str]]:
        """Say where the data contradict what was given: doubts and blockers."""
        u, given, values = suspect.unknowns, suspect.predictor.given, suspect.values
        doubts, blockers = [], []
        frequency, score = given.natural_frequency, suspect.scores[u.frequency]
        if suspect.active[u.frequency]:
            if abs(values[u.frequency]) > _CORRECTED_FREQUENCY:
                doubts.append(
                    f"the vibration fits a natural frequency of {frequency * math.exp(values[u.frequency]):.1f} Hz, "
                    f"not the {frequency:g} Hz given: correct dynamics.natural_frequency"
                )
        elif score.significance > CONTRADICTION and abs(score.value) > _CORRECTED_FREQUENCY:
            blockers.append(
                f"The natural frequency given, {frequency:g} Hz, contradicts the vibration, which fits about "
                f"{frequency * math.exp(float(np.clip(score.value, -0.3, 0.3))):.1f} Hz: correct "
                "dynamics.natural_frequency or allow dynamics.refine"
            )
        if suspect.active[u.damping] and abs(values[u.damping]) > _CORRECTED_DAMPING:
            doubts.append(
                f"the vibration fits a damping ratio of {given.damping_ratio * math.exp(values[u.damping]):.3f}, not "
                f"the {given.damping_ratio:g} given"
            )
        if suspect.active[u.delay] and abs(values[u.delay]) > _CORRECTED_DELAY:
            late, early = ("joint states", "vibration") if values[u.delay] > 0.0 else ("vibration", "joint states")
            doubts.append(
                f"the stamps of the {late} lag those of the {early} by {1e3 * abs(values[u.delay]):.1f} ms, which is "
                "allowed for"
            )
        torque = suspect.scores[u.torque]
        if not suspect.relative and torque.significance > CONTRADICTION and abs(torque.value) > _CORRECTED_TORQUE:
            direction = "larger" if torque.value > 0.0 else "smaller"
            blockers.append(
                f"The vibration contradicts the torque given, which seems to be {direction}: check load.torque or the "
                "effort's unit; the indexes' scale rests on it"
            )
        return doubts, blockers

    def _fragile(self, suspect: Suspect) -> str:
        """Say whether an error in natural frequency or damping, unseen by the data, could change the name."""
        u, index = suspect.unknowns, suspect.indexes.index
        if min(index) <= 0.0 or (max(index) < self._warn and not suspect.relative):
            return ""
        ratio = math.log(index.flexspline / index.circular_spline)
        shift = 0.0
        for place, trusted in ((u.frequency, TRUSTED_FREQUENCY), (u.damping, TRUSTED_DAMPING)):
            if suspect.active[place]:
                continue
            score = suspect.scores[place]
            error = 1.0 / math.sqrt(1.0 / trusted**2 + 1.0 / score.std**2)
            shift += (2.0 * error * _slope_of_ratio(u, suspect.values, score.response, index)) ** 2
        shift = math.sqrt(shift)
        if shift < _NOTABLE or abs(ratio) > shift:
            return ""
        return (
            f"At this speed the lines are so near the natural frequency ({suspect.predictor.given.natural_frequency:g} "
            "Hz given) that a small error in it would change the name: let the joint turn at other speeds too"
        )


def _slope_of_ratio(unknowns: Unknowns, values: FloatArray, response: FloatArray, index: LinePair) -> float:
    """Change of ln(flexspline index / circular spline index) per unit of the unknown that `response` belongs to."""
    slopes = [
        float(values[part] @ response[part]) / size**2
        for part, size in ((unknowns.flexspline, index.flexspline), (unknowns.circular_spline, index.circular_spline))
    ]
    return slopes[0] - slopes[1]
