"""What the model needs to know along a joint's motion: the angles of stiffness and load, and the torque."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import scipy

from ...arrays import ComplexArray, FloatArray
from ...model.oscillator import gauss_times
from ...orders.regression import line_columns
from ...reducer import WAVE_GENERATOR_LOBES, Reducer


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
    start: float
    """Time of the first sample [s]."""


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
    time : ndarray, shape S
        [s]
    """

    lines: FloatArray
    rates: FloatArray
    loads: FloatArray
    torque: FloatArray
    speed: FloatArray
    acceleration: FloatArray
    time: FloatArray

    def lines_after(self, delay: float, drift: float) -> FloatArray:
        """Return `lines` at the angle that the output has `delay` [s] later, which grows by `drift` [s/s]."""
        if delay == 0.0 and drift == 0.0:
            return self.lines
        later = delay + drift * self.time
        turn = 1j * (self.speed + 0.5 * later * self.acceleration) * later
        lines = self.lines.reshape(*self.lines.shape[:-1], 2, 2, -1)
        rates = self.rates.reshape(2, 2, -1)
        after = np.empty_like(lines)
        for spline in range(2):
            steps = powers(np.exp(rates[spline, 0, 0] * turn), lines.shape[-1])[1:]
            for k, step in enumerate(steps):
                cosine, sine = lines[..., spline, 0, k], lines[..., spline, 1, k]
                after[..., spline, 0, k] = step.real * cosine + step.imag * sine
                after[..., spline, 1, k] = step.real * sine - step.imag * cosine
        return np.asarray(after.reshape(self.lines.shape))

    def turned(self, series: FloatArray) -> FloatArray:
        """Return the series whose lines are the derivative, by the output angle, of those of `series`."""
        # d cos = -sin, d(-sin) = -cos: the other column of the pair, with its sign
        return np.asarray((self.rates * series).reshape(2, 2, -1)[:, ::-1] * [[-1.0], [1.0]]).ravel()

    def slopes(self, lines: FloatArray) -> FloatArray:
        """Return the derivative of lines by the output angle, column by column."""
        pairs = (lines * self.rates).reshape(*lines.shape[:-1], 2, 2, -1)
        return np.asarray(np.concatenate([pairs[..., 1:, :], -pairs[..., :1, :]], axis=-2).reshape(lines.shape))


def paths_along(
    motion: Motion, reducer: Reducer, harmonics: int, load_orders: tuple[int, ...], substeps: int
) -> tuple[Path, Path]:
    """Return the path on an integration grid of `substeps` steps a sample, and at the Gauss points of its steps.

    Their shapes are (steps + 1,), the last sample included, and (2, steps). Between samples the angle is a cubic,
    whose slopes are the speeds; all else is linear.
    """
    grid = np.arange((motion.angle.size - 1) * substeps + 1) / substeps
    nodes, gauss = (_path(motion, places, reducer, harmonics, load_orders) for places in (grid, gauss_times(grid)))
    return nodes, gauss


def _path(motion: Motion, places: FloatArray, reducer: Reducer, harmonics: int, load_orders: tuple[int, ...]) -> Path:
    """Return the path at some places along the samples, counted in samples."""
    samples = np.arange(motion.angle.size)
    angle = scipy.interpolate.CubicHermiteSpline(samples, motion.angle, motion.speed * motion.step)(places)
    lowest = reducer.output_orders[0]
    first = np.exp(1j * lowest * angle)
    second = first * powers(np.exp(1j * angle), WAVE_GENERATOR_LOBES)[-1]  # the lobes: what the orders differ by
    lines = np.empty((*places.shape, 4, harmonics))
    for spline, unit in enumerate((first, second)):
        for k, power in enumerate(powers(unit, harmonics)[1:]):
            lines[..., 2 * spline, k] = power.real
            np.negative(power.imag, out=lines[..., 2 * spline + 1, k])
    return Path(
        lines=lines.reshape(*places.shape, -1),
        rates=np.outer(np.repeat([lowest, lowest + WAVE_GENERATOR_LOBES], 2), 1 + np.arange(harmonics)).ravel(),
        loads=line_columns(angle, load_orders),
        torque=np.interp(places, samples, motion.torque),
        speed=np.interp(places, samples, motion.speed),
        acceleration=np.interp(places, samples, motion.acceleration),
        time=motion.start + motion.step * places,
    )


def powers(unit: ComplexArray, highest: int) -> list[ComplexArray]:
    """Return the powers 0, 1, … `highest`: products are many times as fast as an exponential for each."""
    found = [np.ones_like(unit)]
    for _ in range(highest):
        found.append(found[-1] * unit)
    return found
