"""``hd-monitor paper``: the source paper reproduced, claim by claim, or its figures for your own reducer."""

import argparse
import shlex
import shutil
import sys
import time
from importlib.util import find_spec
from pathlib import Path

from ..errors import HdMonitorError
from ..offline.output import check_folder
from ..paper.cases import has_cases, load_own_case, load_paper_cases
from ..paper.exhibit import Outcome
from ..paper.reproduction import EXHIBITS, OWN_EXHIBITS, compute
from ..paper.table import claim_table, fact_table


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.description = (
        "Computes every figure, table and claim of Gu, Tong, Huang and Li (2021), prints each claim beside our "
        "own number, and with --report writes the figures. Exit status: 0 if every claim passes (places where the "
        "paper contradicts itself, "
        "confirmed by our numbers, count as passing), 1 if one fails, 2 for unusable input."
    )
    parser.add_argument(
        "--report",
        metavar="DIR",
        type=Path,
        help="write every figure as PNG and one self-contained page, index.html, there",
    )
    parser.add_argument(
        "--only",
        metavar="ID",
        action="append",
        default=[],
        help="compute only this figure (F10 means F10a and F10b); may be given again or hold a list with commas",
    )
    parser.add_argument(
        "--params",
        metavar="FILE",
        type=Path,
        help="YAML with a reducer of your own (teeth, mount, fn, ζ, β; see my_reducer.yaml in the installed "
        "config folder): the same figures for it, without the paper's claims; or an edited copy of paper.yaml: the "
        "paper with those values",
    )
    parser.add_argument("--list", action="store_true", help="list what can be computed, and end")
    parser.add_argument("--quiet", action="store_true", help="no progress on standard error")


def run(arguments: argparse.Namespace) -> int:
    """Compute, print and write; return the exit status."""
    if arguments.list:
        for entry in EXHIBITS:
            print(f"{entry.id:6s}{entry.about}")
        return 0
    if arguments.report is not None:
        _check_report(arguments.report)
    start = time.perf_counter()

    def tell(line: str) -> None:
        if not arguments.quiet:
            print(line, file=sys.stderr, flush=True)

    own = arguments.params is not None and not has_cases(arguments.params)
    if own:
        case = load_own_case(arguments.params)
        if case.ignored:
            print(
                f"{arguments.params.name}: ignoring {', '.join(case.ignored)}: not used by these "
                "figures; correct if others share the file, else check the spelling",
                file=sys.stderr,
            )
        exhibits = compute(OWN_EXHIBITS, case, arguments.only, tell)
        print(fact_table(exhibits))
        heading = f"Torsional vibration of the reducer in {arguments.params.name}"
    else:
        cases = load_paper_cases(arguments.params)
        exhibits = compute(EXHIBITS, cases, arguments.only, tell)
        print(claim_table(exhibits, min(max(shutil.get_terminal_size((100, 24)).columns, 60), 120)))
        heading = "Torsional vibration of a harmonic driver (Gu et al. 2021), reproduced"
    if arguments.report is not None:
        from ..paper.page import write_report

        print(f"report: {write_report(exhibits, arguments.report, heading=heading, command=_command(arguments))}")
    tell(f"{len(exhibits)} of {len(OWN_EXHIBITS if own else EXHIBITS)} in {time.perf_counter() - start:.1f} s")
    return int(any(claim.outcome is Outcome.FAIL for exhibit in exhibits.values() for claim in exhibit.claims))


def _command(arguments: argparse.Namespace) -> str:
    words = ["hd-monitor", "paper"]
    for name in arguments.only:
        words += ["--only", name]
    if arguments.params is not None:
        words += ["--params", arguments.params.name]
    return shlex.join([*words, "--report", arguments.report.name or "."])


def _check_report(folder: Path) -> None:
    """Find out before the work, not after it, that the report cannot be written."""
    missing = [name for name in ("matplotlib", "jinja2") if find_spec(name) is None]
    if missing:
        raise HdMonitorError(
            f"--report needs {' and '.join(missing)}; pip install '.[offline]' in the checkout, or leave it out"
        )
    check_folder(folder)
