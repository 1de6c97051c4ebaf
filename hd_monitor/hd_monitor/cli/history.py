"""``hd-monitor history``: what the ledger knows of every reducer, and what changed."""

import argparse
import sys
from pathlib import Path

from ..errors import ParameterError
from ..history.entry import Kind
from ..history.ledger import Ledger
from ..offline.history import COLUMNS, as_csv, as_dict, read_histories, rows, table
from ..offline.output import check_file, check_folder, write_file
from ..offline.parameters import load_parameters
from .replay import write_json


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.add_argument("--history", type=Path, metavar="FILE", help="the ledger, as history.path names it")
    parser.add_argument("--params", type=Path, metavar="FILE", help="parameter file whose history.path is meant")
    parser.add_argument("--node", metavar="NAME", help="full name of the node in that file whose parameters are meant")
    parser.add_argument("--serial", metavar="S", help="serial number of one reducer; default: all")
    parser.add_argument("--json", metavar="OUT", help="write everything as JSON to this file; - for standard output")
    parser.add_argument("--csv", type=Path, metavar="OUT", help="write a row for each value as CSV to this file")
    parser.add_argument("--parquet", type=Path, metavar="OUT", help="the same as Parquet (needs pyarrow)")
    parser.add_argument("--report", type=Path, metavar="DIR", help="write an HTML page into this folder")
    parser.add_argument(
        "--set-baseline",
        action="store_true",
        help="declare the reducers to be as they should be: the hour of motion before now is what later ones are "
        "compared with",
    )


def run(arguments: argparse.Namespace) -> int:
    """Show the ledger; return the exit status."""
    if arguments.parquet:
        import pyarrow.parquet  # before any work: it may be missing
    for path in (arguments.csv, arguments.parquet):
        if path:
            check_file(path)
    if arguments.json and arguments.json != "-":
        check_file(Path(arguments.json))
    if arguments.report:
        check_folder(arguments.report)
    text = sys.stderr if arguments.json == "-" else sys.stdout
    with Ledger(_path(arguments), read_only=True) as ledger:
        histories = read_histories(ledger, arguments.serial)
        if arguments.set_baseline:
            for history in histories:
                ledger.mark(history.reducer.serial, history.joint, Kind.BASELINE)
            histories = read_histories(ledger, arguments.serial)
        content = as_dict(histories, str(ledger.path))
    print(table(histories), file=text)
    if arguments.json:
        write_json(content, arguments.json)
    if arguments.csv:
        write_file(arguments.csv, as_csv(histories))
    if arguments.parquet:
        pyarrow.parquet.write_table(pyarrow.table(_columns(list(rows(histories)))), arguments.parquet)
    if arguments.report:
        from ..offline.report.history_page import write_history

        print(f"report: {write_history(arguments.report, content, histories)}", file=text)
    return 0


def _path(arguments: argparse.Namespace) -> Path:
    if arguments.history:
        return Path(arguments.history)
    if not arguments.params:
        raise ParameterError("no ledger given; name it with --history FILE, or give --params FILE with history.path")
    parameters = load_parameters(arguments.params, arguments.node)
    paths = {str(value) for name, value in parameters.items() if f".{name}".endswith(".history.path") and value}
    if len(paths) != 1:
        raise ParameterError(
            f"{arguments.params} names {len(paths) or 'no'} ledger(s) in history.path; give one with --history FILE"
        )
    return Path(paths.pop()).expanduser()


def _columns(values: list[tuple[object, ...]]) -> dict[str, list[object]]:
    columns = zip(*values, strict=True) if values else [()] * len(COLUMNS)
    return dict(zip(COLUMNS, map(list, columns), strict=True))
