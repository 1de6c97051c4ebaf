"""Identification from joint states alone: motor effort or velocity as the vibration signal."""
