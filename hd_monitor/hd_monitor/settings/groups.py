"""Everything that can be set, by group: a field declares a parameter's default, unit, range and description."""

import re
from dataclasses import dataclass

from ..errors import ParameterError
from ..parameter import choice, number, plain
from ..sources import INPUT_SOURCES, LOAD_SOURCES

AXES = ("x", "y", "z", "-x", "-y", "-z")

_TOPIC = re.compile(r"/?[A-Za-z_][A-Za-z0-9_]*(/[A-Za-z_][A-Za-z0-9_]*)*")


def _check_topic(parameter: str, topic: str) -> None:
    if topic and not _TOPIC.fullmatch(topic):
        raise ParameterError(
            f"{parameter} = {topic!r} is not a topic's name; it has words of letters, digits and underscores with "
            "single slashes between, as in ft_sensor/wrench"
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class InputSettings:
    """The parameters ``input.*``.

    Raises
    ------
    ParameterError
        If a topic is not a name that ROS allows.
    """

    source: str = choice(
        "block", INPUT_SOURCES, "the vibration signal; joint_effort and joint_velocity need joint_states only"
    )
    topic: str = plain(
        "",
        "topic of the vibration; relative ones are below the joint's name with several joints; empty: the name that "
        "belongs to input.source (torsional_acceleration/block, torsional_acceleration or imu/data_raw)",
    )
    axis: str = choice("y", AXES, "axis of an IMU's linear acceleration that points along the motion (tangential)")
    sensor_radius: float = number(
        0.55,
        "m",
        0.0,
        100.0,
        "distance of the accelerometer from the joint's axis, also used to show the RMS in m/s²; with accel_stamped "
        "and 0 < radius the angular value is still what is analysed",
    )
    joint_name: str = plain(
        "", "the joint's name in joint_states; empty: the name in `joints`, or the only joint there is"
    )
    timeout: float = number(
        5.0,
        "s",
        0.05,
        3600.0,
        "silence after which an input that has come counts as lost; a reliable topic may pause for the 3 s after which "
        "Fast DDS repeats a lost datagram",
    )
    startup_warning: float = number(
        10.0, "s", 0.0, 3600.0, "time without the first data of an input after which its status warns"
    )
    startup_timeout: float = number(
        30.0, "s", 0.05, 3600.0, "time without the first data of an input after which it counts as lost"
    )
    queue_seconds: float = number(
        5.0,
        "s",
        0.1,
        60.0,
        "depth of the subscription queues, in seconds of the expected rate; Fast DDS keeps 5000 messages",
    )
    expected_rate: float = number(
        1000.0,
        "Hz",
        1.0,
        100_000.0,
        "expected rate of the messages of the fastest input, for the depth of the queues; single samples stamped more "
        "than twice as densely are used only where they fill half of a period",
    )
    reliability: str = choice(
        "reliable",
        ("reliable", "best_effort"),
        "QoS of the subscriptions; best_effort hears every publisher, reliable loses nothing but hears reliable "
        "publishers only",
    )
    bandwidth: float = number(
        0.0,
        "Hz",
        0.0,
        100_000.0,
        "frequency at which the accelerometer, with its anti-aliasing filter, attenuates by 3 dB; beyond it nothing "
        "counts; 0: unknown, 0.4 of the sampling rate",
    )
    delay_uncertainty: float = number(
        0.02,
        "s",
        0.0,
        0.2,
        "how well the stamps of vibration and joint states agree: the standard deviation of the lag between them",
    )
    clock_drift: float = number(
        100.0,
        "ppm",
        0.0,
        1000.0,
        "standard deviation of the rate at which that lag may change, where the two are stamped by different clocks",
    )
    clipping_limit: float = number(
        0.0,
        "rad/s²",
        0.0,
        1e9,
        "full scale of the sensor, above which samples count as clipped; 0: recognise flat tops",
    )
    temperature_topic: str = plain(
        "",
        "topic of the reducer's temperature (sensor_msgs/Temperature), below the joint's name with several joints; the "
        "ledger keeps it beside the readings; empty: none",
    )

    def __post_init__(self) -> None:
        """Refuse a topic that cannot be subscribed to."""
        _check_topic("input.topic", self.topic)
        _check_topic("input.temperature_topic", self.temperature_topic)


@dataclass(frozen=True, slots=True, kw_only=True)
class LoadSettings:
    """The parameters ``load.*``.

    Raises
    ------
    ParameterError
        If the topic is not a name that ROS allows.
    """

    source: str = choice(
        "auto",
        LOAD_SOURCES,
        "where the transmitted torque comes from; auto: effort if joint_states has it, else load.torque; wrench: a "
        "force-torque sensor",
    )
    torque: float = number(
        10.0,
        "N·m",
        -1e6,
        1e6,
        "mean torque on the output where no effort is measured; 0: unknown, indexes are then relative",
    )
    torque_uncertainty: float = number(
        0.1, "", 0.0, 2.0, "how sure you are of a measured torque's scale: its standard deviation as a part of it"
    )
    assumed_uncertainty: float = number(
        0.5,
        "",
        0.0,
        2.0,
        "the same of load.torque, where no torque is measured; from about 0.3 on indexes are relative until the motion "
        "itself tells their scale",
    )
    topic: str = plain(
        "",
        "topic of the torque's sensor with load.source: wrench; empty: wrench, below the joint's name with several "
        "joints",
    )
    axis: str = choice(
        "z", AXES, "axis of the wrench that points along the joint's axis, with the sign that an effort would have"
    )

    def __post_init__(self) -> None:
        """Refuse a topic that cannot be subscribed to."""
        _check_topic("load.topic", self.topic)


@dataclass(frozen=True, slots=True, kw_only=True)
class AnalysisSettings:
    """The parameters ``analysis.*``."""

    harmonics: int = number(3, "", 1, 8, "line pairs identified, k = 1 … harmonics")
    period: float = number(1.0, "s", 0.1, 60.0, "time between two verdicts, by message stamps")
    memory: float = number(120.0, "s", 1.0, 86_400.0, "time of motion over which the evidence fades")
    max_gap: float = number(
        0.05,
        "s",
        0.0,
        10.0,
        "longest hole in the vibration signal that is bridged by leaving samples out; a longer one cuts",
    )
    minimum_speed: float = number(
        30.0, "rpm", 0.1, 100_000.0, "wave-generator speed below which the joint counts as standing"
    )
    rms_bin_width: float = number(100.0, "rpm", 1.0, 10_000.0, "width of the speed bins of the RMS curve")


@dataclass(frozen=True, slots=True, kw_only=True)
class DiagnosisSettings:
    """The parameters ``diagnosis.*``.

    Raises
    ------
    ParameterError
        If the limits contradict each other.
    """

    warn_index: float = number(0.05, "", 0.0, 1.0, "stiffness index (fraction) above which a spline is suspect")
    error_index: float = number(0.08, "", 0.0, 2.0, "stiffness index (fraction) above which a spline is defective")
    warn_transmission_error: float = number(
        1.5,
        "arcmin",
        0.01,
        600.0,
        "transmission error, peak to peak, above which a spline is suspect, if one is estimated",
    )
    error_transmission_error: float = number(
        3.0, "arcmin", 0.01, 600.0, "transmission error, peak to peak, above which a spline is defective"
    )
    warn_growth: float = number(
        0.3,
        "",
        0.01,
        100.0,
        "growth of a spline's first line against the baseline (fraction) above which it is suspect, where the indexes "
        "are relative",
    )
    error_growth: float = number(
        1.0, "", 0.01, 100.0, "growth of a spline's first line (fraction) above which it is defective"
    )
    both_ratio: float = number(
        0.87,
        "",
        0.0,
        1.0,
        "both splines are named where the smaller reading is above the limit and at least this part of the larger",
    )
    confidence: float = number(
        0.99,
        "",
        0.5,
        0.999999,
        "probability with which a part's index or transmission error must be beyond its limit for the part to be "
        "accused, or both splines below it to be called sound; between the two there is no verdict yet",
    )
    hysteresis: float = number(
        0.1, "", 0.0, 0.9, "part of a limit by which an index must fall below it before the status improves"
    )
    confirm_count: int = number(2, "", 1, 100, "verdicts (N) that must agree before the status changes")
    confirm_window: int = number(3, "", 1, 100, "number of recent verdicts (M) considered for that")
    latch: bool = plain(False, "keep the worst status until the latch is reset")

    def __post_init__(self) -> None:
        """Refuse limits that contradict each other."""
        for reading in ("index", "transmission_error", "growth"):
            warn, error = getattr(self, f"warn_{reading}"), getattr(self, f"error_{reading}")
            if error < warn:
                raise ParameterError(
                    f"diagnosis.error_{reading} = {error} is below diagnosis.warn_{reading} = {warn}; an error must be "
                    "worse than a warning"
                )
        if self.confirm_count > self.confirm_window:
            raise ParameterError(
                f"diagnosis.confirm_count = {self.confirm_count} can never be reached within "
                f"diagnosis.confirm_window = {self.confirm_window} verdicts"
            )


@dataclass(frozen=True, slots=True, kw_only=True)
class HistorySettings:
    """The parameters ``history.*``."""

    path: str = plain("", "file of the ledger, which remembers every reducer by its serial number; empty: none")
    interval: float = number(300.0, "s", 1.0, 1e6, "time of motion from one entry of the ledger to the next")
