"""Tells which spline of a harmonic drive is worn, from torsional vibration and the joint's angle.

Everything here but `ros`, `offline`, `watch`, `paper`, `cli` and `process`, which their executables call, is the core:
numpy and scipy only, no clock, no input or output.
"""

__version__ = "0.1.0"
