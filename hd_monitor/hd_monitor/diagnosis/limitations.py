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
