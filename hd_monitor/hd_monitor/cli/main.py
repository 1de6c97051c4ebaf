"""Entry point of ``hd-monitor``: find the subcommand's module, here or in another package, and run it."""

import argparse
import importlib
import sys
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from types import ModuleType
from typing import TYPE_CHECKING

from .. import __version__
from ..errors import HdMonitorError, did_you_mean
from ..offline.parameters import check_files
from ..process import STATUSES, guard, set_up_process
from . import extensions
from .completion import complete, completed_words

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

COMMANDS = {
    "replay": "put a recorded bag through the same core, with JSON and a report",
    "watch": "show all joints in the terminal, live or from a bag",
    "compare": "compare two bags or two JSON results: what changed",
    "history": "show what the ledger knows of every reducer, and what changed",
    "identify": "estimate the stiffness indexes, fn and ζ from a recorded run",
    "move": "write a health-check move for a joint",
    "parameters": "list every parameter of the nodes, as a page or as a parameter file",
    "paper": "reproduce every figure, table and claim of the source paper",
}
"""Help by subcommand. Its module, of the same name, is imported only to run it: none needs the extras of another."""

SIMULATOR_COMMANDS = {
    "demo": "simulate a defective reducer and watch it over real DDS",
    "gallery": "show what each effect of a real drive does to the zoom spectrum",
}
"""Help by subcommand of the simulator's package, listed even where that is not installed."""


def main(argv: Sequence[str] | None = None) -> int:
    """Run ``hd-monitor`` and return its exit status, one of `STATUSES`."""
    set_up_process()
    words = list(completed_words() or (sys.argv[1:] if argv is None else argv))
    command = next((word for word in words if not word.startswith("-")), "")
    return guard(f"hd-monitor {command}".rstrip(), lambda: _parsed(words))


def _parsed(words: Sequence[str]) -> Callable[[], int]:
    """Return the work that the command line asks for."""
    parser = argparse.ArgumentParser(
        prog="hd-monitor",
        description="Watches harmonic-drive reducers and names the part that is going bad.",
        epilog=STATUSES,
    )
    parser.add_argument("--version", action="version", version=f"hd-monitor {__version__}")
    subparsers = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    added = extensions.declared(extensions.COMMANDS)
    origins = {name: f"from the package {entry.module.partition('.')[0]}" for name, entry in added.items()}
    texts = {**origins, **SIMULATOR_COMMANDS, **COMMANDS}
    chosen = next((word for word in words if not word.startswith("-")), None)
    if chosen is not None and chosen not in texts and completed_words() is None:
        hint = did_you_mean(chosen, texts) or "; hd-monitor --help lists them"
        raise HdMonitorError(f"{chosen!r} is not one of its commands{hint}")
    if chosen in COMMANDS:
        check_files(words, "--params")
    for name, text in texts.items():
        subparser = subparsers.add_parser(
            name, help=text, description=f"{text[:1].upper()}{text[1:]}.", epilog=STATUSES
        )
        if name == chosen:
            command = _load(name, added)
            command.configure(subparser)
            subparser.set_defaults(run=command.run)
    complete(parser)
    arguments = parser.parse_args(words)
    return partial(arguments.run, arguments)


def _load(name: str, added: Mapping[str, "EntryPoint"]) -> ModuleType:
    if name in COMMANDS:
        return importlib.import_module(f"hd_monitor.cli.{name}")
    if name not in added:
        raise HdMonitorError(extensions.SIMULATOR_MISSING)
    module: ModuleType = added[name].load()
    return module


if __name__ == "__main__":
    raise SystemExit(main())
