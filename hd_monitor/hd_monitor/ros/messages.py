"""From the core's results to ROS messages."""

import array
from collections.abc import Sequence

import numpy as np
from diagnostic_msgs.msg import DiagnosticStatus, KeyValue
from std_msgs.msg import Float64MultiArray, MultiArrayDimension, MultiArrayLayout

from ..arrays import FloatArray
from ..contract import Dimension, rms_layout, zoom_layout
from ..diagnosis.status import Status
from ..orders.rms_curve import SpeedBin
from ..orders.zoom import ZoomSpectrum


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
    """Write a zoom spectrum as [bin, (frequency Hz, amplitude rad/s²)]."""
    table = np.column_stack((zoom.frequencies, zoom.amplitude))
    return _multi_array(zoom_layout(len(table)), table)


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
