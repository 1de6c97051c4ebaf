"""The sentences of the first screen: which part, how bad, how sure, what to do, since when, what is missing."""

import math
from datetime import datetime

from .. import contract
from ..contract import NANOSECONDS
from ..diagnosis.advice import advise
from ..diagnosis.verdict import Component, FaultCode, Level
from .reading import GROWTH, Reading, number
from .state import Joint, View, seconds_between

_PARTS = {
    Component.FLEXSPLINE: "flexspline",
    Component.CIRCULAR_SPLINE: "circular spline",
    Component.BOTH: "both splines",
    Component.NONE: "none: sound",
    Component.UNDETERMINED: "undetermined",
}
_INPUTS = {"HD_INPUT_OK": "ok", "HD_INPUT_WAITING": "wait", "HD_INPUT_LOST": "LOST", "HD_INPUT_INVALID": "BAD"}
_DATES_FROM = 1_000_000_000  # s; below it a stamp is simulated time, not a date


STATES = ("GONE", "ERROR", "WARN", "UNRATED", "WAITING", "OK")
"""What `state` says, the worst first."""


def state(joint: Joint, view: View) -> str:
    """One word: the level, or what stands in its place."""
    if view.silent_for(joint):
        return "GONE"
    if joint.reducer is None or joint.code == FaultCode.WAITING:
        return "WAITING"
    return "UNRATED" if joint.code == FaultCode.UNRATED else joint.level.name


def part(joint: Joint) -> str:
    """The part named."""
    if joint.code in ("", FaultCode.WAITING):
        return "no verdict yet"
    return _PARTS.get(Component(joint.component), joint.component) if joint.component in set(Component) else "?"


def input_word(joint: Joint) -> str:
    """Whether the inputs arrive, in a word."""
    return _INPUTS.get(joint.input.values["fault_code"], "?") if joint.input else "?"


def how_bad_in_short(joint: Joint) -> str:
    """The decisive reading against its limit."""
    reading = joint.decisive
    if reading is None:
        return "-"
    if not reading.limited:
        return f"{'grown' if reading.quantity == GROWTH else 'share'} {reading.value:.0f} {reading.unit}"
    if reading.value >= reading.error:
        return f"{reading.value / reading.error:.1f} x error"
    return f"{reading.value / reading.warn:.1f} x warn"


def how_bad(joint: Joint) -> str:
    """The decisive reading with its size and its limit."""
    reading = joint.decisive
    if reading is None:
        return "Not known yet"
    what = f"{_name(reading)} {_amount(reading.value, reading)}"
    if reading.quantity == GROWTH:
        return f"{what} against the baseline"
    if not reading.limited:
        return f"{what} of the pair; without a torque its size has no limit"
    level, limit = ("error", reading.error) if reading.value >= reading.error else ("warn", reading.warn)
    return f"{what}: {how_bad_in_short(joint).partition(' x')[0]} times the {level} limit of {limit:g} {reading.unit}"


def how_sure_in_short(joint: Joint) -> str:
    """The decisive reading's 95 % interval."""
    return interval(joint.decisive).replace(" to ", "–") if joint.decisive else "-"


def how_sure(joint: Joint) -> str:
    """The decisive reading's 95 % interval, and where it lies."""
    reading = joint.decisive
    if reading is None:
        return "Not at all: there is no reading yet"
    where = f": {standing(reading)}" if reading.limited else ""
    named = "" if joint.component != Component.UNDETERMINED else "; which part is at fault is not known"
    return f"95 % sure of {interval(reading)}{where}{named}" if math.isfinite(reading.std) else "Interval unknown"


def interval(reading: Reading) -> str:
    """Write a 95 % interval."""
    low, high = reading.interval
    if math.isnan(high):
        return "unknown"
    return f"{low:.{reading.digits}f} to {high:.{reading.digits}f} {_sign(reading)}"


