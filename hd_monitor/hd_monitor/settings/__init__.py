"""Settings of the monitor: one table of parameters, read by the node, by replay and by the tests alike."""

from .changes import CHANGEABLE, check_change, is_changeable
from .groups import DiagnosisSettings
from .joint_settings import JointSettings
from .joints import set_aside_foreign, split_joints
from .table import NODE_PARAMETERS, PARAMETERS, ROS_PARAMETERS
from .uncertainty import Uncertainty

__all__ = [
    "CHANGEABLE",
    "NODE_PARAMETERS",
    "PARAMETERS",
    "ROS_PARAMETERS",
    "DiagnosisSettings",
    "JointSettings",
    "Uncertainty",
    "check_change",
    "is_changeable",
    "set_aside_foreign",
    "split_joints",
]
