"""Verdicts over time: confidence, hysteresis, N of M, latch."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import norm

from hd_monitor.diagnosis.absence import WAITING
from hd_monitor.diagnosis.judge import Judge
from hd_monitor.diagnosis.verdict import Cause, Component, FaultCode, Level, Verdict
from hd_monitor.identification.result import Identification
from hd_monitor.limitation import Limitation, LimitationCode, blocker, doubt
from hd_monitor.reducer import LinePair
from hd_monitor.settings import JointSettings


def judge_of(**changes: object) -> Judge:
    return Judge(JointSettings.from_mapping({f"diagnosis.{name}": value for name, value in changes.items()}))


def evidence(cs: float, fs: float, std: float = 0.001, **changes: object) -> Identification:
    nothing = np.zeros(3, dtype=complex)
    found = Identification(
        circular_spline=nothing, flexspline=nothing, index=LinePair(cs, fs), index_std=LinePair(std, std)
    )
    return replace(found, **changes)  # type: ignore[arg-type]


def settled(judge: Judge, found: Identification | None, otherwise: Verdict = WAITING) -> Verdict:
    for _ in range(3):
        verdict = judge.judge(found, otherwise)
    return verdict


@pytest.mark.parametrize(
    ("cs", "fs", "component", "level", "code"),
    [
        (0.01, 0.02, Component.NONE, Level.OK, FaultCode.OK),
        (0.01, 0.06, Component.FLEXSPLINE, Level.WARN, FaultCode.FLEXSPLINE),
        (0.10, 0.06, Component.CIRCULAR_SPLINE, Level.ERROR, FaultCode.CIRCULAR_SPLINE),
        (0.10, 0.095, Component.BOTH, Level.ERROR, FaultCode.BOTH_SPLINES),
    ],
)
def test_clear_evidence_is_named(cs: float, fs: float, component: Component, level: Level, code: FaultCode) -> None:
    verdict = settled(judge_of(), evidence(cs, fs))
    assert (verdict.component, verdict.level, verdict.fault_code) == (component, level, code)
    assert f"flexspline index {100 * fs:.2f} ± 0." in verdict.reason


@pytest.mark.parametrize(
    ("mount", "shared", "own"),
    [
        ("circular_spline_fixed", evidence(0.10, 0.01), evidence(0.01, 0.10)),
        ("flexspline_fixed", evidence(0.01, 0.10), evidence(0.10, 0.01)),
    ],
)
def test_the_line_that_the_motor_shares_is_pointed_out(mount: str, shared: Identification, own: Identification) -> None:
    settings = JointSettings.from_mapping({"reducer.mount": mount})
    assert "motor ripple" in settled(Judge(settings), shared).reason
    assert "motor ripple" not in settled(Judge(settings), own).reason


def test_no_evidence_is_no_verdict_yet_and_says_what_is_missing() -> None:
    verdict = settled(judge_of(), None, Verdict.waiting("The joint has not turned"))
    assert (verdict.component, verdict.level) == (Component.UNDETERMINED, Level.OK)
    assert verdict.fault_code is FaultCode.WAITING
    assert verdict.reason == "No verdict yet: the joint has not turned"


SHORT = blocker(LimitationCode.ONE_STROKE)
WRONG_TORQUE = blocker(LimitationCode.TORQUE_CONTRADICTED, factor=3.0)


def test_too_little_motion_is_no_verdict_yet() -> None:
    verdict = settled(judge_of(), evidence(0.01, 0.10, limitations=(SHORT,)))
    assert (verdict.component, verdict.level) == (Component.UNDETERMINED, Level.OK)
    assert verdict.fault_code is FaultCode.WAITING
    assert verdict.reason.startswith("No verdict yet: one stroke only")


@pytest.mark.parametrize("limitations", [(WRONG_TORQUE,), (WRONG_TORQUE, SHORT)])
def test_a_contradiction_forbids_a_name_and_needs_a_person(limitations: tuple[Limitation, ...]) -> None:
    verdict = settled(judge_of(), evidence(0.01, 0.10, limitations=limitations))
    assert (verdict.component, verdict.level) == (Component.UNDETERMINED, Level.WARN)
    assert verdict.fault_code is FaultCode.UNDETERMINED
    assert verdict.reason.startswith("The vibration would fit 3 times the torque given")


def test_a_first_verdict_awaits_its_confirmation() -> None:
    judge = judge_of(confirm_count=3, confirm_window=5)
    for count in (1, 2):
        verdict = judge.judge(evidence(0.01, 0.10), WAITING)
        assert (verdict.fault_code, verdict.level) == (FaultCode.WAITING, Level.OK)
        awaited = f"No verdict yet: to be confirmed ({count} of 3 verdicts): The flexspline is defective"
        assert verdict.reason.startswith(awaited)
    assert judge.judge(evidence(0.01, 0.10), WAITING).fault_code is FaultCode.FLEXSPLINE


def test_a_name_is_held_over_a_single_look_that_lacks_motion() -> None:
    judge = judge_of()
    settled(judge, evidence(0.01, 0.10))
    verdict = judge.judge(evidence(0.01, 0.10, limitations=(SHORT,)), WAITING)
    assert verdict.fault_code is FaultCode.FLEXSPLINE
    assert "One stroke only" in verdict.reason


def test_indistinguishable_splines_are_not_named_but_the_defect_is_shown() -> None:
    verdict = settled(judge_of(), evidence(0.15, 0.12, 0.03, index_correlation=-0.9))
    assert verdict.component is Component.UNDETERMINED
    assert verdict.level is Level.ERROR
    assert "which spline" in verdict.reason


def test_a_vague_index_beside_the_limit_is_not_called_sound() -> None:
    for std, words in ((0.008, "as much motion would decide"), (0.02, "not known well enough")):
        verdict = settled(judge_of(), evidence(0.04, 0.01, std))
        assert (verdict.fault_code, verdict.level) == (FaultCode.WAITING, Level.OK)
        assert words in verdict.reason


@pytest.mark.parametrize("confidence", [0.8, 0.9, 0.95])
def test_a_part_is_accused_exactly_where_it_is_probable_enough(confidence: float) -> None:
    std, margin = 0.01, 0.005  # of the probability; its own error is 1e-3
    for wanted, code in ((confidence + margin, FaultCode.FLEXSPLINE), (confidence - margin, FaultCode.WAITING)):
        index = 0.05 + std * float(norm.ppf(wanted))
        assert settled(judge_of(confidence=confidence), evidence(0.0, index, std)).fault_code is code
    for wanted, code in ((confidence + margin, FaultCode.OK), (confidence - margin, FaultCode.WAITING)):
        index = 0.05 - std * float(norm.ppf(wanted))
        found = replace(evidence(0.0, index), index_std=LinePair(1e-6, std))
        assert settled(judge_of(confidence=confidence), found).fault_code is code


def test_index_and_transmission_error_count_together() -> None:
    """That look alike: the flexspline is at fault for certain, by which of the two is open."""
    correlation = np.eye(4)
    correlation[1, 3] = correlation[3, 1] = -0.99
    found = evidence(
        0.0, 0.055, 0.005,
        transmission_error=LinePair(0.0, 1.65), transmission_error_std=LinePair(1e-6, 0.15), correlation=correlation,
    )  # fmt: skip
    found = replace(found, index_std=LinePair(1e-6, 0.005))
    assert norm.cdf(1.0) < 0.99  # neither alone
    verdict = settled(judge_of(), found)
    assert verdict.component is Component.FLEXSPLINE
    assert verdict.cause is Cause.EITHER


def test_doubts_are_reported_with_the_named_part() -> None:
    verdict = settled(
        judge_of(), evidence(0.01, 0.10, limitations=(doubt(LimitationCode.MOTION_STAMPS_LAG, delay_ms=16.5),))
    )
    assert verdict.component is Component.FLEXSPLINE
    assert "16.5 ms" in verdict.reason


def test_without_torque_the_larger_one_is_named_without_alarm() -> None:
    verdict = settled(judge_of(), evidence(3.0, 1.0, 0.1, relative=True))
    assert (verdict.component, verdict.level) == (Component.CIRCULAR_SPLINE, Level.OK)
    assert "relative" in verdict.reason
    close = settled(judge_of(), evidence(1.2, 1.0, 0.3, relative=True))
    assert close.component is Component.UNDETERMINED


VAGUE_SCALE = {"relative": True, "scale_std": 0.5}


def test_a_defect_that_no_error_of_the_torque_explains_is_an_alarm() -> None:
    verdict = settled(judge_of(), evidence(0.01, 0.20, 0.04, **VAGUE_SCALE))
    assert (verdict.component, verdict.level, verdict.cause) == (Component.FLEXSPLINE, Level.ERROR, Cause.STIFFNESS)


def test_a_likely_defect_of_unknown_size_is_named_without_alarm() -> None:
    found = replace(evidence(0.01, 0.055, **VAGUE_SCALE), index_std=LinePair(0.004, 0.015))
    verdict = settled(judge_of(), found)
    assert (verdict.component, verdict.level, verdict.cause) == (Component.FLEXSPLINE, Level.OK, Cause.RELATIVE)


@pytest.mark.parametrize("size", [0.0, 0.002, 0.01, 0.03])
@pytest.mark.parametrize("std", [1e-4, 0.01])
def test_no_unit_is_called_sound_whose_scale_is_unknown(size: float, std: float) -> None:
    verdict = settled(judge_of(), evidence(size, size / 2.0, std, **VAGUE_SCALE))
    assert (verdict.fault_code, verdict.level) == (FaultCode.WAITING, Level.OK)
    assert "The torque is not known well enough" in verdict.sentence
    assert "load.assumed_uncertainty" in verdict.reason


def test_evidence_that_will_not_change_any_more_confirms_itself() -> None:
    judge = judge_of(confirm_count=3, confirm_window=5)
    assert judge.conclude(evidence(0.01, 0.10)).component is Component.FLEXSPLINE
    settled(judge, evidence(0.01, 0.02))
    assert judge.conclude(evidence(0.10, 0.01)).component is Component.CIRCULAR_SPLINE


def test_a_change_needs_confirmation_and_a_single_outlier_changes_nothing() -> None:
    judge = judge_of(confirm_count=3, confirm_window=5)
    first = [judge.judge(evidence(0.01, 0.02), WAITING) for _ in range(3)]
    assert [v.component for v in first] == [Component.UNDETERMINED, Component.UNDETERMINED, Component.NONE]
    assert judge.judge(evidence(0.01, 0.10), WAITING).component is Component.NONE
    assert judge.judge(evidence(0.01, 0.02), WAITING).component is Component.NONE
    assert judge.judge(evidence(0.01, 0.10), WAITING).component is Component.NONE
    assert judge.judge(evidence(0.01, 0.10), WAITING).component is Component.FLEXSPLINE  # 3 of the last 5


def test_while_a_verdict_is_held_its_words_follow_the_evidence() -> None:
    judge = judge_of(confirm_count=2, confirm_window=3)
    settled(judge, evidence(0.01, 0.02))
    held = judge.judge(evidence(0.01, 0.10), WAITING)
    assert (held.component, held.level) == (Component.NONE, Level.OK)
    assert "flexspline index 10.00 ± 0." in held.reason
    assert held.reason.startswith("To be confirmed (1 of 2 verdicts): The flexspline is defective")


def test_hysteresis_keeps_an_alarm_until_the_index_is_clearly_below_the_limit() -> None:
    judge, std = judge_of(), 1e-4
    assert settled(judge, evidence(0.01, 0.049, std)).component is Component.NONE
    assert settled(judge, evidence(0.01, 0.051, std)).component is Component.FLEXSPLINE
    assert settled(judge, evidence(0.01, 0.047, std)).component is Component.FLEXSPLINE
    assert settled(judge, evidence(0.01, 0.044, std)).component is Component.NONE
    assert settled(judge, evidence(0.01, 0.081, std)).level is Level.ERROR
    assert settled(judge, evidence(0.01, 0.075, std)).level is Level.ERROR
    assert settled(judge, evidence(0.01, 0.071, std)).level is Level.WARN


def test_a_latched_verdict_stays_until_reset() -> None:
    judge = judge_of(latch=True)
    assert settled(judge, evidence(0.01, 0.10)).component is Component.FLEXSPLINE
    held = settled(judge, evidence(0.01, 0.01))
    assert (held.component, held.level) == (Component.FLEXSPLINE, Level.ERROR)
    assert "latched" in held.reason
    judge.reset_latch()
    assert settled(judge, evidence(0.01, 0.01)).component is Component.NONE


def test_limits_can_change_while_running() -> None:
    judge = judge_of()
    assert settled(judge, evidence(0.01, 0.06)).component is Component.FLEXSPLINE
    judge.change_limits(replace(JointSettings.from_mapping().diagnosis, warn_index=0.10, error_index=0.2))
    assert settled(judge, evidence(0.01, 0.06)).component is Component.NONE


@pytest.mark.parametrize(("cs", "fs"), [(0.01, 0.02), (0.01, 0.10)])
@pytest.mark.parametrize("relative", [False, True])
def test_nothing_is_said_of_lines_that_are_mostly_unexplained(cs: float, fs: float, relative: bool) -> None:
    def left(part: float) -> Verdict:
        widened = doubt(LimitationCode.UNCERTAINTY_WIDENED, factor=3.0, unexplained=part)
        return settled(judge_of(), evidence(cs, fs, relative=relative, limitations=(widened,)))

    assert left(0.1).component is not Component.UNDETERMINED
    assert left(0.3).component is Component.UNDETERMINED
    assert "not explained well enough" in left(0.3).sentence
