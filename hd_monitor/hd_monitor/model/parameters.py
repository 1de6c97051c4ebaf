"""Parameters of the parametric torsional model (eqs. 2-4 of Gu et al. 2021), written with angles instead of time."""

import math
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt
from numpy.polynomial.polynomial import polyval

from ..arrays import ComplexArray, FloatArray
from ..errors import ParameterError
from ..reducer import WAVE_GENERATOR_LOBES, Reducer


def _finite(name: str, value: float, *, above: float = -math.inf, at_least: float = -math.inf) -> None:
    if not math.isfinite(value) or value <= above or value < at_least:
        bound = f"above {above:g}" if above > -math.inf else f"at least {at_least:g}"
        raise ParameterError(f"{name} = {value!r} is impossible for a reducer; it must be a finite number {bound}")


@dataclass(frozen=True, slots=True, kw_only=True)
class Dynamics:
    """The mean torsional oscillator: reducer stiffness against the driven inertia.

    Parameters
    ----------
    natural_frequency : float
        Undamped torsional natural frequency fn [Hz].
    damping_ratio : float
        Fraction of critical damping.
    inertia : float
        Inertia J of the output side [kg·m²].

    Raises
    ------
    ParameterError
        If a value is not finite, or the frequency or the inertia is not positive, or the damping is negative.
    """

    natural_frequency: float = 55.0
    damping_ratio: float = 0.023
    inertia: float = 0.29

    def __post_init__(self) -> None:
        """Refuse impossible values."""
        _finite("natural_frequency [Hz]", self.natural_frequency, above=0.0)
        _finite("damping_ratio", self.damping_ratio, at_least=0.0)
        _finite("inertia [kg·m²]", self.inertia, above=0.0)

    @property
    def angular_frequency(self) -> float:
        """Natural frequency ωn [rad/s]."""
        return math.tau * self.natural_frequency

    @property
    def stiffness(self) -> float:
        """Mean torsional stiffness Kav = J ωn² [N·m/rad]."""
        return self.inertia * self.angular_frequency**2

    def receptance(self, frequency: npt.ArrayLike) -> ComplexArray:
        """Normalised frequency response ωn² / (ωn² - ω² + 2jζωnω) at `frequency` [Hz]; 1 at 0 Hz."""
        ratio = np.asarray(frequency, dtype=np.float64) / self.natural_frequency
        return np.asarray(1.0 / (1.0 - ratio**2 + 2j * self.damping_ratio * ratio))


@dataclass(frozen=True, slots=True)
class StiffnessSeries:
    """Stiffness fluctuation that one spline's defect causes: Σ βi cos(i φ + phase_i), i = 1, 2, ….

    Parameters
    ----------
    beta : sequence of float
        Fluctuation indexes βi, fractions of the mean stiffness (Table 1 of Gu et al. 2021 lists such values).
    phase : sequence of float, optional
        Phase of each harmonic [rad]; all zero by default.

    Raises
    ------
    ParameterError
        If a value is not finite or the two sequences differ in length.
    """

    beta: tuple[float, ...] = ()
    phase: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        """Freeze the sequences and check them."""
        beta = tuple(float(b) for b in self.beta)
        phase = tuple(float(p) for p in self.phase) or (0.0,) * len(beta)
        if len(phase) != len(beta):
            raise ParameterError(f"{len(phase)} phases for {len(beta)} harmonics: give one phase a harmonic, or none")
        for name, values in (("beta", beta), ("phase", phase)):
            if not all(math.isfinite(v) for v in values):
                raise ParameterError(f"{name} = {values} has a value that is not finite; give plain numbers")
        object.__setattr__(self, "beta", beta)
        object.__setattr__(self, "phase", phase)

    @classmethod
    def from_phasors(cls, phasors: npt.ArrayLike) -> "StiffnessSeries":
        """Build the series from complex βi·exp(j phase_i)."""
        z = np.atleast_1d(np.asarray(phasors, dtype=np.complex128))
        return cls(tuple(np.abs(z).tolist()), tuple(np.angle(z).tolist()))

    @property
    def phasors(self) -> ComplexArray:
        """Complex βi·exp(j phase_i), shape (harmonics,)."""
        return np.asarray(self.beta) * np.exp(1j * np.asarray(self.phase))

    @property
    def index(self) -> float:
        """Fluctuation index of the spline: root-sum-square of the βi, a fraction of the mean stiffness."""
        return math.sqrt(sum(b * b for b in self.beta))

    def __call__(self, angle: npt.ArrayLike) -> FloatArray:
        """Relative stiffness fluctuation at the spline's phase angle [rad], any shape."""
        unit = np.exp(1j * np.asarray(angle, dtype=np.float64))
        return np.asarray(polyval(unit, [0.0, *self.phasors]).real)


