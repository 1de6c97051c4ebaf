"""What the sensor's bandwidth lets through: the model's prediction passes it before it is compared with the samples."""

import math
from dataclasses import dataclass

import numpy as np
import scipy

from ...arrays import ComplexArray, FloatArray

PART_OF_RATE = 0.4
"""Bandwidth over the sampling rate where none is given: from there on anti-aliasing filters attenuate."""

_ROLL_OFF = 0.25  # of the bandwidth, over which what is heard falls to nothing beyond it
_REFLECTED = 8.0  # periods of the bandwidth by which a series is continued at its ends, where the filter settles


@dataclass(frozen=True, slots=True, kw_only=True)
class LowPass:
    """The sensor's low-pass: a Butterworth filter of second order, and soon nothing beyond its bandwidth.

    Attributes
    ----------
    limit : float
        Frequency [Hz] beyond which nothing counts.
    bandwidth : float
        -3 dB bandwidth [Hz] of the filter; inf if unknown, when all below the limit counts as heard in full.
    """

    limit: float
    bandwidth: float = math.inf

    @classmethod
    def of(cls, bandwidth: float, rate: float) -> "LowPass":
        """Return the low-pass of a sensor of a given bandwidth [Hz], 0 if unknown, and sampling rate [Hz]."""
        if bandwidth == 0.0:
            return cls(limit=PART_OF_RATE * rate)
        return cls(limit=min(bandwidth, 0.5 * rate), bandwidth=bandwidth)

    def changes(self, highest: float) -> bool:
        """Whether vibrations up to a frequency [Hz] are heard otherwise than they are."""
        return highest > self.limit or math.isfinite(self.bandwidth)

    def response(self, frequencies: FloatArray) -> ComplexArray:
        """Part of a vibration at frequencies [Hz] that is heard, with its phase."""
        ratio = frequencies / self.bandwidth
        heard = 1.0 / (1.0 - ratio**2 + 1j * math.sqrt(2.0) * ratio)
        beyond = np.clip((frequencies / self.limit - 1.0) / _ROLL_OFF, 0.0, 1.0)
        return np.asarray(heard * np.cos(0.5 * math.pi * beyond) ** 2)

    def heard(self, series: FloatArray, step: float) -> FloatArray:
        """What is heard of series sampled every `step` [s], of shape (samples, columns)."""
        size = series.shape[0]
        pad = min(size - 1, math.ceil(_REFLECTED / (self.limit * step)))
        first, last = series[:1], series[-1:]
        whole = np.concatenate([2.0 * first - series[pad:0:-1], series, 2.0 * last - series[-2 : -pad - 2 : -1]])
        length = scipy.fft.next_fast_len(whole.shape[0], real=True)
        spectrum = scipy.fft.rfft(whole, length, axis=0)
        spectrum *= self.response(np.asarray(scipy.fft.rfftfreq(length, step)))[:, None]
        return np.asarray(scipy.fft.irfft(spectrum, length, axis=0)[pad : pad + size])
