"""From evidence to a verdict: limits with hysteresis, confidence, confirmation N of M, latch."""

import math
from collections import deque
from dataclasses import replace

from ..identification.result import Identification
from ..reducer import LinePair, Mount
from ..settings import DiagnosisSettings, JointSettings
from .limitations import describe_limitation
from .probability import (
    Probabilities,
    beyond,
    component_probabilities,
    find_cause,
    index_probabilities,
    name_component,
    severity,
)
from .verdict import Cause, Component, FaultCode, Level, Verdict
from .wording import (
    describe_component,
    describe_doubtful_limit,
    describe_doubtful_name,
    describe_relative,
    describe_unexplained,
    describe_unknown_scale,
)

LIKELY = 0.5
"""Probability of a defect from which its part is named although the torque is not known well enough for limits."""


class Judge:
    """Keeps one joint's verdict.

    Parameters
    ----------
    settings : JointSettings
        Only ``diagnosis.*`` and the mount are used.

    Notes
    -----
    A verdict about the present evidence becomes the shown one when `confirm_count` of the last `confirm_window`
    verdicts agree on component and level; until the first agreement there is no verdict yet. Wording and figures
    follow the evidence at once. A latched verdict stays until a worse one or :meth:`reset_latch`.
    """

    def __init__(self, settings: JointSettings) -> None:
        self._limits = settings.diagnosis
        # The spline whose line is exactly twice per wave-generator revolution, as the motor's ripple is.
        fixed = settings.reducer.mount is Mount.CIRCULAR_SPLINE_FIXED
        self._motor_side = Component.CIRCULAR_SPLINE if fixed else Component.FLEXSPLINE
        self._recent: deque[tuple[Component, Level]] = deque(maxlen=self._limits.confirm_window)
        self._shown = Verdict.waiting("nothing has been judged so far")
        self._latched: Verdict | None = None

    def change_limits(self, limits: DiagnosisSettings) -> None:
        """Put other limits in force; what is shown stays until the next verdicts."""
        self._limits = limits
        self._recent = deque(self._recent, maxlen=limits.confirm_window)
        if not limits.latch:
            self._latched = None

    def reset_latch(self) -> None:
        """Release a latched verdict."""
        self._latched = None

    def judge(self, evidence: Identification | None, otherwise: Verdict) -> Verdict:
        """Judge the evidence at one time.

        Parameters
        ----------
        evidence : Identification or None
        otherwise : Verdict
            For the case that there is no evidence yet.
        """
        now = otherwise if evidence is None else self._assess(evidence)
        self._recent.append(_kind(now))
        shown = self._shown
        count = self._recent.count(_kind(now))
        if _kind(shown) == _kind(now) or count >= self._limits.confirm_count:
            shown = now
        else:  # the sentence describes the present evidence, though what is shown stays until it is confirmed
            awaited = f"To be confirmed ({count} of {self._limits.confirm_count} verdicts): {now.sentence}"
            if shown.fault_code is not FaultCode.WAITING:
                return self._latch(replace(shown, reason=awaited))
            shown = Verdict.waiting(awaited)
        self._shown = shown
        return self._latch(shown)

    def conclude(self, evidence: Identification) -> Verdict:
        """Judge evidence that will not change any more: it confirms itself."""
        self._recent.extend([_kind(self._assess(evidence))] * self._limits.confirm_count)
        return self.judge(evidence, self._shown)

    def _latch(self, shown: Verdict) -> Verdict:
        if not self._limits.latch:
            return shown
        held = self._latched
        worse = held is None or shown.level > held.level or shown.component == held.component
        if shown.level > Level.OK and shown.component is not Component.UNDETERMINED and worse:
            self._latched = held = shown
        if held is None or held is shown:
            return shown
        return replace(held, reason=f"latched: {held.reason} (now: {shown.reason})")

    def _assess(self, evidence: Identification) -> Verdict:
        if evidence.blockers:
            # Blocked indexes carry no level either
            reason = "; ".join(map(describe_limitation, evidence.blockers))
            wait = all(blocker.is_not_yet for blocker in evidence.blockers)
            return Verdict.waiting(reason) if wait else self._undetermined(reason)
        if evidence.is_unexplained:
            return self._undetermined(describe_unexplained(evidence))
        if evidence.relative and math.isinf(evidence.scale_std):
            return self._assess_relative(evidence)
        verdict = self._assess_absolute(evidence)
        if evidence.relative and verdict.component in (Component.NONE, Component.UNDETERMINED):
            return self._assess_scaleless(evidence)
        return verdict

    def _assess_absolute(self, evidence: Identification) -> Verdict:
        """Accuse a part whose index or transmission error is beyond its limit, as surely as is required."""
        limits = self._limits
        alarmed = self._shown.component not in (Component.NONE, Component.UNDETERMINED)
        limit = limits.warn_index * (1.0 - limits.hysteresis) if alarmed else limits.warn_index
        odds, sizes = component_probabilities(evidence, limits, limit), severity(evidence, limits)
        accused = [probability >= limits.confidence for probability in beyond(evidence, limits, limit)]
        if odds.none >= limits.confidence:
            return self._named(Component.NONE, Level.OK, evidence, Cause.NONE)
        if not any(accused) and 1.0 - odds.none < limits.confidence:
            if evidence.is_hidden_by_misfit(limits.warn_index):
                return self._undetermined(describe_unexplained(evidence))
            return Verdict.waiting(describe_doubtful_limit(evidence, limits, limit))
        component = name_component(
            LinePair(*(max(size, limit) if one else 0.0 for size, one in zip(sizes, accused, strict=True))),
            limit,
            limits.both_ratio,
        )
        level = self._magnitude(evidence)
        if component is Component.NONE or self._contradicted(component, odds):
            return self._undetermined(describe_doubtful_name(evidence, odds), level)
        return self._named(component, level, evidence, find_cause(evidence, limits, limit))

    def _assess_scaleless(self, evidence: Identification) -> Verdict:
        """Name the dominating part, if it may well be defective, where the torque is too uncertain for limits."""
        odds = component_probabilities(evidence, self._limits, self._limits.warn_index)
        if odds.none > 1.0 - LIKELY:
            return Verdict.waiting(describe_unknown_scale(evidence))
        return self._assess_relative(evidence)

    def _assess_relative(self, evidence: Identification) -> Verdict:
        """Without the torque only the ratio of the two indexes means something: no limit applies."""
        component = name_component(evidence.index, 0.0, self._limits.both_ratio)
        odds = index_probabilities(evidence, self._limits, 0.0)
        if self._contradicted(component, odds):
            return self._undetermined(describe_doubtful_name(evidence, odds))
        return Verdict.naming(component, Level.OK, describe_relative(component, evidence), Cause.RELATIVE)

    def _contradicted(self, component: Component, odds: Probabilities) -> bool:
        """Whether a part that should not be named alone could be the one after all, beyond the required confidence."""
        opposite = {
            Component.CIRCULAR_SPLINE: odds.flexspline,
            Component.FLEXSPLINE: odds.circular_spline,
            Component.BOTH: min(odds.circular_spline, odds.flexspline),
            Component.NONE: 0.0,
        }[component]
        return opposite > 1.0 - self._limits.confidence

    def _magnitude(self, evidence: Identification) -> Level:
        """Level that the worst reading calls for, whichever spline it belongs to."""
        limits = self._limits
        shown = self._shown.level
        easier = 1.0 - limits.hysteresis
        readings = [(max(evidence.index), limits.warn_index, limits.error_index)]
        if evidence.transmission_error is not None:
            error = max(evidence.transmission_error)
            readings.append((error, limits.warn_transmission_error, limits.error_transmission_error))
        if any(value >= error * (easier if shown is Level.ERROR else 1.0) for value, _, error in readings):
            return Level.ERROR
        reached = any(value >= warn * (easier if shown > Level.OK else 1.0) for value, warn, _ in readings)
        return Level.WARN if reached else Level.OK

    def _named(self, component: Component, level: Level, evidence: Identification, cause: Cause) -> Verdict:
        reason = describe_component(component, level, cause, evidence, self._limits, self._motor_side)
        return Verdict.naming(component, level, reason, cause)

    @staticmethod
    def _undetermined(reason: str, level: Level = Level.WARN) -> Verdict:
        return Verdict.naming(Component.UNDETERMINED, max(level, Level.WARN), reason)


def _kind(verdict: Verdict) -> tuple[Component, Level]:
    """Return what must agree for a confirmation: that no part can be named needs none beside that none can yet."""
    return verdict.component, Level.WARN if verdict.fault_code is FaultCode.WAITING else verdict.level
