"""The tables of parameters: the rig's, and those of the node that publishes it."""

from dataclasses import dataclass

from hd_monitor.model import Dynamics
from hd_monitor.parameter import Parameter, choice, number, parameters_of, plain, table
from hd_monitor.reducer import Reducer
from hd_monitor.settings import NODE_PARAMETERS as MONITOR_NODE_PARAMETERS
from hd_monitor.settings import PARAMETERS as MONITOR_PARAMETERS

from .drive.catalogue import DRIVES, PAPER
from .drive.defects import CUSTOM, DEFECTS
from .drive.elasticity import Elasticity, Hysteresis
from .drive.friction import Friction
from .drive.slow_change import DefectGrowth, Drift
from .drive.stability import POLICIES as UNSTABLE_POLICIES
from .drive.surroundings import ChangingInertia, MotorRipple
from .messages.transport import TransportSettings
from .motion.programmes import PROGRAMMES
from .sensing.accelerometer import SensorSettings
from .sensing.clock import ClockSettings
from .sensing.effort import EffortSettings
from .sensing.fault import FaultSettings
from .sensing.filter import FilterSettings
from .sensing.imu import ImuSettings
from .sensing.joint import JointSettings

PUBLISHED = ("block", "samples", "both", "none")


def _beta(spline: str) -> tuple[Parameter, ...]:
    name = spline.replace("_", " ")
    indexes = f"stiffness indexes βk of the {name} (fractions), k = 1, 2, …, with defect: custom"
    return table(
        f"{spline}.",
        beta=number((0.0,), "", -1.0, 1.0, indexes),
        phase=number((0.0,), "rad", -1e3, 1e3, f"phases of the {name}'s βk; those left out are 0"),
    )


