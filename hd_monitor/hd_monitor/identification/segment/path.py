"""What the model needs to know along a joint's motion: the angles of stiffness and load, and the torque."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ...arrays import ComplexArray, FloatArray
from ...interpolation import cubics
from ...model.oscillator import GAUSS_OFFSETS
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
        lines = self.lines.reshape(*self.lines.shape[:-1], 2, 2, -1)
        turned = np.concatenate([lines[..., 1:, :], -lines[..., :1, :]], axis=-2)
        return np.asarray(np.cos(shift) * self.lines + np.sin(shift) * turned.reshape(self.lines.shape))


def paths_along(
    motion: Motion, reducer: Reducer, harmonics: int, load_orders: tuple[int, ...], substeps: int
) -> tuple[Path, Path]:
    """Return the path on an integration grid of `substeps` steps a sample, and at the Gauss points of its steps.

    Their shapes are (steps + 1,), the last sample included, and (2, steps). Between samples the angle is a cubic,
    whose slopes are the speeds; all else is linear.
    """
    parts = (np.arange(substeps) + np.array([[0.0], *([offset] for offset in GAUSS_OFFSETS)])) / substeps
    slopes = motion.speed * motion.step
    q = _at_points(parts, motion.angle, *cubics(motion.angle[:-1], motion.angle[1:], slopes[:-1], slopes[1:]))
    turn, lowest = np.exp(1j * q), reducer.output_orders[0]
    first = np.exp(1j * lowest * q)
    second = first * powers(turn, WAVE_GENERATOR_LOBES)[-1]  # the lobes are what the pair's orders differ by
    rates = np.outer(
        [lowest, lowest, lowest + WAVE_GENERATOR_LOBES, lowest + WAVE_GENERATOR_LOBES], 1 + np.arange(harmonics)
    )
    lines = np.empty((q.size, *rates.shape))
    for spline, unit in enumerate((first, second)):
        for k, power in enumerate(powers(unit, harmonics)[1:]):
            lines[:, 2 * spline, k] = power.real
            np.negative(power.imag, out=lines[:, 2 * spline + 1, k])
    loads = np.empty((q.size, 2 * len(load_orders)))
    for place, load_order in enumerate(load_orders):
        load = np.exp(1j * load_order * q)
        loads[:, place], loads[:, place + len(load_orders)] = load.real, -load.imag
    torque, speed, acceleration = (
        _at_points(parts, values, values[:-1], np.diff(values))
        for values in (motion.torque, motion.speed, motion.acceleration)
    )
    steps = (motion.angle.size - 1) * substeps

    def path(points: slice, *shape: int) -> Path:
        return Path(
            lines=lines[points].reshape(*shape, -1),
            rates=rates.ravel(),
            loads=loads[points].reshape(*shape, -1),
            torque=torque[points].reshape(shape),
            speed=speed[points].reshape(shape),
            acceleration=acceleration[points].reshape(shape),
        )

    return path(slice(steps + 1), steps + 1), path(slice(steps + 1, None), 2, steps)


def _at_points(parts: FloatArray, samples: FloatArray, *coefficients: FloatArray) -> FloatArray:
    """Evaluate polynomials in the place in each interval between samples, the constant coefficients first.

    They are evaluated at `parts` of each interval, shape (kinds, parts). The points come kind by kind, each in order of
    time; those of the first kind end with the last sample.
    """
    place = parts[:, :, None]
    values = coefficients[-1]
    for coefficient in coefficients[-2::-1]:
        values = coefficient + place * values
    points = np.moveaxis(values, 1, 2).reshape(len(parts), -1)
    return np.concatenate([points[0], samples[-1:], points[1:].ravel()])


def powers(unit: ComplexArray, highest: int) -> list[ComplexArray]:
    """Return the powers 0, 1, … `highest`: products are many times as fast as an exponential for each."""
    found = [np.ones_like(unit)]
    for _ in range(highest):
        found.append(found[-1] * unit)
    return found
