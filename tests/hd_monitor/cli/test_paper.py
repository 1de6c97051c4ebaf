import pytest

pytest.importorskip("yaml")

from hd_monitor.cli.main import main
from hd_monitor.paper.cases import paper_file


@pytest.fixture
def altered_paper(tmp_path):
    """A copy of the paper's cases in which a static sample fluctuates too little."""
    path = tmp_path / "altered.yaml"
    text = paper_file().read_text(encoding="utf-8")
    assert "beta: [0.032]" in text
    path.write_text(text.replace("beta: [0.032]", "beta: [0.002]"), encoding="utf-8")
    return path


def test_one_figure_prints_its_claims_and_its_progress(capsys):
    assert main(["paper", "--only", "F4"]) == 0
    out, err = capsys.readouterr()
    assert "2.02500" in out
    assert "2 claims: 2 pass" in out
    assert "[ 1/1] F4" in err


def test_quiet_prints_no_progress(capsys):
    assert main(["paper", "--only", "F4", "--quiet"]) == 0
    assert capsys.readouterr().err == ""


def test_a_failing_claim_makes_the_exit_status_1(capsys, altered_paper):
    assert main(["paper", "--only", "F7", "--params", str(altered_paper)]) == 1
    assert "FAIL" in capsys.readouterr().out


def test_contradictions_of_the_paper_do_not(capsys):
    assert main(["paper", "--only", "F7"]) == 0
    assert "contradiction" in capsys.readouterr().out


def test_list(capsys):
    assert main(["paper", "--list"]) == 0
    out = capsys.readouterr().out
    assert [line.split()[0] for line in out.splitlines()][:3] == ["F4", "F7", "T1"]


def test_report(capsys, tmp_path):
    pytest.importorskip("matplotlib")
    pytest.importorskip("jinja2")
    folder = tmp_path / "report"
    assert main(["paper", "--only", "F7,F4", "--report", str(folder)]) == 0
    assert sorted(path.name for path in folder.iterdir()) == ["F4.png", "F7.png", "index.html"]
    assert "hd-monitor paper --only F7,F4 --report report" in (folder / "index.html").read_text(encoding="utf-8")
    assert "index.html" in capsys.readouterr().out


def test_own_reducer(capsys):
    example = paper_file().with_name("my_reducer.yaml")
    assert main(["paper", "--params", str(example), "--only", "F4", "--only", "F7"]) == 0
    out = capsys.readouterr().out
    assert "reduction: 101" in out
    assert "claims" not in out


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--only", "F99"], "there is no figure 'f99'"),
        (["--params", "nowhere.yaml"], "nowhere.yaml cannot be read"),
    ],
)
def test_unusable_input_ends_with_2_and_one_line(capsys, arguments, message):
    assert main(["paper", *arguments]) == 2
    err = capsys.readouterr().err
    assert message in err
    assert len(err.strip().splitlines()) == 1


def test_a_report_that_cannot_be_written_is_refused_before_the_work(capsys, tmp_path):
    pytest.importorskip("matplotlib")
    blocked = tmp_path / "file"
    blocked.write_text("")
    assert main(["paper", "--report", str(blocked / "below")]) == 3
    err = capsys.readouterr().err
    assert "below cannot be written: Not a directory" in err
    assert "[ 1/" not in err
