"""Identification from joint states alone: motor effort or velocity as the vibration signal.

`identifier` cuts joint states into segments and says what limits the result, `pooling` fits lines to the segments of
each direction, and `agreement` decides whether the directions allow a name.
"""
