"""The drive: a reducer with its defects and all that acts on it, integrated along a motion."""
