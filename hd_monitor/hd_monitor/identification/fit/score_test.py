"""Do the data contradict what was given: natural frequency, damping, torque, the agreement of the clocks?"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...arrays import BoolArray, FloatArray
from .information import Information


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ScoreTest:
    """What the data alone say of one unknown, all fitted unknowns being free.

    Attributes
    ----------
    value : float
        The value favoured by the data, to first order; 0 is the one given.
    std : float
        Its standard deviation; inf where the data say nothing.
    response : ndarray, shape (unknowns,)
        By how much the best values of the fitted unknowns change per unit of this one.
    """

    value: float
    std: float
    response: FloatArray

    @property
    def significance(self) -> float:
        """Distance from the given value in standard deviations."""
        return abs(self.value) / self.std


def score_tests(
    places: Sequence[int], information: Information, values: FloatArray, active: BoolArray, given_std: FloatArray
) -> dict[int, ScoreTest]:
    """Efficient score tests of some unknowns.

    Parameters
    ----------
    places : sequence of int
        Their places.
    information : Information
        All evidence and the prior information.
    values : ndarray, shape (unknowns,)
        The best values of the unknowns fitted, the given ones of the others.
    active : ndarray of bool, shape (unknowns,)
        Unknowns that were fitted.
    given_std : ndarray, shape (unknowns,)
        Standard deviations of the unknowns in the prior information; that of the one in question has no say.
    """
    score = information.score(values)
    idle = [place for place in places if not active[place]]
    sets = [(active, idle)] if idle else []  # all those that were not fitted are tested against the same ones
    for place in places:
        if active[place]:
            others = active.copy()
            others[place] = False
            sets.append((others, [place]))
    found = {}
    for others, some in sets:
        coupling = information.matrix[np.ix_(others, some)]
        projections = np.linalg.lstsq(information.matrix[np.ix_(others, others)], coupling, rcond=1e-13)[0]
        for place, projection in zip(some, projections.T, strict=True):
            response = np.zeros(values.size)
            response[others] = -projection
            weight = 1.0 / float(given_std[place]) ** 2
            weighed = float(information.matrix[place] @ response + information.matrix[place, place]) - weight
            if weighed <= 1e-6 * weight:
                found[place] = ScoreTest(value=0.0, std=math.inf, response=response)
                continue
            slope = float(score[place] + response @ score) + weight * float(values[place])
            found[place] = ScoreTest(
                value=float(values[place]) + slope / weighed, std=1.0 / math.sqrt(weighed), response=response
            )
    return found
