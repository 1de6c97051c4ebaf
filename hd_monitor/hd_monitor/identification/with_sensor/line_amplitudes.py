"""Line amplitudes of the newest segments, by known-order regression in the joint's angle."""

import math
from collections.abc import Sequence

import numpy as np

from ...orders.regression import solve_normal
from ...reducer import LinePair, Reducer
from ..fit.multistart import newest_segments
from ..fit.noise import NoiseFloor
from ..result import LineEstimate
from ..segment.path import powers
from ..segment.segment import Segment

_SIDE_TRAVEL = 0.55 * math.tau  # rad of travel from which the lines between and beside a pair are fitted too


def measure_lines(
    recent: Sequence[Segment], reducer: Reducer, harmonics: int, floor: NoiseFloor
) -> tuple[LineEstimate, ...]:
    """Amplitudes of θ'' [rad/s²] of the line pairs k = 1 … harmonics over the newest segments.

    Pairs above what the sampling rate shows are left out, and all of them where the travel does not separate them.
    Where it allows that, the lines that load fluctuations and the coupling of the two splines put between and beside
    a pair are fitted along, so that they are not mistaken for it.

    Parameters
    ----------
    recent : sequence of Segment
        In the order of time.
    reducer : Reducer
    harmonics : int
    floor : NoiseFloor
        From which the standard deviations follow.
    """
    newest = newest_segments(recent)
    angle = np.concatenate([s.angle[s.used] for s in newest])
    values = np.concatenate([(s.acceleration - s.slow @ (s.slow.T @ s.acceleration))[s.used] for s in newest])
    top_speed = max(float(np.abs(s.speed).max()) for s in newest)
    mean_speed = float(np.mean([np.abs(s.speed).mean() for s in newest]))
    lowest_order, highest_order = reducer.output_orders
    seen = math.floor(min(s.highest_frequency for s in newest) * math.tau / (highest_order * top_speed + 1e-9))
    pairs = range(1, min(harmonics, seen) + 1)
    if not pairs:
        return ()
    gap = highest_order - lowest_order
    places = [place for k in pairs for place in ((k, 0), (k, k))]  # (k, m): k times the lowest order, m gaps above
    if float(np.ptp(angle)) > _SIDE_TRAVEL:
        places += [(k, m) for k in pairs for m in range(-1, k + 2) if m not in (0, k)]
    orders = [k * lowest_order + m * gap for k, m in places]
    base, side = (powers(np.exp(1j * order * angle), len(pairs) + 1) for order in (lowest_order, gap))
    phase = np.stack([base[k] * (side[m] if m >= 0 else side[-m].conj()) for k, m in places])
    columns = np.concatenate([phase.real, -phase.imag, values[None]])
    fit = solve_normal(columns @ columns.T, np.arange(2 * len(places)))
    if fit is None:
        return ()
    solution, inverse = fit
    phasors = solution[: len(orders)] + 1j * solution[len(orders) :]
    own = inverse.diagonal()[: len(orders)]
    noise = floor.sample_std(np.maximum(np.asarray(orders) * mean_speed / math.tau, 1.0), newest[0].period)
    amplitude, std = np.abs(phasors), noise * np.sqrt(own)
    return tuple(
        LineEstimate(
            k=k,
            amplitude=LinePair(float(amplitude[2 * k - 2]), float(amplitude[2 * k - 1])),
            std=LinePair(float(std[2 * k - 2]), float(std[2 * k - 1])),
        )
        for k in pairs
    )
