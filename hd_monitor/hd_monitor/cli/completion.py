"""Completion of the command line by the shell, with argcomplete where that is installed."""

import argparse
import os
import shlex
from collections.abc import Sequence


def completed_words() -> Sequence[str] | None:
    """Words of the command line that a shell wants completed, so far; None where none does."""
    if "_ARGCOMPLETE" not in os.environ:
        return None
    line = os.environ.get("COMP_LINE", "")[: int(os.environ.get("COMP_POINT", "0"))]
    try:
        return shlex.split(line)[1:]
    except ValueError:  # a quotation that has yet to be closed
        return line.split()[1:]


def complete(parser: argparse.ArgumentParser) -> None:
    """Answer the shell and end the process, if it was the shell that asked."""
    if "_ARGCOMPLETE" in os.environ:
        import argcomplete

        argcomplete.autocomplete(parser)
