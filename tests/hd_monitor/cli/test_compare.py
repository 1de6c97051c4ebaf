"""The compare command: what changed between two recordings, from bags or from results."""

import json
from pathlib import Path
from typing import Any

import pytest
from tests.hd_monitor.offline import recordings as rec

from hd_monitor.cli.main import main


@pytest.fixture(scope="module")
def bags(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    folder = tmp_path_factory.mktemp("pair")
    steps: dict[str, Any] = {
        "programme": "dwell",
        "dwell__first": 1000.0,
        "dwell__last": 1400.0,
        "dwell__time": 4.0,
        "cycles": 1,
    }
    before = rec.write(folder / "before", rec.simulated(**steps, defect="circular_spline"))
    after = rec.write(folder / "after", rec.simulated(**steps, defect="none", seed=5))
    return before, after


def test_a_new_circular_spline_shows(
    bags: tuple[Path, Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out, report = tmp_path / "out.json", tmp_path / "report"
    assert main(["compare", *map(str, bags), "--json", str(out), "--report", str(report)]) == 0
    words = capsys.readouterr().out
    assert "The verdict went from circular spline, ERROR, to no defect, OK." in words
    assert "The circular spline's index fell from 10." in words
    assert "The flexspline's index rose" not in words
    (joint,) = json.loads(out.read_text())["joints"]
    changes = {item["spline"]: item for item in joint["indexes"]}
    assert changes["circular_spline"]["significant"]
    assert changes["circular_spline"]["before"] == pytest.approx(0.103, abs=0.004)
    assert changes["circular_spline"]["change"] < -0.05
    assert joint["peaks"][1]["rms"] < 0.5 * joint["peaks"][0]["rms"]
    assert {path.name for path in report.iterdir()} == {"index.html", "property_curves.png", "indexes.png"}
    assert "http" not in (report / "index.html").read_text(encoding="utf-8")


def test_results_compare_as_their_bags_do(bags: tuple[Path, Path], tmp_path: Path) -> None:
    results = [tmp_path / f"{bag.name}.json" for bag in bags]
    for bag, result in zip(bags, results, strict=True):
        assert main(["replay", str(bag), "--json", str(result)]) == 0
    out = [tmp_path / "from_bags.json", tmp_path / "from_results.json"]
    for pair, target in zip((bags, results), out, strict=True):
        assert main(["compare", *map(str, pair), "--json", str(target)]) == 0
    contents = [json.loads(target.read_text()) for target in out]
    assert contents[0]["joints"] == contents[1]["joints"]


def test_a_recording_compared_with_itself_has_not_changed(
    bags: tuple[Path, Path], capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["compare", str(bags[0]), str(bags[0])]) == 0
    words = capsys.readouterr().out
    assert "The verdict is the same" in words
    assert words.count("index did not change significantly") == 2
    assert "No line changed significantly." in words
    assert "is about the same" in words


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("{", "is not JSON"),
        (100_000 * "[", "is not JSON"),
        ("{}", "is not what"),
        ('{"joints": []}', "no joint in common"),
        ("[1]", "is not what"),
    ],
    ids=["cut off", "nested", "empty", "no joints", "a list"],
)
def test_a_file_that_is_not_a_result_is_refused_in_one_line(
    bags: tuple[Path, Path], tmp_path: Path, capsys: pytest.CaptureFixture[str], content: str, words: str
) -> None:
    file = tmp_path / "x.json"
    file.write_text(content)
    assert main(["compare", str(bags[0]), str(file)]) == 2
    *progress, line = capsys.readouterr().err.strip().splitlines()
    assert words in line
    assert all("times real time" in report for report in progress)  # shown where the other recording takes its time
