"""The core needs numpy and scipy only: no ROS, no display, no plotting library. Nothing here needs the simulator."""

import ast
import json
import subprocess
import sys
from pathlib import Path

import pytest

import hd_monitor

SHELLS = {"ros", "offline", "paper", "cli", "watch"}
ALLOWED = {"hd_monitor", "numpy", "scipy"}
PACKAGE = Path(hd_monitor.__file__).parent
ROOT = Path(__file__).resolve().parents[2]

REPORT_LOADED = """
import importlib, json, sys

def report(modules):
    before = set(sys.modules)
    for module in modules:
        importlib.import_module(module)
    # A module without a spec was not imported: compiled code makes such ones for its own needs.
    loaded = [name for name, module in sys.modules.items() if getattr(module, "__spec__", None) and name not in before]
    top = {name.partition(".")[0] for name in loaded}
    print(json.dumps(sorted(top - set(sys.stdlib_module_names))), flush=True)
"""
TOGETHER = REPORT_LOADED + "report(sys.argv[1:])"
# A fork is as fresh as a new interpreter, but for numpy and scipy, whose import is most of a new one's time.
ONE_BY_ONE = (
    REPORT_LOADED
    + """
import os
import numpy, scipy.interpolate, scipy.signal
for module in sys.argv[1:]:
    child = os.fork()
    if not child:
        report([module])
        os._exit(0)
    if os.waitpid(child, 0)[1]:
        sys.exit(f"cannot be imported alone: {module}")
"""
)


def core_modules() -> list[str]:
    """Find every module of the package that is not in a shell."""
    names = []
    for path in sorted(PACKAGE.rglob("*.py")):
        parts = path.relative_to(PACKAGE).with_suffix("").parts
        if parts[0] not in SHELLS:
            names.append(".".join(("hd_monitor", *parts)).removesuffix(".__init__"))
    return names


def loaded_in(script: str, *modules: str) -> list[set[str]]:
    """Run a probe in a fresh interpreter; return the top-level packages that it loads, one set per printed line."""
    done = subprocess.run(
        [sys.executable, "-c", script, *modules], capture_output=True, text=True, timeout=120, check=False
    )
    assert done.returncode == 0, done.stderr
    # A compiled module may import its internals under names that start with an underscore.
    return [{name for name in json.loads(line) if not name.startswith("_")} for line in done.stdout.splitlines()]


def modules_named_in(source: str) -> set[str]:
    """Find what a module imports, at its top or later, by a statement or by a name in a string."""
    found = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and not node.level:
            found.add(node.module or "")
        elif isinstance(node, ast.Call) and ast.unparse(node.func).rpartition(".")[2] in {
            "import_module",
            "__import__",
        }:
            found |= {str(word.value) for word in node.args if isinstance(word, ast.Constant)}
    return found


@pytest.mark.parametrize("source", ["import a.b", "def f():\n from a import b", "importlib.import_module('a.b')"])
def test_every_kind_of_import_is_seen(source: str) -> None:
    assert {name.partition(".")[0] for name in modules_named_in(source)} == {"a"}


def test_no_module_imports_the_simulator() -> None:
    # hd_sim_node depends on this package: the other way round they would be a circle.
    paths = sorted([*PACKAGE.rglob("*.py"), *(ROOT / "hd_monitor" / "launch").glob("*.py")])
    assert len(paths) > 100
    offenders = {
        path for path in paths for name in modules_named_in(path.read_text()) if name.startswith("hd_sim_node")
    }
    assert not offenders


def test_package_xml_does_not_need_the_simulator() -> None:
    assert "hd_sim_node" not in (ROOT / "hd_monitor" / "package.xml").read_text()


def test_the_core_is_found() -> None:
    assert {"hd_monitor", "hd_monitor.reducer", "hd_monitor.model.oscillator", "hd_monitor.monitor"} <= set(
        core_modules()
    )


def test_whole_core_loads_numpy_and_scipy_only() -> None:
    (packages,) = loaded_in(TOGETHER, *core_modules())
    assert packages <= ALLOWED


def test_no_core_module_loads_a_package_of_scipy_before_its_first_use() -> None:
    # They take a second and 60 MB, which a node whose inputs have not begun need not have spent.
    script = TOGETHER + "\nprint(json.dumps([n for n in sys.modules if n.startswith('scipy.') and '._' not in n]))"
    _, packages = loaded_in(script, *core_modules())
    assert packages <= {"scipy.version"}


@pytest.mark.parametrize("script", [TOGETHER, ONE_BY_ONE], ids=["together", "one by one"])
def test_the_probe_sees_a_foreign_package(script: str) -> None:
    (packages,) = loaded_in(script, "pytest")
    assert "pytest" in packages


def test_each_core_module_imports_alone() -> None:
    # Alone, in no particular order: a circular import or one hidden behind another module's shows here.
    modules = core_modules()
    for module, packages in zip(modules, loaded_in(ONE_BY_ONE, *modules), strict=True):
        assert packages <= ALLOWED, module
