"""Launch files start what the packages install; where ROS's launch is to be had, they are loaded by it too."""

import ast
from pathlib import Path
from xml.etree import ElementTree

import pytest

ROOT = Path(__file__).resolve().parents[2]
LAUNCH_FILES = sorted(ROOT.glob("hd_*/launch/*.launch.py"))
EXECUTABLES = {path.name: path.parents[1].name for path in ROOT.glob("hd_*/exec/*")}


def launch_id(path: Path) -> str:
    return f"{path.parents[1].name}/{path.name}"


def nodes_started_by(path: Path) -> list[dict[str, str]]:
    """Return the literal keywords of every Node(...) or LifecycleNode(...) in a launch file."""
    calls = [node for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))) if isinstance(node, ast.Call)]
    nodes = [call for call in calls if ast.unparse(call.func).rpartition(".")[2] in {"Node", "LifecycleNode"}]
    return [
        {str(word.arg): str(word.value.value) for word in call.keywords if isinstance(word.value, ast.Constant)}
        for call in nodes
    ]


def test_both_packages_have_launch_files() -> None:
    assert {path.parents[1].name for path in LAUNCH_FILES} == {"hd_monitor", "hd_sim_node"}


@pytest.mark.parametrize("path", LAUNCH_FILES, ids=launch_id)
def test_nodes_are_executables_of_their_packages(path: Path) -> None:
    for node in nodes_started_by(path):
        assert EXECUTABLES.get(node["executable"]) == node["package"], f"{path.name} starts {node}"


@pytest.mark.parametrize("path", LAUNCH_FILES, ids=launch_id)
def test_imports_are_declared_in_package_xml(path: Path) -> None:
    manifest = ElementTree.parse(path.parents[1] / "package.xml").getroot()
    declared = {element.text for tag in ("depend", "exec_depend") for element in manifest.iter(tag)}
    tree = ast.parse(path.read_text(encoding="utf-8"))
    imported = {
        node.module.partition(".")[0] for node in ast.walk(tree) if isinstance(node, ast.ImportFrom) and node.module
    }
    ros = {name for name in imported if name.startswith(("launch", "ament", "hd_"))}
    assert ros <= declared | {path.parents[1].name}


@pytest.mark.parametrize("path", LAUNCH_FILES, ids=launch_id)
def test_launch_loads_the_file(path: Path) -> None:
    launch = pytest.importorskip("launch", reason="ROS's launch is not on this machine")
    sources = pytest.importorskip("launch.launch_description_sources")
    description = sources.PythonLaunchDescriptionSource(str(path)).get_launch_description(launch.LaunchContext())
    assert description.get_launch_arguments()


def test_the_demo_without_its_rig_says_what_to_build(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    launch = pytest.importorskip("launch", reason="ROS's launch is not on this machine")
    sources = pytest.importorskip("launch.launch_description_sources")
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path))
    service = launch.LaunchService()
    file = str(ROOT / "hd_monitor" / "launch" / "demo.launch.py")
    description = sources.PythonLaunchDescriptionSource(file).get_launch_description(service.context)
    *arguments, start = description.entities
    for argument in arguments:
        argument.visit(service.context)
    with pytest.raises(RuntimeError, match="colcon build --packages-up-to hd_sim_node"):
        start.visit(service.context)
