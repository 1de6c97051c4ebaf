import math
from dataclasses import replace

import pytest

from hd_monitor.diagnosis.limitations import describe_limitation
from hd_monitor.identification.sensorless.agreement import (
    DirectionEvidence,
    disagreements,
    pooled,
    pooled_dominance,
)
from hd_monitor.reducer import LinePair
from hd_monitor.settings.groups import DiagnosisSettings

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
    limits = DiagnosisSettings(confidence=confidence)
    return tuple(map(describe_limitation, disagreements(directions, LINES, limits)))


def test_a_spline_that_leads_in_both_directions_may_be_named():
    assert reasons(direction(), direction("reverse")) == ()
    flexspline = direction(dominance=(0.001, 0.999), amplitude=(1.0, 3.0))
    assert reasons(flexspline, replace(flexspline, name="reverse")) == ()


def test_directions_that_disagree_name_nothing():
    (reason,) = reasons(direction(), direction("reverse", dominance=(0.001, 0.999), amplitude=(1.0, 3.0)))
    assert "do not agree on the larger line" in reason
    assert "forward: 3 ± 0.1 and 1 ± 0.1; reverse: 1 ± 0.1 and 3 ± 0.1" in reason


def test_a_sure_direction_carries_a_weak_one_that_agrees_and_none_that_does_not():
    sure, weak = direction(dominance=(1.0, 0.0)), {"dominance": (0.6, 0.3), "chance": (0.1, 0.4)}
    assert reasons(sure, direction("reverse", amplitude=(0.3, 0.2), **weak)) == ()
    (reason,) = reasons(sure, direction("reverse", amplitude=(0.2, 0.3), **weak))
    assert "do not agree on the larger line" in reason


def test_all_directions_together_must_reach_the_confidence():
    pair = direction(dominance=(0.92, 0.01)), direction("reverse", dominance=(0.92, 0.01))
    assert pooled_dominance(pair).circular_spline == pytest.approx(0.9765, abs=1e-3)
    assert reasons(*pair, confidence=0.97) == ()
    assert "not certain enough" in reasons(*pair, confidence=0.99)[0]


def test_a_spline_is_not_named_alone_where_both_would_be_by_their_sizes():
    size = {"amplitude": (1.0, 0.95), "dominance": (0.999, 0.2)}
    assert "not certain enough" in reasons(direction(**size), direction("reverse", **size))[0]


def test_lines_that_are_surely_alike_may_be_named_both():
    alike = direction(dominance=(0.01, 0.02), chance=(1e-9, 1e-9), amplitude=(2.0, 2.0))
    assert reasons(alike, replace(alike, name="reverse")) == ()
    assert reasons(alike, direction("reverse", dominance=(0.3, 0.02))) != ()


def test_a_line_must_stand_out_in_all_directions_together():
    assert reasons(direction(), direction("reverse", chance=(0.01, 0.2))) == ()
    (reason,) = reasons(direction(chance=(0.01, 0.2)), direction("reverse", chance=(0.01, 0.2)))
    assert "(forward; reverse)" in reason
    assert "stands out of the noise" in reason


def test_one_stroke_is_not_enough():
    assert "One stroke only" in reasons(direction())[0]
    assert "One stroke only" in reasons(direction(), direction())[0]


def test_a_stronger_line_elsewhere_questions_the_teeth():
    wrong = direction(rival=190.0, chance=(0.3, 0.4))
    found = reasons(wrong, replace(wrong, name="reverse"))
    assert "stronger line at about 190" in found[0]
    assert "reducer.flexspline_teeth" in found[0]
    assert reasons(direction(rival=190.0), direction("reverse")) == ()


# Several recordings ---------------------------------------------------------------------------------------------------


def test_weak_recordings_add_up():
    weak = {"dominance": (0.85, 0.05), "chance": (0.02, 0.5)}
    pair = direction(**weak), direction("reverse", **weak)
    assert reasons(*pair) != ()
    assert reasons(*pair, *pair, *pair, *pair) == ()


def test_a_recording_that_is_sure_of_the_other_spline_forbids_a_name():
    pair = direction(amplitude=(9.0, 1.0)), direction("reverse", amplitude=(9.0, 1.0))
    other = direction(dominance=(0.001, 0.999), amplitude=(1.0, 3.0))
    (reason,) = reasons(*pair, *pair, other)
    assert "contradict each other" in reason
    assert "forward: 1 ± 0.1 and 3 ± 0.1" in reason
    unsure = replace(other, dominance=LinePair(0.1, 0.9))
    assert reasons(*pair, *pair, unsure) == ()


def test_recordings_that_differ_by_more_than_their_noise_widen_the_uncertainty():
    same = pooled([direction(), direction()])
    assert same.amplitude == pytest.approx((3.0, 1.0))
    assert same.std.circular_spline == pytest.approx(0.1 / math.sqrt(2.0))
    varied = pooled([direction(), direction(amplitude=(4.0, 1.0))])
    assert varied.amplitude.circular_spline == pytest.approx(3.5)
    assert varied.std == pytest.approx((0.5, 0.1 / math.sqrt(2.0)))
