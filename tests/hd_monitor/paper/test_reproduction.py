import re

import pytest

from hd_monitor.errors import ParameterError
from hd_monitor.paper.exhibit import Claim, Exhibit, Outcome
from hd_monitor.paper.reproduction import EXHIBITS, Entry, compute, select
from hd_monitor.paper.table import claim_table, summary

PROMISED = "F4 F7 T1 F8 E5 F9 F10a F10b F11a F11b F13a F13b F13c F14 F15 F16 F17 F18a F18b F19 F20 ST"


def claim(outcome: Outcome) -> Claim:
    return Claim(
        statement="water is wet",
        paper="wet",
        ours="moist",
        passed=outcome is not Outcome.FAIL,
        contradiction=outcome is Outcome.CONTRADICTION,
        note="by touch",
    )


def test_everything_promised_is_listed_once():
    listed = [entry.id for entry in EXHIBITS]
    assert set(PROMISED.split()) <= set(listed)
    assert len(set(listed)) == len(listed)


@pytest.mark.parametrize("name", [entry.id for entry in EXHIBITS])
def test_every_exhibit_has_claims_and_labelled_panels(exhibit, name):
    shown = exhibit(name)
    assert shown.claims
    assert shown.panels
    for panel in shown.panels:
        assert panel.x_label
        assert panel.y_label


@pytest.mark.parametrize(
    ("names", "chosen"),
    [
        (["F10"], ["F10a", "F10b"]),
        (["f10A"], ["F10a"]),
        (["F13c,F4"], ["F4", "F13c"]),
        (["F13"], ["F13a", "F13b", "F13c"]),
        (["sr", "F4"], ["F4", "SR"]),
        ([], [entry.id for entry in EXHIBITS]),
    ],
)
def test_selection(names, chosen):
    assert [entry.id for entry in select(names, EXHIBITS)] == chosen


@pytest.mark.parametrize("name", ["F1", "F99", "10"])
def test_unknown_figures_are_refused_with_the_list(name):
    with pytest.raises(ParameterError, match="choose from F4, F7"):
        select([name], EXHIBITS)


def test_progress_names_each_exhibit_and_its_failures():
    lines: list[str] = []
    shown = Exhibit(title="t", caption="c", claims=(claim(Outcome.FAIL), claim(Outcome.PASS)))
    compute([Entry[None]("X1", "an example", lambda _: shown)], None, progress=lines.append)
    assert len(lines) == 1
    assert re.match(r"\[ 1/1\] X1 +an example: 1 of 2 claims FAIL, [\d.]+ s", lines[0])


def test_only_chosen_exhibits_are_computed(cases):
    assert list(compute(EXHIBITS, cases, ["F4"])) == ["F4"]


@pytest.mark.parametrize(
    ("outcome", "word"), [(Outcome.PASS, "pass"), (Outcome.FAIL, "FAIL"), (Outcome.CONTRADICTION, "contradiction")]
)
def test_table_shows_claim_paper_ours_outcome_and_note(outcome, word):
    text = claim_table({"X1": Exhibit(title="t", caption="c", claims=(claim(outcome),))})
    for part in ("X1", "water is wet", "paper: wet", "ours:  moist", "note:  by touch", word):
        assert part in text


def test_a_contradiction_that_our_numbers_do_not_confirm_fails():
    unconfirmed = Claim(statement="", paper="", ours="", passed=False, contradiction=True)
    assert unconfirmed.outcome is Outcome.FAIL


def test_summary_counts():
    claims = [claim(o) for o in (Outcome.PASS, Outcome.PASS, Outcome.CONTRADICTION, Outcome.FAIL)]
    text = summary(Exhibit(title="t", caption="c", claims=tuple(some)) for some in (claims[:3], claims[3:]))
    assert text.startswith("4 claims: 2 pass, 1 where the paper contradicts itself")
    assert text.endswith("1 fail")
