"""What a monitor says at one time: the verdict and everything it rests on."""

from dataclasses import dataclass, field

from .acquisition.quality import Quality
from .analysis.rms_curve import RmsCurve
from .analysis.zoom import ZoomSpectrum
from .diagnosis.verdict import Verdict
from .identification.result import Identification


@dataclass(frozen=True, slots=True, kw_only=True)
class Assessment:
    """A joint's state at one time.

    Attributes
    ----------
    stamp : int
        The time it speaks of [ns], on the message stamps' clock: a whole multiple of ``analysis.period``.
    verdict : Verdict
    identification : Identification or None
        None as long as nothing could be identified.
    zoom : ZoomSpectrum or None
        Around the strongest line pair at the present speed; None while the joint does not turn steadily.
    rms_curve : RmsCurve
    quality : Quality
        Counters of what came in, since the start.
    speed : float
        Mean wave-generator speed over the last period [rpm]; NaN without joint states.
    rms : float
        RMS of the vibration signal over the last period, in m/s² at the sensor's radius for accelerations.
    """

    stamp: int
    verdict: Verdict
    identification: Identification | None
    zoom: ZoomSpectrum | None
    rms_curve: RmsCurve
    quality: Quality
    speed: float
    rms: float
    extra: tuple[tuple[str, str], ...] = field(default=())
