"""A contiguous stretch of vibration made ready for fitting: its samples, and the motion between them."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.ndimage import median_filter

from ..acquisition.record import Record
from ..model.oscillator import GAUSS_OFFSETS
from ..reducer import Reducer

FloatArray = npt.NDArray[np.float64]
BoolArray = npt.NDArray[np.bool_]

LARGEST_PHASE_STEP = 1.0
"""Phase [rad] of the natural oscillation and of the fastest stiffness harmonic that an integration step may cover."""

OUTLIER = 8.0
"""Robust standard deviations by which a sample must stick out of its neighbours to be left out."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Path:
    """What the model needs to know along the motion, at some set of instants of shape `S`.

    Attributes
    ----------
    lines : ndarray, shape S + (4 * harmonics,)
        cos and -sin of every harmonic's angle, in the order of the unknowns: times β they give the stiffness.
    loads : ndarray, shape S + (2 * load orders,)
        cos and -sin of the load angles.
    torque : ndarray, shape S
        Known torque [N·m].
    """

    lines: FloatArray
    loads: FloatArray
    torque: FloatArray


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Stretch:
    """A contiguous stretch on a uniform grid.

    Attributes
    ----------
    start, period : float
        Time of the first sample and sample period [s].
    acceleration : ndarray, shape (samples,)
        θ'' [rad/s²]; 0 where left out.
    used : ndarray of bool, shape (samples,)
        Which samples count.
    angle, speed : ndarray, shape (samples,)
        Output angle [rad] and speed [rad/s].
    substeps : int
        Integration steps per sample period.
    at_steps : Path
        The motion at the integration grid's points, shape (steps + 1,).
    at_gauss : Path
        The motion at the two Gauss points of every step, shape (2, steps).
    slow : ndarray, shape (samples, terms)
        Orthonormal directions of slow motion (0 where samples are left out), no part of the torsional vibration.
    """

    start: float
    period: float
    acceleration: FloatArray
    used: BoolArray
    angle: FloatArray
    speed: FloatArray
    substeps: int
    at_steps: Path
    at_gauss: Path
    slow: FloatArray

    def __len__(self) -> int:
        """Return the number of samples, those left out included."""
        return int(self.acceleration.size)

    @property
    def duration(self) -> float:
        """Length [s]."""
        return len(self) * self.period


@dataclass(frozen=True, slots=True, kw_only=True)
class StretchBuilder:
    """Makes stretches of records.

    Attributes
    ----------
    reducer : Reducer
    harmonics : int
        Line pairs.
    load_orders : tuple of int
        Cycles per output revolution of unknown load fluctuations.
    natural_frequency : float
        [Hz]; together with the lines' frequencies it sets the integration step.
    torque : float or None
        Torque [N·m] to be used instead of the records'; None for the records'.
    inertial : bool
        Whether the sensor also feels gravity and the joint's own acceleration, as an IMU does.
    """

    reducer: Reducer
    harmonics: int
    load_orders: tuple[int, ...]
    natural_frequency: float
    torque: float | None = None
    inertial: bool = False

    def build(self, records: Sequence[Record]) -> Stretch:
        """Join successive records, each of which continues the one before it."""
        angle, speed, torque, raw = (
            np.concatenate([getattr(record, name) for record in records])
            for name in ("angle", "speed", "torque", "acceleration")
        )
        period = records[0].period
        if self.torque is not None:
            torque = np.full(angle.size, self.torque)
        used = np.isfinite(raw)
        used[used] = ~outliers(raw[used])
        steps = self._substeps(speed, period)
        places = np.arange((angle.size - 1) * steps) / steps
        gauss = np.stack([places + c / steps for c in GAUSS_OFFSETS])
        nodes = np.append(places, float(angle.size - 1))
        return Stretch(
            start=records[0].start,
            period=period,
            acceleration=np.where(used, raw, 0.0),
            used=used,
            angle=angle,
            speed=speed,
            substeps=steps,
            at_steps=self._path(_hermite(angle, speed * period, nodes), _linear(torque, nodes)),
            at_gauss=self._path(_hermite(angle, speed * period, gauss), _linear(torque, gauss)),
            slow=self._slow(angle, speed, used, period),
        )

    def _substeps(self, speed: FloatArray, period: float) -> int:
        fastest = self.harmonics * self.reducer.output_orders.flexspline * float(np.abs(speed).max())
        phase = max(math.tau * self.natural_frequency * 1.15, 0.7 * fastest) * period
        return max(1, math.ceil(phase / LARGEST_PHASE_STEP))

    def _path(self, angle: FloatArray, torque: FloatArray) -> Path:
        lines = np.empty((*angle.shape, 4 * self.harmonics))
        for place, order in enumerate(self.reducer.output_orders):
            unit = np.exp(1j * order * angle)
            power = unit
            for k in range(self.harmonics):
                lines[..., 2 * self.harmonics * place + k] = power.real
                lines[..., 2 * self.harmonics * place + self.harmonics + k] = -power.imag
                power = power * unit
        phases = np.multiply.outer(angle, np.asarray(self.load_orders, dtype=np.float64))
        loads = np.concatenate([np.cos(phases), -np.sin(phases)], axis=-1)
        return Path(lines=lines, loads=loads, torque=torque)

    def _slow(self, angle: FloatArray, speed: FloatArray, used: BoolArray, period: float) -> FloatArray:
        degree = 3 + math.ceil(2.0 * angle.size * period)
        columns = np.polynomial.legendre.legvander(np.linspace(-1.0, 1.0, angle.size), degree)
        if self.inertial:
            own = np.stack([np.cos(angle), np.sin(angle), np.gradient(speed, period)], axis=1)
            columns = np.concatenate([columns, own / (np.linalg.norm(own, axis=0) + 1e-12)], axis=1)
        columns = columns * used[:, None]
        left, sizes, _ = np.linalg.svd(columns / (np.linalg.norm(columns, axis=0) + 1e-12), full_matrices=False)
        return np.ascontiguousarray(left[:, sizes > 1e-6 * sizes[0]])


def outliers(values: FloatArray) -> BoolArray:
    """Mark samples that stick out of their neighbours: more than any smooth vibration does, however it swells."""
    if values.size < 16:
        return np.zeros(values.shape, dtype=np.bool_)
    middle = median_filter(values, 5, mode="nearest")
    difference = np.abs(values - middle)
    limit = OUTLIER * 1.4826 * float(np.median(difference))
    local = median_filter(np.abs(values), 9, mode="nearest")
    return np.asarray((difference > limit) & (difference > 2.0 * local))


def _hermite(values: FloatArray, slopes: FloatArray, places: FloatArray) -> FloatArray:
    """Cubic Hermite interpolation on a unit grid; `slopes` are per grid step."""
    left = np.minimum(places.astype(np.intp), values.size - 2)
    u = places - left
    rise = values[left + 1] - values[left]
    a, b = slopes[left] - rise, rise - slopes[left + 1]
    return np.asarray(values[left] + u * (rise + (1.0 - u) * (a * (1.0 - u) + b * u)))


def _linear(values: FloatArray, places: FloatArray) -> FloatArray:
    left = np.minimum(places.astype(np.intp), values.size - 2)
    return np.asarray(values[left] + (places - left) * (values[left + 1] - values[left]))
