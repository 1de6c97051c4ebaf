"""Errors that hd_monitor raises on purpose: each message states the value, the consequence and what to do."""

UNUSABLE_INPUT = 2
"""Exit status for unusable input or parameters, or a package that is not installed."""


class HdMonitorError(ValueError):
    """Base of every error that hd_monitor raises on purpose."""


class GeometryError(HdMonitorError):
    """The tooth numbers or the mount do not describe a harmonic drive that can turn."""


class ParameterError(HdMonitorError):
    """A parameter lies outside the range in which it means anything."""


class LayoutError(HdMonitorError):
    """A message's arrays do not have the layout that the topic's contract requires."""
