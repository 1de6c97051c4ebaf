import pytest

from hd_monitor.diagnosis.limitations import describe_limitation
from hd_monitor.identification.sensorless.agreement import (
    DirectionEvidence,
    disagreements,
    pooled_dominance,
)
from hd_monitor.reducer import LinePair

LINES = LinePair(200.0, 202.0)


def direction(name="forward", dominance=(0.999, 0.001), chance=(1e-6, 0.5), rival=None, amplitude=(3.0, 1.0)):
    return DirectionEvidence(
        name=name,
        amplitude=LinePair(*amplitude),
        std=LinePair(0.1, 0.1),
        chance=LinePair(*chance),
        dominance=LinePair(*dominance),
        rival=rival,
        segments=4,
        samples=800,
    )


def reasons(*directions, confidence=0.99):
    return tuple(map(describe_limitation, disagreements(directions, LINES, confidence)))


def test_a_spline_that_leads_in_both_directions_may_be_named():
    assert reasons(direction(), direction("reverse")) == ()
    assert reasons(direction(dominance=(0.001, 0.999)), direction("reverse", dominance=(0.0, 1.0))) == ()


def test_directions_that_disagree_name_nothing():
    (reason,) = reasons(direction(), direction("reverse", dominance=(0.001, 0.999), amplitude=(1.0, 3.0)))
    assert "do not agree on the larger line" in reason
    assert "forward: 3 ± 0.1 and 1 ± 0.1; reverse: 1 ± 0.1 and 3 ± 0.1" in reason


def test_one_sure_direction_does_not_carry_an_unsure_one():
    (reason,) = reasons(direction(dominance=(1.0, 0.0)), direction("reverse", dominance=(0.8, 0.1)))
    assert "not certain enough" in reason


def test_all_directions_together_must_reach_the_confidence():
    pair = direction(dominance=(0.92, 0.01)), direction("reverse", dominance=(0.92, 0.01))
    assert pooled_dominance(pair).circular_spline == pytest.approx(0.9765, abs=1e-3)
    assert reasons(*pair, confidence=0.97) == ()
    assert reasons(*pair, confidence=0.99) != ()


def test_lines_that_are_surely_alike_may_be_named_both():
    alike = direction(dominance=(0.01, 0.02), chance=(1e-9, 1e-9), amplitude=(2.0, 2.0))
    assert reasons(alike, alike) == ()
    assert reasons(alike, direction(dominance=(0.3, 0.02))) != ()


def test_a_line_must_stand_out_in_every_direction():
    (reason,) = reasons(direction(), direction("reverse", chance=(0.01, 0.2)))
    assert "(reverse)" in reason
    assert "stands out of the noise" in reason


def test_one_stroke_is_not_enough():
    assert "One stroke only" in reasons(direction())[0]


def test_a_stronger_line_elsewhere_questions_the_teeth():
    wrong = direction(rival=190.0, chance=(0.3, 0.4))
    found = reasons(wrong, wrong)
    assert "stronger line at about 190" in found[0]
    assert "reducer.flexspline_teeth" in found[0]
    assert reasons(direction(rival=190.0), direction()) == ()
