"""Transmission error: by how much the output lags and leads the ideal ratio, line by line."""

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.polynomial.polynomial import polyval

from hd_monitor.arrays import ComplexArray, FloatArray
from hd_monitor.errors import ParameterError
from hd_monitor.reducer import ARCMIN, Reducer


class ErrorSignal(NamedTuple):
    """A transmission error and its derivative by the output angle, of the shape of the angles."""

    error: FloatArray | float
    """e [rad]"""
    slope: FloatArray | float
    """de/dq [rad/rad]"""


NO_ERROR = ErrorSignal(0.0, 0.0)


@dataclass(frozen=True, slots=True)
class ErrorSeries:
    """The error that one part contributes: a Fourier series over the part's phase angle.

    Parameters
    ----------
    peak_to_peak : tuple of float
        Size [arcmin, peak to peak] of the harmonics k = 1, 2, …; catalogues state positional accuracy in this unit.
    phase : tuple of float
        Their phases [rad]; those left out are 0.

    Attributes
    ----------
    phasors : ndarray, shape (harmonics,)
        Complex amplitudes [rad].

    Raises
    ------
    ParameterError
        If there are more phases than harmonics.
    """

    peak_to_peak: tuple[float, ...] = ()
    phase: tuple[float, ...] = ()
    phasors: ComplexArray = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the lengths and form the phasors."""
        if len(self.phase) > max(1, len(self.peak_to_peak)):
            raise ParameterError(
                f"{len(self.phase)} phases of a transmission error with {len(self.peak_to_peak)} harmonics; give at "
                "most one phase a harmonic"
            )
        size = 0.5 * ARCMIN * np.asarray(self.peak_to_peak, dtype=np.float64)
        phase = np.zeros(size.size)
        phase[: len(self.phase)] = self.phase[: size.size]
        object.__setattr__(self, "phasors", size * np.exp(1j * phase))

    def at(self, unit: ComplexArray, order: float) -> ErrorSignal:
        """Error where the part's phasor is `unit`, which turns `order` times in an output revolution."""
        if not any(self.peak_to_peak):
            return NO_ERROR
        derivative = 1j * order * np.arange(1, self.phasors.size + 1) * self.phasors
        return ErrorSignal(*(np.asarray(polyval(unit, [0.0, *series]).real) for series in (self.phasors, derivative)))


@dataclass(frozen=True, slots=True, kw_only=True)
class TransmissionErrors:
    """The errors of all parts that turn at lines of their own.

    Parameters
    ----------
    flexspline, circular_spline : ErrorSeries
        At the orders of the splines' stiffness lines, so that both kinds of line stand at the same place (Jia 2021,
        Mech. Mach. Theory 155:104122; Yao, Chen, Xing 2022).
    wave_generator : ErrorSeries
        Harmonics of the wave generator's revolution: 1 of its eccentricity, 2 of the ellipse, 1 and 3 of both.
    """

    flexspline: ErrorSeries = field(default_factory=ErrorSeries)
    circular_spline: ErrorSeries = field(default_factory=ErrorSeries)
    wave_generator: ErrorSeries = field(default_factory=ErrorSeries)

    def highest_order(self, reducer: Reducer) -> float:
        """Highest order per output revolution at which there is an error; 0 without."""
        orders = reducer.output_orders
        series = (
            (self.flexspline, orders.flexspline),
            (self.circular_spline, orders.circular_spline),
            (self.wave_generator, reducer.reduction),
        )
        return max(len(part.peak_to_peak) * order if any(part.peak_to_peak) else 0.0 for part, order in series)
