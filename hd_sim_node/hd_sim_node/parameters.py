"""The tables of parameters: the rig's, and those of the node that publishes it."""

from hd_monitor.parameter import Parameter, choice, number, switch
from hd_monitor.settings import NODE_PARAMETERS as MONITOR_NODE_PARAMETERS
from hd_monitor.settings import PARAMETERS as MONITOR_PARAMETERS

from .defects import CUSTOM, DEFECTS
from .encoder import EFFORTS, SIDES
from .programmes import PROGRAMMES

PUBLISHED = ("block", "samples", "both", "none")
UNSTABLE = ("refuse", "warn", "ignore")
IMU_AXES = ("x", "y", "z", "-x", "-y", "-z")


def _fraction(name: str, description: str) -> Parameter:
    return number(name, 0.0, "", 0.0, 1.0, description)


def _beta(spline: str) -> tuple[Parameter, Parameter]:
    name = spline.replace("_", " ")
    indexes = f"stiffness indexes βk of the {name} (fractions), k = 1, 2, …, with defect: custom"
    return (
        number(f"{spline}.beta", (0.0,), "", -1.0, 1.0, indexes),
        number(f"{spline}.phase", (0.0,), "rad", -1e3, 1e3, f"phases of the {name}'s βk; those left out are 0"),
    )


