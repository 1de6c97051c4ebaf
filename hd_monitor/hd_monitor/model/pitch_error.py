"""From an accumulated pitch error of a spline to its stiffness fluctuation (section 2.1 of Gu et al. 2021)."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from numpy.polynomial.polynomial import polyval

from ..arrays import FloatArray
from ..errors import ParameterError
from .parameters import StiffnessSeries

_ANGLES = 2048
"""Places of the wave generator over half a revolution at which the interference is evaluated."""

MESHED_FRACTION = 0.25
"""Part of the flexspline's teeth that mesh at once, in both lobes together (section 1: at least a quarter)."""


@dataclass(frozen=True, slots=True)
class PitchErrors:
    """Accumulated pitch errors of a spline.

    Parameters
    ----------
    accumulated : sequence of float
        Error of each tooth's place against an ideal division, along the pitch circle [m], one a tooth; its mean
        depends on the first tooth counted and has no effect.

    Raises
    ------
    ParameterError
        If there are fewer than 4 teeth or a value is not finite.
    """

    accumulated: tuple[float, ...]

    def __post_init__(self) -> None:
        """Freeze the values and check them."""
        values = tuple(float(x) for x in self.accumulated)
        if len(values) < 4 or not all(np.isfinite(values)):
            raise ParameterError(
                f"{len(values)} accumulated pitch errors are not those of a spline; give one finite value in metres "
                "for each tooth"
            )
        object.__setattr__(self, "accumulated", values)

    @classmethod
    def of_eccentric_gear(
        cls, teeth: int, eccentricity: float, *, scatter: float = 0.0, seed: int = 0
    ) -> "PitchErrors":
        """Errors of a gear cut off its centre: one cycle a revolution of amplitude `eccentricity` [m].

        Each tooth's own place has the standard deviation `scatter` [m]; the same seed gives the same gear.
        """
        places = 2.0 * np.pi * np.arange(teeth) / teeth
        own = np.random.default_rng(seed).normal(0.0, scatter, teeth)
        return cls(tuple((eccentricity * np.cos(places) + own).tolist()))

    @property
    def total(self) -> float:
        """Total accumulated pitch error [m]: largest minus smallest, as a gear inspection prints it."""
        return max(self.accumulated) - min(self.accumulated)

    def interference(self, lobe_angle: npt.ArrayLike) -> FloatArray:
        """Extra tooth deflection [m] with a lobe of the wave generator at `lobe_angle` [rad] on this spline, any shape.

        The two lobes are half a revolution apart, so the teeth of one zone are pressed against those of the other by
        the difference of the two zones' errors; which of them gives way does not matter, so it is never negative. It
        therefore varies twice a revolution (paper, case 1). Each zone averages over the teeth that mesh in it.
        """
        angle = np.asarray(lobe_angle, dtype=np.float64)
        count = len(self.accumulated)
        phasors = 2.0 * np.fft.rfft(self.accumulated) / count
        if count % 2 == 0:
            phasors[-1] /= 2.0  # half the number of teeth is its own negative order
        # E(α) - E(α + π): even orders cancel, odd ones double
        phasors[::2] = 0.0
        phasors *= 2.0 * np.sinc(np.arange(phasors.size) * MESHED_FRACTION / 2.0)
        return np.abs(polyval(np.exp(1j * angle), phasors).real)

    def stiffness_series(self, sensitivity: float, harmonics: int = 3) -> StiffnessSeries:
        """Stiffness fluctuation that the interference causes, over the spline's own phase 2·(lobe angle).

        Parameters
        ----------
        sensitivity : float
            Relative rise of the torsional stiffness for each metre of interference [1/m]; meshing stiffens with
            preload.
        harmonics : int
            Harmonics of the series, each a cycle count of twice a lobe revolution.

        Returns
        -------
        StiffnessSeries
            Relative to the mean stiffness, interference included.

        Raises
        ------
        ParameterError
            If the sensitivity is negative or not finite.
        """
        if not (np.isfinite(sensitivity) and sensitivity >= 0.0):
            raise ParameterError(
                f"sensitivity = {sensitivity!r} 1/m is not a stiffening by preload; give the relative stiffness rise "
                "per metre, 0 or more"
            )
        angles = np.pi * np.arange(_ANGLES) / _ANGLES
        relative = 1.0 + sensitivity * self.interference(angles)
        spectrum = np.fft.rfft(relative) / _ANGLES
        return StiffnessSeries.from_phasors(2.0 * spectrum[1 : harmonics + 1] / spectrum[0].real)
