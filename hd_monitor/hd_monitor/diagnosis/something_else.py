"""What the model leaves unexplained, in words for a technician."""

from collections.abc import Iterable, Mapping

from ..identification.checks.something_else import SomethingElse, Source

_SOURCES: Mapping[Source, str] = {
    Source.WAVE_GENERATOR: "wave generator",
    Source.MOTOR_RIPPLE: "ripple of the motor's torque",
    Source.MAINS: "mains",
    Source.UNKNOWN: "unknown source",
}


def describe_something_else(row: SomethingElse) -> str:
    """Return what a line may come from, where it stands and how strong it is."""
    places = []
    if row.order is not None:
        places.append(f"{row.order:.0f} cycles per output revolution")
    if row.frequency is not None:
        places.append(f"{row.frequency:.1f} Hz")
    where = " or, as one speed does not tell which, at a fixed ".join(places)
    percent = 100.0 * row.share
    return f"{_SOURCES[row.source]} at {where}: {row.amplitude:.2g} rad/s², {percent:.1f} % of the vibration's power"


def describe_all_else(rows: Iterable[SomethingElse]) -> str:
    """Return all of them as one text; ``none`` if there are none."""
    return "; ".join(map(describe_something_else, rows)) or "none"
