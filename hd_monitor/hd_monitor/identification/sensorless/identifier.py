"""The two splines' shares from joint states alone: motor effort or velocity as the vibration signal."""

import math
from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ...acquisition.record import JointSamples
from ...arrays import FloatArray
from ...orders.gram import Gram, PairOrders, gram_of_segment, residual_of_segment
from ...orders.joint_segment import JointSegment, JointSegmentCutter, one_speed
from ...orders.pair import PairEstimate, estimate_pair
from ...orders.whitening import learn_whitening
from ...reducer import LinePair
from ...settings import JointSettings
from ..limitation import Limitation, LimitationCode
from ..result import Identification, LineEstimate
from .agreement import DirectionEvidence, other_teeth, reasons_against_naming
from .doubts import STILL, complaints_about, doubts_about

LEAST_SHARE = 0.1
"""Part of the motion that a direction must have to be heard."""

NEIGHBOURS = (-4, -3, -2, -1, 1, 2, 3, 4)
"""Differences of other tooth numbers that are watched from those given."""

RELEARN = 3.0
"""Growth of the data after which the background is learnt anew."""


@dataclass(slots=True, eq=False)
class _Pooled:
    """A segment with its sums for every pair, k = 1 first; None where the pair is too fast for the sampling rate."""

    segment: JointSegment
    grams: list[Gram | None]


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

    A motor current tells nothing of the stiffness's size, so the indexes are relative: shares whose squares add up to
    one. A spline is named only if its line is found in every direction and is the larger one in each of them.

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
        self._reducer = settings.reducer
        self._memory = settings.analysis.memory
        self._ratio = settings.diagnosis.both_ratio
        self._confidence = settings.diagnosis.confidence
        reduction = self._reducer.reduction
        cs, fs = self._reducer.output_orders
        motor = (reduction, 2.0 * reduction)
        self._harmonics = range(1, settings.analysis.harmonics + 1)
        self._orders = [PairOrders.around(LinePair(cs, fs), k, motor) for k in self._harmonics]
        # Teeth near those given share a line with them, or lie where travel does not part them: they are watched, too.
        self._neighbours = [LinePair(cs + shift, fs + shift) for shift in NEIGHBOURS]
        self._orders += [PairOrders.around(pair, 1, motor) for pair in self._neighbours]
        minimum_speed = settings.analysis.minimum_speed * 2.0 * np.pi / 60.0 / reduction
        self._cutter = JointSegmentCutter(settings.input.source, (cs, fs), minimum_speed)
        self._pooled: deque[_Pooled] = deque()
        self._coefficients = np.ones(1)
        self._learnt = 0.0
        self._seen = 0.0
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
        """Return what the segments seen so far tell, or None before the first one."""
        if self._stale:
            self._latest = self._identify()
            self._stale = False
        if self._latest is None:
            complaints = complaints_about(
                self._settings.input.source, messages=self._messages, usable=self._usable, too_fast=self._too_fast
            )
            return self._nothing(complaints) if complaints else None
        return self._latest

    def finish(self) -> Identification | None:
        """Use the segment that is still open, and return what everything seen tells."""
        for segment in self._cutter.finish():
            self._append(segment)
        return self.estimate()

    # Pooling -------------------------------------------------------------------------------------------------------

    def _append(self, segment: JointSegment) -> None:
        self._stale = True
        self._seen += segment.duration
        self._pooled.append(_Pooled(segment, []))
        held = sum(pooled.segment.duration for pooled in self._pooled)
        while len(self._pooled) > 1 and held - self._pooled[0].segment.duration >= self._memory:
            held -= self._pooled.popleft().segment.duration
        due = RELEARN * self._learnt if self._learnt < self._memory else self._learnt + self._memory
        if self._seen >= due:
            self._learnt = self._seen
            residuals = [residual_of_segment(pooled.segment, self._orders[0]) for pooled in self._pooled]
            self._coefficients = learn_whitening(residuals)
            for pooled in self._pooled:
                pooled.grams = self._grams(pooled.segment)
        else:
            self._pooled[-1].grams = self._grams(segment)

    def _grams(self, segment: JointSegment) -> list[Gram | None]:
        return [gram_of_segment(segment, orders, self._coefficients) for orders in self._orders]

    def _groups(self) -> Iterator[tuple[str, list[_Pooled]]]:
        """Segments that are pooled coherently: by direction, or by time if there is one direction only."""
        names = {1: "forward", -1: "reverse"}
        heard = [pooled for pooled in self._pooled if pooled.grams[0] is not None]
        total = sum(pooled.segment.values.size for pooled in heard)
        by_direction = {sign: [pooled for pooled in heard if pooled.segment.direction == sign] for sign in names}
        kept = {
            sign: group
            for sign, group in by_direction.items()
            if sum(pooled.segment.values.size for pooled in group) >= max(LEAST_SHARE * total, 1)
        }
        for sign, group in kept.items():
            if len(kept) == 2 or len(group) < 2:
                yield names[sign], group
            else:
                half = len(group) // 2
                yield f"{names[sign]}, first half", group[:half]
                yield f"{names[sign]}, second half", group[half:]

    # Results -------------------------------------------------------------------------------------------------------

    def _identify(self) -> Identification | None:
        groups = list(self._groups())
        estimates = [
            (name, group, estimate)
            for name, group in groups
            if (estimate := self._estimate_group(group, 0)) is not None
        ]
        self._directions = tuple(
            DirectionEvidence.of(name, estimate, self._ratio, len(group)) for name, group, estimate in estimates
        )
        if not estimates:
            still = all(np.ptp(pooled.segment.values) == 0.0 for pooled in self._pooled)
            return self._nothing((STILL,)) if still else self._latest
        pairs = [estimate for _, _, estimate in estimates]
        mean, covariance = _mean_amplitudes(pairs)
        total = float(np.hypot(*mean))
        # Shares cos(angle) and sin(angle): their errors are those of the angle alone.
        across = np.array([mean[1], -mean[0]]) / total**2
        angle_std = float(np.sqrt(across @ covariance @ across))
        cs, fs = mean / total
        strongest = max(pairs, key=lambda pair: pair.explained)
        phases = strongest.phasors / np.maximum(np.abs(strongest.phasors), 1e-300)
        noise = float(np.mean([pair.noise**2 for pair in pairs]))
        angles = np.concatenate([pooled.segment.angle for _, group, _ in estimates for pooled in group])
        return Identification(
            circular_spline=np.array([cs * phases[0]]),
            flexspline=np.array([fs * phases[1]]),
            index=LinePair(float(cs), float(fs)),
            index_std=LinePair(float(fs) * angle_std, float(cs) * angle_std),
            index_correlation=-1.0,
            relative=True,
            lines=self._lines(groups, pairs),
            travel=float(np.ptp(angles)),
            samples=sum(pair.rows for pair in pairs),
            signal_to_noise=10.0 * float(np.log10(0.5 * total**2 / noise)),
            misfit=float(np.mean([pair.floor for pair in pairs])),
            limitations=_said(
                False,
                doubts_about(
                    LinePair(float(cs), float(fs)),
                    self._reducer,
                    one_speed=one_speed(pooled.segment for pooled in self._pooled),
                    too_fast=self._too_fast,
                ),
            )
            + _said(True, self._other_teeth(groups, pairs))
            + _said(True, reasons_against_naming(self._directions, self._reducer.output_orders, self._confidence)),
            load_fluctuation=math.nan,
        )

    def _lines(self, groups: list[tuple[str, list[_Pooled]]], first: list[PairEstimate]) -> tuple[LineEstimate, ...]:
        """Amplitudes of every pair, root-mean-square over the directions; the first pair's estimates are there."""
        lines = []
        for number in range(len(self._harmonics)):
            pairs = first if number == 0 else self._estimates(groups, number)
            if pairs:
                mean, covariance = _mean_amplitudes(pairs)
                std = np.sqrt(np.diag(covariance))
                lines.append(
                    LineEstimate(
                        k=number + 1,
                        amplitude=LinePair(*mean.tolist()),
                        std=LinePair(*std.tolist()),
                    )
                )
        return tuple(lines)

    def _estimates(self, groups: list[tuple[str, list[_Pooled]]], number: int) -> list[PairEstimate]:
        found = (self._estimate_group(group, number) for _, group in groups)
        return [estimate for estimate in found if estimate is not None]

    def _estimate_group(self, group: list[_Pooled], number: int) -> PairEstimate | None:
        grams = [gram for pooled in group if (gram := pooled.grams[number]) is not None]
        return estimate_pair(grams, self._orders[number])

    def _other_teeth(self, groups: list[tuple[str, list[_Pooled]]], own: list[PairEstimate]) -> tuple[str, ...]:
        """Say which tooth numbers near those given fit better; empty if none do."""
        given = sum(estimate.log_evidence for estimate in own)
        rivals = []
        for number, pair in enumerate(self._neighbours, start=len(self._harmonics)):
            found = self._estimates(groups, number)
            if len(found) == len(own):
                rivals.append((sum(estimate.log_evidence for estimate in found) - given, pair, found))
        if not rivals:
            return ()
        lead, pair, found = max(rivals, key=lambda rival: rival[0])
        return other_teeth(lead, pair, [estimate.chance for estimate in found], self._reducer.output_orders)

    @property
    def _too_fast(self) -> float:
        """Part of the motion that was too fast for the rate of the joint states."""
        return self._cutter.too_fast / self._cutter.turning if self._cutter.turning > 0.0 else 0.0

    @staticmethod
    def _nothing(reasons: tuple[str, ...]) -> Identification:
        nothing = np.zeros(0, dtype=np.complex128)
        return Identification(
            circular_spline=nothing,
            flexspline=nothing,
            index=LinePair(0.0, 0.0),
            index_std=LinePair(float("inf"), float("inf")),
            relative=True,
            limitations=_said(True, reasons),
            load_fluctuation=math.nan,
        )


def _said(blocks: bool, texts: tuple[str, ...]) -> tuple[Limitation, ...]:
    return tuple(Limitation(code=LimitationCode.OTHER, blocks=blocks, values={"text": text}) for text in texts)


def _mean_amplitudes(pairs: list[PairEstimate]) -> tuple[FloatArray, FloatArray]:
    """Root-mean-square amplitudes (2,) over the directions, bias from noise removed, and their covariance (2, 2).

    Where both lines are smaller than their bias, the bias stays: there is nothing else to tell them apart by.
    """
    squares, covariance = np.zeros(2), np.zeros((2, 2))
    for pair in pairs:
        amplitude = np.array(pair.amplitude)
        bias = np.diag(pair.covariance).reshape(2, 2).sum(axis=0)
        squares += np.maximum(amplitude**2 - bias, 0.0) / len(pairs)
        covariance += pair.amplitude_covariance / len(pairs)
    if not squares.any():
        squares = np.mean([np.square(pair.amplitude) for pair in pairs], axis=0)
    mean = np.sqrt(squares)
    return mean, covariance / len(pairs)
