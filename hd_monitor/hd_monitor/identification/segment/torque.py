"""What drives the model besides the defects: the measured torque and the joint's own acceleration, without noise.

The reducer is a lightly damped resonator: noise of a per cent on a measured torque, taken as exact, would excite it
more than a defect does. What a joint transmits follows its angle and its motion, and else changes slowly.
"""

import math

import numpy as np
import scipy

from ...arrays import FloatArray
from ...orders.regression import line_columns

SLOW = 0.08
"""Standard deviation [s] of the smoothing of what angle and motion do not explain: 2 Hz."""

SIGNIFICANT = 9.0
"""Power of a term, a degree of freedom, over that of the torque's noise from which the term counts as real."""

_SLOW_SIGNIFICANT = 3.0  # power of what is slow, over that of the noise in it, from which some of it counts as real
_NOISE_BAND = (4.0, 20.0)  # Hz, above what is slow and below what slow joint states can show
_MEDIAN = math.log(2.0)  # of the power of noise at one frequency, over its mean
_QUICK = 0.012  # s, smoothing of the joint's own acceleration
_LOAD_ORDERS = (1, 2)  # cycles per output revolution
_FRICTION_SPEED = 0.03  # of the top speed, over which friction changes its sign
_RIDGE = 1e-6


def own_acceleration(speed: FloatArray, period: float) -> FloatArray:
    """Acceleration [rad/s²] of the output, from its speed [rad/s] at samples `period` [s] apart."""
    if float(np.ptp(speed)) == 0.0:
        return np.zeros(speed.shape)
    return np.asarray(scipy.ndimage.gaussian_filter1d(np.gradient(speed, period), _QUICK / period, mode="nearest"))


def regress_torque(
    torque: FloatArray, angle: FloatArray, speed: FloatArray, acceleration: FloatArray, period: float
) -> FloatArray:
    """Return a measured torque [N·m] without its noise.

    A regression on angle (gravity, load), speed (friction) and acceleration keeps what is quick but explained, such
    as the friction's change of sign at a reversal; of the rest only what is slow is kept. Both are kept only as far
    as they stand out of the torque's own noise: whatever is kept counts as exactly known, and puts side lines beside
    every line that no noise floor accounts for.
    """
    if float(np.ptp(torque)) == 0.0:
        return torque
    top = float(np.abs(speed).max()) or 1.0
    terms = [np.stack([speed / top, np.tanh(speed / (_FRICTION_SPEED * top))], axis=1), acceleration[:, None]]
    terms += [line_columns(angle, [order]) for order in _LOAD_ORDERS]
    explained = _projection(torque, terms)
    variance = _noise_density(torque - explained, period) / (2.0 * period)
    while terms:
        # without a term the projection loses what the term alone explains
        without = [_projection(torque, [term for term in terms if term is not left]) for left in terms]
        losses = [
            float(np.sum((explained - rest) ** 2)) / term.shape[1] for rest, term in zip(without, terms, strict=True)
        ]
        least = int(np.argmin(losses))
        if losses[least] > SIGNIFICANT * variance:
            break
        del terms[least]
        explained = without[least]
    slow = scipy.ndimage.gaussian_filter1d(torque - explained, SLOW / period, mode="nearest")
    by_noise = variance * period / (2.0 * math.sqrt(math.pi) * SLOW)
    share = max(0.0, 1.0 - _SLOW_SIGNIFICANT * by_noise / max(float(np.mean(slow**2)), 1e-300))
    return np.asarray(explained + share * slow)


def _projection(torque: FloatArray, terms: list[FloatArray]) -> FloatArray:
    """Part of a torque that a constant and the terms explain."""
    columns = np.concatenate([np.ones((torque.size, 1)), *terms], axis=1)
    columns /= np.linalg.norm(columns, axis=0) + 1e-300
    gram = columns.T @ columns
    return np.asarray(columns @ np.linalg.solve(gram + _RIDGE * np.eye(len(gram)), columns.T @ torque))


def _noise_density(rest: FloatArray, period: float) -> float:
    """One-sided density [(N·m)²/Hz] of the noise in what a regression leaves of a torque."""
    frequencies, density = scipy.signal.periodogram(rest, 1.0 / period, window="hann", detrend=False)
    band = (frequencies >= _NOISE_BAND[0]) & (frequencies <= _NOISE_BAND[1])
    return float(np.median(density[band])) / _MEDIAN if band.any() else 0.0
