"""Parametric stability by Floquet's theorem: does a disturbance of the periodic response grow?"""

import math
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from ..arrays import FloatArray
from ..errors import ParameterError
from .oscillator import Oscillator, gauss_times
from .parameters import ParametricModel, StiffnessSeries

_STEPS_PER_RADIAN = 12.0  # of the fastest of natural oscillation and stiffness harmonics; growth rates good to 1e-4 1/s


def growth_rate(model: ParametricModel, speed_rpm: float) -> float:
    """Exponential growth rate [1/s] of free vibration at a constant wave-generator speed [rpm]; unstable above 0.

    The stiffness is exactly periodic: after 1/gcd(z1, z2) of an output revolution (40 wave-generator revolutions for
    160/162) it repeats, so the eigenvalues of the transition matrix over that period decide.

    Raises
    ------
    ParameterError
        If the speed is zero or not finite.
    """
    if not np.isfinite(speed_rpm) or speed_rpm == 0.0:
        raise ParameterError(f"speed = {speed_rpm!r} rpm has no period; give a speed other than 0")
    cs, fs = (round(x) for x in model.reducer.output_orders)
    omega = abs(speed_rpm) * 2.0 * math.pi / 60.0 / model.reducer.reduction
    period = 2.0 * math.pi / (math.gcd(cs, fs) * omega)
    fastest = max(model.dynamics.angular_frequency * 1.5, model.harmonics * fs * omega)
    steps = math.ceil(period * fastest * _STEPS_PER_RADIAN / math.pi)
    times = np.linspace(0.0, period, steps + 1)
    oscillator = Oscillator(model.dynamics, model.stiffness_fluctuation(omega * gauss_times(times)), period / steps)
    monodromy, logarithm = _product(oscillator.transition)
    largest = float(np.abs(np.linalg.eigvals(monodromy)).max())
    return (math.log(largest) + logarithm) / period


def stability_chart(model: ParametricModel, speeds_rpm: npt.ArrayLike, scales: npt.ArrayLike) -> FloatArray:
    """Growth rates [1/s] over wave-generator speeds [rpm] and factors on all indexes β, shape (scales, speeds)."""
    models = [scale_defects(model, float(scale)) for scale in np.asarray(scales)]
    return np.array([[growth_rate(scaled, float(speed)) for speed in np.asarray(speeds_rpm)] for scaled in models])


def scale_defects(model: ParametricModel, factor: float) -> ParametricModel:
    """Return the model with every stiffness index β multiplied by `factor`."""
    circular_spline, flexspline = (
        StiffnessSeries(tuple(b * factor for b in series.beta), series.phase)
        for series in (model.circular_spline, model.flexspline)
    )
    return replace(model, circular_spline=circular_spline, flexspline=flexspline)


def _product(matrices: FloatArray) -> tuple[FloatArray, float]:
    """Product M[n-1]···M[0] as a matrix and the logarithm of a common factor, so that nothing underflows."""
    logarithms = np.zeros(matrices.shape[0])
    while matrices.shape[0] > 1:
        if matrices.shape[0] % 2:
            matrices = np.concatenate([matrices, np.eye(2)[None]])
            logarithms = np.append(logarithms, 0.0)
        matrices = matrices[1::2] @ matrices[0::2]
        scales = np.abs(matrices).max(axis=(1, 2))
        matrices = matrices / scales[:, None, None]
        logarithms = logarithms[1::2] + logarithms[0::2] + np.log(scales)
    return matrices[0], float(logarithms[0])
