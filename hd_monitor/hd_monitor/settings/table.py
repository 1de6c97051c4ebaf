"""The table of parameters: name, default, unit, range and description of everything that can be set."""

from ..parameter import Parameter
from ..reducer import Mount
from ..sources import INPUT_SOURCES, LOAD_SOURCES

AXES = ("x", "y", "z", "-x", "-y", "-z")

PARAMETERS: tuple[Parameter, ...] = (
    Parameter(
        name="reducer.flexspline_teeth", default=160, low=1, high=10_000, description="teeth of the flexspline, z1"
    ),
    Parameter(
        name="reducer.circular_spline_teeth",
        default=162,
        low=1,
        high=10_000,
        description="teeth of the circular spline, z2 (usually z1 + 2)",
    ),
    Parameter(
        name="reducer.mount",
        default="circular_spline_fixed",
        choices=tuple(m.value for m in Mount),
        description="the spline that stands still",
    ),
    Parameter(name="reducer.serial", default="", description="serial number of the reducer, shown as hardware_id"),
    Parameter(
        name="dynamics.natural_frequency",
        default=55.0,
        unit="Hz",
        low=0.5,
        high=2000.0,
        description="torsional natural frequency of the joint with its load",
    ),
    Parameter(
        name="dynamics.damping_ratio", default=0.023, low=1e-4, high=0.7, description="fraction of critical damping"
    ),
    Parameter(
        name="dynamics.inertia",
        default=0.29,
        unit="kg·m²",
        low=1e-6,
        high=1e6,
        description="inertia that the reducer drives, seen at its output",
    ),
    Parameter(
        name="dynamics.refine",
        default=True,
        description="refine natural frequency and damping on line where the speed varies enough to tell them",
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
    Parameter(
        name="input.sensor_radius",
        default=0.55,
        unit="m",
        low=0.0,
        high=100.0,
        description="distance of the accelerometer from the joint's axis, also used to show the RMS in m/s²; "
        "with accel_stamped and 0 < radius the angular value is still what is analysed",
    ),
    Parameter(
        name="input.joint_name",
        default="",
        description="the joint's name in joint_states; empty: the name in `joints`, or the only joint there is",
    ),
    Parameter(
        name="input.timeout",
        default=2.0,
        unit="s",
        low=0.05,
        high=3600.0,
        description="silence after which an input counts as lost",
    ),
    Parameter(
        name="input.queue_seconds",
        default=5.0,
        unit="s",
        low=0.1,
        high=60.0,
        description="depth of the subscription queues, in seconds of the expected rate; Fast DDS keeps 5000 messages",
    ),
    Parameter(
        name="input.expected_rate",
        default=1000.0,
        unit="Hz",
        low=1.0,
        high=100_000.0,
        description="expected rate of the messages of the fastest input, for the depth of the queues",
    ),
    Parameter(
        name="input.reliability",
        default="reliable",
        choices=("reliable", "best_effort"),
        description="QoS of the subscriptions; best_effort hears every publisher, reliable loses nothing but hears "
        "reliable publishers only",
    ),
    Parameter(
        name="input.clipping_limit",
        default=0.0,
        unit="rad/s²",
        low=0.0,
        high=1e9,
        description="full scale of the sensor, above which samples count as clipped; 0: recognise flat tops",
    ),
    Parameter(
        name="load.source",
        default="auto",
        choices=tuple(LOAD_SOURCES),
        description="where the transmitted torque comes from; auto: effort if joint_states has it, else load.torque; "
        "wrench: a force-torque sensor",
    ),
    Parameter(
        name="load.torque",
        default=10.0,
        unit="N·m",
        low=-1e6,
        high=1e6,
        description="mean torque on the output where no effort is measured; 0: unknown, indexes are then relative",
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
    Parameter(
        name="analysis.harmonics", default=3, low=1, high=8, description="line pairs identified, k = 1 … harmonics"
    ),
    Parameter(
        name="analysis.period",
        default=1.0,
        unit="s",
        low=0.1,
        high=60.0,
        description="time between two verdicts, by message stamps",
    ),
    Parameter(
        name="analysis.memory",
        default=120.0,
        unit="s",
        low=1.0,
        high=86_400.0,
        description="time of motion over which the evidence fades",
    ),
    Parameter(
        name="analysis.max_gap",
        default=0.05,
        unit="s",
        low=0.0,
        high=10.0,
        description="longest hole in the vibration signal that is bridged by leaving samples out; a longer one cuts",
    ),
    Parameter(
        name="analysis.minimum_speed",
        default=30.0,
        unit="rpm",
        low=0.0,
        high=100_000.0,
        description="wave-generator speed below which the joint counts as standing",
    ),
    Parameter(
        name="analysis.rms_bin_width",
        default=100.0,
        unit="rpm",
        low=1.0,
        high=10_000.0,
        description="width of the speed bins of the RMS curve",
    ),
    Parameter(
        name="diagnosis.warn_index",
        default=0.05,
        low=0.0,
        high=1.0,
        description="stiffness index (fraction) above which a spline is suspect",
    ),
    Parameter(
        name="diagnosis.error_index",
        default=0.08,
        low=0.0,
        high=2.0,
        description="stiffness index (fraction) above which a spline is defective",
    ),
    Parameter(
        name="diagnosis.both_ratio",
        default=0.87,
        low=0.0,
        high=1.0,
        description="both splines are named where the smaller index is above the limit and at least this part of the "
        "larger",
    ),
    Parameter(
        name="diagnosis.confidence",
        default=0.99,
        low=0.5,
        high=0.999999,
        description="probability that a named part must have on the evidence; below it the verdict is undetermined",
    ),
    Parameter(
        name="diagnosis.hysteresis",
        default=0.1,
        low=0.0,
        high=0.9,
        description="part of a limit by which an index must fall below it before the status improves",
    ),
    Parameter(
        name="diagnosis.confirm_count",
        default=2,
        low=1,
        high=100,
        description="verdicts (N) that must agree before the status changes",
    ),
    Parameter(
        name="diagnosis.confirm_window",
        default=3,
        low=1,
        high=100,
        description="number of last verdicts (M) looked at for that",
    ),
    Parameter(name="diagnosis.latch", default=False, description="keep the worst status until the latch is reset"),
)

NODE_PARAMETERS: tuple[Parameter, ...] = (
    Parameter(name="autostart", default=True, description="come up configured and active, without a lifecycle manager"),
)
"""Parameters of the node as a whole, besides `joints`: they say nothing about any joint."""

ROS_PARAMETERS = ("use_sim_time", "start_type_description_service")
"""Parameters that every ROS node has of its own."""
