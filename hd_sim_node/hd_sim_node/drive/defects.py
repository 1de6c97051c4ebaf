"""Defects to choose by name: which spline is bad and how bad."""

import math

from hd_monitor.errors import ParameterError
from hd_monitor.model import StiffnessSeries

HEALTHY = StiffnessSeries((0.012, 0.008, 0.004), (0.9, 2.1, 4.0))
"""What manufacturing leaves in a good spline: index 0.015."""

FAULTY = StiffnessSeries((0.085, 0.050, 0.030), (0.3, 1.7, 5.1))
"""A bad spline: index 0.103, falling over the harmonics as Table 1 of Gu et al. 2021 does. Both splines like this are
stable up to the principal instability, which lies at 2 fn (3300 rpm for 55 Hz)."""

CUSTOM = "custom"

DEFECTS: dict[str, tuple[StiffnessSeries, StiffnessSeries]] = {
    "none": (HEALTHY, HEALTHY),
    "flexspline": (FAULTY, HEALTHY),
    "circular_spline": (HEALTHY, FAULTY),
    "both": (FAULTY, FAULTY),
}
"""(flexspline, circular spline) by the value of the parameter `defect`, which may also be ``custom``."""


def stiffness_of(
    defect: str, flexspline: StiffnessSeries, circular_spline: StiffnessSeries
) -> tuple[StiffnessSeries, StiffnessSeries]:
    """Return the (flexspline, circular spline) series of a defect; ``custom`` takes the two given.

    Raises
    ------
    ParameterError
        If the stiffness could vanish.
    """
    series = (flexspline, circular_spline) if defect == CUSTOM else DEFECTS[defect]
    total = math.fsum(abs(b) for s in series for b in s.beta)
    if total >= 1.0:
        raise ParameterError(
            f"the β of both splines add up to {total:g}: the stiffness could vanish; keep their sum below 1"
        )
    return series
