"""A contiguous stretch of vibration made ready for fitting: its samples, and the motion between them."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from scipy import fft

from ..acquisition.record import Record
from ..errors import ParameterError
from ..interpolation import hermite, linear
from ..model.oscillator import GAUSS_OFFSETS
from ..reducer import Reducer
from .conditioning import condition
from .drive import own_acceleration, smooth_torque
from .tones import foreign_tones, tone_columns

FloatArray = npt.NDArray[np.float64]
BoolArray = npt.NDArray[np.bool_]

FREQUENCY_MARGIN = 1.25
"""Factor by which the natural frequency may turn out higher than given."""

MOST_SUBSTEPS = 16
"""Integration steps per sample above which a stretch is refused."""

LARGEST_PHASE_STEP = 1.0
"""Phase [rad] of the natural oscillation and of the fastest stiffness harmonic that an integration step may cover."""

_SIDE_ORDERS = 4.0  # orders above the highest line at which load fluctuations may still put side lines


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Path:
    """What the model needs to know along the motion, at some set of instants of shape `S`.

    Attributes
    ----------
    lines : ndarray, shape S + (4 * harmonics,)
        cos and -sin of every harmonic's angle, in the order of the unknowns: times β they give the stiffness.
    rates : ndarray, shape (4 * harmonics,)
        Orders of these angles, cycles per output revolution.
    loads : ndarray, shape S + (2 * load orders,)
        cos and -sin of the load angles.
    torque : ndarray, shape S
        Known torque [N·m].
    speed, acceleration : ndarray, shape S
        Output speed [rad/s] and its derivative [rad/s²].
    """

    lines: FloatArray
    rates: FloatArray
    loads: FloatArray
    torque: FloatArray
    speed: FloatArray
    acceleration: FloatArray

    def lines_after(self, delay: float) -> FloatArray:
        """Return `lines` at the angle that the output has `delay` [s] later."""
        if delay == 0.0:
            return self.lines
        shift = np.multiply.outer(self.speed * delay, self.rates)
        cosine, other = self.quadrature(self.lines)
        return np.asarray(np.cos(shift) * self.lines + np.sin(shift) * np.where(cosine, other, -other))

    def quadrature(self, lines: FloatArray) -> tuple[BoolArray, FloatArray]:
        """Mark the columns that hold cosines, and return the columns with cos and -sin of each angle exchanged."""
        harmonics = self.rates.size // 4
        swapped = lines.reshape(*lines.shape[:-1], 2, 2, harmonics)[..., ::-1, :].reshape(lines.shape)
        return np.tile(np.repeat([True, False], harmonics), 2), swapped


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
    highest_frequency : float
        Frequency [Hz] up to which the samples are to be trusted.
    raw_highest : float
        Half the sensor's sampling rate [Hz].
    raw_samples : int
        Samples of the sensor behind it.
    outliers : int
        Of these, left out because they stuck out of their neighbours.
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
    highest_frequency: float
    raw_highest: float
    raw_samples: int
    outliers: int

    def __len__(self) -> int:
        """Return the number of samples, those left out included."""
        return int(self.acceleration.size)

    def mirrored(self) -> "Stretch":
        """Return the stretch as a sensor mounted the other way round would have recorded it."""
        return replace(self, acceleration=-self.acceleration)

    @property
    def duration(self) -> float:
        """Length [s]."""
        return len(self) * self.period

    @property
    def travel(self) -> float:
        """Length of the way [rad] that the output went, there and back counted twice."""
        return float(np.abs(np.diff(self.angle)).sum())

    @property
    def frequencies(self) -> FloatArray:
        """Frequencies [Hz] of the rows of :meth:`transform`, shape (bins,)."""
        length, bins = self._bins()
        return np.asarray(fft.rfftfreq(length, self.period)[bins])

    @property
    def fill(self) -> float:
        """Expected square of a row of :meth:`transform` of white noise of unit variance."""
        return int(self.used.sum()) / self._bins()[0]

    def transform(self, signals: FloatArray) -> FloatArray:
        """Spectra of signals, shape (samples, columns), between slow motion and the highest frequency.

        Real parts of all bins over their imaginary parts, shape (2 * bins, columns).
        """
        x = signals * self.used[:, None]
        x -= self.slow @ (self.slow.T @ x)
        length, bins = self._bins()
        spectrum = fft.rfft(x, length, axis=0)[bins] * math.sqrt(2.0 / length)
        return np.concatenate([spectrum.real, spectrum.imag])

    def _bins(self) -> tuple[int, slice]:
        """Length of the Fourier transform, and which of its bins count."""
        length = fft.next_fast_len(len(self), real=True)
        slow = _slow_degree(self.duration) / (2.0 * self.duration)
        width = 1.0 / (length * self.period)
        return length, slice(math.ceil(slow / width), math.floor(self.highest_frequency / width * (1.0 + 1e-9)) + 1)


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
        [Hz]; together with the lines' frequencies it sets the sampling rate that is needed and the integration step.
    inertial : bool
        Whether the sensor also feels gravity, as an IMU does.
    """

    reducer: Reducer
    harmonics: int
    load_orders: tuple[int, ...]
    natural_frequency: float
    inertial: bool = False

    def build(self, records: Sequence[Record], torque: float | None) -> Stretch:
        """Join successive records, each of which continues the one before it.

        Parameters
        ----------
        records : sequence of Record
        torque : float or None
            Torque [N·m] to be used instead of the records'; None for the records'.

        Raises
        ------
        ParameterError
            If the sampling rate is far too low for the lines and the natural frequency.
        """
        period = _common_period(records)
        angle, speed, measured, raw = (
            np.concatenate([getattr(record, name) for record in records])
            for name in ("angle", "speed", "torque", "acceleration")
        )
        top_speed = float(np.abs(speed).max())
        line = (self.harmonics * self.reducer.output_orders.flexspline + _SIDE_ORDERS) * top_speed / math.tau
        signal = condition(raw, period, line, FREQUENCY_MARGIN * self.natural_frequency)
        places = signal.first + signal.factor * np.arange(signal.values.size)
        angle, speed, measured = angle[places], speed[places], measured[places]
        step = period * signal.factor
        steps = self._substeps(line, step)
        if steps > MOST_SUBSTEPS:
            raise ParameterError(
                f"at {top_speed:.3g} rad/s and {1.0 / step:.4g} samples a second the lines and the natural frequency, "
                f"{self.natural_frequency:g} Hz, ask for {steps} integration steps a sample, above {MOST_SUBSTEPS}: "
                "such a signal shows nothing of them; sample faster"
            )
        nodes = np.append(np.arange((angle.size - 1) * steps) / steps, angle.size - 1.0)
        gauss = np.stack([nodes[:-1] + c / steps for c in GAUSS_OFFSETS])
        own = own_acceleration(speed, step)
        known = np.full(angle.size, torque) if torque is not None else smooth_torque(measured, angle, speed, own, step)
        motion = _Motion(angle, speed, own, known, step)
        return Stretch(
            start=records[0].start + signal.first * period,
            period=step,
            acceleration=signal.values,
            used=signal.used,
            angle=angle,
            speed=speed,
            substeps=steps,
            at_steps=self._path(motion, nodes),
            at_gauss=self._path(motion, gauss),
            slow=self._slow(motion, signal.values, signal.used),
            highest_frequency=signal.highest_frequency,
            raw_highest=0.5 / period,
            raw_samples=int(np.isfinite(raw).sum()),
            outliers=signal.outliers,
        )

    def _substeps(self, line: float, step: float) -> int:
        fastest = math.tau * max(FREQUENCY_MARGIN * self.natural_frequency, 0.7 * line)
        return max(1, math.ceil(fastest * step / LARGEST_PHASE_STEP))

    def _path(self, motion: "_Motion", places: FloatArray) -> Path:
        q = _hermite(motion.angle, motion.speed * motion.step, places)
        lines = np.empty((*q.shape, 4 * self.harmonics))
        rates = np.empty(4 * self.harmonics)
        for spline, order in enumerate(self.reducer.output_orders):
            unit = np.exp(1j * order * q)
            power = unit
            for k in range(self.harmonics):
                real = 2 * self.harmonics * spline + k
                lines[..., real], rates[real] = power.real, (k + 1) * order
                lines[..., real + self.harmonics], rates[real + self.harmonics] = -power.imag, (k + 1) * order
                power = power * unit
        phases = np.multiply.outer(q, np.asarray(self.load_orders, dtype=np.float64))
        return Path(
            lines=lines,
            rates=rates,
            loads=np.concatenate([np.cos(phases), -np.sin(phases)], axis=-1),
            torque=_linear(motion.torque, places),
            speed=_linear(motion.speed, places),
            acceleration=_linear(motion.acceleration, places),
        )

    def _slow(self, motion: "_Motion", values: FloatArray, used: BoolArray) -> FloatArray:
        """Directions below about 1 Hz, the joint's own acceleration, foreign tones; for an inertial sensor gravity."""
        size = motion.angle.size
        degree = _slow_degree(size * motion.step)
        parts = [np.polynomial.legendre.legvander(np.linspace(-1.0, 1.0, size), degree)]
        if float(np.ptp(motion.acceleration)) > 0.0:
            parts.append(motion.acceleration[:, None])
        if self.inertial:
            parts.append(np.stack([np.cos(motion.angle), np.sin(motion.angle)], axis=1))
        tones = foreign_tones(values, motion.step, *self._own_lines(motion))
        if tones.size:
            parts.append(tone_columns(tones, size, motion.step))
        columns = np.concatenate(parts, axis=1) * used[:, None]
        columns /= np.linalg.norm(columns, axis=0) + 1e-300
        squares, directions = np.linalg.eigh(columns.T @ columns)
        kept = squares > 1e-10 * squares[-1]
        return np.asarray(columns @ (directions[:, kept] / np.sqrt(squares[kept])))

    def _own_lines(self, motion: "_Motion") -> tuple[FloatArray, float]:
        """Frequencies [Hz] between which every group of lines is, and how far its side lines reach beyond."""
        speed = np.abs(motion.speed)
        low, high = float(speed.min()) / math.tau, float(speed.max()) / math.tau
        lowest, highest = self.reducer.output_orders
        groups = range(1, 2 * self.harmonics + 3)  # the coupling of the splines makes lines beyond the harmonics, too
        own = [(k * lowest * low, k * highest * high) for k in groups]
        return np.asarray(own), _SIDE_ORDERS * high


class _Motion(NamedTuple):
    """The motion at the samples: output angle, speed and acceleration, known torque, and the sample period."""

    angle: FloatArray
    speed: FloatArray
    acceleration: FloatArray
    torque: FloatArray
    step: float


def _slow_degree(duration: float) -> int:
    """Degree of the polynomial in time [s] that takes off what is slower than about 1 Hz."""
    return 3 + math.ceil(2.0 * duration)


def _common_period(records: Sequence[Record]) -> float:
    """Mean sample period of successive records, each of which has its own estimate of it."""
    first, last = records[0], records[-1]
    if len(records) == 1:
        return first.period
    return (last.start - first.start) / sum(len(record) for record in records[:-1])


def _hermite(values: FloatArray, slopes: FloatArray, places: FloatArray) -> FloatArray:
    """Cubic Hermite interpolation on a unit grid; `slopes` are per grid step."""
    left = np.minimum(places.astype(np.intp), values.size - 2)
    return hermite(values[left], values[left + 1], slopes[left], slopes[left + 1], places - left)


def _linear(values: FloatArray, places: FloatArray) -> FloatArray:
    left = np.minimum(places.astype(np.intp), values.size - 2)
    return linear(values[left], values[left + 1], places - left)
