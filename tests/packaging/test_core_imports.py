"""The core is numpy and scipy only, so that it runs where there is no ROS, no display and no plotting library."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

import hd_monitor

SHELLS = {"ros", "offline", "paper", "cli"}
ALLOWED = {"hd_monitor", "numpy", "scipy"}
PACKAGE = Path(hd_monitor.__file__).parent

REPORT_LOADED = """
import importlib, json, sys
before = set(sys.modules)
for module in sys.argv[1:]:
    importlib.import_module(module)
# A module without a spec was not imported: compiled code makes such ones for its own needs.
loaded = [name for name, module in sys.modules.items() if getattr(module, "__spec__", None) and name not in before]
top = {name.partition(".")[0] for name in loaded}
print(json.dumps(sorted(top - set(sys.stdlib_module_names))))
"""


def core_modules() -> list[str]:
    """Find every module of the package that is not in a shell."""
    names = []
    for path in sorted(PACKAGE.rglob("*.py")):
        parts = path.relative_to(PACKAGE).with_suffix("").parts
        if parts[0] not in SHELLS:
            names.append(".".join(("hd_monitor", *parts)).removesuffix(".__init__"))
    return names


def third_party_packages_loaded_by(*modules: str) -> set[str]:
    """Import `modules` in a fresh interpreter and return the top-level packages that this loads."""
    done = subprocess.run(
        [sys.executable, "-c", REPORT_LOADED, *modules], capture_output=True, text=True, timeout=120, check=False
    )
    assert done.returncode == 0, done.stderr
    # A compiled module may import its internals under names that start with an underscore.
    return {name for name in json.loads(done.stdout) if not name.startswith("_")}


def test_the_core_is_found() -> None:
    assert {"hd_monitor", "hd_monitor.reducer", "hd_monitor.model.oscillator", "hd_monitor.monitor"} <= set(
        core_modules()
    )


def test_whole_core_loads_numpy_and_scipy_only() -> None:
    assert third_party_packages_loaded_by(*core_modules()) <= ALLOWED


def test_the_probe_sees_a_foreign_package() -> None:
    assert "pytest" in third_party_packages_loaded_by("pytest")


@pytest.mark.parametrize("module", core_modules())
def test_each_core_module_imports_alone(module: str) -> None:
    # Alone, in no particular order: a circular import or one hidden behind another module's shows here.
    assert third_party_packages_loaded_by(module) <= ALLOWED
