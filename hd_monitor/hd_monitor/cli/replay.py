"""``hd-monitor replay``: recorded bags through the same core as the node."""

import argparse
import json
import sys
from contextlib import nullcontext
from pathlib import Path

from ..diagnosis.verdict import Level
from ..errors import ParameterError
from ..history.ledger import Ledger
from ..offline.compression import CHUNK_LIMIT
from ..offline.output import check_file, check_folder, write_file
from ..offline.parameters import load_parameters, parse_override
from ..offline.plan import Request
from ..offline.run import replay_bags
from ..offline.summary import summarise
from .reading import add_reading_arguments

_FAIL_ON = {"warn": Level.WARN, "error": Level.ERROR}


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.add_argument(
        "bags",
        type=Path,
        nargs="+",
        metavar="BAG",
        help="rosbag2 folder or file, MCAP or SQLite; several, oldest first, are one history of the arm",
    )
    add_input_arguments(parser)
    parser.add_argument("--report", type=Path, metavar="DIR", help="write an HTML page with plots into this folder")
    parser.add_argument("--history", type=Path, metavar="FILE", help="write what was found to this ledger")
    parser.add_argument(
        "--fail-on",
        choices=sorted(_FAIL_ON),
        help="exit with status 1 if a joint's last verdict, or the state of its inputs, is this bad or worse",
    )


def add_input_arguments(parser: argparse.ArgumentParser, result: str = "result") -> None:
    """Add the arguments that say how a bag is to be read, and where the `result` goes as JSON."""
    add_reading_arguments(parser)
    parser.add_argument(
        "--chunk-limit",
        type=_mebibytes,
        default=CHUNK_LIMIT,
        metavar="MIB",
        help=f"size [MiB] to which a compressed chunk or message may expand; default: {CHUNK_LIMIT >> 20}",
    )
    parser.add_argument("--json", metavar="OUT", help=f"write the {result} as JSON to this file; - for standard output")


def request_from(arguments: argparse.Namespace) -> Request:
    """Gather the arguments into a request.

    Raises
    ------
    ParameterError
        If a file or an argument cannot be read.
    """
    parameters = load_parameters(arguments.params, arguments.node) if arguments.params else {}
    parameters.update(parse_override(text) for text in arguments.param)
    remap = {}
    for text in arguments.remap:
        name, mark, target = text.partition(":=")
        if not (name and mark and target):
            raise ParameterError(
                f"--remap {text!r} maps nothing; write FROM:=TO, as in joint_states:=/arm/joint_states"
            )
        remap[name] = target
    return Request(
        parameters=parameters,
        joints=arguments.joint,
        namespace=arguments.namespace,
        remap=remap,
        chunk_limit=arguments.chunk_limit or CHUNK_LIMIT,
    )


def _mebibytes(text: str) -> int:
    """Read a whole number of MiB; return the bytes."""
    if not text.isdecimal() or not int(text):
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number of MiB above 0")
    return int(text) << 20


def run(arguments: argparse.Namespace) -> int:
    """Replay the bags; return the exit status."""
    check_outputs(arguments)
    with Ledger(arguments.history) if arguments.history else nullcontext() as ledger:
        outcome = replay_bags(arguments.bags, request_from(arguments), for_report=bool(arguments.report), ledger=ledger)
    for note in outcome.notes:
        print(f"hd-monitor replay: {note}", file=sys.stderr)
    text = sys.stderr if arguments.json == "-" else sys.stdout
    for joint in outcome.joints:
        print(summarise(joint), file=text)
    if arguments.json:
        write_json(outcome.content, arguments.json)
    if arguments.report:
        from ..offline.report.page import write_report

        page = write_report(arguments.report, outcome.content, outcome.joints, outcome.collectors)
        print(f"report: {page}", file=text)
    last = [joint.last for joint in outcome.joints if joint.last is not None]
    worst = max(level for said in last for level in (said.verdict.level, said.input.level))
    return int(bool(arguments.fail_on) and worst >= _FAIL_ON[arguments.fail_on])


def check_outputs(arguments: argparse.Namespace) -> None:
    """Raise an `OutputError` before the work if a result cannot be written."""
    given = vars(arguments)
    for path in (given["json"], given.get("yaml")):
        if path and path != "-":
            check_file(Path(path))
    if given.get("report"):
        check_folder(given["report"])


def write_json(content: object, target: str) -> None:
    """Write JSON to a file, or to standard output if that is called ``-``."""
    text = json.dumps(content, indent=1, ensure_ascii=False, allow_nan=False)
    if target == "-":
        print(text)
    else:
        write_file(Path(target), text + "\n")
