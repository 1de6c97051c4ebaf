"""The groups of a joint's parameters as types; the table holds their defaults, units, ranges and descriptions."""

import re
from dataclasses import dataclass

from ..errors import ParameterError

_TOPIC = re.compile(r"/?[A-Za-z_][A-Za-z0-9_]*(/[A-Za-z_][A-Za-z0-9_]*)*")


@dataclass(frozen=True, slots=True, kw_only=True)
class InputSettings:
    """The parameters ``input.*``."""

    source: str
    axis: str
    sensor_radius: float
    joint_name: str
    timeout: float
    queue_seconds: float
    expected_rate: float
    reliability: str
    clipping_limit: float


@dataclass(frozen=True, slots=True, kw_only=True)
class LoadSettings:
    """The parameters ``load.*``.

    Raises
    ------
    ParameterError
        If the topic is not a name that ROS allows.
    """

    source: str
    torque: float
    topic: str
    axis: str

    def __post_init__(self) -> None:
        """Refuse a topic that cannot be subscribed to."""
        if self.topic and not _TOPIC.fullmatch(self.topic):
            raise ParameterError(
                f"load.topic = {self.topic!r} is not a topic's name; it has words of letters, digits and underscores "
                "with single slashes between, as in ft_sensor/wrench"
            )


@dataclass(frozen=True, slots=True, kw_only=True)
class AnalysisSettings:
    """The parameters ``analysis.*``."""

    harmonics: int
    period: float
    memory: float
    max_gap: float
    minimum_speed: float
    rms_bin_width: float


@dataclass(frozen=True, slots=True, kw_only=True)
class DiagnosisSettings:
    """The parameters ``diagnosis.*``.

    Raises
    ------
    ParameterError
        If the limits contradict each other.
    """

    warn_index: float
    error_index: float
    both_ratio: float
    confidence: float
    hysteresis: float
    confirm_count: int
    confirm_window: int
    latch: bool

    def __post_init__(self) -> None:
        """Refuse limits that contradict each other."""
        if self.error_index < self.warn_index:
            raise ParameterError(
                f"diagnosis.error_index = {self.error_index} is below diagnosis.warn_index = {self.warn_index}; an "
                "error must be worse than a warning"
            )
        if self.confirm_count > self.confirm_window:
            raise ParameterError(
                f"diagnosis.confirm_count = {self.confirm_count} can never be reached within "
                f"diagnosis.confirm_window = {self.confirm_window} verdicts"
            )
