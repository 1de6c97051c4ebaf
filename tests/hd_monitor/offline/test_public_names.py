"""Recordings are read by their formats and by public names of the libraries, whose insides change at any release."""

import ast
import importlib
from collections.abc import Iterator
from pathlib import Path

import pytest

import hd_monitor

LIBRARIES = ("lz4", "mcap", "rosbags", "zstandard")
NAMED_TUPLE = {"_asdict", "_replace"}  # public, their underscore only keeps them apart from fields
PACKAGE = Path(hd_monitor.__file__).parent
SOURCES = sorted(PACKAGE.rglob("*.py"))
MODULES = {str(path.relative_to(PACKAGE)): ast.parse(path.read_text(encoding="utf-8")) for path in SOURCES}


def imported(tree: ast.Module) -> Iterator[tuple[str, str]]:
    """Yield (module, name in it) of all that is imported from elsewhere; the name is empty for a whole module."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from ((alias.name, "") for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
            yield from ((node.module, alias.name) for alias in node.names)


def private_attributes(tree: ast.Module) -> Iterator[str]:
    """Yield the names with a leading underscore that are read from anything but the object or the class itself."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Attribute):
            own = isinstance(node.value, ast.Name) and node.value.id in ("self", "cls")
            name = "" if own else node.attr
        elif isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in ("getattr", "setattr"):
            name = str(node.args[1].value) if isinstance(node.args[1], ast.Constant) else ""
        else:
            continue
        if name.startswith("_") and not name.endswith("__") and name not in NAMED_TUPLE:
            yield f"{name} in line {node.lineno}"


def uses_a_library(tree: ast.Module) -> bool:
    return any(module.split(".")[0] in LIBRARIES for module, _ in imported(tree))


def test_the_libraries_users_are_found() -> None:
    found = {name for name, tree in MODULES.items() if uses_a_library(tree)}
    assert {"offline/compression.py", "offline/mcap_records.py", "offline/whole_mcap.py"} <= found


@pytest.mark.parametrize("name", [name for name, tree in MODULES.items() if uses_a_library(tree)])
def test_only_public_names_are_imported_and_read(name: str) -> None:
    assert not list(private_attributes(MODULES[name]))
    for module, item in imported(MODULES[name]):
        if module.split(".")[0] in LIBRARIES:
            public = getattr(importlib.import_module(module), "__all__", None)
            assert not any(part.startswith("_") for part in (*module.split("."), item))
            assert not item or public is None or item in public, f"{item} is not among the names that {module} offers"


def test_the_monitor_reads_recordings_without_the_library_that_wrote_them() -> None:
    """What rosbags keeps of an open file has no public name, so that nothing here may rest on it."""
    assert not [name for name, tree in MODULES.items() if any(m.split(".")[0] == "rosbags" for m, _ in imported(tree))]
