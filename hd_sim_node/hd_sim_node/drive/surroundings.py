"""What acts on the drive from outside: gravity and the motion of the load."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class Surroundings:
    """What acts on the rig besides the model's own torques.

    Parameters
    ----------
    gravity : float
        Amplitude [N·m] of an eccentric load's torque, a cosine of the output angle.
    gravity_angle : float
        Output angle [rad] at which gravity's torque is largest.
    rigid_body : bool
        Whether the output's own acceleration along the programme counts: its inertia winds up the reducer, and the
        accelerometer feels it. The paper's model leaves it out.
    """

    gravity: float = 0.0
    gravity_angle: float = 0.0
    rigid_body: bool = False
