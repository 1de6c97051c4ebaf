"""Stiffness that depends on the twist: the law of the restoring torque, and how it changes with its unknowns."""

import functools
import itertools
from dataclasses import dataclass

import numpy as np

from ...arrays import FloatArray

LEVELS = (0.0, 0.25, 0.5, 1.0, 2.0)
"""Twists, in units of that by the reference torque, between which ln(stiffness) is linear; it is constant beyond."""

_OWN = LEVELS.index(1.0)
_FINE = 16  # points of the tables from one level to the next


@dataclass(frozen=True, eq=False, kw_only=True)
class Hardening:
    """The law G(τ) [rad]: the restoring torque at a twist τ [rad] over the stiffness at the reference torque; odd.

    Attributes
    ----------
    values : ndarray, shape (levels - 1,)
        ln(stiffness / that at the reference torque) at the other `LEVELS`: what catalogues state as K1, K2 and K3.
    unit : float
        Twist [rad] by the reference torque.
    """

    values: FloatArray
    unit: float

    @property
    def is_linear(self) -> bool:
        """Whether the stiffness is the same at every twist."""
        return not self.values.any()

    def slope(self, twist: FloatArray) -> FloatArray:
        """G'(τ)."""
        if self.is_linear:
            return np.ones_like(twist)
        return np.asarray(np.interp(np.abs(twist) / self.unit, _grid(), self._slope))

    def torque(self, twist: FloatArray) -> FloatArray:
        """G(τ) [rad]."""
        return twist if self.is_linear else self._integral(self._slope, twist)

    def twist(self, torque: FloatArray) -> FloatArray:
        """Twist [rad] at which G is `torque` [rad], to about 1e-3 of the unit."""
        if self.is_linear:
            return torque
        table, size = _integrated(self._slope), np.abs(torque) / self.unit
        beyond = np.maximum(size - table[-1], 0.0) / self._slope[-1]
        return np.asarray(np.copysign(self.unit * (np.interp(size, table, _grid()) + beyond), torque))

    def derivatives(self, twist: FloatArray) -> FloatArray:
        """Derivatives of G(τ) by the values, shape S + (levels - 1,)."""
        return self._integral(self._slope[:, None] * _weights(), twist)

    @functools.cached_property
    def _slope(self) -> FloatArray:
        return np.asarray(np.exp(_weights() @ self.values))

    def _integral(self, slope: FloatArray, twist: FloatArray) -> FloatArray:
        """Odd integral from 0 to twists of slopes on the grid, shape (points, …), which are linear in between."""
        grid, size = _grid(), np.abs(twist) / self.unit
        bend = np.zeros_like(slope)
        bend[:-1] = 0.5 * (np.diff(slope, axis=0).T / np.diff(grid)).T
        cell = np.searchsorted(grid, size, side="right") - 1
        part = size - grid[cell]
        sign = self.unit * np.sign(twist)
        if slope.ndim > 1:
            part, sign = part[..., None], sign[..., None]
        return np.asarray(sign * (_integrated(slope)[cell] + part * (slope[cell] + part * bend[cell])))


def _integrated(slope: FloatArray) -> FloatArray:
    """Integral of slopes from 0 to each point of the grid, shape (points, …)."""
    areas = (0.5 * (slope[1:] + slope[:-1]).T * np.diff(_grid())).T
    return np.concatenate([np.zeros_like(slope[:1]), np.cumsum(areas, axis=0)])


@functools.cache
def _grid() -> FloatArray:
    """Twists of the tables, in units of that by the reference torque."""
    steps = [np.linspace(low, high, _FINE, endpoint=False) for low, high in itertools.pairwise(LEVELS)]
    return np.append(np.concatenate(steps), LEVELS[-1])


@functools.cache
def _weights() -> FloatArray:
    """Weights of the values in ln(slope) on the grid, shape (points, levels - 1)."""
    every = np.stack([np.interp(_grid(), LEVELS, row) for row in np.eye(len(LEVELS))], axis=-1)
    return np.delete(every, _OWN, axis=1)