PARAMETERS: tuple[Parameter, ...] = (
    choice("programme", "dwell", PROGRAMMES, "; ".join(f"{name}: {kind.summary}" for name, kind in PROGRAMMES.items())),
    number("cycles", 0, "", 0, 1_000_000, "runs of the programme; 0: without end"),
    number("duration", 0.0, "s", 0.0, 1e7, "simulated time after which it ends; 0: as long as the programme"),
    number("start_angle", 0.0, "deg", -1e6, 1e6, "output angle at the start"),
    number("speed_ripple.amplitude", 0.0, "", 0.0, 0.99, "speed ripple, fraction of the speed"),
    number("speed_ripple.order", 2.0, "", 0.0, 100.0, "cycles of the speed ripple per wave-generator revolution"),
    *(parameter for kind in PROGRAMMES.values() for parameter in kind.parameters),
    # The reducer and its dynamics are the monitor's own parameters, so that one file serves both nodes.
    *(p for p in MONITOR_PARAMETERS if p.name.startswith("reducer.") and p.name != "reducer.serial"),
    *(p for p in MONITOR_PARAMETERS if p.name.startswith("dynamics.") and p.name != "dynamics.refine"),
    choice("defect", "flexspline", (*DEFECTS, CUSTOM), "the bad spline; custom: the β given for both splines"),
    *_beta("flexspline"),
    *_beta("circular_spline"),
    number("torque.mean", 10.0, "N·m", -1e6, 1e6, "mean torque on the output, M0"),
    number("torque.drive_fluctuation", 0.0, "N·m", 0.0, 1e6, "amplitude of the drive's ripple, twice per revolution"),
    number("torque.drive_phase", 0.0, "rad", -1e3, 1e3, "phase of the drive's ripple"),
    number("torque.load_fluctuation", 0.0, "N·m", 0.0, 1e6, "amplitude of the load's fluctuation"),
    number("torque.load_phase", 0.0, "rad", -1e3, 1e3, "phase of the load's fluctuation"),
    number("torque.load_order", 2, "", 1, 100, "load cycles per output revolution; 2: each line in the other's place"),
    number("torque.gravity", 0.0, "N·m", 0.0, 1e6, "amplitude of an eccentric load's torque, 1 per output revolution"),
    number("torque.gravity_angle", 0.0, "deg", -1e6, 1e6, "output angle at which gravity's torque is largest"),
    switch("rigid_body", False, "count the output's own acceleration: it winds up the reducer and the sensor feels it"),
    number("sensor.rate", 1000.0, "Hz", 1.0, 100_000.0, "sampling rate of the accelerometer"),
    number("sensor.radius", 0.55, "m", 0.0, 100.0, "distance of the accelerometer from the joint's axis"),
    number("sensor.noise", 0.1, "rad/s²", 0.0, 1e9, "standard deviation of white noise"),
    number("sensor.offset", 0.0, "rad/s²", -1e9, 1e9, "constant added to the signal"),
    number("sensor.spike_rate", 0.0, "1/s", 0.0, 1e5, "spikes per second"),
    number("sensor.spike_size", 100.0, "rad/s²", 0.0, 1e9, "standard deviation of the spikes"),
    number("sensor.full_scale", 0.0, "rad/s²", 0.0, 1e9, "value at which the sensor clips; 0: none"),
    number("sensor.resolution", 0.0, "rad/s²", 0.0, 1e9, "step of the sensor's values; 0: continuous"),
    number("sensor.stuck_after", 0.0, "s", 0.0, 1e7, "time after which the sensor repeats its last value; 0: never"),
    number("sensor.jitter", 0.0, "s", 0.0, 10.0, "standard deviation of the stamps"),
    number("sensor.delay", 0.0, "s", -10.0, 10.0, "what the stamps are late by"),
    choice("sensor.imu_axis", "y", IMU_AXES, "axis of the IMU that points along the motion (tangential)"),
    Parameter(name="sensor.frame_id", default="hd_rig_sensor", description="frame_id of the accelerometer's messages"),
    _fraction("transport.loss", "vibration messages lost, as a fraction"),
    _fraction("transport.duplicates", "vibration messages that come twice, as a fraction"),
    _fraction("transport.late", "vibration messages that come behind up to three later ones, as a fraction"),
    Parameter(name="joint_states.name", default="joint", description="the joint's name in joint_states"),
    number("joint_states.rate", 100.0, "Hz", 0.1, 10_000.0, "joint states per second"),
    choice("joint_states.side", "motor", SIDES, "where the encoder sits; output: it sees the torsional vibration"),
    switch("joint_states.reversed", False, "count against the wave generator's sense"),
    number("joint_states.resolution", 0.0, "rad", 0.0, 10.0, "step of the position; 0: continuous"),
    switch("joint_states.velocity", True, "report velocities"),
    number("joint_states.velocity_noise", 0.0, "rad/s", 0.0, 1e6, "standard deviation of the velocity's noise"),
    choice(
        "joint_states.effort",
        "transmitted",
        EFFORTS,
        "transmitted: the output's torque without the drive's ripple; mean: torque.mean; reaction: what "
        "the reducer transmits, vibration included; none: no effort",
    ),
    number("joint_states.effort_noise", 0.0, "N·m", 0.0, 1e6, "standard deviation of the effort's noise"),
    number("joint_states.jitter", 0.0, "s", 0.0, 10.0, "standard deviation of the stamps"),
    _fraction("joint_states.loss", "joint states lost, as a fraction"),
    choice("publish", "block", PUBLISHED, "form of the vibration; samples are one message each and cost CPU"),
    switch("publish_imu", False, "also publish imu/data_raw, one message a sample"),
    number("block_size", 50, "", 1, 100_000, "samples in a block"),
    number("seed", 0, "", 0, 2**31 - 1, "of all random numbers"),
    choice("unstable", "refuse", UNSTABLE, "what to do if vibration grows without bound at a speed of the programme"),
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
    number("time_scale", 1.0, "", 0.001, 10_000.0, "simulated seconds in a second of real time; stamps keep this pace"),
    number("wait_for_subscribers", 0, "", 0, 100, "start when every topic has this many subscribers; 0: at once"),
    switch("exit_at_end", False, "end the process when the programme has ended"),
    number("queue_seconds", 4.0, "s", 0.1, 60.0, "real time that the queues hold; Fast DDS keeps 5000 messages"),
)
"""Parameters of the node beside the rig's: how the simulation is published."""

ALL_PARAMETERS = (*NODE_PARAMETERS, *PARAMETERS)
"""What ``hd-monitor parameters`` lists."""
