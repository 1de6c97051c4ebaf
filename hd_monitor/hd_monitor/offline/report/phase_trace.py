"""The phase trace (Fig. 17 of Gu et al. 2021): torsional displacement and velocity, integrated in the pass band."""

import math
from typing import NamedTuple

import numpy as np

from ...acquisition.record import Record
from ...arrays import FloatArray
from ...reducer import Reducer
from .spectra import filled, whole_runs

_FINER = 8
_FEWEST_CYCLES = 12
_CYCLES_SHOWN = 60
"""Cycles of the first line shown: enough to see the trace's rings wander through a beat, few enough to see rings."""


class PhaseTrace(NamedTuple):
    """Displacement [rad] and velocity [rad/s] of the vibration, shape (samples,), in the band [Hz] given."""

    displacement: FloatArray
    velocity: FloatArray
    band: tuple[float, float]
    rpm: float


def phase_trace(record: Record, reducer: Reducer) -> PhaseTrace | None:
    """Integrate a steady record twice, without what lies below half the first line and near the Nyquist frequency.

    Integration divides by the frequency, so that the noise and the slow motion below the lines would hide them. None
    if the first line lies too high for the sampling rate or no stretch without a hole holds enough of its cycles.
    """
    rpm = abs(float(record.speed.mean())) * reducer.reduction * 60.0 / math.tau
    first = reducer.line_frequencies(rpm).circular_spline
    band = (0.5 * first, 0.45 / record.period)
    begin, end = max(whole_runs(record.acceleration), key=lambda run: run[1] - run[0], default=(0, 0))
    if first * (end - begin) * record.period < _FEWEST_CYCLES or first >= band[1]:
        return None
    # Samples lost at either end of the record would leak into the band: fade in and out, then show the middle.
    values = filled(record.acceleration[begin:end])
    edge = min(values.size // 8, max(1, round(2.0 / (first * record.period))))
    fade = np.ones(values.size)
    ramp = 0.5 - 0.5 * np.cos(math.pi * (np.arange(edge) + 0.5) / edge)
    fade[:edge], fade[-edge:] = ramp, ramp[::-1]
    spectrum = np.fft.rfft(fade * values)
    frequency = np.fft.rfftfreq(values.size, record.period)
    inside = (frequency >= band[0]) & (frequency <= band[1])
    integral = np.where(inside, 1.0, 0.0) / (2j * math.pi * np.where(inside, frequency, 1.0))
    # More points than samples, by the same spectrum: else fast vibration would show as polygons.
    count = _FINER * values.size
    velocity = _FINER * np.fft.irfft(spectrum * integral, count)
    displacement = _FINER * np.fft.irfft(spectrum * integral**2, count)
    guard = 2 * edge  # what the fade itself sets ringing
    shown = min(values.size - 2 * guard, round(_CYCLES_SHOWN / (first * record.period)))
    part = slice(_FINER * (values.size - guard - shown), _FINER * (values.size - guard))
    return PhaseTrace(displacement[part], velocity[part], band, rpm)
