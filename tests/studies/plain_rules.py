"""Two plain rules that the monitor is compared with: the paper's, and a linear fit of what the first order explains."""

import math
from collections.abc import Sequence

import numpy as np

from hd_monitor.acquisition.record import Record
from hd_monitor.arrays import ComplexArray, FloatArray
from hd_monitor.diagnosis.verdict import Component
from hd_monitor.model import Oscillator
from hd_monitor.model.oscillator import GAUSS_OFFSETS
from hd_monitor.orders.zoom import zoom_spectrum
from hd_monitor.reducer import ARCMIN, Reducer
from hd_monitor.settings import JointSettings

HARMONICS = (1, 2, 3)

_LONGEST_STEP = 0.8  # rad of ωn


def joined(records: Sequence[Record]) -> tuple[FloatArray, ...]:
    """Acceleration, angle, speed and torque of all records."""
    fields = ("acceleration", "angle", "speed", "torque")
    return tuple(np.concatenate([getattr(record, name) for record in records]) for name in fields)


def higher_peak(reducer: Reducer, records: Sequence[Record]) -> Component:
    """Paper's rule: zoom spectrum around the strongest pair, at the mean speed; the higher line names the part."""
    acceleration, _, speed, _ = joined(records)
    filled = np.where(np.isfinite(acceleration), acceleration, 0.0)
    rpm = float(np.mean(np.abs(speed))) * reducer.reduction * 60.0 / math.tau
    period = records[0].period
    pairs = []
    for k in HARMONICS:
        around = reducer.line_frequencies(rpm, k)
        if 0.0 < around.flexspline < 0.45 / period:
            pairs.append(zoom_spectrum(filled - filled.mean(), period, around=around, k=k).line_amplitudes)
    if not pairs:
        return Component.UNDETERMINED
    strongest = max(pairs, key=max)
    left_higher = strongest.circular_spline > strongest.flexspline
    return Component.CIRCULAR_SPLINE if left_higher else Component.FLEXSPLINE


def linear_fit(settings: JointSettings, records: Sequence[Record]) -> Component:
    """Least squares of each line's stiffness and transmission error, and the rule of the interface on them.

    To first order ``x'' + 2ζωn x' + ωn² x = -β M/J - ωn² e - 2ζωn e'``: a column is the given drive's response to the
    real or the imaginary part of one line's β or e, where that is at its warn limit. All records count as one.
    """
    acceleration, angle, speed, torque = joined(records)
    dynamics, limits, period = settings.dynamics, settings.diagnosis, records[0].period
    torque = np.where(np.isfinite(torque), torque, settings.load.torque)
    omega = dynamics.angular_frequency
    damping = 2.0 * dynamics.damping_ratio * omega
    error = 0.5 * ARCMIN * limits.warn_transmission_error

    def forcing(rows: FloatArray) -> FloatArray:
        """Forcing of all columns [rad/s²] at the samples of these numbers, whole or not."""
        q, v, m = (np.interp(rows, np.arange(angle.size), values) for values in (angle, speed, torque))
        waves: list[ComplexArray] = []
        for order in (k * order for k in HARMONICS for order in settings.reducer.output_orders):
            wave: ComplexArray = np.exp(1j * order * q)
            waves.append(np.asarray(-limits.warn_index * m / dynamics.inertia * wave))
            if settings.transmission_error:
                waves.append(np.asarray(-error * (omega**2 + damping * 1j * order * v) * wave, dtype=np.complex128))
        return np.stack([part for wave in waves for part in (wave.real, wave.imag)], axis=-1)

    finer = math.ceil(omega * period / _LONGEST_STEP)
    starts = np.arange((angle.size - 1) * finer)
    within = forcing(np.stack([starts + offset for offset in GAUSS_OFFSETS]) / finer)
    at_samples = forcing(np.arange(float(angle.size)))
    oscillator = Oscillator(dynamics, np.zeros(within.shape[:2]), period / finer)
    moved = oscillator.respond(within, np.zeros((2, at_samples.shape[1])))
    columns = at_samples - damping * moved.velocity[::finer] - omega**2 * moved.displacement[::finer]
    used = np.isfinite(acceleration)
    if used.sum() <= columns.shape[1]:
        return Component.UNDETERMINED
    found = np.linalg.lstsq(columns[used], acceleration[used], rcond=None)[0]
    squares = (found.reshape(len(HARMONICS), 2, -1, 2) ** 2).sum(axis=(0, 3))  # by spline and kind of reading
    return name(np.sqrt(squares.max(axis=1)).tolist(), limits.both_ratio)


def name(severity: Sequence[float], both_ratio: float) -> Component:
    """Apply the interface's rule to the readings (circular spline, flexspline) as fractions of the warn limit."""
    smaller, larger = sorted(severity)
    if larger < 1.0:
        return Component.NONE
    if smaller >= max(1.0, both_ratio * larger):
        return Component.BOTH
    return Component.CIRCULAR_SPLINE if severity[0] > severity[1] else Component.FLEXSPLINE
