"""The command ``hd-sim-bag``: write a simulated rig's messages to a bag, far faster than real time."""

import argparse
import math
import sys
import time
from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from hd_monitor.errors import ParameterError
from hd_monitor.process import STATUSES, guard, set_up_process


def build_parser() -> argparse.ArgumentParser:
    """Build the command line."""
    from .drive.catalogue import DRIVES
    from .drive.defects import CUSTOM, DEFECTS
    from .motion.programmes import PROGRAMMES
    from .parameters import PUBLISHED

    parser = argparse.ArgumentParser(
        prog="hd-sim-bag",
        description="Simulates a harmonic-drive rig and writes a rosbag2 bag with what hd_sim_node would publish, "
        "without ROS and far faster than real time.",
        epilog="example: hd-sim-bag --defect flexspline --programme strokes --duration 120 --out strokes; " + STATUSES,
    )
    parser.add_argument("--out", required=True, type=Path, metavar="BAG", help="folder to write; must not exist")
    parser.add_argument(
        "--params",
        action="append",
        type=Path,
        default=[],
        metavar="FILE",
        help="parameter file, the same as for the node; given several times: one rig each, all in one bag",
    )
    parser.add_argument("--node", metavar="NAME", default="hd_sim_node", help="node whose parameters the files hold")
    parser.add_argument(
        "--set", action="append", default=[], metavar="NAME:=VALUE", help="set a parameter of every rig; repeatable"
    )
    parser.add_argument("--drive", choices=tuple(DRIVES), help="preset of the parameters that are not given")
    parser.add_argument("--defect", choices=(*DEFECTS, CUSTOM), help="the bad spline")
    parser.add_argument("--programme", choices=tuple(PROGRAMMES), help="what the wave generator does")
    parser.add_argument("--publish", choices=PUBLISHED, help="form of the vibration")
    parser.add_argument("--duration", type=float, metavar="S", help="simulated time; default: the programme once")
    parser.add_argument("--seed", type=int, metavar="N", help="of all random numbers")
    parser.add_argument("--storage", choices=("mcap", "sqlite3"), default="mcap", help="format (default: %(default)s)")
    parser.add_argument(
        "--compression", choices=("none", "file", "message"), default="none", help="Zstandard (default: %(default)s)"
    )
    parser.add_argument("--namespace", default="", metavar="NS", help="namespace of the topics")
    parser.add_argument(
        "--start", type=float, metavar="T", help="stamp of the start, seconds since 1970 (default: now)"
    )
    return parser


def main(argv: Sequence[str] | None = None) -> int:
    """Run ``hd-sim-bag`` and return its exit status, one of `STATUSES`."""
    set_up_process()
    return guard("hd-sim-bag", lambda: partial(_run, build_parser().parse_args(argv)))


def _run(arguments: argparse.Namespace) -> int:
    from hd_monitor.offline.parameters import load_parameters, parse_override

    from .bag import write_bag
    from .parameters import NODE_PARAMETERS
    from .settings import RigSettings, pick

    overrides = dict(parse_override(text) for text in arguments.set)
    shortcuts = ("drive", "defect", "programme", "publish", "duration", "seed")
    overrides |= {name: value for name in shortcuts if (value := getattr(arguments, name)) is not None}
    files: list[Mapping[str, Any]] = [load_parameters(path, arguments.node) for path in arguments.params] or [{}]
    rigs = [RigSettings.from_mapping(pick({**given, **overrides}, NODE_PARAMETERS)) for given in files]
    for remark in dict.fromkeys(remark for rig in rigs for remark in rig.remarks):
        print(f"hd-sim-bag: {remark}", file=sys.stderr)
    stamp = time.time() if arguments.start is None else arguments.start
    if not (math.isfinite(stamp) and 0.0 <= stamp < 2.0**31):
        raise ParameterError(f"--start {stamp:g} does not fit into a stamp; give 0 to 2147483647")
    begun = time.monotonic()
    tty = sys.stderr.isatty()

    def show(fraction: float) -> None:
        print(f"\r{fraction:4.0%}", end="", file=sys.stderr, flush=True)

    summary = write_bag(
        rigs,
        arguments.out,
        storage=arguments.storage,
        compression=arguments.compression,
        start=round(stamp * 1e9),
        namespace=arguments.namespace,
        progress=show if tty else None,
    )
    took = time.monotonic() - begun
    if tty:
        print("\r", end="", file=sys.stderr)
    size = sum(file.stat().st_size for file in summary.path.iterdir()) / 1e6
    print(f"{summary.path}: {summary.duration:g} s simulated in {took:.1f} s, {size:.1f} MB")
    for topic, count in sorted(summary.messages.items()):
        print(f"  {topic}: {count} messages")
    return 0


if __name__ == "__main__":
    sys.exit(main())
