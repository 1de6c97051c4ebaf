"""Errors that hd_monitor raises on purpose: each message states the value, the consequence and what to do."""

import reprlib
from collections.abc import Iterable, Sequence
from difflib import get_close_matches

UNUSABLE_INPUT = 2
"""Exit status for unusable input or parameters, or a package that is not installed."""

FAILED = 3
"""Exit status for output that cannot be written and for an error of our own."""

_LISTED, _LONGEST = 6, 80


def listed(names: Sequence[str]) -> str:
    r"""List names that come from outside in a sentence: the first few, abridged and in quotes if they would break it.

    Examples
    --------
    >>> print(listed(["elbow", "left\narm", "", "x" * 100]))
    elbow, 'left\narm', '', 'xxxxxxxxxxxx...xxxxxxxxxxxxx'
    >>> print(listed("abcdefgh"))
    a, b, c, d, e, f and 2 more
    """
    few = names[:_LISTED]
    shown = [name if name.isprintable() and 0 < len(name) < _LONGEST else reprlib.repr(name) for name in few]
    return ", ".join(shown) + (f" and {len(names) - _LISTED} more" if len(names) > _LISTED else "")


def did_you_mean(word: str, known: Iterable[str]) -> str:
    """Write a hint at the known word that a misspelt one resembles, to follow a sentence; empty if none does.

    Examples
    --------
    >>> did_you_mean("elbwo", ["shoulder", "elbow"])
    '; did you mean elbow?'
    >>> did_you_mean("gripper", ["shoulder", "elbow"])
    ''
    """
    close = get_close_matches(word, list(known), n=1)
    return f"; did you mean {close[0]}?" if close else ""


class HdMonitorError(ValueError):
    """Base of every error that hd_monitor raises on purpose.

    Attributes
    ----------
    status : int
        Exit status of a process that it ends.
    """

    status = UNUSABLE_INPUT


class GeometryError(HdMonitorError):
    """The tooth numbers or the mount do not describe a harmonic drive that can turn."""


class ParameterError(HdMonitorError):
    """A parameter lies outside the range in which it means anything."""


class LayoutError(HdMonitorError):
    """A message's arrays do not have the layout that the topic's contract requires."""


class OutputError(HdMonitorError):
    """A result cannot be written."""

    status = FAILED
