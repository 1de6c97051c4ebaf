"""The data-quality table of a report: what came, at which rate, and what was wrong with it."""

from typing import NamedTuple

from ...acquisition.quality import Quality
from ...sources import Quantity
from ..result import JointResult
from .collector import Collector


class Row(NamedTuple):
    """A row: what is counted, how often, what it means; `bad` rows stand out."""

    name: str
    value: str
    meaning: str
    bad: bool


def quality_rows(result: JointResult, collector: Collector) -> list[Row]:
    """Write the table."""
    if result.last is None:
        return []
    quality = result.last.quality
    rate = quality.motion_messages / collector.motion_seconds if collector.motion_seconds > 0.0 else 0.0
    rows = [Row("joint states", f"{quality.motion_messages} at {rate:.1f} Hz", "messages with a position", False)]
    if not result.plan.settings.sensorless:
        rows.insert(0, Row("vibration samples", f"{quality.samples} at {quality.rate:.2f} Hz", "accepted", False))
    if Quantity.TORQUE in result.plan.topics:
        rows.append(Row("torque samples", str(quality.torque_messages), "of the torque sensor, accepted", False))
    rows += [Row(name, str(count), meaning, count > 0) for name, count, meaning in _faults(quality)]
    if quality.last_fault:
        rows.append(Row("last complaint", quality.last_fault, "in the monitor's words", True))
    return rows


def _faults(quality: Quality) -> list[tuple[str, int, str]]:
    return [
        ("gaps", quality.gaps, "holes in the vibration signal"),
        ("lost samples", quality.lost, "missing in those holes"),
        ("duplicates", quality.duplicates, "came twice, dropped"),
        ("out of order", quality.out_of_order, "came late, sorted in or dropped"),
        ("not finite", quality.not_finite, "NaN or infinite, left out"),
        ("clipped", quality.clipped, "at the sensor's full scale, left out"),
        ("stuck", quality.stuck, "did not change while the joint turned, left out"),
        ("spikes", quality.spikes, "outliers, left out"),
        ("clock jumps", quality.clock_jumps, "stamps went back or far ahead"),
        ("bad joint states", quality.motion_faults, "no position, repeated or out of order"),
        ("bad torque samples", quality.torque_faults, "not finite, repeated or out of order"),
        ("rejected messages", quality.rejected, "wrong layout or without the joint"),
    ]
