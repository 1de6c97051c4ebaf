"""The static torsional stiffness test bed of section 2.2: load the output at locked wave-generator positions."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ..arrays import FloatArray
from ..errors import ParameterError
from .parameters import ParametricModel, StiffnessSeries

_LOAD_STEPS = 10  # evenly spaced torques from zero (not included) to the largest


@dataclass(frozen=True, slots=True, kw_only=True)
class StaticTestBed:
    """The instruments and the loading of a static stiffness test.

    Parameters
    ----------
    torque : float
        Largest torque applied [N·m].
    force_arm, dial_arm : float
        Distances of the force gauge and of the dial indicator from the axis [m].
    force_resolution : float
        Smallest step of the force gauge [N].
    dial_resolution : float
        Smallest step of the dial indicator [m].

    Raises
    ------
    ParameterError
        If a length or the torque is not positive, or a resolution is negative.
    """

    torque: float = 40.0
    force_arm: float = 0.4
    dial_arm: float = 0.4
    force_resolution: float = 0.1
    dial_resolution: float = 1e-6

    def __post_init__(self) -> None:
        """Refuse impossible values."""
        for name in ("torque", "force_arm", "dial_arm"):
            value = getattr(self, name)
            if not (np.isfinite(value) and value > 0):
                raise ParameterError(f"{name} = {value!r} is not possible for a test bed; give a value above 0")
        for name in ("force_resolution", "dial_resolution"):
            value = getattr(self, name)
            if not (np.isfinite(value) and value >= 0.0):
                raise ParameterError(f"{name} = {value!r} is not a resolution; give 0 for an ideal instrument, or more")

    def measure(self, model: ParametricModel, wave_generator_angles: npt.ArrayLike) -> FloatArray:
        """Measure the stiffness at each position.

        Parameters
        ----------
        model : ParametricModel
        wave_generator_angles : array_like, shape (positions,)
            Angles at which the wave generator is locked [rad].

        Returns
        -------
        ndarray, shape (positions,)
            Slope dT/dφ [N·m/rad] (eq. 1) of the readings, by least squares.
        """
        stiffness = model.stiffness(np.asarray(wave_generator_angles, dtype=np.float64) / model.reducer.reduction)
        torque = self.torque * np.arange(1, _LOAD_STEPS + 1) / _LOAD_STEPS
        twist = torque / stiffness[..., None]
        read_torque = _read(torque / self.force_arm, self.force_resolution) * self.force_arm
        read_twist = _read(twist * self.dial_arm, self.dial_resolution) / self.dial_arm
        # Through the origin: both instruments are set to zero without load
        return np.asarray((read_torque * read_torque).sum() / (read_twist * read_torque).sum(axis=-1))


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class StiffnessFit:
    """Static stiffness readings and the curve through them.

    Attributes
    ----------
    angle, readings : ndarray, shape (positions,)
        Of the wave generator, φ [rad], and the stiffness there [N·m/rad].
    mean : float
        Kav [N·m/rad].
    series : StiffnessSeries
        K = mean·(1 + series(2φ)).
    """

    angle: FloatArray
    readings: FloatArray
    mean: float
    series: StiffnessSeries

    def __call__(self, wave_generator_angle: npt.ArrayLike) -> FloatArray:
        """Fitted stiffness [N·m/rad] at wave-generator angles [rad], any shape."""
        return self.mean * (1.0 + self.series(2.0 * np.asarray(wave_generator_angle)))

    @property
    def index(self) -> float:
        """Index of fluctuation Δ/Kav, a fraction; Δ is half the curve's difference between largest and smallest."""
        curve = self(np.linspace(0.0, np.pi, 2001))
        return float((curve.max() - curve.min()) / 2.0 / self.mean)


def fit_stiffness(
    wave_generator_angles: npt.ArrayLike, stiffness: npt.ArrayLike, *, harmonics: int = 2
) -> StiffnessFit:
    """Fit mean and harmonics to static stiffness readings by least squares.

    Readings over a wave-generator revolution or two do not separate the splines' lines (that takes half an output
    revolution); the fit gives their sum.

    Parameters
    ----------
    wave_generator_angles, stiffness : array_like, shape (positions,)
        [rad] and [N·m/rad].
    harmonics : int
        Number of harmonics; readings every 30° resolve 2.

    Returns
    -------
    StiffnessFit

    Raises
    ------
    ParameterError
        If the positions are too few or too evenly folded to separate the harmonics.
    """
    phi = np.asarray(wave_generator_angles, dtype=np.float64)
    values = np.asarray(stiffness, dtype=np.float64)
    waves = np.exp(2j * np.multiply.outer(phi, np.arange(1, harmonics + 1)))
    matrix = np.column_stack([np.ones(phi.size), waves.real, -waves.imag])
    solution, _, rank, _ = np.linalg.lstsq(matrix, values, rcond=1e-9)
    if rank < matrix.shape[1]:
        raise ParameterError(
            f"{phi.size} positions do not separate {harmonics} harmonics; measure at more positions or fit fewer"
        )
    mean = float(solution[0])
    phasors = (solution[1 : harmonics + 1] + 1j * solution[harmonics + 1 :]) / mean
    return StiffnessFit(angle=phi, readings=values, mean=mean, series=StiffnessSeries.from_phasors(phasors))


def _read(value: FloatArray, resolution: float) -> FloatArray:
    """Return the reading of an instrument of this resolution."""
    return value if resolution == 0.0 else np.rint(value / resolution) * resolution
