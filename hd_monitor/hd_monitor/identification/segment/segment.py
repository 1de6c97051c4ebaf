"""A contiguous segment of vibration made ready for fitting: its samples, and the motion between them."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
import scipy

from ...acquisition.record import Record, join_records
from ...arrays import BoolArray, FloatArray
from ...errors import ParameterError
from ...orders.orthonormal import orthonormal
from ...orders.regression import line_columns
from ...orders.tones import foreign_tones
from ...reducer import Reducer
from .decimation import decimate
from .low_pass import LowPass
from .path import Motion, Path, paths_along
from .torque import own_acceleration, regress_torque
from .wander import Wander

FREQUENCY_MARGIN = 1.25
"""Factor by which the natural frequency may turn out higher than given."""

MOST_SUBSTEPS = 16
"""Integration steps per sample above which a segment is refused."""

LARGEST_PHASE_STEP = 1.0
"""Phase [rad] of the natural oscillation and of the fastest stiffness harmonic that an integration step may cover."""

_SIDE_ORDERS = 4.0  # orders above the highest line within which load fluctuations may cause side lines


class Twist(NamedTuple):
    """Twist of the reducer along a segment [rad]."""

    at_steps: FloatArray | None
    at_gauss: FloatArray | None


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Segment:
    """A contiguous segment on a uniform grid.

    Attributes
    ----------
    period : float
        Sample period [s].
    acceleration : ndarray, shape (samples,)
        θ'' [rad/s²]; 0 where left out.
    used : ndarray of bool, shape (samples,)
        Which samples count.
    angle, speed : ndarray, shape (samples,)
        Output angle [rad] and speed [rad/s].
    substeps : int
        Integration steps per sample period.
    fastest : float
        Highest frequency [Hz] of what is predicted.
    at_steps : Path
        The motion at the integration grid's points, shape (steps + 1,).
    at_gauss : Path
        The motion at the two Gauss points of every step, shape (2, steps).
    slow : ndarray, shape (samples, terms)
        Orthonormal directions of slow motion (0 where samples are left out), no part of the torsional vibration.
    highest_frequency : float
        Frequency [Hz] up to which the samples can be trusted.
    low_pass : LowPass
        What the sensor hears.
    raw_samples : int
        Samples of the sensor behind it.
    wander : Wander or None
        Course of the inertia; None if it is constant.
    twist : Twist or None
        As predicted last: where to start from if the stiffness depends on it.
    """

    period: float
    acceleration: FloatArray
    used: BoolArray
    angle: FloatArray
    speed: FloatArray
    substeps: int
    fastest: float
    at_steps: Path
    at_gauss: Path
    slow: FloatArray
    highest_frequency: float
    low_pass: LowPass
    raw_samples: int
    wander: Wander | None = None
    twist: Twist | None = None

    def __len__(self) -> int:
        """Return the number of samples, those left out included."""
        return int(self.acceleration.size)

    def heard(self, predicted: FloatArray) -> FloatArray:
        """What the sensor hears of accelerations on the integration grid, shape (steps + 1, columns): the samples."""
        if self.low_pass.changes(self.fastest):
            predicted = self.low_pass.heard(predicted, self.period / self.substeps)
        return predicted[:: self.substeps]

    def mirrored(self) -> "Segment":
        """Return the segment as a sensor mounted the other way round would have recorded it."""
        return replace(self, acceleration=-self.acceleration)

    def wandering(self) -> "Segment":
        """Return the segment with an inertia that may move."""
        return replace(self, wander=self.wander or Wander.none(self.duration))

    @property
    def duration(self) -> float:
        """Length [s]."""
        return len(self) * self.period

    @property
    def frequencies(self) -> FloatArray:
        """Frequencies [Hz] of the rows of :meth:`transform`, shape (bins,)."""
        length, bins = self._bins()
        return np.asarray(scipy.fft.rfftfreq(length, self.period)[bins])

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
        spectrum = scipy.fft.rfft(x, length, axis=0)[bins] * math.sqrt(2.0 / length)
        return np.concatenate([spectrum.real, spectrum.imag])

    def _bins(self) -> tuple[int, slice]:
        """Length of the Fourier transform, and which of its bins count."""
        length = scipy.fft.next_fast_len(len(self), real=True)
        slow = _slow_degree(self.duration) / (2.0 * self.duration)
        width = 1.0 / (length * self.period)
        return length, slice(math.ceil(slow / width), math.floor(self.highest_frequency / width * (1.0 + 1e-9)) + 1)


@dataclass(frozen=True, slots=True, kw_only=True)
class SegmentBuilder:
    """Makes segments of records.

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
    keep_tones : bool
        Whether foreign tones are left in.
    bandwidth : float
        The sensor's -3 dB bandwidth [Hz]; 0 if unknown.
    """

    reducer: Reducer
    harmonics: int
    load_orders: tuple[int, ...]
    natural_frequency: float
    inertial: bool = False
    keep_tones: bool = False
    bandwidth: float = 0.0

    def build(self, records: Sequence[Record], torque: float | None, origin: float = 0.0) -> Segment:
        """Join successive records, each of which continues the one before it.

        Parameters
        ----------
        records : sequence of Record
        torque : float or None
            Torque [N·m] to be used instead of the records'; None for the records'.
        origin : float
            Time [s] from which that of the segment counts.

        Raises
        ------
        ParameterError
            If the sampling rate is far too low for the lines and the natural frequency.
        """
        record = join_records(records)
        low_pass = LowPass.of(self.bandwidth, 1.0 / record.period)
        raw, period = record.acceleration, record.period
        top_speed = float(np.abs(record.speed).max())
        line = (self.harmonics * self.reducer.output_orders.flexspline + _SIDE_ORDERS) * top_speed / math.tau
        signal = decimate(raw, period, line, FREQUENCY_MARGIN * self.natural_frequency)
        places = signal.first + signal.factor * np.arange(signal.values.size)
        angle, speed, measured = record.angle[places], record.speed[places], record.torque[places]
        step = period * signal.factor
        fastest = math.tau * max(FREQUENCY_MARGIN * self.natural_frequency, 0.7 * line)  # rad/s
        steps = max(1, math.ceil(fastest * step / LARGEST_PHASE_STEP))
        if steps > MOST_SUBSTEPS:
            raise ParameterError(
                f"at {top_speed:.3g} rad/s and {1.0 / step:.4g} samples per second the lines and natural frequency, "
                f"{self.natural_frequency:g} Hz, would need {steps} integration steps a sample, above {MOST_SUBSTEPS}: "
                "such a signal shows nothing of them; check that positions are in rad on the output side, or sample "
                "faster"
            )
        own = own_acceleration(speed, step)
        known = np.full(angle.size, torque) if torque is not None else regress_torque(measured, angle, speed, own, step)
        motion = Motion(angle, speed, own, known, step, record.start - origin + period * signal.first)
        at_steps, at_gauss = paths_along(motion, self.reducer, self.harmonics, self.load_orders, steps)
        return Segment(
            period=step,
            acceleration=signal.values,
            used=signal.used,
            angle=angle,
            speed=speed,
            substeps=steps,
            fastest=max(line, FREQUENCY_MARGIN * self.natural_frequency),
            at_steps=at_steps,
            at_gauss=at_gauss,
            slow=self._slow(motion, signal.values, signal.used),
            highest_frequency=min(signal.highest_frequency, low_pass.limit),
            low_pass=low_pass,
            raw_samples=int(np.isfinite(raw).sum()),
        )

    def _slow(self, motion: Motion, values: FloatArray, used: BoolArray) -> FloatArray:
        """Directions below about 1 Hz, of the joint's own acceleration, of foreign tones; of gravity if inertial."""
        size = motion.angle.size
        degree = _slow_degree(size * motion.step)
        parts = [np.polynomial.legendre.legvander(np.linspace(-1.0, 1.0, size), degree)]
        if float(np.ptp(motion.acceleration)) > 0.0:
            parts.append(motion.acceleration[:, None])
        if self.inertial:
            parts.append(line_columns(motion.angle, [1.0]))
        if not self.keep_tones:
            tones = foreign_tones(values, motion.step, *self._own_lines(motion))
            if tones.size:
                parts.append(line_columns(math.tau * motion.step * np.arange(size), tones))
        return orthonormal(np.concatenate(parts, axis=1) * used[:, None])

    def _own_lines(self, motion: Motion) -> tuple[FloatArray, float]:
        """Frequencies [Hz] between which every group of lines is, and how far its side lines reach beyond."""
        speed = np.abs(motion.speed)
        low, high = float(speed.min()) / math.tau, float(speed.max()) / math.tau
        lowest, highest = self.reducer.output_orders
        groups = range(1, 2 * self.harmonics + 3)  # the coupling of the splines makes lines beyond the harmonics, too
        own = [(k * lowest * low, k * highest * high) for k in groups]
        own += [(order * low, order * high) for order in self.load_orders]
        return np.asarray(own), _SIDE_ORDERS * high


def _slow_degree(duration: float) -> int:
    """Degree of the polynomial that removes what is slower than about 1 Hz over a duration [s]."""
    return 3 + math.ceil(2.0 * duration)
