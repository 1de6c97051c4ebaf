"""The model's vibration in time, along any motion of the output."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray
from ..errors import ParameterError
from ..reducer import Reducer
from .oscillator import Oscillator, gauss_times
from .parameters import ParametricModel

AngleFunction = Callable[[FloatArray], FloatArray]
"""Output angle q [rad] at times [s], any shape."""


@dataclass(frozen=True, slots=True, eq=False)
class TimeResponse:
    """Torsional vibration sampled at a constant rate.

    Attributes
    ----------
    rate : float
        Samples per second [Hz].
    output_angle : ndarray, shape (samples,)
        Kinematic output angle q [rad].
    displacement, velocity, acceleration : ndarray, shape (samples,)
        θ [rad], θ' [rad/s], θ'' [rad/s²].
    """

    rate: float
    output_angle: FloatArray
    displacement: FloatArray
    velocity: FloatArray
    acceleration: FloatArray

    @property
    def times(self) -> FloatArray:
        """Times of the samples [s], from 0, shape (samples,)."""
        return np.arange(self.output_angle.size) / self.rate

    def after(self, time: float) -> "TimeResponse":
        """Return the part from `time` [s] on; its times start at 0 again."""
        first = round(time * self.rate)
        arrays = self.output_angle, self.displacement, self.velocity, self.acceleration
        return TimeResponse(self.rate, *(values[first:] for values in arrays))


def constant_speed(reducer: Reducer, speed_rpm: float) -> AngleFunction:
    """Output angle [rad] at a constant wave-generator speed [rpm], 0 at the start."""
    omega = speed_rpm * 2.0 * np.pi / 60.0 / reducer.reduction
    return lambda times: omega * times


def linear_sweep(reducer: Reducer, start: float, rate: float) -> AngleFunction:
    """Output angle [rad] of a sweep whose circular-spline line ωo2/2π rises from `start` [Hz] by `rate` [Hz/s]."""
    cycles_per_radian = reducer.output_orders.circular_spline / (2.0 * np.pi)
    return lambda times: (start + 0.5 * rate * times) * times / cycles_per_radian


def simulate(model: ParametricModel, output_angle: AngleFunction, *, duration: float, rate: float) -> TimeResponse:
    """Integrate eq. 3 along a motion, starting from the static wind-up at rest.

    Parameters
    ----------
    model : ParametricModel
    output_angle : callable
        Output angle q [rad] at an array of times [s].
    duration : float
        [s]
    rate : float
        Samples per second [Hz], which is also the integration step: 2 kHz is good to 1e-5 at a natural frequency
        of 55 Hz.

    Returns
    -------
    TimeResponse
        `duration * rate` samples, without the end point.

    Raises
    ------
    ParameterError
        If duration or rate is not positive, or the rate does not resolve the natural frequency.
    """
    if not (np.isfinite(duration) and np.isfinite(rate) and duration > 0.0 and rate > 0.0):
        raise ParameterError(f"{duration!r} s at {rate!r} Hz hold no samples; give a duration and a rate above 0")
    steps = max(1, round(duration * rate) - 1)
    times = np.arange(steps + 1) / rate
    angle, between = output_angle(times), output_angle(gauss_times(times))
    oscillator = Oscillator(model.dynamics, model.stiffness_fluctuation(between), 1.0 / rate)
    start = (float(model.static_deflection(angle[0])), 0.0)
    displacement, velocity = oscillator.respond(model.torque_at(between) / model.dynamics.inertia, start)
    return TimeResponse(
        rate=rate,
        output_angle=angle,
        displacement=displacement,
        velocity=velocity,
        acceleration=model.acceleration(angle, displacement, velocity),
    )
