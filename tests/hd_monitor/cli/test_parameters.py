from pathlib import Path

import pytest

from hd_monitor.cli.main import main
from hd_monitor.cli.parameters import markdown, node_tables
from hd_monitor.settings import NODE_PARAMETERS, PARAMETERS, set_aside_foreign, split_joints
from hd_sim_node.parameters import NODE_PARAMETERS as RIG_NODE_PARAMETERS
from hd_sim_node.parameters import PARAMETERS as RIG_PARAMETERS
from hd_sim_node.settings import RigSettings, pick

PAGE = Path(__file__).resolve().parents[3] / "msgs_doc" / "parameters.md"


def test_the_page_is_up_to_date(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["parameters"]) == 0
    assert capsys.readouterr().out == PAGE.read_text(encoding="utf-8"), (
        "run: hd-monitor parameters > msgs_doc/parameters.md"
    )


def test_the_page_has_every_parameter() -> None:
    page = markdown(node_tables())
    for parameter in (*PARAMETERS, *NODE_PARAMETERS, *RIG_PARAMETERS, *RIG_NODE_PARAMETERS):
        assert f"| `{parameter.name}` |" in page


def test_table_cells_of_the_page_contain_no_bar() -> None:
    for line in markdown(node_tables()).splitlines():
        if line.startswith("|"):
            assert line.count("|") == 6, line


def test_the_file_gives_every_default_back(capsys: pytest.CaptureFixture[str]) -> None:
    yaml = pytest.importorskip("yaml")
    assert main(["parameters", "--format", "yaml"]) == 0
    content = yaml.safe_load(capsys.readouterr().out)
    monitor, foreign = set_aside_foreign(content["hd_monitor_node"]["ros__parameters"])
    assert not foreign
    settings = split_joints(monitor)["joint"]
    assert dict(settings.values) == {parameter.name: parameter.default for parameter in PARAMETERS}
    rig = RigSettings.from_mapping(pick(content["hd_sim_node"]["ros__parameters"], RIG_NODE_PARAMETERS))
    assert rig == RigSettings.from_mapping()


def test_one_node_only(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["parameters", "--node", "monitor", "--format", "yaml"]) == 0
    output = capsys.readouterr().out
    assert "hd_monitor_node:" in output
    assert "hd_sim_node:" not in output
