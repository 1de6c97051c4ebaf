"""The two splines' shares from joint states alone: motor effort or velocity as the vibration signal."""

import math
from collections import deque
from collections.abc import Iterator, Sequence
from functools import partial
from typing import NamedTuple

import numpy as np

from ...acquisition.record import JointSamples
from ...arrays import FloatArray
from ...limitation import Limitation, LimitationCode, blocker, doubt
from ...orders.joint_segment import ONE_SPEED, JointSegment, JointSegmentCutter, one_speed
from ...orders.line_orders import LineOrders
from ...orders.pooling import SegmentPool
from ...orders.regression import solve
from ...reducer import LinePair, Mount
from ...settings import JointSettings
from ..result import Identification, LineEstimate
from ..teeth.candidates import Candidate, ToothPair, surroundings, with_neighbours
from ..teeth.ranking import FitLines
from .agreement import DirectionEvidence, by_direction, disagreements
from .teeth import question_motor, question_teeth
from .torque_share import TorqueShare, torque_shares

COHERENT = 120.0
"""Motion [s] that is added up phase by phase; what is older, or of another recording, adds up as evidence: load, pose
and temperature change the phases."""

_ENOUGH_MESSAGES = 100
_NOTABLE, _NEARLY_ALL = 0.1, 0.9  # parts of the motion that are too fast


class _Closed(NamedTuple):
    """What is kept of earlier motion."""

    evidence: tuple[DirectionEvidence, ...]
    questions: tuple[Limitation, ...]
    """Of the tooth numbers."""
    seconds: float


