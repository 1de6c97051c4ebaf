"""Conclusion of a ranking of tooth pairs, in words for a technician."""

import math

from ..identification.teeth.ranking import Ambiguity, ToothPairRanking


def describe_ranking(ranking: ToothPairRanking) -> str:
    """Return one sentence."""
    name, travel = _named(ranking, 0), f"{math.degrees(ranking.travel):.0f}° of travel"
    match ranking.ambiguity:
        case Ambiguity.NO_MOTION:
            return (
                "No motion in which lines could show: let the joint turn faster, or publish its states at a higher rate"
            )
        case Ambiguity.NO_LINES:
            return (
                f"No tooth pair's lines stand out of the noise, not even those of {name}, which fit best: record longer"
            )
        case Ambiguity.SECOND_PAIR:
            why = f"{_named(ranking, 1)} nearly as well (odds {math.exp(ranking.margin):.0f} to 1 over {travel})"
        case Ambiguity.SINGLE_LINE:
            why = f"a single line explains {travel} nearly as well, and may be something else's"
        case Ambiguity.ONE_SPEED:
            speed = f"{ranking.speed:.2g} rad/s"
            why = f"at one speed ({speed}) a fixed frequency of the machine looks the same: vary the speed"
        case Ambiguity.ENCODER:
            why = "an encoder's own errors come at these orders too"
        case None:
            odds = (
                f"by odds of 10^{ranking.margin / math.log(10.0):.0f} to 1"
                if len(ranking.ranked) > 1
                else "being the only one"
            )
            return f"{name} teeth fit best, {odds}; the mount does not show in the lines"
    return f"{name} teeth fit best but {why}: not conclusive"


def _named(ranking: ToothPairRanking, place: int) -> str:
    teeth = ranking.ranked[place].teeth
    return f"{teeth.flexspline:g}/{teeth.circular_spline:g}"
