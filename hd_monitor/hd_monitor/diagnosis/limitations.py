"""What limits a result, in words for a technician: one sentence for each code."""

from collections.abc import Mapping

from ..limitation import Limitation, LimitationCode

_BOTH_LINES = "{order:g} and {next_order:g} cycles per output revolution"
_BOTH_DIRECTIONS = "; ".join(
    f"{{{d}}}: {{{d}_line:.3g}} ± {{{d}_line_std:.2g}} and {{{d}_next_line:.3g}} ± {{{d}_next_line_std:.2g}}"
    for d in ("first", "second")
)
_CORRECT_TEETH = (
    "the {given} given; correct reducer.flexspline_teeth and reducer.circular_spline_teeth, since with wrong ones no "
    "part can be named"
)

SENTENCES: Mapping[LimitationCode, str] = {
    LimitationCode.NATURAL_FREQUENCY_CORRECTED: (
        "the vibration fits a natural frequency of {fitted_hz:.4g} Hz, not the {given_hz:g} Hz given: correct "
        "dynamics.natural_frequency"
    ),
    LimitationCode.DAMPING_CORRECTED: ("the vibration fits a damping ratio of {fitted:.2g}, not the {given:g} given"),
    LimitationCode.MOTION_STAMPS_LAG: (
        "the stamps of the joint states lag those of the vibration by {delay_ms:.1f} ms, which is compensated"
    ),
    LimitationCode.VIBRATION_STAMPS_LAG: (
        "the stamps of the vibration lag those of the joint states by {delay_ms:.1f} ms, which is compensated"
    ),
    LimitationCode.TORQUE_CORRECTED: (
        "the vibration fits {factor:.2g} times the torque given, or that much less inertia: check load.torque or the "
        "effort's unit, and dynamics.inertia"
    ),
    LimitationCode.TORQUE_CONTRADICTED: (
        "The vibration would fit {factor:.2g} times the torque given, or that much less inertia, more than either may "
        "be wrong: check load.torque or the effort's unit, dynamics.inertia, and the sensor's gain, unit and bandwidth"
    ),
    LimitationCode.TORQUE_ABSURD: (
        "A torque of {torque_nm:.3g} N·m would wind the reducer up by {wind_up_deg:.0f}°: check the effort's unit, "
        "dynamics.inertia and dynamics.natural_frequency"
    ),
    LimitationCode.TEETH_CONTRADICTED: (
        "Check the tooth numbers: lines are at {lines} cycles per output revolution, and {other} teeth explain them "
        f"far better than {_CORRECT_TEETH}"
    ),
    LimitationCode.TEETH_CONTRADICTED_VAGUELY: (
        "Check the tooth numbers: {other} teeth, or numbers close to these, explain the vibration far better than "
        f"{_CORRECT_TEETH}"
    ),
    LimitationCode.TEETH_AMBIGUOUS: (
        "Over {travel_deg:.0f}° of travel {other} teeth explain the lines as well as the {given} given, and with them "
        "the same line may accuse the other spline: check reducer.flexspline_teeth and reducer.circular_spline_teeth "
        "against the type plate, or let the joint turn further"
    ),
    LimitationCode.MOTOR_LINE: (
        "The line at {order:g} cycles per output revolution is once per motor revolution of {other} teeth, both of "
        "whose lines stand out, while only one of the {given} given does: check reducer.flexspline_teeth and "
        "reducer.circular_spline_teeth"
    ),
    LimitationCode.VALUE_ON_BOUND: (
        "the fit ended on the limit of its search for {names}, so the value there is not a measurement: check "
        "teeth, mount, dynamics.* and load.*, and the sensor's gain and bandwidth"
    ),
    LimitationCode.STAMPS_APART: (
        "The stamps of the {late} lag those of the {early} by about {delay_ms:.0f} ms: stamp both when they are "
        "measured, by one clock"
    ),
    LimitationCode.STAMPS_APART_OR_MORE: (
        "The stamps of the {late} lag those of the {early} by about {delay_ms:.0f} ms, or by whole repetitions of the "
        "motion more or less: stamp both when they are measured, by one clock"
    ),
    LimitationCode.VIBRATION_CLOCK_RATE: (
        "The clock of the vibration's stamps is about {percent:+.2g} % wrong against that of the joint states: stamp "
        "samples when they are measured, instead of counting them at a nominal rate"
    ),
    LimitationCode.MOTION_JITTER: (
        "The stamps of the joint states jitter by {jitter_ms:.3g} ms, in which the lines turn by {turn_deg:.0f}°: "
        "stamp them when they are measured"
    ),
    LimitationCode.POSITION_STEPS: (
        "The positions in joint_states come in steps of {step_rad:.2g} rad, whose error turns the lines by "
        "{turn_deg:.0f}°: publish them as finely as the encoder reads"
    ),
    LimitationCode.POSITION_JUMPS: (
        "The positions in joint_states jump by up to {jump_deg:.3g}° from message to message, which their velocities "
        "do not explain: check the encoder and the driver"
    ),
    LimitationCode.VIBRATION_STEPS: (
        "the vibration comes in steps of {step:.2g} rad/s², {levels:.0f} of them in all, which hide the lines: choose "
        "a smaller range of the sensor"
    ),
    LimitationCode.VIBRATION_FOREIGN: (
        "The vibration near the lines does not follow the angle of this joint: check that the sensor is mounted on it, "
        "that the joint states are its own and that the tooth numbers are right"
    ),
    LimitationCode.SENSOR_SILENT: (
        "the sensor no longer hears the lines of this joint, although it moves as it did before: check the sensor and "
        "its mounting"
    ),
    LimitationCode.EFFORT_HELD: (
        "The efforts in joint_states change only every {held_s:.1f} s, too seldom for the torque that the vibration "
        "needs: publish them as they are measured, or set load.source to parameter"
    ),
    LimitationCode.EFFORT_NOISY: (
        "The efforts in joint_states scatter by {std_nm:.2g} N·m from message to message, too much for the torque that "
        "the vibration needs: filter them, or set load.source to parameter"
    ),
    LimitationCode.VELOCITY_ZERO: (
        "The velocities in joint_states are zero while the positions move by {moved_deg:.3g}°: have the driver publish "
        "velocities, or leave the field empty so that they are derived from the positions"
    ),
    LimitationCode.POSITION_STILL: (
        "The positions in joint_states do not change while the velocities reach {velocity_deg_s:.3g}°/s: check what "
        "the driver publishes"
    ),
    LimitationCode.MOTION_INCONSISTENT: (
        "Positions and velocities in joint_states contradict each other: they differ by {difference_percent:.0f} % of "
        "the motion; check that both belong to this joint and to the same stamp"
    ),
    LimitationCode.VELOCITY_UNIT: (
        "Positions and velocities in joint_states contradict each other: the positions change {ratio:.3g} times as "
        "much as the velocities say, which {mistake} would explain; publish rad and rad/s of the output side"
    ),
    LimitationCode.VELOCITY_SCALE: (
        "Positions and velocities in joint_states contradict each other: the positions change {ratio:.3g} times as "
        "much as the velocities say; check the scale of both"
    ),
    LimitationCode.VIBRATION_CONSTANT: (
        "The vibration signal does not change at all while the joint turns: check the sensor"
    ),
    LimitationCode.INERTIA_MOVES: (
        "Only an inertia that moves along the motion explains the vibration: hold the other joints still, or check "
        "teeth, mount, natural frequency and torque, and the sensor's gain and bandwidth; what is found counts once as "
        "much motion again agrees with it"
    ),
    LimitationCode.SEGMENTS_DISAGREE: (
        "The inertia moves along the motion, and what is found differs from segment to segment {factor:.0f} times as "
        "much as noise explains: no part can be named on it; hold the other joints still, or measure the torque"
    ),
    LimitationCode.INERTIA_UNFOLLOWED: (
        "the newest motion was left out: the inertia moves, and its course could not be found"
    ),
    LimitationCode.SEGMENT_UNUSABLE: "The newest motion could not be used: {cause}",
    LimitationCode.LINES_BEYOND_BANDWIDTH: (
        "At {speed_rpm:.0f} rpm all lines lie beyond the {limit_hz:.0f} Hz that the sensor hears: sample faster, "
        "correct input.bandwidth, or turn more slowly"
    ),
    LimitationCode.LINES_PARTLY_HEARD: (
        "At {speed_rpm:.0f} rpm the lines from the pair k = {k:.0f} on lie beyond the {limit_hz:.0f} Hz that the "
        "sensor hears, so that a defect may hide in them: turn more slowly at times, sample faster, or look at the "
        "first {heard:.0f} alone (analysis.harmonics)"
    ),
    LimitationCode.LINES_TOO_WEAK: (
        "The lines are too weak against the noise at {speed_rpm:.0f} rpm (signal to noise {signal_to_noise_db:.0f} "
        "dB): turn faster, load the joint more, or record for longer"
    ),
    LimitationCode.VALUES_TOO_FEW: (
        "Too few samples can be used so far: wait for more motion, or have the sensor sample faster, and neither clip "
        "nor lose samples"
    ),
    LimitationCode.LINES_ABSENT: (
        "The sensor hears nothing of this joint: neither spline's line rises above the noise, as even those of a sound "
        "reducer do; check that the sensor works and that it is mounted on this joint"
    ),
    LimitationCode.UNCERTAINTY_WIDENED: (
        "the model explains the lines only in part, so the uncertainties are widened {factor:.1f} times"
    ),
    LimitationCode.OTHER_PART: (
        "a torque of {torque_nm:.3g} ± {std_nm:.2g} N·m at {order:g} cycles per output revolution points to the {part}"
    ),
    LimitationCode.SIGNAL_MISSING: (
        "The joint states carry no {field}: set input.source to {other}, or have the driver publish it"
    ),
    LimitationCode.SIGNAL_CONSTANT: (
        "The signal does not change at all while the joint turns: check what the driver publishes"
    ),
    LimitationCode.ALL_TOO_FAST: (
        "The joint turns too fast for the rate of its joint states, the lines lie above half of it: publish them "
        "faster, or let the joint turn more slowly now and then"
    ),
    LimitationCode.PARTLY_TOO_FAST: (
        "{share:.0%} of the motion was too fast for the rate of the joint states and was left out"
    ),
    LimitationCode.ONE_SPEED: (
        "the joint turned at one speed: a fixed frequency of the machine at {lower_hz:.1f} or {upper_hz:.1f} Hz would "
        "look the same"
    ),
    LimitationCode.MOTOR_SHARES_LINE: (
        "the larger line comes exactly twice per wave-generator revolution, as ripple of the motor and a bent shaft "
        "do: check the motor too"
    ),
    LimitationCode.ONE_STROKE: (
        "One stroke only so far: what it shows must come back in others, ideally in the other direction"
    ),
    LimitationCode.NO_LINE_FOUND: (
        f"No line at {_BOTH_LINES} stands out of the noise ({{directions}}): more motion lowers the noise floor"
    ),
    LimitationCode.LINES_TOO_SIMILAR: (
        f"Which of the lines at {_BOTH_LINES} is larger is not certain enough ({_BOTH_DIRECTIONS}): more motion in "
        "both directions may show it"
    ),
    LimitationCode.DIRECTIONS_DISAGREE: (
        f"The directions at {_BOTH_LINES} do not agree on the larger line ({_BOTH_DIRECTIONS}): more motion in both "
        "directions may show it"
    ),
    LimitationCode.RECORDINGS_DISAGREE: (
        f"Recordings at {_BOTH_LINES} contradict each other on the larger line ({_BOTH_DIRECTIONS}): if the reducer "
        "was exchanged or adjusted in between, start anew"
    ),
    LimitationCode.STRONGER_LINE_BESIDE: (
        f"The signal has a stronger line at about {{order_beside:.0f}} than at {_BOTH_LINES}: check "
        "reducer.flexspline_teeth and reducer.circular_spline_teeth"
    ),
}


def describe_limitation(limitation: Limitation) -> str:
    """Return a limitation's sentence, or clause where it only weakens the result."""
    text = SENTENCES[limitation.code].format(**limitation.values)
    return text[:1].upper() + text[1:] if limitation.blocks else text
