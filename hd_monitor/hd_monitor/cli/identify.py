"""``hd-monitor identify``: stiffness indexes, fn and ζ of a joint from recorded runs, with confidence intervals."""

import argparse
import sys
from pathlib import Path

from ..offline.identify import identify
from ..offline.identify_result import as_dict, parameter_file
from ..offline.identify_table import table
from ..offline.output import write_file
from ..offline.parameters import parse_override
from .replay import add_input_arguments, check_outputs, request_from, write_json


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.add_argument(
        "bags",
        nargs="+",
        type=Path,
        metavar="BAG",
        help="rosbag2 folder or file, MCAP or SQLite; all recordings of a joint count together. fn and ζ show in a "
        "sweep or run-up through fn/k; nothing fades, whatever analysis.memory says in FILE",
    )
    add_input_arguments(parser)
    parser.add_argument(
        "--yaml",
        type=Path,
        metavar="FILE",
        help="write fn, ζ and, where the tooth check is conclusive, the teeth as a ROS parameter file for the monitor",
    )


def run(arguments: argparse.Namespace) -> int:
    """Identify the joints in the bags; return the exit status."""
    check_outputs(arguments)
    notes: list[str] = []

    def note(sentence: str) -> None:
        notes.append(sentence)
        print(f"hd-monitor identify: {sentence}", file=sys.stderr)

    by_hand = [parse_override(text)[0] for text in arguments.param]
    joints = identify(arguments.bags, request_from(arguments), by_hand=by_hand, note=note)
    text = sys.stderr if arguments.json == "-" else sys.stdout
    for joint in joints:
        print(table(joint), file=text)
    if arguments.json:
        write_json(as_dict(joints, [str(bag) for bag in arguments.bags], notes), arguments.json)
    if arguments.yaml:
        content, reasons = parameter_file(joints)
        for reason in reasons:
            print(f"hd-monitor identify: not in {arguments.yaml}: {reason}", file=sys.stderr)
        if content:
            write_file(arguments.yaml, content)
            print(f"parameters: {arguments.yaml}", file=text)
        else:
            print(f"hd-monitor identify: {arguments.yaml} is not written: there is nothing to write", file=sys.stderr)
    return 0
