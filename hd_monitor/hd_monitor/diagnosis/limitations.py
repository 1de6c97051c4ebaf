"""What limits a result, in words for a technician: one sentence for each code."""

from collections.abc import Mapping

from ..identification.limitation import Limitation, LimitationCode

SENTENCES: Mapping[LimitationCode, str] = {
    LimitationCode.NATURAL_FREQUENCY_CORRECTED: (
        "the vibration fits a natural frequency of {fitted_hz:.1f} Hz, not the {given_hz:g} Hz given: correct "
        "dynamics.natural_frequency"
    ),
    LimitationCode.NATURAL_FREQUENCY_CONTRADICTED: (
        "The natural frequency given, {given_hz:g} Hz, contradicts the vibration, which fits about {fitted_hz:.1f} Hz: "
        "correct dynamics.natural_frequency or allow dynamics.refine"
    ),
    LimitationCode.DAMPING_CORRECTED: ("the vibration fits a damping ratio of {fitted:.3f}, not the {given:g} given"),
    LimitationCode.MOTION_STAMPS_LAG: (
        "the stamps of the joint states lag those of the vibration by {delay_ms:.1f} ms, which is allowed for"
    ),
    LimitationCode.VIBRATION_STAMPS_LAG: (
        "the stamps of the vibration lag those of the joint states by {delay_ms:.1f} ms, which is allowed for"
    ),
    LimitationCode.TORQUE_TOO_SMALL: (
        "The vibration contradicts the torque given, which seems to be larger: check load.torque or the effort's unit; "
        "the indexes' scale rests on it"
    ),
    LimitationCode.TORQUE_TOO_LARGE: (
        "The vibration contradicts the torque given, which seems to be smaller: check load.torque or the effort's "
        "unit; the indexes' scale rests on it"
    ),
    LimitationCode.TORQUE_ABSURD: (
        "A torque of {torque_nm:.3g} N·m would wind the reducer up by {wind_up_deg:.0f}°: check the effort's unit, "
        "dynamics.inertia and dynamics.natural_frequency"
    ),
    LimitationCode.VALUE_ON_BOUND: (
        "the fit ended on the limit of its search for {names}, so the value there is not a measurement: check the "
        "parameters"
    ),
    LimitationCode.VELOCITY_ZERO: (
        "The velocities in joint_states are zero while the positions move by {moved_deg:.1f}°: have the driver publish "
        "velocities, or leave the field empty so that they are taken from the positions"
    ),
    LimitationCode.POSITION_STILL: (
        "The positions in joint_states stand still while the velocities reach {velocity_deg_s:.3g}°/s: check what the "
        "driver publishes"
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
    LimitationCode.SEGMENT_UNUSABLE: "The newest motion could not be used: {cause}",
    LimitationCode.NATURAL_FREQUENCY_BEYOND_RATE: (
        "The natural frequency given, {given_hz:g} Hz, lies beyond what {rate_hz:.0f} samples a second show: sample "
        "faster, or correct dynamics.natural_frequency"
    ),
    LimitationCode.LINES_BEYOND_RATE: (
        "At {speed_rpm:.0f} rpm the lines lie beyond what {rate_hz:.0f} samples a second show: sample faster, or turn "
        "more slowly"
    ),
    LimitationCode.TRAVEL_TOO_SHORT: (
        "Only {travel_deg:.0f}° of output travel seen: at least {needed_deg:.0f}° are needed to separate the two "
        "splines' lines, {missing_deg:.0f}° more"
    ),
    LimitationCode.MOTION_TOO_SHORT: (
        "Only {motion_s:.0f} s of motion seen: {needed_s:.0f} s are needed to rule out other causes"
    ),
    LimitationCode.LINES_TOO_WEAK: (
        "The lines are too weak against the noise at {speed_rpm:.0f} rpm (signal to noise {signal_to_noise_db:.0f} "
        "dB): turn faster, load the joint more, or record for longer"
    ),
    LimitationCode.LINES_UNEXPLAINED: (
        "{unexplained_percent:.0f} % of the vibration at the lines is not explained by the model: check teeth, mount, "
        "natural frequency and torque, and look for another source of vibration near the lines (mains hum, a "
        "neighbouring machine)"
    ),
    LimitationCode.UNCERTAINTY_WIDENED: (
        "the model explains the lines only in part, so the uncertainties are widened {factor:.1f} times"
    ),
    LimitationCode.NEAR_RESONANCE: (
        "At this speed the lines are so near the natural frequency ({given_hz:g} Hz given) that a small error in it "
        "would change the name: let the joint turn at other speeds too"
    ),
    LimitationCode.OTHER: "{text}",
}


def describe_limitation(limitation: Limitation) -> str:
    """Return a limitation's sentence, or clause where it only weakens the result."""
    return SENTENCES[limitation.code].format(**limitation.values)
