"""Every example in the docstrings of the installed packages does what it shows."""

import doctest
import importlib
from collections.abc import Iterator
from pathlib import Path

import pytest

import hd_monitor
import hd_sim_node


def modules_with_examples() -> Iterator[str]:
    for package in (hd_monitor, hd_sim_node):
        folder = Path(package.__path__[0])
        for path in sorted(folder.rglob("*.py")):
            if ">>> " in path.read_text(encoding="utf-8"):
                yield ".".join(path.relative_to(folder.parent).with_suffix("").parts).removesuffix(".__init__")


@pytest.mark.parametrize("module", modules_with_examples())
def test_examples_do_what_they_show(module: str) -> None:
    result = doctest.testmod(importlib.import_module(module))
    assert result.attempted > 0, "the examples are where doctest does not look"
    assert result.failed == 0, "see the captured output"
