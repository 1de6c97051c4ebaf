"""Identification from joint states alone: motor effort or velocity as the vibration signal.

`identifier` cuts joint states into segments, `pooling` fits lines to those of each direction, `agreement` decides
whether the directions allow a name, and `limitations` lists what else weakens or forbids it.
"""
