"""Errors of the offline shell."""

from ..errors import HdMonitorError


class BagError(HdMonitorError):
    """A recording of which nothing can be said; the message is one line and says what to do."""


def one_line(error: BaseException) -> str:
    """Return an error's message on one line; its class's name if it has none."""
    return " ".join(str(error).split()).rstrip(".") or type(error).__name__
