"""Errors of the offline shell."""

from ..errors import HdMonitorError


class BagError(HdMonitorError):
    """A recording of which nothing can be said; the message is one line and says what to do."""


def one_line(error: BaseException | str) -> str:
    """Return an error's message on one line, without the path that the system's own name; its class's name if empty."""
    text = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
    return " ".join(text.split()).rstrip(".") or type(error).__name__