def _error(part: str, lines: str) -> tuple[Parameter, ...]:
    name = part.replace("_", " ")
    return table(
        f"{part}.",
        transmission_error=number(
            (0.0,), "arcmin", 0.0, 1e3, f"transmission error of the {name}, peak to peak, of {lines} k = 1, 2, …"
        ),
        transmission_error_phase=number(
            (0.0,), "rad", -1e3, 1e3, f"phases of the {name}'s transmission error; those left out are 0"
        ),
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class GeneralSettings:
    """The parameters without a group."""

    programme: str = choice("dwell", PROGRAMMES, "; ".join(f"{name}: {p.summary}" for name, p in PROGRAMMES.items()))
    cycles: int = number(0, "", 0, 1_000_000, "runs of the programme; 0: without end")
    duration: float = number(0.0, "s", 0.0, 1e7, "simulated time after which it ends; 0: as long as the programme")
    start_angle: float = number(0.0, "deg", -1e6, 1e6, "output angle at the start")
    drive: str = choice(
        PAPER,
        DRIVES,
        "preset of the parameters that are not given; paper: every default; catalogue: a new unit of size 20 and ratio "
        "80; worn: the same at the end of its life",
    )
    defect: str = choice("flexspline", (*DEFECTS, CUSTOM), "the bad spline; custom: the β given for both splines")
    rigid_body: bool = plain(
        False, "count the output's own acceleration: it winds up the reducer and the sensor feels it"
    )
    publish: str = choice("block", PUBLISHED, "form of the vibration; samples are one message each and cost CPU")
    publish_imu: bool = plain(False, "also publish imu/data_raw, one message a sample")
    block_size: int = number(50, "", 1, 100_000, "samples in a block")
    seed: int = number(0, "", 0, 2**31 - 1, "of all random numbers")
    unstable: str = choice(
        "refuse", UNSTABLE_POLICIES, "what to do if vibration grows without bound at a speed of the programme"
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class SamplingSettings:
    """Those parameters ``sensor.*`` that say how often the accelerometer is sampled, and name it."""

    rate: float = number(1000.0, "Hz", 1.0, 100_000.0, "sampling rate of the accelerometer, by the host's clock")
    frame_id: str = plain("hd_rig_sensor", "frame_id of the accelerometer's messages")


PARAMETERS = (
    *parameters_of(GeneralSettings),
    *table(
        "speed_ripple.",
        amplitude=number(0.0, "", 0.0, 0.99, "speed ripple, fraction of the speed"),
        order=number(2.0, "", 0.0, 100.0, "cycles of the speed ripple per wave-generator revolution"),
    ),
    *(parameter for kind in PROGRAMMES.values() for parameter in kind.parameters),
    # The reducer and its dynamics are the monitor's own parameters, so that one file serves both nodes.
    *(p for p in MONITOR_PARAMETERS if p.name.removeprefix("reducer.") in Reducer.__dataclass_fields__),
    *(p for p in MONITOR_PARAMETERS if p.name.removeprefix("dynamics.") in Dynamics.__dataclass_fields__),
    *_beta("flexspline"),
    *_error("flexspline", "its lines"),
    *_beta("circular_spline"),
    *_error("circular_spline", "its lines"),
    *_error("wave_generator", "the harmonics of its revolution"),
    *parameters_of(Elasticity, "elasticity."),
    *parameters_of(Hysteresis, "hysteresis."),
    *parameters_of(Friction, "friction."),
    *parameters_of(Drift, "drift."),
    *parameters_of(DefectGrowth, "growth."),
    *table(
        "torque.",
        mean=number(10.0, "N·m", -1e6, 1e6, "mean torque on the output, M0"),
        drive_fluctuation=number(0.0, "N·m", 0.0, 1e6, "amplitude of the drive's ripple, twice per revolution"),
        drive_phase=number(0.0, "rad", -1e3, 1e3, "phase of the drive's ripple"),
        load_fluctuation=number(0.0, "N·m", 0.0, 1e6, "amplitude of the load's fluctuation"),
        load_phase=number(0.0, "rad", -1e3, 1e3, "phase of the load's fluctuation"),
        load_order=number(2, "", 1, 100, "load cycles per output revolution; 2: each line in the other's place"),
        gravity=number(0.0, "N·m", 0.0, 1e6, "amplitude of an eccentric load's torque, 1 per output revolution"),
        gravity_angle=number(0.0, "deg", -1e6, 1e6, "output angle at which gravity's torque is largest"),
        payload=number(0.0, "N·m", 0.0, 1e6, "added to torque.gravity while the payload is carried"),
    ),
    *parameters_of(MotorRipple, "torque."),
    *parameters_of(ChangingInertia, "inertia."),
    *(
        parameter
        for group in (SamplingSettings, FilterSettings, ImuSettings, SensorSettings, FaultSettings, ClockSettings)
        for parameter in parameters_of(group, "sensor.")
    ),
    *parameters_of(TransportSettings, "transport."),
    *parameters_of(JointSettings, "joint_states."),
    *parameters_of(EffortSettings, "joint_states."),
)
"""Parameters of the rig: what is simulated."""


CHANGEABLE = (
    *("defect", "flexspline.", "circular_spline.", "wave_generator.", "elasticity.", "hysteresis.", "friction."),
    *("drift.", "growth.", "dynamics.", "torque.", "inertia.", "rigid_body", "transport."),
    *("sensor.gain", "sensor.noise", "sensor.offset", "sensor.spike", "sensor.full_scale", "sensor.resolution"),
    *("sensor.fault", "sensor.clock_offset", "sensor.jitter", "joint_states.effort", "joint_states.velocity"),
    *("joint_states.resolution", "joint_states.wrapped", "joint_states.jitter", "joint_states.delay"),
    "unstable",
)
"""Parameters that begin so may be changed while the rig runs; all others decide how it is set up."""

NODE_PARAMETERS = (
    *MONITOR_NODE_PARAMETERS,
    *table(
        time_scale=number(
            1.0, "", 0.001, 10_000.0, "simulated seconds in a second of real time; stamps keep this pace"
        ),
        wait_for_subscribers=number(0, "", 0, 100, "start when every topic has this many subscribers; 0: at once"),
        exit_at_end=plain(False, "end the process when the programme has ended"),
        queue_seconds=number(4.0, "s", 0.1, 60.0, "real time that the queues hold; Fast DDS keeps 5000 messages"),
    ),
)
"""Parameters of the node beside the rig's: how the simulation is published."""

ALL_PARAMETERS = (*NODE_PARAMETERS, *PARAMETERS)
"""What ``hd-monitor parameters`` lists."""
