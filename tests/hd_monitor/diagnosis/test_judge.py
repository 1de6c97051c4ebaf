"""Verdicts over time: confidence, hysteresis, N of M, latch."""

from dataclasses import replace

import numpy as np
import pytest

from hd_monitor.diagnosis.absence import WAITING
from hd_monitor.diagnosis.judge import Judge
from hd_monitor.diagnosis.verdict import Component, FaultCode, Level, Verdict
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
    assert f"{100 * fs:.1f} %" in verdict.reason


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


SHORT = blocker(LimitationCode.TRAVEL_TOO_SHORT, travel_deg=20.0, needed_deg=90.0, missing_deg=70.0)
WRONG_TORQUE = blocker(LimitationCode.TORQUE_TOO_SMALL)


def test_too_little_motion_is_no_verdict_yet() -> None:
    verdict = settled(judge_of(), evidence(0.01, 0.10, limitations=(SHORT,)))
    assert (verdict.component, verdict.level) == (Component.UNDETERMINED, Level.OK)
    assert verdict.fault_code is FaultCode.WAITING
    assert verdict.reason.startswith("No verdict yet: only 20°")


@pytest.mark.parametrize("limitations", [(WRONG_TORQUE,), (WRONG_TORQUE, SHORT)])
def test_a_contradiction_forbids_a_name_and_needs_a_person(limitations: tuple[Limitation, ...]) -> None:
    verdict = settled(judge_of(), evidence(0.01, 0.10, limitations=limitations))
    assert (verdict.component, verdict.level) == (Component.UNDETERMINED, Level.WARN)
    assert verdict.fault_code is FaultCode.UNDETERMINED
    assert verdict.reason.startswith("The vibration contradicts the torque given")


def test_a_first_verdict_awaits_its_confirmation() -> None:
    judge = judge_of(confirm_count=3, confirm_window=5)
    for count in (1, 2):
        verdict = judge.judge(evidence(0.01, 0.10), WAITING)
        assert (verdict.fault_code, verdict.level) == (FaultCode.WAITING, Level.OK)
        assert verdict.reason.startswith("No verdict yet: the flexspline is defective")
        assert verdict.reason.endswith(f"(to be confirmed: {count} of 3)")
    assert judge.judge(evidence(0.01, 0.10), WAITING).fault_code is FaultCode.FLEXSPLINE


def test_a_name_is_held_over_a_single_look_that_lacks_motion() -> None:
    judge = judge_of()
    settled(judge, evidence(0.01, 0.10))
    verdict = judge.judge(evidence(0.01, 0.10, limitations=(SHORT,)), WAITING)
    assert verdict.fault_code is FaultCode.FLEXSPLINE
    assert verdict.reason.startswith("Only 20°")


def test_indistinguishable_splines_are_not_named_but_the_defect_is_shown() -> None:
    verdict = settled(judge_of(), evidence(0.15, 0.12, 0.03, index_correlation=-0.9))
    assert verdict.component is Component.UNDETERMINED
    assert verdict.level is Level.ERROR
    assert "which spline" in verdict.reason


def test_a_vague_index_beside_the_limit_is_not_called_sound() -> None:
    verdict = settled(judge_of(), evidence(0.04, 0.01, 0.02))
    assert (verdict.fault_code, verdict.level) == (FaultCode.WAITING, Level.OK)
    assert "as much motion would decide" in verdict.reason


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
    assert held.component is Component.NONE
    assert "10.0 %" in held.reason
    assert "held" in held.reason


def test_hysteresis_keeps_an_alarm_until_the_index_is_clearly_below_the_limit() -> None:
    judge = judge_of()
    assert settled(judge, evidence(0.01, 0.049)).component is Component.NONE
    assert settled(judge, evidence(0.01, 0.051)).component is Component.FLEXSPLINE
    assert settled(judge, evidence(0.01, 0.047)).component is Component.FLEXSPLINE
    assert settled(judge, evidence(0.01, 0.044)).component is Component.NONE
    assert settled(judge, evidence(0.01, 0.081)).level is Level.ERROR
    assert settled(judge, evidence(0.01, 0.075)).level is Level.ERROR
    assert settled(judge, evidence(0.01, 0.071)).level is Level.WARN


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
