"""What limits a result, as a code with its numbers; :mod:`hd_monitor.diagnosis.limitations` has the sentences."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum


class LimitationCode(StrEnum):
    """Kinds of limitation."""

    # What was given contradicts the data
    NATURAL_FREQUENCY_CORRECTED = "natural_frequency_corrected"
    DAMPING_CORRECTED = "damping_corrected"
    MOTION_STAMPS_LAG = "motion_stamps_lag"
    VIBRATION_STAMPS_LAG = "vibration_stamps_lag"
    TORQUE_CORRECTED = "torque_corrected"
    TORQUE_CONTRADICTED = "torque_contradicted"
    TORQUE_ABSURD = "torque_absurd"
    TEETH_CONTRADICTED = "teeth_contradicted"
    TEETH_CONTRADICTED_VAGUELY = "teeth_contradicted_vaguely"
    TEETH_AMBIGUOUS = "teeth_ambiguous"
    MOTOR_LINE = "motor_line"
    VALUE_ON_BOUND = "value_on_bound"
    # What the input says cannot be
    STAMPS_APART = "stamps_apart"
    STAMPS_APART_OR_MORE = "stamps_apart_or_more"
    VIBRATION_CLOCK_RATE = "vibration_clock_rate"
    MOTION_JITTER = "motion_jitter"
    POSITION_STEPS = "position_steps"
    POSITION_JUMPS = "position_jumps"
    VIBRATION_STEPS = "vibration_steps"
    VIBRATION_FOREIGN = "vibration_foreign"
    SENSOR_SILENT = "sensor_silent"
    EFFORT_HELD = "effort_held"
    EFFORT_NOISY = "effort_noisy"
    VELOCITY_ZERO = "velocity_zero"
    POSITION_STILL = "position_still"
    MOTION_INCONSISTENT = "motion_inconsistent"
    VELOCITY_UNIT = "velocity_unit"
    VELOCITY_SCALE = "velocity_scale"
    VIBRATION_CONSTANT = "vibration_constant"
    SEGMENT_UNUSABLE = "segment_unusable"
    INERTIA_UNFOLLOWED = "inertia_unfollowed"
    INERTIA_MOVES = "inertia_moves"
    SEGMENTS_DISAGREE = "segments_disagree"
    # What the signal does not show
    LINES_BEYOND_BANDWIDTH = "lines_beyond_bandwidth"
    LINES_PARTLY_HEARD = "lines_partly_heard"
    LINES_TOO_WEAK = "lines_too_weak"
    LINES_ABSENT = "lines_absent"
    VALUES_TOO_FEW = "values_too_few"
    # What the model does not explain
    UNCERTAINTY_WIDENED = "uncertainty_widened"
    OTHER_PART = "other_part"
    # What joint states alone do not show
    SIGNAL_MISSING = "signal_missing"
    SIGNAL_CONSTANT = "signal_constant"
    ALL_TOO_FAST = "all_too_fast"
    PARTLY_TOO_FAST = "partly_too_fast"
    ONE_SPEED = "one_speed"
    MOTOR_SHARES_LINE = "motor_shares_line"
    ONE_STROKE = "one_stroke"
    NO_LINE_FOUND = "no_line_found"
    LINES_TOO_SIMILAR = "lines_too_similar"
    DIRECTIONS_DISAGREE = "directions_disagree"
    RECORDINGS_DISAGREE = "recordings_disagree"
    STRONGER_LINE_BESIDE = "stronger_line_beside"


NOT_YET = frozenset(
    {
        LimitationCode.LINES_TOO_WEAK,
        LimitationCode.VALUES_TOO_FEW,
        LimitationCode.INERTIA_MOVES,
        LimitationCode.ONE_STROKE,
        LimitationCode.NO_LINE_FOUND,
        LimitationCode.LINES_TOO_SIMILAR,
        LimitationCode.DIRECTIONS_DISAGREE,
    }
)
"""Codes that more motion, or another one, lifts; all others contradict parameters or model and need a person."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Limitation:
    """One reason to doubt a result, or not to name a part on it.

    Attributes
    ----------
    code : LimitationCode
    blocks : bool
        Whether it forbids naming a part; else it only weakens the result.
    values : mapping of str to float or str
        What its sentence states; the unit is in the name.
    """

    code: LimitationCode
    blocks: bool
    values: Mapping[str, float | str] = field(default_factory=dict)

    @property
    def is_not_yet(self) -> bool:
        """Whether it only says that something has not been seen yet."""
        return self.code in NOT_YET


def doubt(code: LimitationCode, **values: float | str) -> Limitation:
    """Return a limitation that weakens a result."""
    return Limitation(code=code, blocks=False, values=values)


def blocker(code: LimitationCode, **values: float | str) -> Limitation:
    """Return a limitation that forbids naming a part."""
    return Limitation(code=code, blocks=True, values=values)