@dataclass(frozen=True, slots=True, kw_only=True)
class Torque:
    """Torque M on the output (eq. 4): a mean, a drive fluctuation and a load fluctuation.

    Parameters
    ----------
    mean : float
        Transmitted torque M0 [N·m].
    drive_fluctuation, drive_phase : float
        Amplitude M1 [N·m] and phase [rad] of the drive's ripple, twice per wave-generator revolution.
    load_fluctuation, load_phase : float
        Amplitude M2 [N·m] and phase [rad] of the load's fluctuation.
    load_order : int
        Cycles of the load fluctuation per output revolution: 1 for gravity on an eccentric load, 2 for the paper's
        case (0.3125 Hz = ωo1 - ωo2 at 25 Hz), which modulates each spline's line into the other's place.

    Raises
    ------
    ParameterError
        If a value is not finite, an amplitude is negative or the order is not a positive whole number.
    """

    mean: float = 10.0
    drive_fluctuation: float = 0.0
    drive_phase: float = 0.0
    load_fluctuation: float = 0.0
    load_phase: float = 0.0
    load_order: int = 2

    def __post_init__(self) -> None:
        """Refuse impossible values."""
        for name in ("mean", "drive_phase", "load_phase"):
            if not math.isfinite(getattr(self, name)):
                raise ParameterError(f"torque {name} = {getattr(self, name)!r} is not finite; give a plain number")
        _finite("drive_fluctuation [N·m]", self.drive_fluctuation, at_least=0.0)
        _finite("load_fluctuation [N·m]", self.load_fluctuation, at_least=0.0)
        if int(self.load_order) != self.load_order or self.load_order < 1:
            raise ParameterError(
                f"load_order = {self.load_order!r} is not a whole number of cycles per output revolution; a load "
                "fluctuation repeats with the output: give 1 (gravity), 2, …"
            )


@dataclass(frozen=True, slots=True, kw_only=True)
class ParametricModel:
    """J θ'' + C θ' + K(q) θ = M(q): a reducer with defects, at any motion q(t) of its output.

    Parameters
    ----------
    reducer : Reducer
    dynamics : Dynamics
    flexspline, circular_spline : StiffnessSeries
        Defects of the two splines (the paper's β1 and β2).
    torque : Torque
    """

    reducer: Reducer = field(default_factory=Reducer)
    dynamics: Dynamics = field(default_factory=Dynamics)
    flexspline: StiffnessSeries = field(default_factory=StiffnessSeries)
    circular_spline: StiffnessSeries = field(default_factory=StiffnessSeries)
    torque: Torque = field(default_factory=Torque)

    @property
    def harmonics(self) -> int:
        """Number of harmonics of the spline that has more of them, at least 1."""
        return max(len(self.circular_spline.beta), len(self.flexspline.beta), 1)

    def stiffness_fluctuation(self, output_angle: npt.ArrayLike) -> FloatArray:
        """Relative stiffness fluctuation K/Kav - 1 (eq. 2) at the output angle q [rad], any shape."""
        q = np.asarray(output_angle, dtype=np.float64)
        orders = self.reducer.output_orders
        return self.circular_spline(orders.circular_spline * q) + self.flexspline(orders.flexspline * q)

    def stiffness(self, output_angle: npt.ArrayLike) -> FloatArray:
        """Stiffness K [N·m/rad] (eq. 2) at the output angle q [rad], any shape."""
        return self.dynamics.stiffness * (1.0 + self.stiffness_fluctuation(output_angle))

    def torque_at(self, output_angle: npt.ArrayLike) -> FloatArray:
        """Torque M [N·m] (eq. 4) at the output angle q [rad], any shape."""
        q = np.asarray(output_angle, dtype=np.float64)
        torque = np.full(q.shape, self.torque.mean)
        if self.torque.drive_fluctuation:
            drive_order = WAVE_GENERATOR_LOBES * self.reducer.reduction
            torque += self.torque.drive_fluctuation * np.cos(drive_order * q + self.torque.drive_phase)
        if self.torque.load_fluctuation:
            torque += self.torque.load_fluctuation * np.cos(self.torque.load_order * q + self.torque.load_phase)
        return torque

    def acceleration(
        self, output_angle: npt.ArrayLike, displacement: npt.ArrayLike, velocity: npt.ArrayLike
    ) -> FloatArray:
        """Torsional acceleration θ'' [rad/s²] by eq. 3, from q [rad], θ [rad] and θ' [rad/s]."""
        dynamics, omega = self.dynamics, self.dynamics.angular_frequency
        restoring = omega**2 * (1.0 + self.stiffness_fluctuation(output_angle)) * np.asarray(displacement)
        damping = 2.0 * dynamics.damping_ratio * omega * np.asarray(velocity)
        return np.asarray(self.torque_at(output_angle) / dynamics.inertia - damping - restoring)

    def static_deflection(self, output_angle: npt.ArrayLike) -> FloatArray:
        """Wind-up M/K [rad] of the output at rest at the output angle q [rad], any shape."""
        return self.torque_at(output_angle) / self.stiffness(output_angle)
