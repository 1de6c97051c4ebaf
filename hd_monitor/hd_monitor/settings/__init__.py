"""Settings of the monitor: one table of parameters, read by the node, by replay and by the tests alike."""

from .groups import AnalysisSettings, DiagnosisSettings, InputSettings, LoadSettings
from .joint_settings import JointSettings
from .joints import set_aside_foreign, split_joints
from .table import INPUT_SOURCES, NODE_PARAMETERS, PARAMETERS, ROS_PARAMETERS, SENSORLESS_SOURCES

__all__ = [
    "INPUT_SOURCES",
    "NODE_PARAMETERS",
    "PARAMETERS",
    "ROS_PARAMETERS",
    "SENSORLESS_SOURCES",
    "AnalysisSettings",
    "DiagnosisSettings",
    "InputSettings",
    "JointSettings",
    "LoadSettings",
    "set_aside_foreign",
    "split_joints",
]
