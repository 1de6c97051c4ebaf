"""Whether joint states leave the tooth numbers given standing: what advice needs, and what forbids a name."""

import math
from collections.abc import Sequence

from ...limitation import Limitation, LimitationCode, blocker
from ...reducer import Reducer
from ..teeth.candidates import Candidate, ToothPair
from ..teeth.ranking import MARGIN, FitLines, contradiction, odds_as_pair, rank

BETTER_TEETH = math.log(1e4)
"""Difference of log evidence, odds of 10 000 to 1, by which other teeth must lead; several are compared."""

CATALOGUE_PRIOR = 2.0 * BETTER_TEETH
"""Log odds, before any data, of a pair that catalogues list against a neighbour that none lists: 198/200 or 201/203
are typing errors for 200/202, not reducers."""


def question_teeth(
    given: Reducer, candidates: Sequence[Candidate], parts: Sequence[FitLines], *, travel: float, one_speed: bool
) -> tuple[Limitation, ...]:
    """Return why the teeth given forbid a name, if they do.

    Parameters
    ----------
    given : Reducer
    candidates : sequence of Candidate
        The pair given and those near it.
    parts : sequence of callable
        Fit lines to each direction.
    travel : float
        Range of the output angle [rad].
    one_speed : bool
        Whether all motion was at one speed, where a machine's tone looks like a line.

    Notes
    -----
    Lines closer than one cycle over the travel form one hump, whose shape, on a real joint, is not that of two
    constant lines: a pair that near is never advice, and does not rule out one that catalogues list.
    """
    own = ToothPair.of(given)
    found = {one.teeth: one for one in rank(candidates, parts).ranked}
    if not math.isfinite(found[own].log_evidence):
        return ()
    odds = {teeth: one.log_evidence + CATALOGUE_PRIOR * teeth.is_in_catalogue for teeth, one in found.items()}
    best, *others = sorted(found, key=lambda teeth: -odds[teeth])
    is_apart = {teeth: abs(teeth.flexspline - own.flexspline) * travel > math.tau for teeth in found}
    certain = (
        best != own
        and odds[best] - odds[own] >= BETTER_TEETH
        and odds[best] - odds[others[0]] >= MARGIN
        and is_apart[best]
        and found[best].lines_found == 2
        and odds_as_pair(best, parts) >= MARGIN
        and odds_as_pair(own, parts) < MARGIN
        and not one_speed
        and not best.is_beside_encoder
    )
    if certain:
        return (contradiction(given, best, found[best].lines),)
    for teeth in (best, *others):
        listed_instead = teeth.is_in_catalogue and not own.is_in_catalogue
        likelier = odds[teeth] - odds[own] >= BETTER_TEETH or (listed_instead and not is_apart[teeth])
        if teeth != own and found[teeth].lines_found and likelier:
            code = LimitationCode.TEETH_AMBIGUOUS
            return (blocker(code, given=str(own), other=str(teeth), travel_deg=math.degrees(travel)),)
    return ()


def question_motor(given: Reducer, parts: Sequence[FitLines]) -> tuple[Limitation, ...]:
    """Return why a name is forbidden where the only line is once per revolution of another reducer's motor.

    That reducer has about twice the teeth, and both of its lines stand out.
    """
    own = ToothPair.of(given)
    lines = rank([Candidate(teeth=own)], parts).ranked[0].lines
    doubled = [Candidate(teeth=teeth) for teeth in own.doubled()]
    if len(lines) != 1 or not doubled:
        return ()
    for found in rank(doubled, parts).ranked:
        if found.lines_found == 2 and any(2.0 * lines[0] == order for order in found.teeth):
            names = {"given": str(own), "other": str(found.teeth)}
            return (blocker(LimitationCode.MOTOR_LINE, order=lines[0], **names),)
    return ()
