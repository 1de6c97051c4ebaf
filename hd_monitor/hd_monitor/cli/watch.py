"""``hd-monitor watch``: all joints in the terminal, live or from a recording."""

import argparse
import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from ..errors import OutputError, ParameterError
from .reading import add_reading_arguments

if TYPE_CHECKING:
    from ..watch.source import Source

_LAST_DOMAIN = 232
_FEW_SIGNS = {"linux", "dumb", "vt100", "vt220"}
"""Terminals whose fonts lack the signs of bars and curves."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.description = (
        "Shows all joints in the terminal, the worst one first: which part, how bad, how sure, what to do, since when. "
        "It listens to the nodes of its ROS_DOMAIN_ID, or reads a recording (--bag; the options after --ascii say how)."
    )
    parser.add_argument("--bag", type=Path, metavar="BAG", help="rosbag2 folder or file to show instead of live topics")
    parser.add_argument("--domain", type=int, metavar="N", help="ROS_DOMAIN_ID; default: the environment's")
    parser.add_argument("--ascii", action="store_true", help="draw with letters only")
    add_reading_arguments(parser)
    parser.set_defaults(chunk_limit=None)


def run(arguments: argparse.Namespace) -> int:
    """Show the joints until the user quits; return the exit status."""
    from ..watch.app import WatchApp

    if not (sys.stdin.isatty() and sys.stdout.isatty()):
        raise OutputError("watch needs a terminal; elsewhere use hd-monitor replay BAG, or read /diagnostics")
    source = _source(arguments)
    try:
        app = WatchApp(source, ascii_only=arguments.ascii or os.environ.get("TERM") in _FEW_SIGNS)
        app.run()
    finally:
        source.close()
    if app.failure is not None:
        raise app.failure
    return app.return_code or 0


def _source(arguments: argparse.Namespace) -> "Source":
    if arguments.bag is not None:
        from ..watch.bag import BagSource
        from .replay import request_from

        return BagSource(arguments.bag, request_from(arguments))
    if arguments.domain is not None and not 0 <= arguments.domain <= _LAST_DOMAIN:
        raise ParameterError(f"--domain = {arguments.domain} is not a ROS_DOMAIN_ID; give 0 to {_LAST_DOMAIN}")
    from ..watch.live import LiveSource

    return LiveSource(arguments.domain)
