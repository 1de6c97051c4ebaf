"""A rig's settings: its parameters, checked, for the node, the bag writer and the tests alike."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Self

from hd_monitor.errors import ParameterError, did_you_mean
from hd_monitor.model import Dynamics, ParametricModel, StiffnessSeries, Torque
from hd_monitor.parameter import Parameter, check_all, fill_group, flatten
from hd_monitor.reducer import Reducer
from hd_monitor.settings import NODE_PARAMETERS, ROS_PARAMETERS
from hd_monitor.settings import PARAMETERS as MONITOR_PARAMETERS

from .drive.catalogue import PAPER, preset
from .drive.defects import CUSTOM, stiffness_of
from .drive.effects import Effects, grown
from .drive.elasticity import Elasticity, Hysteresis
from .drive.friction import Friction
from .drive.slow_change import DefectGrowth, Drift
from .drive.surroundings import ChangingInertia, MotorRipple, Surroundings
from .drive.transmission_error import ErrorSeries, TransmissionErrors
from .messages.transport import TransportSettings
from .motion.programme import Ripple, SpeedProgramme
from .motion.programmes import build_programme
from .parameters import PARAMETERS, GeneralSettings, SamplingSettings
from .sensing.accelerometer import SensorSettings
from .sensing.clock import ClockSettings
from .sensing.effort import EffortSettings
from .sensing.fault import FaultSettings
from .sensing.filter import FilterSettings
from .sensing.imu import ImuSettings
from .sensing.joint import JointSettings


@dataclass(frozen=True, slots=True)
class RigSettings:
    """All settings of a simulated rig, checked against the table and against each other.

    Examples
    --------
    >>> settings = RigSettings.from_mapping({"programme": "fixed", "fixed.speed": 400.0, "defect": "both"})
    >>> settings.programme.speeds.tolist(), round(settings.model.flexspline.index, 3)
    ([400.0, 400.0], 0.103)
    """

    values: Mapping[str, Any]

    @classmethod
    def from_mapping(cls, given: Mapping[str, Any] | None = None) -> Self:
        """Check dotted or nested parameters and fill in the drive's preset, then the defaults.

        Raises
        ------
        ParameterError, GeometryError
            If a name is unknown or a value is wrong, alone or beside the others.
        """
        own = flatten(given or {})
        settings = cls(check_all(PARAMETERS, {**preset(own.get("drive")), **own}, owner="the rig"))
        for part in ("model", "programme", "surroundings", "effects"):  # contradictions show here, not at a sample
            getattr(settings, part)
        settings.clock.check(settings.sampling.rate)
        return settings

    @property
    def general(self) -> GeneralSettings:
        """The parameters without a group."""
        return fill_group(self.values, "", GeneralSettings)

    @property
    def sampling(self) -> SamplingSettings:
        """How the accelerometer is sampled."""
        return fill_group(self.values, "sensor", SamplingSettings)

    @property
    def remarks(self) -> list[str]:
        """Sentences about settings that the user may not have intended."""
        remarks, drive, defect = [], self.general.drive, self.general.defect
        if drive != PAPER:
            given = fill_group(self.values, "dynamics", Dynamics)
            remarks.append(
                f"drive = {drive!r} has a natural frequency of {given.natural_frequency:g} Hz and an inertia of "
                f"{given.inertia:g} kg·m²; give the monitor the same dynamics, and reducer.transmission_error: 1.0"
            )
        if defect != CUSTOM and any((*self.values["flexspline.beta"], *self.values["circular_spline.beta"])):
            remarks.append(
                f"defect = {defect!r} ignores the flexspline.beta and circular_spline.beta given; set defect to "
                "'custom' to use them"
            )
        return remarks

    @property
    def reducer(self) -> Reducer:
        """The reducer's geometry."""
        return fill_group(self.values, "reducer", Reducer)

    @property
    def model(self) -> ParametricModel:
        """The reducer with its defects, the inertia and the torques."""
        flexspline, circular_spline = stiffness_of(
            self.general.defect, self._custom("flexspline"), self._custom("circular_spline")
        )
        return ParametricModel(
            reducer=self.reducer,
            dynamics=fill_group(self.values, "dynamics", Dynamics),
            flexspline=flexspline,
            circular_spline=circular_spline,
            torque=fill_group(self.values, "torque", Torque),
        )

    @property
    def largest_model(self) -> ParametricModel:
        """The model with its defects as large as they grow."""
        return grown(self.model, self.effects.growth)

    def _custom(self, spline: str) -> StiffnessSeries:
        beta, phase = self.values[f"{spline}.beta"], self.values[f"{spline}.phase"]
        return StiffnessSeries(beta, phase + (0.0,) * (len(beta) - len(phase)))

    @property
    def programme(self) -> SpeedProgramme:
        """The speed programme."""
        general, ripple = self.general, Ripple(self.values["speed_ripple.amplitude"], self.values["speed_ripple.order"])
        return build_programme(
            general.programme, self.values, self.reducer, cycles=general.cycles, ripple=ripple, seed=general.seed
        )

    @property
    def surroundings(self) -> Surroundings:
        """What acts besides the model's own torques."""
        return Surroundings(
            gravity=self.values["torque.gravity"],
            gravity_angle=math.radians(self.values["torque.gravity_angle"]),
            payload=self.values["torque.payload"],
            rigid_body=self.general.rigid_body,
            ripple=fill_group(self.values, "torque", MotorRipple),
            inertia=fill_group(self.values, "inertia", ChangingInertia),
        )

    @property
    def effects(self) -> Effects:
        """What the drive does beyond the parametric model."""
        errors = {
            part: ErrorSeries(
                self.values[f"{part}.transmission_error"], self.values[f"{part}.transmission_error_phase"]
            )
            for part in ("flexspline", "circular_spline", "wave_generator")
        }
        return Effects(
            errors=TransmissionErrors(**errors),
            elasticity=fill_group(self.values, "elasticity", Elasticity),
            hysteresis=fill_group(self.values, "hysteresis", Hysteresis),
            friction=fill_group(self.values, "friction", Friction),
            drift=fill_group(self.values, "drift", Drift),
            growth=fill_group(self.values, "growth", DefectGrowth),
        )

    @property
    def start_angle(self) -> float:
        """Output angle at the start [rad]."""
        return math.radians(self.general.start_angle)

    @property
    def duration(self) -> float:
        """Simulated time [s] after which the rig ends; infinite if never."""
        return min(self.general.duration or math.inf, self.programme.duration)

    @property
    def sensor(self) -> SensorSettings:
        """What the accelerometer does to the signal."""
        return fill_group(self.values, "sensor", SensorSettings)

    @property
    def filter(self) -> FilterSettings:
        """The accelerometer's low-pass filter."""
        return fill_group(self.values, "sensor", FilterSettings)

    @property
    def imu(self) -> ImuSettings:
        """How the IMU sits on the link."""
        return fill_group(self.values, "sensor", ImuSettings)

    @property
    def fault(self) -> FaultSettings:
        """How the accelerometer fails."""
        return fill_group(self.values, "sensor", FaultSettings)

    @property
    def clock(self) -> ClockSettings:
        """The accelerometer's clock."""
        return fill_group(self.values, "sensor", ClockSettings)

    @property
    def joint(self) -> JointSettings:
        """The joint's encoder and driver."""
        return fill_group(self.values, "joint_states", JointSettings)

    @property
    def effort(self) -> EffortSettings:
        """The effort that the joint's driver reports."""
        return fill_group(self.values, "joint_states", EffortSettings)

    @property
    def transport(self) -> TransportSettings:
        """What happens to the vibration messages in transit."""
        return fill_group(self.values, "transport", TransportSettings)


def pick(given: Mapping[str, Any], also: Sequence[Parameter] = ()) -> dict[str, Any]:
    """Pick the rig's parameters from a file that it may share with the monitor.

    Parameters
    ----------
    given : mapping
        Nested or dotted.
    also : sequence of Parameter
        More parameters that belong to the caller, and are left out.

    Raises
    ------
    ParameterError
        If a name is unknown to the rig, the monitor and the caller: a misspelt one would have no effect.
    """
    flat = flatten(given)
    own = {parameter.name for parameter in PARAMETERS}
    foreign = {p.name for p in (*also, *MONITOR_PARAMETERS, *NODE_PARAMETERS)} | {"joints", *ROS_PARAMETERS}
    joints = flat.get("joints") or ()
    for name in flat:
        if name not in own | foreign and not name.startswith(tuple(f"{joint}." for joint in joints)):
            hint = did_you_mean(name, own) or "; see msgs_doc/parameters.md for their list"
            raise ParameterError(f"{name} is not a parameter of the rig{hint}")
    return {name: value for name, value in flat.items() if name in own}
