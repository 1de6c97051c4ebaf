"""The two splines' shares from joint states alone: motor effort or velocity as the vibration signal."""

import math
from collections.abc import Iterator, Sequence
from functools import partial

import numpy as np

from ...acquisition.record import JointSamples
from ...arrays import FloatArray
from ...limitation import Limitation, LimitationCode, blocker, doubt
from ...orders.joint_segment import JointSegment, JointSegmentCutter, one_speed
from ...orders.line_orders import LineOrders
from ...orders.pooling import SegmentPool
from ...orders.regression import LineFit, solve
from ...reducer import LinePair, Mount
from ...settings import JointSettings
from ..result import Identification, LineEstimate
from ..teeth.candidates import Candidate, ToothPair, surroundings, with_neighbours
from ..teeth.ranking import FitLines
from .agreement import DirectionEvidence, disagreements
from .teeth import question_motor, question_teeth

_ENOUGH_MESSAGES = 100
_NOTABLE, _NEARLY_ALL = 0.1, 0.9  # parts of the motion that are too fast


class SensorlessIdentifier:
    """Identifies one joint's reducer from its joint states.

    Parameters
    ----------
    settings : JointSettings
        With ``input.source`` ``joint_effort`` or ``joint_velocity``.

    Notes
    -----
    The lines are sought in the position of the same message, so that the stamps hardly matter. Every segment (one
    direction, no stop) is whitened by a filter learnt from the joint itself and freed from friction, gravity and the
    servo's slow work by a spline in the angle that is too stiff to follow a line. Segments of one direction add up
    coherently in the absolute angle; the directions stay apart, since friction and load make them differ.

    A motor current says nothing about the stiffness's size, so the indexes are relative: shares whose squares add up
    to one. A spline is named only if its line is found in every direction and is the larger one in each of them.

    Examples
    --------
    >>> import numpy as np
    >>> settings = JointSettings.from_mapping({"input.source": "joint_effort"})
    >>> identifier = SensorlessIdentifier(settings)
    >>> t = np.arange(0.0, 40.0, 0.01)
    >>> angle = 1.5 * np.sin(0.6 * t)
    >>> effort = 5.0 * np.sin(angle) + 2.0 * np.sign(np.cos(0.6 * t)) + 0.3 * np.cos(160 * angle)
    >>> effort += 0.1 * np.random.default_rng(1).standard_normal(t.size)
    >>> identifier.add(JointSamples(times=t, angle=angle, speed=0.9 * np.cos(0.6 * t), effort=effort))
    >>> found = identifier.estimate()
    >>> round(found.lines[0].amplitude.circular_spline, 1), found.index.circular_spline > 0.9, found.blockers
    (0.3, True, ())
    """

    def __init__(self, settings: JointSettings) -> None:
        self._settings = settings
        reduction, (cs, fs) = settings.reducer.reduction, settings.reducer.output_orders
        motor = (reduction, 2.0 * reduction)
        orders = [LineOrders.of_pair(LinePair(cs, fs), k, motor) for k in range(1, settings.analysis.harmonics + 1)]
        self._candidates = with_neighbours(settings.reducer)
        doubled = [Candidate(teeth=teeth) for teeth in ToothPair.of(settings.reducer).doubled()]
        minimum_speed = settings.analysis.minimum_speed * 2.0 * np.pi / 60.0 / reduction
        self._cutter = JointSegmentCutter(settings.input.source, (cs, fs), minimum_speed)
        around = [surroundings(candidates, motor) for candidates in (self._candidates, doubled) if candidates]
        self._pool = SegmentPool([*orders, *around], settings.analysis.memory)
        self._messages = 0
        self._usable = 0
        self._latest: Identification | None = None
        self._directions: tuple[DirectionEvidence, ...] = ()
        self._stale = False

    @property
    def directions(self) -> tuple[DirectionEvidence, ...]:
        """The first pair direction by direction, as of the last estimate."""
        self.estimate()
        return self._directions

    def add(self, samples: JointSamples) -> None:
        """Add joint states, in the order of their stamps; how they are grouped into calls does not matter."""
        signal = samples.effort if self._settings.input.source == "joint_effort" else samples.speed
        self._messages += len(samples)
        self._usable += int(np.count_nonzero(np.isfinite(signal)))
        for segment in self._cutter.add(samples):
            self._append(segment)

    def estimate(self) -> Identification | None:
        """Return what the segments seen so far show, or None before the first one."""
        if self._stale:
            self._latest = self._identify()
            self._stale = False
        if self._latest is None:
            blockers = self._blockers_of_input()
            return Identification.none(blockers, relative=True) if blockers else None
        return self._latest

    def finish(self) -> Identification | None:
        """Use the segment that is still open, and return what all segments show."""
        for segment in self._cutter.finish():
            self._append(segment)
        return self.estimate()

    def _append(self, segment: JointSegment) -> None:
        self._stale = True
        self._pool.add(segment)

    def _identify(self) -> Identification | None:
        """Identify from the pooled segments; the latest result stays where they do not determine the pair."""
        settings, reducer = self._settings, self._settings.reducer
        groups = self._pool.fits(0)
        self._directions = tuple(DirectionEvidence.of(group, settings.diagnosis.both_ratio) for group in groups)
        if not groups:
            still = all(np.ptp(segment.values) == 0.0 for segment in self._pool.segments)
            constant = (blocker(LimitationCode.SIGNAL_CONSTANT),)
            return Identification.none(constant, relative=True) if still else self._latest
        fits = [group.fit for group in groups]
        mean, covariance = _mean_amplitudes(fits)
        total = float(np.hypot(*mean))
        # Shares cos(angle) and sin(angle): their errors are those of the angle alone.
        across = np.array([mean[1], -mean[0]]) / total**2
        angle_std = float(np.sqrt(across @ covariance @ across))
        index = LinePair(*(mean / total).tolist())
        strongest = max(fits, key=lambda fit: fit.explained)
        cs, fs = np.array(index) * strongest.phasors / np.maximum(strongest.amplitudes, 1e-300)
        angles = np.concatenate([segment.angle for group in groups for segment in group.segments])
        return Identification(
            circular_spline=np.array([cs]),
            flexspline=np.array([fs]),
            index=index,
            index_std=LinePair(index.flexspline * angle_std, index.circular_spline * angle_std),
            index_correlation=-1.0,
            relative=True,
            lines=tuple(self._lines()),
            travel=float(np.ptp(angles)),
            samples=sum(fit.rows for fit in fits),
            signal_to_noise=10.0 * float(np.log10(0.5 * total**2 / np.mean([fit.noise**2 for fit in fits]))),
            misfit=float(np.mean([fit.floor for fit in fits])),
            limitations=(
                *self._doubts(index),
                *self._questioned_teeth(float(np.ptp(angles))),
                *disagreements(self._directions, reducer.output_orders, settings.diagnosis.confidence),
            ),
            load_fluctuation=math.nan,
        )

    def _lines(self) -> Iterator[LineEstimate]:
        """Amplitudes of every pair, root-mean-square over the directions."""
        for number in range(self._settings.analysis.harmonics):
            fits = [group.fit for group in self._pool.fits(number)]
            if fits:
                mean, covariance = _mean_amplitudes(fits)
                std = np.sqrt(np.diag(covariance))
                yield LineEstimate(k=number + 1, amplitude=LinePair(*mean.tolist()), std=LinePair(*std.tolist()))

    def _questioned_teeth(self, travel: float) -> tuple[Limitation, ...]:
        """Limit the result if other tooth numbers than those given, near them or doubled, may be the right ones."""
        given = self._settings.reducer
        near, doubled = (self._parts(self._settings.analysis.harmonics + place) for place in (0, 1))
        steady = math.isfinite(one_speed(self._pool.segments))
        reasons = question_teeth(given, self._candidates, near, travel=travel, one_speed=steady)
        return reasons or question_motor(given, [*near, *doubled])

    def _parts(self, number: int) -> list[FitLines]:
        """One function a direction that fits lines to it, for one set of orders by its number; none without it."""
        return [partial(solve, products) for _, _, products in self._pool.groups(number)]

    def _doubts(self, index: LinePair) -> Iterator[Limitation]:
        """Doubts beside the name that the shares suggest, apart from the evidence itself."""
        reducer = self._settings.reducer
        # The line of the spline that stands still has exactly the order 2 of the wave generator.
        at_order_two = index.circular_spline if reducer.mount is Mount.CIRCULAR_SPLINE_FIXED else index.flexspline
        if at_order_two == max(index):
            yield doubt(LimitationCode.MOTOR_SHARES_LINE)
        speed = one_speed(self._pool.segments)
        if math.isfinite(speed):
            lower, upper = (order * speed / math.tau for order in reducer.output_orders)
            yield doubt(LimitationCode.ONE_SPEED, lower_hz=lower, upper_hz=upper)
        if self._too_fast > _NOTABLE:
            yield doubt(LimitationCode.PARTLY_TOO_FAST, share=self._too_fast)

    def _blockers_of_input(self) -> tuple[Limitation, ...]:
        """What keeps the input from ever yielding a result; empty if nothing does so far."""
        if self._messages >= _ENOUGH_MESSAGES and not self._usable:
            effort = self._settings.input.source == "joint_effort"
            field, other = ("effort", "joint_velocity") if effort else ("velocity", "joint_effort")
            return (blocker(LimitationCode.SIGNAL_MISSING, field=field, other=other),)
        return (blocker(LimitationCode.ALL_TOO_FAST),) if self._too_fast > _NEARLY_ALL else ()

    @property
    def _too_fast(self) -> float:
        """Part of the motion that was too fast for the rate of the joint states."""
        return self._cutter.too_fast / self._cutter.turning if self._cutter.turning > 0.0 else 0.0


def _mean_amplitudes(fits: Sequence[LineFit]) -> tuple[FloatArray, FloatArray]:
    """Root-mean-square amplitudes (2,) over the directions, bias from noise removed, and their covariance (2, 2).

    Where both lines are smaller than their bias, the bias stays: nothing else distinguishes them.
    """
    squares = np.mean(
        [np.maximum(f.amplitudes**2 - np.diag(f.covariance).reshape(2, 2).sum(axis=0), 0.0) for f in fits], axis=0
    )
    if not squares.any():
        squares = np.mean([f.amplitudes**2 for f in fits], axis=0)
    covariance = np.sum([f.amplitude_covariance for f in fits], axis=0) / len(fits) ** 2
    return np.sqrt(squares), covariance
