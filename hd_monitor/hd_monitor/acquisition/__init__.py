"""From stamped arrays to contiguous records of vibration and motion."""

from .quality import Quality
from .record import JointSamples, Record
from .recorder import Harvest, Recorder

__all__ = ["Harvest", "JointSamples", "Quality", "Record", "Recorder"]
