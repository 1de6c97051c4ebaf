"""From the core's results to ROS messages."""

import array
import math
from collections.abc import Sequence

import numpy as np
from diagnostic_msgs.msg import DiagnosticStatus, KeyValue
from std_msgs.msg import Float64MultiArray, MultiArrayDimension, MultiArrayLayout

from .. import contract
from ..arrays import FloatArray
from ..contract import Dimension, rms_layout, zoom_layout
from ..diagnosis.status import Status
from ..identification.result import Identification
from ..orders.rms_curve import SpeedBin
from ..orders.zoom import ZoomSpectrum
from ..reducer import LinePair


def diagnostic_status(status: Status, node: str) -> DiagnosticStatus:
    """Write a status of the node of this fully qualified name as a message."""
    return DiagnosticStatus(
        level=bytes([status.level]),  # an int is accepted too, but serialised as garbage
        name=f"{node}: {status.subject}",
        message=status.message,
        hardware_id=status.hardware_id,
        values=[KeyValue(key=key, value=value) for key, value in status.values],
    )


def zoom_message(zoom: ZoomSpectrum) -> Float64MultiArray:
    """Write a zoom spectrum as [(frequency Hz, amplitude rad/s²), bin]."""
    return _multi_array(zoom_layout(), np.vstack((zoom.frequencies, zoom.amplitude)))


def readings_of(found: Identification) -> dict[str, float]:
    """Return the readings that are known, by topic: indexes [%], transmission errors [arcmin peak to peak]."""
    readings = dict.fromkeys(contract.READINGS, LinePair(math.nan, math.nan))
    if not found.relative:
        readings["index"] = LinePair(*(100.0 * index for index in found.index))
    if found.transmission_error is not None:
        readings["transmission_error"] = found.transmission_error
    values = {f"{part}/{name}": getattr(pair, part) for name, pair in readings.items() for part in LinePair._fields}
    return {topic: value for topic, value in values.items() if math.isfinite(value)}


def rms_message(curve: Sequence[SpeedBin]) -> Float64MultiArray:
    """Write an RMS curve as [speed bin, (rpm, RMS m/s², samples)]."""
    table = np.asarray(curve, dtype=np.float64).reshape(-1, 3)
    return _multi_array(rms_layout(len(table)), table)


def _multi_array(dimensions: tuple[Dimension, ...], table: FloatArray) -> Float64MultiArray:
    layout = MultiArrayLayout(
        dim=[MultiArrayDimension(label=d.label, size=d.size, stride=d.stride) for d in dimensions]
    )
    # By way of bytes: assigning an ndarray costs a hundred times more.
    return Float64MultiArray(layout=layout, data=array.array("d", table.tobytes()))
