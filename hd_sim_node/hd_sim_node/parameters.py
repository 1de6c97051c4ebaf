"""The tables of parameters: the rig's, and those of the node that publishes it."""

from hd_monitor.parameter import Parameter
from hd_monitor.settings import NODE_PARAMETERS as MONITOR_NODE_PARAMETERS
from hd_monitor.settings import PARAMETERS as MONITOR_PARAMETERS

from .defects import CUSTOM, DEFECTS
from .encoder import EFFORTS, SIDES
from .programmes import PROGRAMMES

PUBLISHED = ("block", "samples", "both", "none")
IMU_AXES = ("x", "y", "z", "-x", "-y", "-z")


def _number(name: str, default: float, unit: str, low: float, high: float, description: str) -> Parameter:
    return Parameter(name=name, default=default, unit=unit, low=low, high=high, description=description)


def _fraction(name: str, description: str) -> Parameter:
    return _number(name, 0.0, "", 0.0, 1.0, description)


def _beta(spline: str) -> tuple[Parameter, Parameter]:
    name = spline.replace("_", " ")
    return (
        Parameter(
            name=f"{spline}.beta",
            default=(0.0,),
            low=-1.0,
            high=1.0,
            description=f"stiffness indexes βk of the {name} (fractions), k = 1, 2, …, with defect: custom",
        ),
        Parameter(
            name=f"{spline}.phase",
            default=(0.0,),
            unit="rad",
            low=-1e3,
            high=1e3,
            description=f"phases of the {name}'s βk; those left out are 0",
        ),
    )


PARAMETERS: tuple[Parameter, ...] = (
    Parameter(
        name="programme",
        default="dwell",
        choices=tuple(PROGRAMMES),
        description="; ".join(f"{name}: {kind.summary}" for name, kind in PROGRAMMES.items()),
    ),
    Parameter(name="cycles", default=0, low=0, high=1_000_000, description="runs of the programme; 0: without end"),
    _number("duration", 0.0, "s", 0.0, 1e7, "simulated time after which it ends; 0: as long as the programme"),
    _number("start_angle", 0.0, "deg", -1e6, 1e6, "output angle at the start"),
    _number("speed_ripple.amplitude", 0.0, "", 0.0, 0.99, "speed ripple, fraction of the speed"),
    _number("speed_ripple.order", 2.0, "", 0.0, 100.0, "cycles of the speed ripple per wave-generator revolution"),
    *(parameter for kind in PROGRAMMES.values() for parameter in kind.parameters),
    # The reducer and its dynamics are the monitor's own parameters, so that one file serves both nodes.
    *(p for p in MONITOR_PARAMETERS if p.name.startswith("reducer.") and p.name != "reducer.serial"),
    *(p for p in MONITOR_PARAMETERS if p.name.startswith("dynamics.") and p.name != "dynamics.refine"),
    Parameter(
        name="defect",
        default="flexspline",
        choices=(*DEFECTS, CUSTOM),
        description="the bad spline; custom: flexspline.beta and circular_spline.beta count",
    ),
    *_beta("flexspline"),
    *_beta("circular_spline"),
    _number("torque.mean", 10.0, "N·m", -1e6, 1e6, "mean torque on the output, M0"),
    _number("torque.drive_fluctuation", 0.0, "N·m", 0.0, 1e6, "amplitude of the drive's ripple, twice per revolution"),
    _number("torque.drive_phase", 0.0, "rad", -1e3, 1e3, "phase of the drive's ripple"),
    _number("torque.load_fluctuation", 0.0, "N·m", 0.0, 1e6, "amplitude of the load's fluctuation"),
    _number("torque.load_phase", 0.0, "rad", -1e3, 1e3, "phase of the load's fluctuation"),
    Parameter(
        name="torque.load_order",
        default=2,
        low=1,
        high=100,
        description="cycles of the load's fluctuation per output revolution; 2 puts each line into the other's place",
    ),
    _number("torque.gravity", 0.0, "N·m", 0.0, 1e6, "amplitude of an eccentric load's torque, 1 per output revolution"),
    _number("torque.gravity_angle", 0.0, "deg", -1e6, 1e6, "output angle at which gravity's torque is largest"),
    Parameter(
        name="rigid_body",
        default=False,
        description="count the output's own acceleration: it winds up the reducer and the accelerometer feels it",
    ),
    _number("sensor.rate", 1000.0, "Hz", 1.0, 100_000.0, "sampling rate of the accelerometer"),
    _number("sensor.radius", 0.55, "m", 0.0, 100.0, "distance of the accelerometer from the joint's axis"),
    _number("sensor.noise", 0.1, "rad/s²", 0.0, 1e9, "standard deviation of white noise"),
    _number("sensor.offset", 0.0, "rad/s²", -1e9, 1e9, "constant added to the signal"),
    _number("sensor.spike_rate", 0.0, "1/s", 0.0, 1e5, "spikes per second"),
    _number("sensor.spike_size", 100.0, "rad/s²", 0.0, 1e9, "standard deviation of the spikes"),
    _number("sensor.full_scale", 0.0, "rad/s²", 0.0, 1e9, "value at which the sensor clips; 0: none"),
    _number("sensor.resolution", 0.0, "rad/s²", 0.0, 1e9, "step of the sensor's values; 0: continuous"),
    _number("sensor.stuck_after", 0.0, "s", 0.0, 1e7, "time after which the sensor repeats its last value; 0: never"),
    _number("sensor.jitter", 0.0, "s", 0.0, 10.0, "standard deviation of the stamps"),
    _number("sensor.delay", 0.0, "s", -10.0, 10.0, "what the stamps are late by"),
    Parameter(
        name="sensor.imu_axis",
        default="y",
        choices=IMU_AXES,
        description="axis of the IMU that points along the motion (tangential)",
    ),
    Parameter(name="sensor.frame_id", default="hd_rig_sensor", description="frame_id of the accelerometer's messages"),
    _fraction("transport.loss", "vibration messages lost, as a fraction"),
    _fraction("transport.duplicates", "vibration messages that come twice, as a fraction"),
    _fraction("transport.late", "vibration messages that come behind up to three later ones, as a fraction"),
    Parameter(name="joint_states.name", default="joint", description="the joint's name in joint_states"),
    _number("joint_states.rate", 100.0, "Hz", 0.1, 10_000.0, "joint states per second"),
    Parameter(
        name="joint_states.side",
        default="motor",
        choices=SIDES,
        description="where the encoder sits; output: behind the reducer, where it sees the torsional vibration",
    ),
    Parameter(name="joint_states.reversed", default=False, description="count against the wave generator's sense"),
    _number("joint_states.resolution", 0.0, "rad", 0.0, 10.0, "step of the position; 0: continuous"),
    Parameter(name="joint_states.velocity", default=True, description="report velocities"),
    _number("joint_states.velocity_noise", 0.0, "rad/s", 0.0, 1e6, "standard deviation of the velocity's noise"),
    Parameter(
        name="joint_states.effort",
        default="transmitted",
        choices=EFFORTS,
        description="transmitted: the output's torque without the drive's ripple; mean: torque.mean; reaction: what "
        "the reducer transmits, vibration included; none: no effort",
    ),
    _number("joint_states.effort_noise", 0.0, "N·m", 0.0, 1e6, "standard deviation of the effort's noise"),
    _number("joint_states.jitter", 0.0, "s", 0.0, 10.0, "standard deviation of the stamps"),
    _fraction("joint_states.loss", "joint states lost, as a fraction"),
    Parameter(
        name="publish",
        default="block",
        choices=PUBLISHED,
        description="form of the torsional acceleration; samples are one message each and cost CPU",
    ),
    Parameter(name="publish_imu", default=False, description="also publish imu/data_raw, one message a sample"),
    Parameter(name="block_size", default=50, low=1, high=100_000, description="samples in a block"),
    Parameter(name="seed", default=0, low=0, high=2**31 - 1, description="of all random numbers"),
    Parameter(
        name="unstable",
        default="refuse",
        choices=("refuse", "warn", "ignore"),
        description="what to do where the defects make vibration grow without bound at a speed of the programme",
    ),
)
"""Parameters of the rig: what is simulated."""


