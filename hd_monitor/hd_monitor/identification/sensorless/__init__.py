"""Identification from joint states alone: motor effort or velocity as the vibration signal.

`identifier` cuts joint states into segments and says what limits the result, `pooling` fits lines to the segments of
each direction, `agreement` decides whether the directions allow a name, and
`torque_share` how much of a line follows the torque.
"""
