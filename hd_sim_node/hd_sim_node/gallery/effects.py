"""The effects shown: what is set, on which ground, and what to look for."""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from hd_monitor.orders.zoom import ZoomSpectrum, zoom_spectrum

from ..drive.catalogue import preset
from ..settings import RigSettings
from ..simulation import Simulation

SPEED = 1400.0
"""Wave-generator speed [rpm]: the pair k = 1 lies 8 Hz below the natural frequency and is the strongest."""

SETTLING = 3.0
"""Seconds left out at the start; vibration decays within a tenth of that."""

LENGTH = 48.0
"""Seconds shown: 28 beats of the pair, 14 output revolutions, so that what belongs to them falls on bins, without the
window's side lobes."""

BARE: Mapping[str, Any] = {
    "programme": "fixed",
    "fixed.speed": SPEED,
    "duration": SETTLING + LENGTH + 1.0,
}
"""The paper's drive with its bad flexspline, turned at one speed under one torque."""

SWINGING = {"torque.gravity": 15.0}
"""Torque through zero: -5 to 25 N·m."""


_BINS = 140  # 28 to the pair's spacing


class Effect(NamedTuple):
    """One panel of the picture: the drive with `settings` over the one without; `ground` is set in both."""

    name: str
    settings: Mapping[str, Any]
    look_for: str
    ground: Mapping[str, Any] = {}
    shown: str = ""
    """What the table says in place of the settings."""


def of_catalogue(*prefixes: str) -> dict[str, Any]:
    """Values of the preset ``catalogue`` whose names begin so."""
    return {name: value for name, value in preset("catalogue").items() if name.startswith(prefixes)}


_ERRORS = ("flexspline.t", "circular_spline.t", "wave_generator.t")
_FRICTION = of_catalogue("friction.")

EFFECTS = (
    Effect(
        "Transmission error, flexspline",
        of_catalogue("flexspline.t"),
        "The flexspline's line grows or shrinks, as the two phases have it, though the stiffness fluctuates as before.",
    ),
    Effect(
        "Transmission error, circular spline",
        of_catalogue("circular_spline.t"),
        "The sound spline's line passes the bad one's: whoever takes the higher peak for the bad part is wrong here.",
    ),
    Effect(
        "Transmission error, wave generator",
        of_catalogue("wave_generator.t"),
        "Its second harmonic stands at the circular spline's line; the first and third lie outside this window.",
    ),
    Effect(
        "Torque ripple of the motor",
        of_catalogue("torque.ripple"),
        "The ripple twice per revolution stands there too: the same force, so that the two cannot be distinguished.",
    ),
    Effect(
        "Gravity",
        SWINGING,
        "A torque once per output revolution puts a line on either side of each spline's, half a spacing away.",
    ),
    Effect(
        "Changing inertia",
        {"inertia.lowest": -0.3, "inertia.highest": 0.5, "inertia.period": 4.0},
        "The natural frequency moves with the other joints: a comb of lines 1/4 Hz apart, in which the weaker line "
        "is lost.",
    ),
    Effect(
        "Stiffness in three steps",
        of_catalogue("elasticity."),
        "Where the torque passes T1 the stiffness changes: side lines as high as the lines themselves, one of them "
        "on the circular spline's.",
        SWINGING,
    ),
    Effect(
        "Hysteresis",
        of_catalogue("hysteresis."),
        "A small vibration meets a stiffer spring than a slow load: fn rises, and all lines below it sink.",
        SWINGING,
    ),
    Effect(
        "Friction",
        _FRICTION,
        "Turning with the load, it takes its share of the torque off the flexspline: both lines sink alike. Against "
        "it they rise.",
    ),
    Effect(
        "Warm instead of cold",
        {**of_catalogue("drift."), "drift.time": 0.5},
        "As the grease thins, friction takes less torque and the lines rise again.",
        _FRICTION,
        "`drift.*` of the catalogue, within seconds<br>both: the friction of row 9",
    ),
    Effect(
        "A defect that grows",
        {"growth.flexspline": 2.0, "growth.length": SETTLING + LENGTH},
        "Doubled over the record, the flexspline's line shows its mean height, on a broader foot.",
    ),
    Effect(
        "All of the catalogue at once",
        of_catalogue(*_ERRORS, "torque.ripple", "elasticity.", "hysteresis.", "friction.", "drift.") | SWINGING,
        "The sound circular spline's line is nearly as high as the bad flexspline's, among the side lines of the "
        "torque.",
        shown="all effects in the table below, and `torque.gravity: 15`",
    ),
)
"""In the order of the picture. The values are the catalogue's where it has any."""


def zoom_of(settings: Mapping[str, Any]) -> ZoomSpectrum:
    """Simulate :data:`BARE` with more settings and take the zoom spectrum of what the sensor puts out.

    With ``publish_imu`` that is the IMU's tangential acceleration over its radius, otherwise what the accelerometer
    gives.
    """
    rig = RigSettings.from_mapping({**BARE, **settings})
    rate, stretches = rig.sampling.rate, list(Simulation(rig))
    samples = np.concatenate([s.samples if s.imu is None else s.imu.force[:, 1] / rig.imu.radius for s in stretches])
    shown = samples[round(SETTLING * rate) :][: round(LENGTH * rate)]
    around, period = rig.reducer.line_frequencies(SPEED, 1), stretches[0].blocks[0].period
    return zoom_spectrum(shown, period, around=around, k=1, bins=_BINS)
