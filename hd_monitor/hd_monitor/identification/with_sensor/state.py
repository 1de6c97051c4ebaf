"""What an estimation with a sensor knows: one frozen state, replaced as a whole by each update."""

import math
from dataclasses import dataclass, field, replace

from ...arrays import FloatArray
from ...limitation import Limitation
from ..checks.coverage import Coverage
from ..checks.residual import LineResidual
from ..checks.tone_watch import ToneWatch
from ..fit.information import Information
from ..fit.noise import NoiseFloor
from ..fit.unknowns import Unknowns
from ..result import Identification
from ..segment.segment import Segment
from ..teeth.watch import ToothWatch
from .schedule import Schedule

UNSEEN = 3.0
"""Amplitude wrongly taken for defects, over that left at the lines: the unknowns follow what they can of anything."""

TORQUE_VARIES = 1.25
"""Ratio of torques from which the stiffness at one may differ from that at the other."""

WINDOW = 16.0
"""Motion [s] that is kept to be fitted again as a whole; from then on each segment is used once."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Setup:
    """What the data have said of torque and sensor.

    Attributes
    ----------
    nominal_torque : float or None
        Torque [N·m] used in place of an unknown one; None as long as the torque is known.
    measured : bool
        Whether all torque so far was measured.
    origin : float or None
        Time [s] of the first segment, from which the drift of the clocks counts; None before it.
    reference_torque : float
        Torque [N·m] in whose unit load fluctuations are expressed; 0 before the first segment.
    mounting : float
        1, or -1 for a sensor whose sign is against that of the torque.
    moving_since : float
        Motion [s] after which the inertia was found to move, as an arm's does with its pose; inf if it was not.
    torques : tuple of float
        Smallest and largest magnitude [N·m] of the torque so far.
    """

    nominal_torque: float | None = None
    measured: bool = True
    origin: float | None = None
    reference_torque: float = 0.0
    mounting: float = 1.0
    moving_since: float = math.inf
    torques: tuple[float, float] = (math.inf, 0.0)

    @property
    def wanders(self) -> bool:
        """Whether the inertia moves."""
        return self.moving_since < math.inf

    @property
    def torque_varies(self) -> bool:
        """Whether the torque varies by so much that the data tell how the stiffness depends on it."""
        return self.torques[1] > TORQUE_VARIES * self.torques[0]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class State:
    """The evidence so far, and the best values of the unknowns.

    Attributes
    ----------
    values : ndarray, shape (unknowns,)
    information : Information
        Of all segments used, without the prior.
    floor : NoiseFloor or None
        None before the first segment.
    residual : LineResidual
        What is left at the lines.
    heard : float
        What the fits explain of the vibration, in units of the noise: the fall of the cost since nothing is predicted.
    rival : ndarray or None, shape (unknowns,)
        Values of another solution that the data do not exclude yet.
    unfollowed : int
        Segments left out in a row since the course of the inertia was not found.
    recent : tuple of Segment
        The newest `WINDOW` of motion.
    coverage : Coverage
    setup : Setup
    schedule : Schedule
    teeth : ToothWatch
    tones : ToneWatch
    result : Identification or None
        The newest result.
    unusable : Limitation or None
        Why the newest segment could not be used; None if it was.
    """

    values: FloatArray
    information: Information
    floor: NoiseFloor | None
    residual: LineResidual
    heard: float = 0.0
    rival: FloatArray | None = None
    unfollowed: int = 0
    recent: tuple[Segment, ...] = ()
    coverage: Coverage = field(default_factory=Coverage)
    setup: Setup = field(default_factory=Setup)
    schedule: Schedule = field(default_factory=Schedule)
    teeth: ToothWatch = field(default_factory=ToothWatch)
    tones: ToneWatch = field(default_factory=ToneWatch)
    result: Identification | None = None
    unusable: Limitation | None = None

    @classmethod
    def initial(cls, unknowns: Unknowns) -> "State":
        """Return the state before any data."""
        return cls(
            values=unknowns.zero(),
            information=Information.none(unknowns.size),
            floor=None,
            residual=LineResidual.empty(unknowns.harmonics),
        )

    @property
    def seconds(self) -> float:
        """Motion used [s]."""
        return self.coverage.time

    @property
    def relative(self) -> bool:
        """Whether the torque is unknown: the scale of the indexes then is, too."""
        return self.setup.nominal_torque is not None

    @property
    def inflation(self) -> float:
        """Factor on the variances by which the model's misfit widens them."""
        return 1.0 + UNSEEN**2 * (self.residual.excess(self.coverage.span) - 1.0)

    def with_segment(self, segment: Segment, setup: Setup) -> "State":
        """Return the state with a further segment, still to be fitted."""
        recent = (*self.recent, segment)
        while sum(s.duration for s in recent[1:]) >= WINDOW:
            recent = recent[1:]
        return replace(self, recent=recent, coverage=self.coverage.plus(segment), setup=setup, unusable=None)

    def restarted(self) -> "State":
        """Return the state without what was learnt of the segments, as all those kept are fitted again."""
        return replace(
            self,
            information=Information.none(self.values.size),
            heard=0.0,
            schedule=replace(self.schedule, restarted=self.seconds),
        )

    def aged(self, duration: float, memory: float) -> "State":
        """Return the state `duration` [s] of motion later; evidence fades with the time constant `memory` [s]."""
        keep = math.exp(-duration / memory)
        return replace(
            self,
            information=self.information.faded(keep),
            heard=keep * self.heard,
            floor=None if self.floor is None else self.floor.faded(keep),
            residual=self.residual.faded(keep),
            teeth=self.teeth.faded(keep),
            tones=self.tones.faded(keep),
        )
