"""From stamped arrays to contiguous records of vibration and motion."""
