"""Values printed by Gu, Tong, Huang and Li (2021); the paper's own numbers are kept here only.

Nothing computed may come from here; figures compute from the cases (``config/paper.yaml``) and are held against this.
"""

from typing import NamedTuple


class Printed(NamedTuple):
    """A printed value: its place in the paper, the value in `unit`, and its wording where it is more than a number."""

    where: str
    value: float
    unit: str = ""
    wording: str = ""

    def __str__(self) -> str:
        """Return the value as the claim table shows it."""
        return self.wording or f"{self.value:g} {self.unit}".strip()


TABLE_1 = {"flexspline": (0.05, 0.03, 0.02), "circular_spline": (0.06, 0.04, 0.02)}

FLEXSPLINE_TEETH = Printed("figure 4", 160)
CIRCULAR_SPLINE_TEETH = Printed("figure 4", 162)
CIRCULAR_SPLINE_CYCLES = Printed("section 2.1, case 1", 2, "", "2 per camshaft cycle")
FLEXSPLINE_CYCLES = Printed(
    "section 2.1, case 2", 2 + 4 / 160, "", "“two times and two teeth” per camshaft cycle: 2 + 2·2/160 = 2.025"
)
STATIC_INDEX = Printed("section 2.2", 0.082, "", "8.2 %")
STATIC_MEAN_STIFFNESS = Printed("section 2.2", 243.5, "N·m/rad")
INERTIA = Printed("section 4", 0.29, "kg·m²")
NATURAL_FREQUENCY = Printed("section 3.2", 55.0, "Hz")
FLEXSPLINE_LINE = Printed("section 3.2", 25.3125, "Hz")
CIRCULAR_SPLINE_LINE = Printed("section 3.2", 25.0, "Hz")
LOAD_FREQUENCY = Printed("section 3.3", 0.3125, "rad/s")

SWEEP_SINGLE_PEAK = Printed("section 3.4.1", 1.0, "", "below 1")
SWEEP_SINGLE_DAMPED_PEAK = Printed("section 3.4.1", 1e-3, "", "under 1e-3")
SWEEP_DOUBLE_PEAK = Printed("section 3.4.2", 1e1, "", "exceeds 1e1")
SWEEP_PEAKS = Printed("section 3.4.1", 3, "", "three: principal instability, resonance, 1/2 harmonic resonance")

RIG_DOMINANT = Printed("section 5", 54.0, "Hz", "4ωo1 ≈ 54 Hz")
RIG_FAST_SPEED = Printed("figure 15", 1700.0, "rpm")
RIG_FAST_DOMINANT = Printed("section 5", 54.0, "Hz", "2ωo1 ≈ 54 Hz")
LOADED_LINES = {"2ωo2 − ωo1": 17.19, "ωo2": 17.01, "ωo1": 16.88, "2ωo1 − ωo2": 16.76}  # Hz, figure 14
SAMPLE_PEAK_SPEED = Printed("section 6", 1300.0, "rpm")
PEAK_REDUCTION = Printed("section 6", 0.5, "", "one half of the original peak")
INDEX_REDUCTION = Printed("section 6", 0.5, "", "half of the original fluctuation")
