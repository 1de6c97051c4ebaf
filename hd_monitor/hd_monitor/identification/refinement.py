"""Do the data contradict what was given: natural frequency, damping, torque, the agreement of the clocks?"""

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from .knowledge import Knowledge

FloatArray = npt.NDArray[np.float64]
BoolArray = npt.NDArray[np.bool_]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Score:
    """What the data alone say of one unknown, all fitted unknowns being free.

    Attributes
    ----------
    value : float
        The value that the data ask for, to first order; 0 is the one given.
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


def score(place: int, knowledge: Knowledge, values: FloatArray, active: BoolArray, given_std: float) -> Score:
    """Efficient score of one unknown.

    Parameters
    ----------
    place : int
        Where it stands.
    knowledge : Knowledge
        All evidence and the prior knowledge.
    values : ndarray, shape (unknowns,)
        The best values of the unknowns fitted, the given ones of the others.
    active : ndarray of bool, shape (unknowns,)
        Unknowns that were fitted.
    given_std : float
        Standard deviation of this unknown in the prior knowledge; it has no say here.
    """
    others = active.copy()
    others[place] = False
    gradient = knowledge.gradient(values)
    coupling = knowledge.information[others, place]
    projection = np.linalg.lstsq(knowledge.information[np.ix_(others, others)], coupling, rcond=1e-13)[0]
    response = np.zeros(values.size)
    response[others] = -projection
    weight = 1.0 / given_std**2
    information = float(knowledge.information[place, place] - coupling @ projection) - weight
    if information <= 1e-6 * weight:
        return Score(value=0.0, std=math.inf, response=response)
    slope = float(gradient[place] - projection @ gradient[others]) + weight * float(values[place])
    return Score(value=float(values[place]) + slope / information, std=1.0 / math.sqrt(information), response=response)
