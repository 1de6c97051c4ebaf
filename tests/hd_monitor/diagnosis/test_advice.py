"""Every code that is published has advice of its own."""

from hd_monitor.diagnosis.advice import advise
from hd_monitor.diagnosis.verdict import FaultCode, Level


def test_every_code_has_advice_of_its_own() -> None:
    said = [advise(code, Level.WARN) for code in FaultCode]
    assert len(set(said)) == len(FaultCode)
    assert advise("HD_NOT_KNOWN_YET", Level.WARN) not in said


def test_an_error_asks_for_more_than_a_warning() -> None:
    assert "Plan" in advise(FaultCode.BOTH_SPLINES, Level.WARN)
    assert "next stop" in advise(FaultCode.BOTH_SPLINES, Level.ERROR)
