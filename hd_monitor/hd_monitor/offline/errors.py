"""Errors of the offline shell."""

from ..errors import HdMonitorError


class BagError(HdMonitorError):
    """A recording of which nothing can be said; the message is one line and says what to do."""
