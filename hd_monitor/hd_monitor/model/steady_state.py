"""Steady state of the parametric model at constant speed, by harmonic balance: no time integration."""

from dataclasses import dataclass

import numpy as np

from ..arrays import ComplexArray, IntArray
from ..errors import ParameterError
from ..reducer import WAVE_GENERATOR_LOBES, LinePair
from .parameters import ParametricModel

DEFAULT_COMBINATION_ORDER = 7
"""Largest abs(p) + abs(q) of the combination lines p·ωo1 + q·ωo2 kept."""


@dataclass(frozen=True, slots=True)
class SteadyState:
    """Fourier series of the periodic response: θ(t) = Σ displacement · exp(j orders Ω t).

    Attributes
    ----------
    orders : ndarray of int, shape (lines,)
        Cycles per output revolution, symmetric about 0, sorted.
    displacement : ndarray of complex, shape (lines,)
        Two-sided coefficients of θ [rad].
    output_speed : float
        Ω [rad/s] of the output.
    """

    orders: IntArray
    displacement: ComplexArray
    output_speed: float

    @property
    def acceleration(self) -> ComplexArray:
        """Two-sided coefficients of θ'' [rad/s²], shape (lines,)."""
        return np.asarray(-((self.orders * self.output_speed) ** 2) * self.displacement)

    @property
    def acceleration_rms(self) -> float:
        """RMS of θ'' [rad/s²]."""
        return float(np.linalg.norm(self.acceleration))

    def acceleration_phasor(self, output_order: float) -> complex:
        """One-sided complex amplitude [rad/s²] of θ'' at `output_order` cycles per output revolution; 0 for no line."""
        match = np.flatnonzero(self.orders == round(output_order))
        return 2.0 * complex(self.acceleration[match[0]]) if match.size else 0j


def combination_orders(model: ParametricModel, order: int) -> IntArray:
    """Cycles per output revolution of the lines p·ωo1 + q·ωo2 with abs(p) + abs(q) up to `order`.

    A load fluctuation at another order than the lines' own spacing adds its first side lines.
    """
    cs, fs = (round(x) for x in model.reducer.output_orders)
    p, q = np.meshgrid(np.arange(-order, order + 1), np.arange(-order, order + 1))
    keep = np.abs(p) + np.abs(q) <= order
    lines = np.unique(p[keep] * fs + q[keep] * cs)
    load = model.torque.load_order
    if model.torque.load_fluctuation and load != fs - cs:
        lines = np.unique(np.concatenate([lines - load, lines, lines + load]))
    return lines.astype(np.int64)


def steady_state(
    model: ParametricModel, speed_rpm: float, *, combination_order: int = DEFAULT_COMBINATION_ORDER
) -> SteadyState:
    """Solve the periodic response at a constant wave-generator speed.

    Parameters
    ----------
    model : ParametricModel
    speed_rpm : float
        Wave-generator speed [rpm]; turning back meets the defects in the opposite order, so that with phases other
        than 0 the amplitudes differ a little between the two directions.
    combination_order : int
        Largest abs(p) + abs(q) kept; 7 agrees with time integration to about 1e-3 of the largest line.

    Returns
    -------
    SteadyState

    Raises
    ------
    ParameterError
        If the speed is zero or not finite: there are no lines to solve for.

    Notes
    -----
    In the frequency domain the product k(t)·θ(t) is a convolution of line coefficients, so eq. 3 becomes one complex
    linear system over the lines. The solution exists for an unstable setting too, but no real machine settles on it:
    check :func:`hd_monitor.model.stability.growth_rate` first.
    """
    if not np.isfinite(speed_rpm) or speed_rpm == 0.0:
        raise ParameterError(f"speed = {speed_rpm!r} rpm has no line frequencies; give a speed other than 0")
    omega = speed_rpm * 2.0 * np.pi / 60.0 / model.reducer.reduction
    orders = combination_orders(model, combination_order)
    wn, zeta = model.dynamics.angular_frequency, model.dynamics.damping_ratio
    w = orders * omega
    matrix = np.diag(wn**2 - w**2 + 2j * zeta * wn * w)
    shifts = np.subtract.outer(orders, orders)
    cs, fs = (round(x) for x in model.reducer.output_orders)
    for series, base in ((model.circular_spline, cs), (model.flexspline, fs)):
        for harmonic, phasor in enumerate(series.phasors, start=1):
            _add_cosine(matrix, shifts, harmonic * base, wn**2 * phasor)
    given = model.torque
    torque = np.zeros(orders.size, dtype=np.complex128)
    _add_cosine(torque, orders, 0, given.mean)
    drive_order = round(WAVE_GENERATOR_LOBES * model.reducer.reduction)
    _add_cosine(torque, orders, drive_order, given.drive_fluctuation * np.exp(1j * given.drive_phase))
    _add_cosine(torque, orders, given.load_order, given.load_fluctuation * np.exp(1j * given.load_phase))
    return SteadyState(orders, np.linalg.solve(matrix, torque / model.dynamics.inertia), omega)


def line_pairs(model: ParametricModel, speed_rpm: float, harmonics: int = 4) -> tuple[LinePair, ...]:
    """Amplitudes of θ'' [rad/s²] of the first `harmonics` line pairs in the steady state at a speed [rpm]."""
    state = steady_state(model, speed_rpm)
    cs, fs = model.reducer.output_orders
    return tuple(
        LinePair(abs(state.acceleration_phasor(k * cs)), abs(state.acceleration_phasor(k * fs)))
        for k in range(1, harmonics + 1)
    )


def _add_cosine(coefficients: ComplexArray, orders: IntArray, order: int, phasor: complex) -> None:
    """Add the two-sided coefficients of Re(phasor·exp(j order q)) where `orders` has them."""
    coefficients[orders == order] += phasor / 2
    coefficients[orders == -order] += np.conj(phasor) / 2
