"""A change is called significant as often as its probability says, and named only if it matters."""

from typing import Any

import numpy as np
import pytest

from hd_monitor.offline.comparison import as_dict, compare
from hd_monitor.offline.errors import BagError


def result(joint="joint", *, cs=0.05, fs=0.02, std=0.002, curve=((500.0, 1.0), (1000.0, 4.0)), **parameters):
    verdict = {"component": "none", "level": 0, "level_name": "OK", "fault_code": "HD_OK", "reason": "", "samples": 1}
    verdict |= {"gaps": 0, "circular_spline_index": cs, "circular_spline_index_std": std}
    verdict |= {"flexspline_index": fs, "flexspline_index_std": std}
    rms = [{"rpm": rpm, "rms": value, "samples": 10} for rpm, value in curve]
    entry = {"joint": joint, "verdict": verdict, "rms_curve": rms, "parameters": parameters, "relative": False}
    return {"joints": [entry]}


def test_chance_is_called_significant_once_in_a_hundred() -> None:
    dice = np.random.default_rng(11)
    trials = 3000
    false = 0
    for before, after in dice.normal(0.05, 0.002, (trials, 2)):
        (change,) = compare(result(cs=before), result(cs=after))
        false += change.indexes["circular_spline"].significant
    # 30 expected; binomial standard deviation 5.4
    assert 10 <= false <= 52


def test_a_significant_change_too_small_to_matter_is_called_so() -> None:
    (change,) = compare(result(cs=0.0500, std=1e-6), result(cs=0.0505, std=1e-6))
    assert change.indexes["circular_spline"].significant
    assert "circular spline's index hardly changed" in change.sentences[1]


def test_peaks_are_compared_at_speeds_that_both_have() -> None:
    low = result(curve=((500.0, 1.0), (1000.0, 4.0)))
    wide = result(curve=((500.0, 0.5), (1000.0, 2.0), (1700.0, 30.0)))
    (change,) = compare(low, wide)
    assert change.peaks is not None
    assert [peak.rms for peak in change.peaks] == [4.0, 2.0]
    (change,) = compare(low, result(curve=((2000.0, 3.0),)))
    assert change.peaks is None
    assert "no speed in common" in " ".join(change.sentences)


def test_different_reducers_are_refused() -> None:
    old, new = ({"reducer.flexspline_teeth": teeth} for teeth in (160, 200))
    with pytest.raises(BagError, match=r"reducer\.flexspline_teeth differ"):
        compare(result(**old), result(**new))


def test_another_basis_is_mentioned() -> None:
    old, new = ({"dynamics.natural_frequency": value} for value in (55.0, 50.0))
    (change,) = compare(result(**old), result(**new))
    assert "different values of dynamics.natural_frequency" in change.sentences[-1]


def test_one_joint_each_is_compared_whatever_its_name_and_several_by_their_names() -> None:
    (change,) = compare(result("elbow"), result("elbow_new"))
    assert change.joint == "elbow"
    two = {"joints": result("a")["joints"] + result("b")["joints"]}
    assert [change.joint for change in compare(two, two)] == ["a", "b"]
    with pytest.raises(BagError, match="no joint in common: a, b before, c after"):
        compare(two, result("c"))


def test_relative_indexes_are_not_compared_with_absolute_ones() -> None:
    relative = result()
    relative["joints"][0]["relative"] = True
    (change,) = compare(relative, result())
    assert not change.indexes
    assert any("relative" in sentence for sentence in change.sentences)


def with_lines(cs: float, fs: float, *, std: float = 0.1, component: str = "none", source: str = "") -> dict[str, Any]:
    """A result from joint states alone."""
    content = result(std=0.01, cs=cs / np.hypot(cs, fs), fs=fs / np.hypot(cs, fs), curve=(), **{"input.source": source})
    (entry,) = content["joints"]
    line = {"k": 1, "circular_spline": cs, "flexspline": fs, "circular_spline_std": std, "flexspline_std": std}
    entry |= {"relative": True, "lines": [line]}
    entry["verdict"] |= {"component": component, "level_name": "WARN" if component == "undetermined" else "OK"}
    return dict(content)


def test_without_a_sensor_lines_ratio_and_shares_are_compared_with_their_significance() -> None:
    changes = compare(with_lines(10.0, 5.0), with_lines(10.1, 6.5))
    (joint,) = as_dict(changes, "before", "after")["joints"]
    cs, fs = joint["lines"]
    assert (cs["significant"], fs["significant"]) == (False, True)
    assert fs["change"] == pytest.approx(1.5)
    assert fs["change_std"] == pytest.approx(0.1 * np.sqrt(2.0))
    assert joint["ratio"]["before"] == pytest.approx(0.5)
    assert joint["ratio"]["after"] == pytest.approx(0.6436, abs=1e-3)
    assert joint["ratio"]["significant"]
    assert [index["spline"] for index in joint["indexes"]] == ["circular_spline", "flexspline"]
    assert joint["indexes"][1]["change"] == pytest.approx(0.094, abs=0.002)
    assert joint["indexes"][1]["change_std"] == pytest.approx(0.01 * np.sqrt(2.0))
    text = " ".join(joint["changes"])
    assert "The flexspline's line k = 1 grew by 30 %: 5.00 ± 0.10 before, 6.50 ± 0.10 after (p < 0.001)." in text
    assert "circular spline's line" not in text


def test_less_evidence_is_not_called_a_deterioration() -> None:
    (change,) = compare(with_lines(10.0, 5.0), with_lines(10.0, 6.0, std=2.0, component="undetermined"))
    assert "less evidence and no deterioration" in change.sentences[0]
    assert "No line changed significantly." in change.sentences
    (change,) = compare(with_lines(10.0, 5.0, component="undetermined"), with_lines(10.0, 5.0))
    assert "The first bore no name" in change.sentences[0]


def test_lines_of_different_signals_are_not_compared() -> None:
    old, new = with_lines(10.0, 5.0, source="joint_effort"), with_lines(1.0, 0.5, source="joint_velocity")
    (change,) = compare(old, new)
    assert not change.lines
    assert change.ratio is None


def test_curves_are_compared_speed_by_speed() -> None:
    def curve(factor: float, seed: int) -> tuple[tuple[float, float], ...]:
        scatter = np.exp(0.02 * np.random.default_rng(seed).standard_normal(12))
        return tuple((100.0 * n, factor * n * s) for n, s in enumerate(scatter.tolist(), start=1))

    (change,) = compare(result(curve=curve(1.0, 1)), result(curve=curve(1.2, 2)))
    assert change.curve is not None
    assert change.curve.speeds == 12
    assert change.curve.ratio == pytest.approx(1.2, abs=0.03)
    assert change.curve.p_value < 1e-3
    false = sum(
        changed.curve is not None and changed.curve.p_value < 0.01
        for seed in range(300)
        for changed in compare(result(curve=curve(1.0, 1 + seed)), result(curve=curve(1.0, 1 + seed + 300)))
    )
    assert false <= 9


@pytest.mark.parametrize("content", [{}, {"joints": 5}, {"joints": [{"joint": "a", "verdict": True, "rms_curve": []}]}])
def test_what_is_no_result_is_refused(content: dict[str, object]) -> None:
    with pytest.raises(BagError, match="the second result is not what hd-monitor replay --json writes"):
        compare(result(), content)


def test_a_result_with_a_missing_number_is_refused() -> None:
    with pytest.raises(BagError, match="the first result"):
        compare(result(curve=((500.0, None),)), result())
