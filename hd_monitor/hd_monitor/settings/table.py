"""The table of parameters: name, default, unit, range and description of everything that can be set."""

from ..parameter import Parameter, number
from ..reducer import Mount
from ..sources import INPUT_SOURCES, LOAD_SOURCES

AXES = ("x", "y", "z", "-x", "-y", "-z")

PARAMETERS: tuple[Parameter, ...] = (
    number("reducer.flexspline_teeth", 160, "", 1, 10_000, "teeth of the flexspline, z1"),
    number("reducer.circular_spline_teeth", 162, "", 1, 10_000, "teeth of the circular spline, z2 (usually z1 + 2)"),
    Parameter(
        name="reducer.mount",
        default="circular_spline_fixed",
        choices=tuple(m.value for m in Mount),
        description="the spline that stands still",
    ),
    Parameter(name="reducer.serial", default="", description="serial number of the reducer, shown as hardware_id"),
    number(
        "dynamics.natural_frequency", 55.0, "Hz", 0.5, 2000.0, "torsional natural frequency of the joint with its load"
    ),
    number("dynamics.damping_ratio", 0.023, "", 1e-4, 0.7, "fraction of critical damping"),
    number("dynamics.inertia", 0.29, "kg·m²", 1e-6, 1e6, "inertia that the reducer drives, seen at its output"),
    Parameter(
        name="dynamics.refine",
        default=True,
        description="refine natural frequency and damping on line where the speed varies enough to determine them",
    ),
    Parameter(
        name="input.source",
        default="block",
        choices=tuple(INPUT_SOURCES),
        description="the vibration signal; joint_effort and joint_velocity need no sensor but joint_states",
    ),
    Parameter(
        name="input.axis",
        default="y",
        choices=AXES,
        description="axis of an IMU's linear acceleration that points along the motion (tangential)",
    ),
    number(
        "input.sensor_radius",
        0.55,
        "m",
        0.0,
        100.0,
        "distance of the accelerometer from the joint's axis, also used to show the RMS in m/s²; "
        "with accel_stamped and 0 < radius the angular value is still what is analysed",
    ),
    Parameter(
        name="input.joint_name",
        default="",
        description="the joint's name in joint_states; empty: the name in `joints`, or the only joint there is",
    ),
    number("input.timeout", 2.0, "s", 0.05, 3600.0, "silence after which an input counts as lost"),
    number(
        "input.queue_seconds",
        5.0,
        "s",
        0.1,
        60.0,
        "depth of the subscription queues, in seconds of the expected rate; Fast DDS keeps 5000 messages",
    ),
    number(
        "input.expected_rate",
        1000.0,
        "Hz",
        1.0,
        100_000.0,
        "expected rate of the messages of the fastest input, for the depth of the queues",
    ),
    Parameter(
        name="input.reliability",
        default="reliable",
        choices=("reliable", "best_effort"),
        description="QoS of the subscriptions; best_effort hears every publisher, reliable loses nothing but hears "
        "reliable publishers only",
    ),
    number(
        "input.clipping_limit",
        0.0,
        "rad/s²",
        0.0,
        1e9,
        "full scale of the sensor, above which samples count as clipped; 0: recognise flat tops",
    ),
    Parameter(
        name="load.source",
        default="auto",
        choices=tuple(LOAD_SOURCES),
        description="where the transmitted torque comes from; auto: effort if joint_states has it, else load.torque; "
        "wrench: a force-torque sensor",
    ),
    number(
        "load.torque",
        10.0,
        "N·m",
        -1e6,
        1e6,
        "mean torque on the output where no effort is measured; 0: unknown, indexes are then relative",
    ),
    Parameter(
        name="load.topic",
        default="",
        description="topic of the torque's sensor with load.source: wrench; empty: wrench, below the joint's name with "
        "several joints",
    ),
    Parameter(
        name="load.axis",
        default="z",
        choices=AXES,
        description="axis of the wrench that points along the joint's axis, with the sign that an effort would have",
    ),
    number("analysis.harmonics", 3, "", 1, 8, "line pairs identified, k = 1 … harmonics"),
    number("analysis.period", 1.0, "s", 0.1, 60.0, "time between two verdicts, by message stamps"),
    number("analysis.memory", 120.0, "s", 1.0, 86_400.0, "time of motion over which the evidence fades"),
    number(
        "analysis.max_gap",
        0.05,
        "s",
        0.0,
        10.0,
        "longest hole in the vibration signal that is bridged by leaving samples out; a longer one cuts",
    ),
    number(
        "analysis.minimum_speed",
        30.0,
        "rpm",
        0.0,
        100_000.0,
        "wave-generator speed below which the joint counts as standing",
    ),
    number("analysis.rms_bin_width", 100.0, "rpm", 1.0, 10_000.0, "width of the speed bins of the RMS curve"),
    number("diagnosis.warn_index", 0.05, "", 0.0, 1.0, "stiffness index (fraction) above which a spline is suspect"),
    number("diagnosis.error_index", 0.08, "", 0.0, 2.0, "stiffness index (fraction) above which a spline is defective"),
    number(
        "diagnosis.both_ratio",
        0.87,
        "",
        0.0,
        1.0,
        "both splines are named where the smaller index is above the limit and at least this part of the larger",
    ),
    number(
        "diagnosis.confidence",
        0.99,
        "",
        0.5,
        0.999999,
        "probability that a named part must have on the evidence; below it the verdict is undetermined",
    ),
    number(
        "diagnosis.hysteresis",
        0.1,
        "",
        0.0,
        0.9,
        "part of a limit by which an index must fall below it before the status improves",
    ),
    number("diagnosis.confirm_count", 2, "", 1, 100, "verdicts (N) that must agree before the status changes"),
    number("diagnosis.confirm_window", 3, "", 1, 100, "number of last verdicts (M) looked at for that"),
    Parameter(name="diagnosis.latch", default=False, description="keep the worst status until the latch is reset"),
)

NODE_PARAMETERS: tuple[Parameter, ...] = (
    Parameter(name="autostart", default=True, description="come up configured and active, without a lifecycle manager"),
)
"""Parameters of the node as a whole, besides `joints`: they say nothing about any joint."""

ROS_PARAMETERS = ("use_sim_time", "start_type_description_service")
"""Parameters that every ROS node has of its own."""
