"""Verdicts on input that does not come or cannot be used: no evidence, so no part is named."""

from collections.abc import Sequence

from .verdict import Component, FaultCode, Level, Verdict


def nothing_received(missing: Sequence[str], timeout: float) -> Verdict:
    """Say that nothing came for `timeout` [s]; `missing` names the inputs that never came at all."""
    reason = f"No {' and no '.join(missing)} received yet" if missing else f"No new data for {timeout:g} s"
    return _lost(f"{reason}: check that the publishers run and the topics match")


def partly_lost(lost: Sequence[str], timeout: float) -> Verdict:
    """Say that the inputs `lost` have not come for `timeout` [s] while others do."""
    return _lost(
        f"No {' and no '.join(lost)} for {timeout:g} s or more while other input goes on: "
        "check the publisher, the topic's name and the stamps"
    )


def unusable(fault: str, timeout: float) -> Verdict:
    """Say that vibration comes but none of it could be used for `timeout` [s], because of `fault`."""
    return Verdict(
        component=Component.UNDETERMINED,
        level=Level.ERROR,
        fault_code=FaultCode.INPUT_INVALID,
        reason=f"The vibration signal comes, but for {timeout:g} s or more no sample could be used: {fault}; "
        "check the sensor",
    )


def _lost(reason: str) -> Verdict:
    return Verdict(component=Component.UNDETERMINED, level=Level.ERROR, fault_code=FaultCode.INPUT_LOST, reason=reason)
