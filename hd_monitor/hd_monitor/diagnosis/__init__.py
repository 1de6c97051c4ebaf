"""From indexes to a verdict with reasons."""

from .judge import Judge
from .probability import component_probabilities, name_component
from .verdict import Component, FaultCode, Level, Verdict

__all__ = [
    "Component",
    "FaultCode",
    "Judge",
    "Level",
    "Verdict",
    "component_probabilities",
    "name_component",
]
