"""Every limitation has a sentence, and the checks supply what it states."""

from string import Formatter

import pytest

from hd_monitor.diagnosis.limitations import SENTENCES, describe_limitation
from hd_monitor.limitation import LimitationCode, blocker


@pytest.mark.parametrize("code", LimitationCode)
def test_every_code_has_a_sentence_that_its_values_fill(code: LimitationCode) -> None:
    fields = {name: spec for _, name, spec, _ in Formatter().parse(SENTENCES[code]) if name}
    values = {name: 7.0 if spec else "word" for name, spec in fields.items()}
    sentence = describe_limitation(blocker(code, **values))
    assert "{" not in sentence
    assert sentence.count("7") + sentence.count("word") >= len(fields)


def test_a_missing_value_is_an_error_not_a_gap_in_the_sentence() -> None:
    with pytest.raises(KeyError, match="wind_up_deg"):
        describe_limitation(blocker(LimitationCode.TORQUE_ABSURD, torque_nm=7.0))
