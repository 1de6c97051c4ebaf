from types import SimpleNamespace

import pytest


@pytest.fixture
def messages():
    pytest.importorskip("rclpy")
    from geometry_msgs.msg import AccelStamped
    from sensor_msgs.msg import Imu, JointState
    from std_msgs.msg import Float64MultiArray

    return SimpleNamespace(block=Float64MultiArray, sample=AccelStamped, imu=Imu, joint=JointState)
