"""What the model needs to know along a joint's motion: the angles of stiffness and load, and the torque."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from ..interpolation import hermite, linear
from ..reducer import Reducer

FloatArray = npt.NDArray[np.float64]
BoolArray = npt.NDArray[np.bool_]


class Motion(NamedTuple):
    """The motion at evenly spaced samples."""

    angle: FloatArray
    """Output angle [rad]."""
    speed: FloatArray
    """Output speed [rad/s]."""
    acceleration: FloatArray
    """Output acceleration [rad/s²]."""
    torque: FloatArray
    """Known torque [N·m]."""
    step: float
    """Sample period [s]."""


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


def path_along(
    motion: Motion, reducer: Reducer, harmonics: int, load_orders: tuple[int, ...], places: FloatArray
) -> Path:
    """Return the path at `places`, in sample periods from the first sample, of any shape."""
    left = np.minimum(places.astype(np.intp), motion.angle.size - 2)
    right, part = left + 1, places - left
    slopes = motion.speed * motion.step
    q = hermite(motion.angle[left], motion.angle[right], slopes[left], slopes[right], part)
    lines = np.empty((*q.shape, 4 * harmonics))
    rates = np.empty(4 * harmonics)
    for spline, order in enumerate(reducer.output_orders):
        for k, power in enumerate(powers(np.exp(1j * order * q), harmonics)[1:]):
            real = 2 * harmonics * spline + k
            lines[..., real], rates[real] = power.real, (k + 1) * order
            lines[..., real + harmonics], rates[real + harmonics] = -power.imag, (k + 1) * order
    loads = np.empty((*q.shape, 2 * len(load_orders)))
    turns = powers(np.exp(1j * q), max(load_orders, default=0))
    for place, load_order in enumerate(load_orders):
        loads[..., place], loads[..., place + len(load_orders)] = turns[load_order].real, -turns[load_order].imag
    return Path(
        lines=lines,
        rates=rates,
        loads=loads,
        torque=linear(motion.torque[left], motion.torque[right], part),
        speed=linear(motion.speed[left], motion.speed[right], part),
        acceleration=linear(motion.acceleration[left], motion.acceleration[right], part),
    )


def powers(unit: npt.NDArray[np.complex128], highest: int) -> list[npt.NDArray[np.complex128]]:
    """Return the powers 0, 1, … `highest`: products are many times as fast as an exponential for each."""
    found = [np.ones_like(unit)]
    for _ in range(highest):
        found.append(found[-1] * unit)
    return found
