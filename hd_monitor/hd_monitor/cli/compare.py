"""``hd-monitor compare``: what changed between two recordings, in words and plots."""

import argparse
import json
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ..offline.comparison import as_dict, compare
from ..offline.errors import BagError
from ..offline.run import replay_bag
from .replay import add_input_arguments, check_outputs, request_from, write_json


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    for name, what in (("before", "the first"), ("after", "the second")):
        parser.add_argument(
            name, type=Path, metavar=name.upper(), help=f"{what} bag, or a result written by replay --json"
        )
    add_input_arguments(parser, "comparison")
    parser.add_argument("--report", type=Path, metavar="DIR", help="write an HTML page with plots into this folder")


def run(arguments: argparse.Namespace) -> int:
    """Compare the two; return the exit status."""
    check_outputs(arguments)
    before, after = (_result(path, arguments) for path in (arguments.before, arguments.after))
    changes = compare(before, after)
    text = sys.stderr if arguments.json == "-" else sys.stdout
    for change in changes:
        print(f"{change.joint}:", file=text)
        for sentence in change.sentences:
            print(f"  {sentence}", file=text)
    content = as_dict(changes, str(arguments.before), str(arguments.after))
    if arguments.json:
        write_json(content, arguments.json)
    if arguments.report:
        from ..offline.report.compare_page import write_comparison

        print(f"report: {write_comparison(arguments.report, content, changes)}", file=text)
    return 0


def _result(path: Path, arguments: argparse.Namespace) -> Mapping[str, Any]:
    if path.suffix != ".json" or path.is_dir():
        outcome = replay_bag(path, request_from(arguments))
        for note in outcome.notes:
            print(f"hd-monitor compare: {path}: {note}", file=sys.stderr)
        return outcome.content
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise BagError(f"{path} cannot be read: {error.strerror}; check the path") from None
    except (ValueError, RecursionError) as error:  # the latter of thousands of brackets
        raise BagError(f"{path} is not JSON ({error}); give what hd-monitor replay --json wrote, or a bag") from None
    keys = ("joint", "verdict", "rms_curve")
    if not (
        isinstance(content, dict)
        and isinstance(content.get("joints"), list)
        and all(isinstance(entry, dict) and all(key in entry for key in keys) for entry in content["joints"])
    ):
        raise BagError(f"{path} is not what hd-monitor replay --json writes; give that, or a bag")
    return content
