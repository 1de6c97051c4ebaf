"""Entry point of ``hd-monitor``: find the subcommand's module, here or in another package, and run it."""

import argparse
import importlib
import os
import signal
import sys
from collections.abc import Callable, Mapping, Sequence
from importlib.metadata import EntryPoint
from types import ModuleType

from ..errors import UNUSABLE_INPUT, HdMonitorError
from ..process import set_up_process
from . import extensions

READER_GONE = 128 + signal.SIGPIPE
"""Exit status where the reader of the output has left, as a shell reports it of other commands."""

_ROS = {"rclpy", "rcl_interfaces", "builtin_interfaces", "lifecycle_msgs", "std_srvs"}

COMMANDS = {
    "replay": "put a recorded bag through the same core, with JSON and a report",
    "compare": "compare two bags or two JSON results: what changed",
    "identify": "estimate the stiffness indexes, fn and ζ from a recorded run",
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
    """Run ``hd-monitor`` and return its exit status: 0 done, 1 `--fail-on` met, 2 unusable input."""
    set_up_process()
    words = list(sys.argv[1:] if argv is None else argv)
    parser = argparse.ArgumentParser(
        prog="hd-monitor", description="Watches harmonic-drive reducers and names the part that is going bad."
    )
    subparsers = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    added = extensions.declared(extensions.COMMANDS)
    origins = {name: f"from the package {entry.module.partition('.')[0]}" for name, entry in added.items()}
    texts = {**origins, **SIMULATOR_COMMANDS, **COMMANDS}
    chosen = next((word for word in words if word in texts), None)

    def work() -> int:
        for name, text in texts.items():
            subparser = subparsers.add_parser(name, help=text, description=text)
            if name == chosen:
                command = _load(name, added)
                command.configure(subparser)
                subparser.set_defaults(run=command.run)
        arguments = parser.parse_args(words)
        status: int = arguments.run(arguments)
        return status

    return guard(f"hd-monitor {chosen}", work)


def guard(name: str, work: Callable[[], int]) -> int:
    """Do a command's work; an error becomes one line that begins with `name`, and an exit status."""
    try:
        status = work()
        sys.stdout.flush()
        return status
    except BrokenPipeError:  # the reader has seen enough, as `| head` has; nor may the flush at exit complain
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return READER_GONE
    except (HdMonitorError, ModuleNotFoundError) as error:
        reason = _missing(error) if isinstance(error, ModuleNotFoundError) else error
        print(f"{name}: {reason}", file=sys.stderr)
        return UNUSABLE_INPUT
    except KeyboardInterrupt:
        return 130


def _load(name: str, added: Mapping[str, EntryPoint]) -> ModuleType:
    if name in COMMANDS:
        return importlib.import_module(f"hd_monitor.cli.{name}")
    if name not in added:
        raise HdMonitorError(extensions.SIMULATOR_MISSING)
    module: ModuleType = added[name].load()
    return module


def _missing(error: ModuleNotFoundError) -> str:
    """Say what is not installed and how to get it."""
    name = (error.name or "").partition(".")[0]
    if name == "hd_sim_node":
        return extensions.SIMULATOR_MISSING
    if name in _ROS or name.endswith("_msgs"):
        return (
            f"needs ROS 2 ({name} is missing): source your ROS installation, or run pip install '.[ros]' "
            "in the checkout"
        )
    return f"needs the Python package {name!r}, which is not installed: run pip install '.[offline]' in the checkout"


if __name__ == "__main__":
    raise SystemExit(main())
