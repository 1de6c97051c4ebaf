"""The report of a replay: everything in one page, pictures where there is something to draw, no markup from outside."""

import html
import re
from pathlib import Path
from typing import Any

import pytest
from tests.hd_monitor.offline import recordings as rec

from hd_monitor.cli.main import main


@pytest.fixture(scope="module")
def report(recording: Path) -> Path:
    folder = recording.parent / "report"
    assert main(["replay", str(recording), "--report", str(folder)]) == 0
    return folder


def test_the_report_holds_everything_in_one_page(report: Path) -> None:
    page = (report / "index.html").read_text(encoding="utf-8")
    pictures = sorted(path.stem for path in report.glob("*.png"))
    # One speed only: nothing is drawn over speed.
    assert pictures == ["indexes", "order_spectrum", "phase_trace", "spectrum", "waterfall", "zoom_spectrum"]
    assert len(re.findall(r'<img [^>]*src="data:image/png;base64,', page)) == len(pictures)
    assert not re.findall(r'(?:src|href)="(?!data:|#)', page)
    assert "http" not in page
    assert "The flexspline is defective" in page
    for words in ("gaps", "duplicates", "out of order", "clipped", "joint states"):
        assert f"<td>{words}</td>" in page


def test_the_report_of_many_speeds_draws_over_speed(tmp_path: Path) -> None:
    bag = rec.write(tmp_path / "bag", rec.simulated(programme="sweep", duration=20.0, defect="both"))
    assert main(["replay", str(bag), "--report", str(tmp_path / "report")]) == 0
    pictures = {path.stem for path in (tmp_path / "report").glob("*.png")}
    assert {"order_map", "rms_curve", "line_amplitudes"} <= pictures


def test_each_joint_has_its_pictures(tmp_path: Path) -> None:
    motion: dict[str, Any] = {"programme": "fixed", "fixed__speed": 1200.0, "duration": 6.0}
    events = [
        event._replace(topic="/joint_states") if event.topic.endswith("joint_states") else event
        for joint in ("a", "b")
        for event in rec.simulated(prefix=f"/{joint}", joint=joint, **motion)
    ]
    bag = rec.write(tmp_path / "bag", events)
    assert main(["replay", str(bag), "--joint", "a", "--joint", "b", "--report", str(tmp_path / "report")]) == 0
    names = {path.name for path in (tmp_path / "report").glob("*.png")}
    assert {"a_zoom_spectrum.png", "b_zoom_spectrum.png"} <= names


def test_joint_states_alone_carry_a_report(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    motion = {"programme": "fixed", "fixed__speed": 60.0, "duration": 40.0, "publish": "none"}
    events = rec.simulated(**motion, defect="circular_spline", joint_states__effort="reaction")  # type: ignore[arg-type]
    bag = rec.write(tmp_path / "bag", events)
    assert main(["replay", str(bag)]) == 2
    assert "set input.source to joint_effort or joint_velocity" in capsys.readouterr().err
    source = ["-p", "input.source:=joint_effort"]
    assert main(["replay", str(bag), *source, "--report", str(tmp_path / "report")]) == 0
    assert (tmp_path / "report" / "order_spectrum.png").is_file()
    out = capsys.readouterr().out
    assert "joint states; no faults in the data" in out


def test_markup_from_outside_stays_text_on_the_page(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    evil = "<script>alert('&')</script>"
    bag = rec.write(
        tmp_path / "<b>bag&",
        [
            rec.Event(event.time, f"/<i>{event.topic}", event.message)
            for event in rec.simulated(programme="fixed", fixed__speed=1200.0, duration=12.0, joint=evil)
        ],
    )
    given = ["-p", 'joints:=["<u>j&"]', "-p", f'input.joint_name:="{evil}"', "-p", f'reducer.serial:="<s>{evil}"']
    command = ["replay", str(bag), "--report", str(tmp_path / "report"), "--json", str(tmp_path / "r.json"), *given]
    assert main(command) == 0, capsys.readouterr().err
    command = ["compare", str(bag), str(tmp_path / "r.json"), "--report", str(tmp_path / "change"), *given]
    assert main(command) == 0, capsys.readouterr().err
    for folder, said in (("report", ("<b>bag&", "/<i>", "<u>j&", evil, "<s>")), ("change", ("<b>bag&", "<u>j&"))):
        page = (tmp_path / folder / "index.html").read_text(encoding="utf-8")
        for word in said:
            assert word not in page
            assert html.escape(word) in page.replace("&#34;", "&quot;").replace("&#39;", "&#x27;")
