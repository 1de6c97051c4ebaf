"""From indexes to a verdict with reasons."""

from .judge import Judge
from .probability import component_probabilities, name_component
from .status import Status, status_of
from .verdict import Component, FaultCode, Level, Verdict

__all__ = [
    "Component",
    "FaultCode",
    "Judge",
    "Level",
    "Status",
    "Verdict",
    "component_probabilities",
    "name_component",
    "status_of",
]
