"""The install carries all that `ros2 run` and `ros2 launch` look for, whether pip or colcon made it."""

import os
import subprocess
import sys
from importlib import metadata
from pathlib import Path
from xml.etree import ElementTree

import pytest

import hd_monitor

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = ("hd_monitor", "hd_sim_node")
EXECUTABLES = sorted((path.parents[1].name, path.name) for path in ROOT.glob("hd_*/exec/*"))
MARKERS = Path("share/ament_index/resource_index/packages")

needs_install = pytest.mark.skipif(
    Path(hd_monitor.__file__) == ROOT / "hd_monitor/hd_monitor/__init__.py",
    reason="hd_monitor is imported from the source tree: there is no install to look at",
)


def prefix_of(package: str) -> Path:
    """Return the prefix that holds `package`, looked up as ROS does, with the Python prefix as the last resort."""
    prefixes = [*os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep), sys.prefix]
    found = [Path(prefix) for prefix in prefixes if prefix and (Path(prefix) / MARKERS / package).is_file()]
    assert found, f"no marker {MARKERS / package} below any of {prefixes}"
    return found[0]


def manifest_version(package_xml: Path) -> str | None:
    return ElementTree.parse(package_xml).getroot().findtext("version")


@needs_install
@pytest.mark.parametrize("package", PACKAGES)
def test_package_xml_is_installed_unchanged(package: str) -> None:
    installed = prefix_of(package) / "share" / package / "package.xml"
    assert installed.read_bytes() == (ROOT / package / "package.xml").read_bytes()


@needs_install
@pytest.mark.parametrize(
    ("package", "folder", "source", "pattern"),
    [
        ("hd_monitor", "launch", "hd_monitor/launch", "*.launch.py"),
        ("hd_sim_node", "launch", "hd_sim_node/launch", "*.launch.py"),
        ("hd_monitor", "config", "config", "*.*"),
    ],
)
def test_shared_files_are_installed_unchanged(package: str, folder: str, source: str, pattern: str) -> None:
    expected = {path.name: path.read_bytes() for path in (ROOT / source).glob(pattern)}
    installed = {path.name: path.read_bytes() for path in (prefix_of(package) / "share" / package / folder).glob("*.*")}
    assert expected, f"nothing matches {source}/{pattern}"
    assert installed == expected


@needs_install
@pytest.mark.parametrize(("package", "executable"), EXECUTABLES)
def test_ros2_run_finds_an_executable(package: str, executable: str) -> None:
    path = prefix_of(package) / "lib" / package / executable
    assert path.is_file()
    assert os.access(path, os.X_OK)


@needs_install
def test_libexec_command_starts_from_anywhere(tmp_path: Path) -> None:
    command = prefix_of("hd_monitor") / "lib/hd_monitor/hd-monitor"
    done = subprocess.run([command, "--help"], cwd=tmp_path, capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0, done.stderr
    assert "replay" in done.stdout


@needs_install
def test_the_command_finds_the_demo_of_the_other_package() -> None:
    pytest.importorskip("rclpy")
    command = prefix_of("hd_monitor") / "lib/hd_monitor/hd-monitor"
    done = subprocess.run([command, "demo", "--help"], capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0, done.stderr
    assert "--time-scale" in done.stdout


@needs_install
@pytest.mark.parametrize("package", PACKAGES)
def test_every_source_file_is_installed(package: str) -> None:
    source = ROOT / package / package
    expected = {str(path.relative_to(source)) for path in source.rglob("*") if path.is_file()}
    expected = {name for name in expected if "__pycache__" not in name}
    spec = __import__(package).__file__
    assert spec is not None
    install = Path(spec).parent
    installed = {str(path.relative_to(install)) for path in install.rglob("*") if path.is_file()}
    assert expected <= installed


@needs_install
def test_metadata_has_the_version() -> None:
    assert metadata.version("hd-monitor") == hd_monitor.__version__


@pytest.mark.parametrize("package", PACKAGES)
def test_package_xml_has_the_version(package: str) -> None:
    assert manifest_version(ROOT / package / "package.xml") == hd_monitor.__version__


def test_changelog_has_the_version() -> None:
    assert f"\n## {hd_monitor.__version__} " in (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
