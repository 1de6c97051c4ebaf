"""Steady records over whole output revolutions, whose Fourier bins are the lines themselves."""

import math

import numpy as np
from scipy.signal import periodogram

from ..arrays import FloatArray
from ..model import ParametricModel
from ..model.simulation import TimeResponse, constant_speed, simulate
from ..reducer import LinePair

REVOLUTIONS = 4
"""Of the output, in every record: the lines of pair k = 1 are then 8 bins apart."""

SETTLING_TIME_CONSTANTS = 20.0
"""Of 1/(ζωn), left out at the start: the transient has then decayed to 2e-9."""

_STEPS_PER_RADIAN = 6.0  # of the natural frequency: 2 kHz at 55 Hz, where the integration is good to 1e-5
_SAMPLES_PER_CYCLE = 12.0  # of the fastest stiffness harmonic


def output_frequency(record: TimeResponse) -> float:
    """Output revolutions per second [Hz] in a steady record."""
    return REVOLUTIONS * record.rate / record.output_angle.size


def amplitude(values: FloatArray, order: float) -> float:
    """Peak amplitude of a steady record's `values` at a whole number of cycles per output revolution (it is a bin)."""
    cycles = np.arange(values.size) * (order * REVOLUTIONS / values.size)
    return float(abs(2.0 * np.mean(values * np.exp(-2j * np.pi * cycles))))


def line_heights(model: ParametricModel, values: FloatArray, k: int = 1) -> LinePair:
    """Peak amplitudes of a steady record's `values` at the k-th pair of lines."""
    return LinePair(*(amplitude(values, k * order) for order in model.reducer.output_orders))


def sampling_rate(model: ParametricModel, speed_rpm: float) -> float:
    """Rate [Hz] at which both the natural vibration and the stiffness harmonics at a speed [rpm] are well resolved."""
    fastest = model.reducer.line_frequencies(speed_rpm, model.harmonics).flexspline
    return max(_STEPS_PER_RADIAN * model.dynamics.angular_frequency, _SAMPLES_PER_CYCLE * fastest)


def steady_record(model: ParametricModel, speed_rpm: float) -> TimeResponse:
    """Simulate a constant speed [rpm] and keep `REVOLUTIONS` of the output after the transient."""
    duration = REVOLUTIONS * 60.0 * model.reducer.reduction / speed_rpm
    cs, fs = (round(order) for order in model.reducer.output_orders)
    periods = REVOLUTIONS * math.gcd(cs, fs)  # common ones of both lines; each gets a whole number of samples
    rate = periods * math.ceil(duration / periods * sampling_rate(model, speed_rpm)) / duration
    settling = SETTLING_TIME_CONSTANTS / (model.dynamics.damping_ratio * model.dynamics.angular_frequency)
    settled = math.ceil(settling * rate) / rate
    motion = constant_speed(model.reducer, speed_rpm)
    return simulate(model, motion, duration=settled + duration, rate=rate).after(settled)


def spectrum(values: FloatArray, rate: float) -> tuple[FloatArray, FloatArray]:
    """Frequencies [Hz] and peak amplitudes, both of shape (bins,), by a Hann window with the mean removed."""
    frequencies, power = periodogram(values, rate, window="hann", detrend="constant", scaling="spectrum")
    return frequencies, np.sqrt(2.0 * power)
