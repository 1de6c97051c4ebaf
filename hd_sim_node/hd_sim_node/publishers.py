"""From the simulation's arrays to ROS messages, one small class a topic."""

from array import array
from typing import Any, Protocol

from geometry_msgs.msg import AccelStamped
from sensor_msgs.msg import Imu, JointState
from std_msgs.msg import Float64MultiArray, MultiArrayDimension

from hd_monitor import contract
from hd_monitor.contract import BLOCK_LABEL, BLOCK_OFFSET, NANOSECONDS

from .imu import ImuBatch, imu_readings
from .settings import RigSettings
from .simulation import Stretch


class Writer(Protocol):
    """Makes the messages of one topic; the message returned is overwritten by the next call, which saves its making."""

    message_type: Any

    def __init__(self, settings: RigSettings) -> None:
        """Set up what all messages have in common."""

    def write(self, stretch: Stretch, row: int, epoch: int) -> Any:
        """Return the message of a row of a stretch; `epoch` [ns] is the stamp of the start."""


def _stamp(message: Any, nanoseconds: int) -> None:
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(nanoseconds, NANOSECONDS)


class BlockWriter:
    """Writes ``torsional_acceleration/block``."""

    message_type = Float64MultiArray

    def __init__(self, settings: RigSettings) -> None:
        self._message = Float64MultiArray()
        self._message.layout.data_offset = BLOCK_OFFSET
        self._message.layout.dim = [MultiArrayDimension(label=BLOCK_LABEL)]

    def write(self, stretch: Stretch, row: int, epoch: int) -> Float64MultiArray:
        """Return the message of a block."""
        block = stretch.blocks[row]
        (_, size, stride), data = contract.pack_block(block._replace(stamp=block.stamp + epoch))
        dimension = self._message.layout.dim[0]
        dimension.size, dimension.stride = size, stride
        self._message.data = array("d", data.tobytes())
        return self._message


class SampleWriter:
    """Writes ``torsional_acceleration``."""

    message_type = AccelStamped

    def __init__(self, settings: RigSettings) -> None:
        self._message = AccelStamped()
        self._message.header.frame_id = settings["sensor.frame_id"]
        self._radius = settings["sensor.radius"]

    def write(self, stretch: Stretch, row: int, epoch: int) -> AccelStamped:
        """Return the message of a sample."""
        value = float(stretch.samples[row])
        _stamp(self._message, epoch + int(stretch.stamps[row]))
        self._message.accel.angular.z = value
        self._message.accel.linear.y = self._radius * value
        return self._message


class ImuWriter:
    """Writes ``imu/data_raw`` (REP-145): no orientation, gravity included."""

    message_type = Imu

    def __init__(self, settings: RigSettings) -> None:
        self._message = Imu()
        self._message.header.frame_id = settings["sensor.frame_id"]
        self._message.orientation_covariance[0] = -1.0
        self._settings = settings
        self._of: Stretch | None = None
        self._readings: ImuBatch | None = None

    def write(self, stretch: Stretch, row: int, epoch: int) -> Imu:
        """Return the message of a sample."""
        if self._readings is None or self._of is not stretch:
            settings = self._settings
            self._of, self._readings = (
                stretch,
                imu_readings(
                    stretch.motion,
                    stretch.samples,
                    radius=settings["sensor.radius"],
                    axis=settings["sensor.imu_axis"],
                    surroundings=settings.surroundings,
                ),
            )
        message = self._message
        _stamp(message, epoch + int(stretch.stamps[row]))
        force, turning = message.linear_acceleration, message.angular_velocity
        force.x, force.y, force.z = self._readings.linear_acceleration[row].tolist()
        turning.x, turning.y, turning.z = self._readings.angular_velocity[row].tolist()
        return message


class JointWriter:
    """Writes ``joint_states``."""

    message_type = JointState

    def __init__(self, settings: RigSettings) -> None:
        self._message = JointState(name=[settings["joint_states.name"]])

    def write(self, stretch: Stretch, row: int, epoch: int) -> JointState:
        """Return the message of a joint state."""
        joint, message = stretch.joint, self._message
        _stamp(message, epoch + int(joint.stamps[row]))
        message.position = array("d", (joint.position[row],))
        message.velocity = array("d", () if joint.velocity is None else (joint.velocity[row],))
        message.effort = array("d", () if joint.effort is None else (joint.effort[row],))
        return message


WRITERS: dict[str, type[Writer]] = {
    contract.TORSIONAL_ACCELERATION_BLOCK: BlockWriter,
    contract.TORSIONAL_ACCELERATION: SampleWriter,
    contract.IMU: ImuWriter,
    contract.JOINT_STATES: JointWriter,
}
"""By topic."""
