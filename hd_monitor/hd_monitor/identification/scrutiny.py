"""What weakens an identification, and what forbids naming a part on it: in words for a technician."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ..model.parameters import Dynamics
from ..settings import JointSettings
from .coverage import Coverage
from .indexes import Indexes
from .refinement import Score
from .unknowns import Unknowns

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class Findings:
    """Doubts and blockers, see :class:`hd_monitor.identification.result.Identification`."""

    doubts: tuple[str, ...] = ()
    blockers: tuple[str, ...] = ()


class Scrutiny:
    """Examines results.

    Parameters
    ----------
    settings : JointSettings
    """

    def __init__(self, settings: JointSettings) -> None:
        self._reducer = settings.reducer
        self._warn: float = settings["diagnosis.warn_index"]

    def examine(
        self,
        *,
        unknowns: Unknowns,
        values: FloatArray,
        indexes: Indexes,
        scores: Mapping[int, Score],
        active: npt.NDArray[np.bool_],
        inflation: float,
        coverage: Coverage,
        given: Dynamics,
        relative: bool,
    ) -> Findings:
        """Return what is doubtful about a result."""
        return Findings()
