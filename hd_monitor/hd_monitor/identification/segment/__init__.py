"""From records to segments: contiguous motion with its vibration, torque and integration grid, ready to be fitted."""
