"""What order spectra take in of a segment: its vibration, levelled and with the resonator's phase turned back."""

import math
from collections.abc import Sequence

import numpy as np
import scipy

from ...arrays import FloatArray
from ...model.parameters import Dynamics
from ...orders.order_spectrum import PER_TURN, TURNS, OrderSpectrum
from ...orders.orthonormal import orthonormal
from ..segment.segment import Segment
from ..segment.torque import own_acceleration

_SLOW = 4.0  # polynomial terms per second, which follow what is slower than about 2 Hz


def with_segment(
    spectra: Sequence[OrderSpectrum], segment: Segment, signals: Sequence[FloatArray], dynamics: Dynamics
) -> tuple[OrderSpectrum, ...]:
    """Add signals [rad/s²] along a segment, one to each spectrum.

    They pass a filter that turns back the resonator's phase: past the resonance a line's phase is reversed, so that
    without it the two sides of a speed ramp would cancel.
    """
    used = segment.used
    place = np.floor(np.mod(segment.angle[used] / math.tau, TURNS) * PER_TURN).astype(np.intp) % (TURNS * PER_TURN)
    counts = np.bincount(place, minlength=TURNS * PER_TURN)
    lowest, highest = float(segment.angle.min()), float(segment.angle.max())
    added = _equalised(_levelled(segment, np.stack(signals)), segment.period, dynamics)[:, used]
    return tuple(
        OrderSpectrum(
            sums=spectrum.sums + np.bincount(place, values, spectrum.sums.size),
            counts=spectrum.counts + counts,
            power=spectrum.power + float(values @ values),
            lowest=min(spectrum.lowest, lowest),
            highest=max(spectrum.highest, highest),
        )
        for spectrum, values in zip(spectra, added, strict=True)
    )


def _levelled(segment: Segment, signals: FloatArray) -> FloatArray:
    """Signals less slow motion; unlike the fit's they keep all tones: at one speed these may be other teeth's lines."""
    degree = 3 + math.ceil(_SLOW * segment.duration)
    columns = np.polynomial.legendre.legvander(np.linspace(-1.0, 1.0, len(segment)), degree)
    own = own_acceleration(segment.speed, segment.period)
    if float(np.ptp(own)) > 0.0:
        columns = np.concatenate([columns, own[:, None]], axis=1)
    slow, signals = orthonormal(columns * segment.used[:, None]), signals * segment.used
    return np.asarray(signals - (signals @ slow) @ slow.T)


def _equalised(signals: FloatArray, period: float, dynamics: Dynamics) -> FloatArray:
    """Signals with the resonator's phase turned back, the magnitudes of their spectra as they were."""
    size = signals.shape[1]
    length = scipy.fft.next_fast_len(2 * size, real=True)
    ratio = np.fft.rfftfreq(length, period) / dynamics.natural_frequency
    response = -(ratio**2) / (1.0 - ratio**2 + 2j * dynamics.damping_ratio * ratio)
    response[0] = 1.0
    turned = np.fft.rfft(signals, length) * (response.conj() / np.abs(response))
    return np.asarray(np.fft.irfft(turned, length)[:, :size])
