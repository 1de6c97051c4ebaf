"""``hd-monitor move``: writes a health-check move for one joint."""

import argparse
import math
from pathlib import Path

from ..errors import ParameterError
from ..offline.move import MoveLimits, plan_move, top_speeds, trajectory_yaml
from ..offline.output import check_file, write_file
from ..offline.parameters import load_parameters, parse_override
from ..settings import split_joints


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.add_argument("--joint", metavar="NAME", help="the joint in the parameters; default: the only one")
    parser.add_argument("--params", type=Path, metavar="FILE", help="ROS parameter file, the same as the node's")
    parser.add_argument("--node", metavar="NAME", help="full name of the node in FILE whose parameters are meant")
    parser.add_argument(
        "-p", "--param", action="append", default=[], metavar="NAME:=VALUE", help="set one parameter (repeatable)"
    )
    for name, default, text in (
        ("lower", -math.pi / 2, "lower end of the travel [rad]; default: -π/2"),
        ("upper", math.pi / 2, "upper end of the travel [rad]; default: π/2"),
        ("speed", 2.0, "highest speed allowed [rad/s]; default: 2"),
        ("acceleration", 5.0, "highest acceleration allowed [rad/s²]; default: 5"),
        ("seconds", 60.0, "duration [s]; default: 60"),
    ):
        parser.add_argument(f"--{name}", type=float, default=default, metavar="X", help=text)
    parser.add_argument("--out", type=Path, metavar="FILE", help="write the trajectory here; default: standard output")


def run(arguments: argparse.Namespace) -> int:
    """Write the move; return the exit status."""
    if arguments.out:
        check_file(arguments.out)
    parameters = load_parameters(arguments.params, arguments.node) if arguments.params else {}
    parameters.update(parse_override(text) for text in arguments.param)
    joints = split_joints(parameters)
    name = arguments.joint or (next(iter(joints)) if len(joints) == 1 else "")
    if name not in joints:
        raise ParameterError(f"--joint {name!r} is none of the parameters' joints: {', '.join(joints)}; give one")
    settings = joints[name]
    limits = MoveLimits(
        lower=arguments.lower, upper=arguments.upper, speed=arguments.speed, acceleration=arguments.acceleration
    )
    move = plan_move(settings, limits, arguments.seconds)
    slowest, fastest = top_speeds(settings, limits)
    lines = [speed * order / math.tau for speed in (slowest, fastest) for order in settings.reducer.output_orders]
    start, end = math.degrees(float(move.positions.min())), math.degrees(float(move.positions.max()))
    comment = (
        f"# Health-check move of {name}: {move.times[-1]:.0f} s of strokes from {start:.1f}° to {end:.1f}°, at top "
        f"speeds with the\n# first pair of lines between {min(lines):.1f} and {max(lines):.1f} Hz. "
        f"Bring the joint to {start:.1f}° first.\n"
    )
    text = comment + trajectory_yaml(move, settings.input.joint_name or name)
    if arguments.out:
        write_file(arguments.out, text)
    else:
        print(text, end="")
    return 0
