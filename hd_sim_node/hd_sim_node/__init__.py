"""A harmonic-drive test rig on ROS 2 topics: speed programmes, defects and a virtual sensor."""

from hd_monitor import __version__

__all__ = ["__version__"]
