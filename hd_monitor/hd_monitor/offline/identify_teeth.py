"""Tooth check: do the teeth given fit the recording, and if not, which do?"""

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from ..acquisition.record import JointSamples
from ..assessment import Assessment
from ..diagnosis.tooth_ranking import ConcludedRanking
from ..identification.teeth.candidates import Candidate, every_pair
from ..identification.teeth.ranking import odds_as_pair, rank
from ..orders.joint_segment import JointSegmentCutter, one_speed, samples_of_records
from ..orders.line_orders import LineOrders
from ..orders.regression import Products, solve
from ..orders.scan import OrderScan
from ..settings import JointSettings

LONGEST = 600.0
"""Motion [s] that the check uses: more would add little, and memory stays flat."""

_APART = 10.0  # s between recordings laid end to end: no stroke continues from one to the next


def rank_tooth_pairs(
    samples: JointSamples, *, source: str = "joint_effort", minimum_speed: float = 0.03
) -> ConcludedRanking:
    """Rank all tooth pairs of `TOOTH_RANGE` by the evidence for their lines in a recording.

    Parameters
    ----------
    samples : JointSamples
    source : str
        ``'joint_effort'`` or ``'joint_velocity'``, the field that is the vibration signal.
    minimum_speed : float
        Output speed [rad/s] below which the joint counts as standing.

    Notes
    -----
    The orders per output revolution are the tooth numbers themselves in both mounts, so the ranking cannot tell the
    mount. Pairs that share a line, as 198/200 and 200/202 do, are distinguished only if both lines stand out.
    """
    pairs = every_pair()
    lowest = LineOrders.of_pair(pairs[0].lines(0.5)).reference_orders.min()
    highest = LineOrders.of_pair(pairs[-1].lines()).reference_orders.max()
    orders = np.arange(max(math.floor(lowest), 2), math.ceil(highest) + 1)
    cutter = JointSegmentCutter(source, (pairs[0].flexspline, pairs[-1].circular_spline), minimum_speed)
    segments = cutter.add(samples) + cutter.finish()
    scan = OrderScan(segments, orders)
    travel = float(np.ptp(np.concatenate([segment.angle for segment in segments]))) if segments else 0.0
    multiples = [(0.5, *range(2, int(orders[-1] // pair.circular_spline) + 1)) for pair in pairs]
    wanted = [Candidate(teeth=pair, further=more) for pair, more in zip(pairs, multiples, strict=True)]

    def ranked(parts: Sequence[Products]) -> ConcludedRanking:
        fits = [partial(solve, part) for part in parts]
        found = rank(wanted, fits).ranked
        as_pair = odds_as_pair(found[0].teeth, fits) if found[0].lines_found else 0.0
        return ConcludedRanking(ranked=found, as_pair=as_pair, travel=travel, speed=one_speed(segments))

    rankings = [ranked(scan.by_direction())]
    if not rankings[0].conclusive and any(found.lines_found for found in rankings[0].ranked):
        # Amplitudes and phases that change with the speed, as near a resonance, do not add up over segments.
        parts = scan.by_parts()
        rankings += [ranked(parts)] if parts else []
    return max(rankings, key=lambda ranking: (ranking.conclusive, ranking.ranked[0].log_evidence))


class ToothCheck:
    """Gathers a joint's motion over recordings and ranks candidate tooth pairs.

    Parameters
    ----------
    settings : JointSettings
    """

    def __init__(self, settings: JointSettings) -> None:
        self._sensorless = settings.sensorless
        self._source = settings.input.source if settings.sensorless else "joint_effort"
        self._minimum_speed = settings.analysis.minimum_speed * math.tau / 60.0 / settings.reducer.reduction
        self._parts: list[JointSamples] = []
        self._end = 0.0
        self._offset = 0.0
        self.seconds = 0.0

    def add(self, assessment: Assessment) -> None:
        """Take what an assessment looked at."""
        if self.seconds >= LONGEST:
            return
        if self._sensorless:
            if assessment.joint_samples is not None and len(assessment.joint_samples):
                self._append(assessment.joint_samples)
            return
        for record in assessment.records:
            if len(record) and float(np.abs(record.speed).max()) >= self._minimum_speed:
                self._append(samples_of_records([record]))

    def cut(self) -> None:
        """End a recording."""
        self._offset = self._end + _APART

    def ranking(self) -> ConcludedRanking | None:
        """Return the candidate pairs by falling evidence; None if there was no motion."""
        if not self._parts:
            return None
        columns = ("times", "angle", "speed", "effort")
        gathered = {name: np.concatenate([getattr(part, name) for part in self._parts]) for name in columns}
        return rank_tooth_pairs(JointSamples(**gathered), source=self._source, minimum_speed=self._minimum_speed)

    def _append(self, samples: JointSamples) -> None:
        if samples.times[0] + self._offset < self._end:  # the stamps were set back, or the next recording began
            self._offset = self._end + _APART - float(samples.times[0])
        times = samples.times + self._offset
        self._end = float(times[-1])
        self.seconds += float(np.ptp(times))
        self._parts.append(replace(samples, times=times))
