"""A message fits into what ``ros2 topic echo`` shows, and says that there is more."""

import pytest

from hd_monitor.diagnosis.limitations import SENTENCES
from hd_monitor.diagnosis.status import LONGEST_MESSAGE, shortened


def test_a_short_sentence_stays() -> None:
    sentence = "x" * LONGEST_MESSAGE
    assert shortened(sentence) == sentence


@pytest.mark.parametrize("sentence", [*SENTENCES.values(), "word " * 60], ids=lambda text: text[:20])
def test_a_long_sentence_loses_whole_clauses_or_words(sentence: str) -> None:
    sentence = f"No verdict yet: {sentence}; {sentence}; {sentence}"
    short = shortened(sentence)
    assert LONGEST_MESSAGE // 2 - 2 < len(short) <= LONGEST_MESSAGE
    assert short.endswith(" …")
    kept = short.removesuffix(" …")
    assert sentence.startswith(kept)
    assert sentence[len(kept)] in ",;: "


def test_a_word_that_is_too_long_is_cut() -> None:
    assert shortened("No verdict yet: " + "x" * 300) == "No verdict yet: " + "x" * (LONGEST_MESSAGE - 18) + " …"
