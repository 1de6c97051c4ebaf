"""The paper's model, and a model's lines as another program computed them, to hold every way of computing against."""

from typing import Any

from hd_monitor.model import ParametricModel, StiffnessSeries

MODEL = ParametricModel(
    flexspline=StiffnessSeries((0.06, 0.03, 0.02)),
    circular_spline=StiffnessSeries((0.03, 0.015, 0.01), (0.7, 1.4, 2.1)),
)
LINES = {
    400.0: [(0.0637, 0.1274), (0.1516, 0.2939), (0.3833, 0.7730), (0.2641, 1.3663)],
    1600.0: [(13.02, 32.93), (0.5399, 1.0676), (0.3097, 0.7766), (0.0737, 0.3679)],
}
"""Amplitudes of θ'' [rad/s²], (circular spline, flexspline) for k = 1 … 4, by speed [rpm]: Runge-Kutta at 2 kHz."""
RK4_ERROR = 4e-4
"""Relative error of the largest of `LINES`."""


def table_1(**changes: Any) -> ParametricModel:
    """Model of section 3.2 of Gu et al. 2021: Table 1's indexes, fn = 55 Hz, ζ = 0.023, M0 = 10 N·m.

    Keyword arguments replace fields of the model.
    """
    fields: dict[str, Any] = {
        "flexspline": StiffnessSeries((0.05, 0.03, 0.02)),
        "circular_spline": StiffnessSeries((0.06, 0.04, 0.02)),
    }
    return ParametricModel(**(fields | changes))