def standing(reading: Reading) -> str:
    """Say in words where the interval lies among the limits."""
    low, high = reading.interval
    if math.isnan(high):
        return "how it compares with the limits is unknown"
    for limit, name in ((reading.error, "error"), (reading.warn, "warn")):
        if low >= limit:
            return f"above the {name} limit"
        if high > limit:
            return f"reaches across the {name} limit"
    return "below the warn limit"


def to_do(joint: Joint, view: View) -> str:
    """Say what a person should do."""
    if view.silent_for(joint):
        return f"Start {joint.key.node} again: it has fallen silent. What follows is the last it said"
    if joint.input and joint.input_level > Level.OK:
        return f"Restore the input: {joint.input.message}"
    return advise(joint.code, joint.level) if joint.reducer else "Wait for the reducer's first status"


def since(joint: Joint, view: View) -> str:
    """Say since when the verdict stands."""
    lasted = duration(seconds_between(joint.since, joint.stamp))
    if joint.before:
        words = f"{moment(joint.since)}, for {lasted}; before that {joint.before}"
    else:
        first = "this view opened" if view.live else "the recording began"
        words = f"at least {lasted}: it was so when {first}, {moment(joint.since)}"
    if silence := view.silent_for(joint):
        words += f"; silent for {duration(silence)}"
    age = number(joint.values, "evidence age (s)")
    return f"{words}; newest evidence is {duration(age)} old" if age >= 10.0 else words


def since_in_short(joint: Joint) -> str:
    """How long the verdict has stood; with a sign where it may be longer."""
    lasted = duration(seconds_between(joint.since, joint.stamp))
    return lasted if joint.before else f">{lasted}"


def missing(joint: Joint, view: View) -> list[str]:
    """List what would make the picture whole."""
    found = []
    if view.silent_for(joint):
        found.append(f"the node: no status for {duration(view.silent_for(joint))}")
    if joint.input is None or joint.input.values["fault_code"] != "HD_INPUT_OK":
        found.append(f"input: {joint.input.message if joint.input else 'no status of it'}")
    if joint.reducer is None:
        return [*found, "the reducer's status"]
    if joint.code == FaultCode.WAITING:
        found.append(joint.reducer.message.removeprefix("No verdict yet: "))
    if joint.values.get("index kind") == "relative" and all(r.quantity != GROWTH for r in joint.readings):
        found.append("the torque: without it, or a baseline, the lines can only be compared with each other")
    if contract.ZOOM_SPECTRUM not in joint.curves:
        found.append("the spectrum: it comes while the joint turns steadily")
    return [*found, *view.notes]


def moment(stamp: int) -> str:
    """Write a stamp [ns]: the time of day in local time, with the date unless it is today's; or simulated seconds."""
    seconds = stamp / NANOSECONDS
    if seconds < _DATES_FROM:
        return f"second {seconds:.1f}"
    local = datetime.fromtimestamp(seconds)
    return f"{local:%H:%M:%S}" if local.date() == datetime.now().date() else f"{local:%Y-%m-%d %H:%M:%S}"


def duration(seconds: float) -> str:
    """Write a duration in the largest unit that leaves a whole number.

    Examples
    --------
    >>> duration(0.4), duration(75.0), duration(7300.0), duration(300_000.0)
    ('0 s', '75 s', '2 h', '3 d')
    """
    for limit, unit, size in ((100.0, "s", 1.0), (6000.0, "min", 60.0), (172_800.0, "h", 3600.0)):
        if seconds < limit:
            return f"{seconds / size:.0f} {unit}"
    return f"{seconds / 86_400.0:.0f} d"


def _name(reading: Reading) -> str:
    return f"{reading.part.replace('_', ' ')} {reading.quantity}".capitalize()


def _amount(value: float, reading: Reading) -> str:
    return f"{value:.{reading.digits}f} {_sign(reading)}"


def _sign(reading: Reading) -> str:
    return "'" if reading.unit == "arcmin" else reading.unit
