"""The parametric torsional model of a harmonic drive, shared by the monitor, the simulator and the paper's figures."""

from .oscillator import Oscillator, Response, gauss_times
from .parameters import Dynamics, ParametricModel, StiffnessSeries, Torque
from .stability import growth_rate, scale_defects, stability_chart
from .steady_state import line_pairs, steady_state

__all__ = [
    "Dynamics",
    "Oscillator",
    "ParametricModel",
    "Response",
    "StiffnessSeries",
    "Torque",
    "gauss_times",
    "growth_rate",
    "line_pairs",
    "scale_defects",
    "stability_chart",
    "steady_state",
]