CHANGEABLE = (
    *("defect", "flexspline.", "circular_spline.", "dynamics.", "torque.", "rigid_body", "transport.", "unstable"),
    *("sensor.noise", "sensor.offset", "sensor.spike", "sensor.full_scale", "sensor.resolution", "sensor.stuck_after"),
    *("sensor.jitter", "sensor.delay", "joint_states.effort", "joint_states.velocity", "joint_states.resolution"),
)
"""Parameters that begin so may be changed while the rig runs; all others decide how it is set up."""

NODE_PARAMETERS: tuple[Parameter, ...] = (
    *(parameter for parameter in MONITOR_NODE_PARAMETERS if parameter.name == "autostart"),
    Parameter(
        name="time_scale",
        default=1.0,
        low=0.001,
        high=10_000.0,
        description="simulated seconds in a second; stamps start now and advance by simulated time",
    ),
    Parameter(
        name="wait_for_subscribers",
        default=0,
        low=0,
        high=100,
        description="start when joint_states and the vibration's topics each have so many subscribers; 0: at once",
    ),
    Parameter(name="exit_at_end", default=False, description="end the process when the programme has ended"),
    Parameter(
        name="queue_seconds",
        default=4.0,
        unit="s",
        low=0.1,
        high=60.0,
        description="depth of the publishers' queues, in seconds of real time; Fast DDS keeps 5000 messages",
    ),
)
"""Parameters of the node beside the rig's: how the simulation is published."""

ALL_PARAMETERS = (*NODE_PARAMETERS, *PARAMETERS)
"""What ``hd-monitor parameters`` lists."""
