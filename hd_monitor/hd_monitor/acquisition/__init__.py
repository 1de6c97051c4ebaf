"""From stamped arrays to contiguous records of vibration and motion."""

from .quality import Quality
from .record import JointSamples, Record
from .recorder import AssembledPeriod, Recorder

__all__ = ["AssembledPeriod", "JointSamples", "Quality", "Record", "Recorder"]