class SensorlessIdentifier:
    """Identifies one joint's reducer from its joint states.

    Parameters
    ----------
    settings : JointSettings
        With ``input.source`` ``joint_effort`` or ``joint_velocity``.
    known : sequence of tuple of DirectionEvidence
        Evidence of earlier motion of this reducer, the oldest first.

    Notes
    -----
    The lines are sought in the position of the same message, so that the stamps hardly matter. Every segment (one
    direction, no stop) is whitened by a filter learnt from the joint itself and freed from friction, gravity and the
    servo's slow work by a spline in the angle that is too stiff to follow a line. Segments of one direction add up
    coherently in the absolute angle; the directions stay apart, since friction and load make them differ. Recordings,
    and what is older than `COHERENT`, add up as evidence.

    A motor current says nothing about the stiffness's size, so the indexes are relative: shares whose squares add up
    to one. A spline is named only if its line is the larger one in every direction, and found in all together.

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

    def __init__(self, settings: JointSettings, known: Sequence[tuple[DirectionEvidence, ...]] = ()) -> None:
        self._settings = settings
        reduction, (cs, fs) = settings.reducer.reduction, settings.reducer.output_orders
        motor = (reduction, 2.0 * reduction)
        orders = [LineOrders.of_pair(LinePair(cs, fs), k, motor) for k in range(1, settings.analysis.harmonics + 1)]
        self._orders = orders[0]
        self._candidates = with_neighbours(settings.reducer)
        doubled = [Candidate(teeth=teeth) for teeth in ToothPair.of(settings.reducer).doubled()]
        minimum_speed = settings.analysis.minimum_speed * 2.0 * np.pi / 60.0 / reduction
        self._cutter = JointSegmentCutter(settings.input.source, (cs, fs), minimum_speed)
        around = [surroundings(candidates, motor) for candidates in (self._candidates, doubled) if candidates]
        self._pool = SegmentPool([*orders, *around], min(settings.analysis.memory, COHERENT))
        self._closed = deque(_Closed(pieces, (), _seconds(pieces)) for pieces in known)
        self._messages = 0
        self._usable = 0
        self._latest: Identification | None = None
        self._directions: tuple[DirectionEvidence, ...] = ()
        self._stale = bool(self._closed)
        self._forget()

    def change(self, settings: JointSettings) -> None:
        """Put other limits in force."""
        self._settings = settings
        self._stale = True

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

    def cut(self) -> None:
        """End a recording: what follows adds up with it as evidence, not phase by phase."""
        self.finish()
        self._close()

    def _append(self, segment: JointSegment) -> None:
        self._stale = True
        self._pool.add(segment)
        if self._settings.analysis.memory > COHERENT <= self._pool.seconds:
            self._close()

    def _close(self) -> None:
        """Keep the evidence of the motion pooled so far, and forget what is older than the memory."""
        if evidence := tuple(self._present()):
            self._closed.append(_Closed(evidence, self._questioned_teeth(), self._pool.seconds))
        self._pool.clear()
        self._forget()

    def _forget(self) -> None:
        held = sum(closed.seconds for closed in self._closed)
        while self._closed and held - self._closed[0].seconds >= self._settings.analysis.memory:
            held -= self._closed.popleft().seconds

    def _present(self) -> Iterator[DirectionEvidence]:
        """Evidence of the motion in the pool, pair by pair, direction by direction."""
        for number in range(self._settings.analysis.harmonics):
            for group in self._pool.fits(number):
                yield DirectionEvidence.of(group, self._settings.diagnosis.both_ratio, number + 1)

    def _identify(self) -> Identification | None:
        """Identify from all evidence; the latest result stays where it does not determine the pair."""
        settings, reducer = self._settings, self._settings.reducer
        present = tuple(self._present())
        evidence = (*(piece for closed in self._closed for piece in closed.evidence), *present)
        first = [piece for piece in evidence if piece.k == 1]
        self._directions = by_direction(first)
        if not first:
            segments = self._pool.segments
            if segments and all(np.ptp(segment.values) == 0.0 for segment in segments):
                return Identification.none((blocker(LimitationCode.SIGNAL_CONSTANT),), relative=True)
            return self._latest
        mean, covariance = _mean_amplitudes(self._directions)
        total = float(np.hypot(*mean))
        # Shares cos(angle) and sin(angle): their errors are those of the angle alone.
        across = np.array([mean[1], -mean[0]]) / total**2
        angle_std = float(np.sqrt(across @ covariance @ across))
        index = LinePair(*(mean / total).tolist())
        strongest = max(first, key=lambda piece: math.hypot(*piece.amplitude) / math.hypot(*piece.std))
        cs, fs = np.array(index) * np.exp(1j * np.array(strongest.phase))
        noise = float(np.mean([piece.noise**2 for piece in first]))
        return Identification(
            circular_spline=np.array([cs]),
            flexspline=np.array([fs]),
            index=index,
            index_std=LinePair(index.flexspline * angle_std, index.circular_spline * angle_std),
            index_correlation=-1.0,
            relative=True,
            lines=tuple(_lines(evidence)),
            travel=max(self._travel, *(piece.travel for piece in first)),
            samples=sum(piece.samples for piece in first),
            signal_to_noise=10.0 * math.log10(0.5 * total**2 / noise),
            misfit=float(np.mean([piece.floor for piece in first])),
            limitations=(
                *self._doubts(index, first),
                *self._all_questions(present),
                *disagreements(first, reducer.output_orders, settings.diagnosis),
            ),
            load_fluctuation=math.nan,
            evidence=present,
            torque_shares=self._torque_shares(),
        )

    def _torque_shares(self) -> tuple[TorqueShare, ...]:
        """How much of the first pair follows the torque, where the newest motion shows both."""
        if self._settings.input.source != "joint_effort":
            return ()
        return torque_shares(self._pool.fits(0), self._orders, self._pool.coefficients)

    def _all_questions(self, present: Sequence[DirectionEvidence]) -> tuple[Limitation, ...]:
        """Questions about the teeth from the newest motion that raises any."""
        own = self._questioned_teeth() if present else ()
        return next((questions for questions in (own, *(c.questions for c in reversed(self._closed))) if questions), ())

    @property
    def _travel(self) -> float:
        """Range of the output angle in the pool [rad]."""
        angles = [segment.angle for segment in self._pool.segments]
        return float(np.ptp(np.concatenate(angles))) if angles else 0.0

    def _questioned_teeth(self) -> tuple[Limitation, ...]:
        """Limit the result if other tooth numbers than those given, near them or doubled, may be the right ones."""
        given = self._settings.reducer
        near, doubled = (self._parts(self._settings.analysis.harmonics + place) for place in (0, 1))
        steady = math.isfinite(one_speed(self._pool.segments))
        reasons = question_teeth(given, self._candidates, near, travel=self._travel, one_speed=steady)
        return reasons or question_motor(given, [*near, *doubled])

    def _parts(self, number: int) -> list[FitLines]:
        """One function a direction that fits lines to it, for one set of orders by its number; none without it."""
        return [partial(solve, products) for _, _, products in self._pool.groups(number)]

    def _doubts(self, index: LinePair, evidence: Sequence[DirectionEvidence]) -> Iterator[Limitation]:
        """Doubts beside the name that the shares suggest, apart from the evidence itself."""
        reducer = self._settings.reducer
        # The line of the spline that stands still has exactly the order 2 of the wave generator.
        at_order_two = index.circular_spline if reducer.mount is Mount.CIRCULAR_SPLINE_FIXED else index.flexspline
        if at_order_two == max(index):
            yield doubt(LimitationCode.MOTOR_SHARES_LINE)
        speed = one_speed(self._pool.segments)
        if math.isfinite(speed) and all(abs(piece.speed - speed) < ONE_SPEED * speed for piece in evidence):
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


def _lines(evidence: Sequence[DirectionEvidence]) -> Iterator[LineEstimate]:
    """Amplitudes of every pair, root-mean-square over the directions."""
    for k in sorted({piece.k for piece in evidence}):
        mean, covariance = _mean_amplitudes(by_direction([piece for piece in evidence if piece.k == k]))
        std = np.sqrt(np.diag(covariance))
        yield LineEstimate(k=k, amplitude=LinePair(*mean.tolist()), std=LinePair(*std.tolist()))


def _seconds(pieces: Sequence[DirectionEvidence]) -> float:
    """Motion behind pieces of evidence [s]."""
    return sum(piece.seconds for piece in pieces if piece.k == 1)


def _mean_amplitudes(directions: Sequence[DirectionEvidence]) -> tuple[FloatArray, FloatArray]:
    """Root-mean-square amplitudes (2,) over the directions, bias from noise removed, and their covariance (2, 2).

    Where both lines are smaller than their bias, the bias stays: nothing else distinguishes them.
    """
    amplitudes = np.array([direction.amplitude for direction in directions])
    bias = 2.0 * np.array([direction.std for direction in directions]) ** 2
    squares = np.maximum(amplitudes**2 - bias, 0.0).mean(axis=0)
    if not squares.any():
        squares = (amplitudes**2).mean(axis=0)
    covariance = np.sum([direction.covariance for direction in directions], axis=0) / len(directions) ** 2
    return np.sqrt(squares), covariance
