"""Errors that hd_monitor raises on purpose: each message states the value, the consequence and what to do."""

UNUSABLE_INPUT = 2
"""Exit status for unusable input or parameters, or a package that is not installed."""

FAILED = 3
"""Exit status for output that cannot be written and for an error of our own."""


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
