"""The settings of one joint's monitor, checked against the table and against each other."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

from ..errors import ParameterError
from ..model.parameters import Dynamics
from ..parameter import Value, check_all, fill_group
from ..reducer import Reducer
from .table import PARAMETERS, SENSORLESS_SOURCES


@dataclass(frozen=True, slots=True)
class JointSettings:
    """All settings of one joint, checked against the table and against each other.

    Examples
    --------
    >>> settings = JointSettings.from_mapping({"reducer.flexspline_teeth": 200, "reducer.circular_spline_teeth": 202})
    >>> settings.reducer.reduction, settings["diagnosis.both_ratio"]
    (100.0, 0.87)
    """

    values: tuple[tuple[str, Value], ...]

    @classmethod
    def from_mapping(cls, given: Mapping[str, Any] | None = None) -> Self:
        """Check dotted or nested parameters and fill in the defaults.

        Raises
        ------
        ParameterError
            If a name is unknown or a value is wrong, alone or beside the others.
        GeometryError
            If the teeth or the mount are impossible.
        """
        values = check_all(PARAMETERS, given or {}, owner="a joint")
        if values["diagnosis.error_index"] < values["diagnosis.warn_index"]:  # type: ignore[operator]
            raise ParameterError(
                f"diagnosis.error_index = {values['diagnosis.error_index']} is below diagnosis.warn_index = "
                f"{values['diagnosis.warn_index']}; an error must be worse than a warning"
            )
        if values["diagnosis.confirm_count"] > values["diagnosis.confirm_window"]:  # type: ignore[operator]
            raise ParameterError(
                f"diagnosis.confirm_count = {values['diagnosis.confirm_count']} can never be reached within "
                f"diagnosis.confirm_window = {values['diagnosis.confirm_window']} verdicts"
            )
        settings = cls(tuple(values.items()))
        settings.reducer  # noqa: B018  impossible geometry is refused here, not at the first sample
        return settings

    def __getitem__(self, name: str) -> Any:
        """Return the value of the parameter with this dotted name."""
        for key, value in self.values:
            if key == name:
                return value
        raise KeyError(name)

    @property
    def reducer(self) -> Reducer:
        """The reducer's geometry."""
        return fill_group(dict(self.values), "reducer", Reducer)

    @property
    def dynamics(self) -> Dynamics:
        """The mean oscillator."""
        return fill_group(dict(self.values), "dynamics", Dynamics)

    @property
    def sensorless(self) -> bool:
        """Whether the vibration signal comes from joint_states alone."""
        return self["input.source"] in SENSORLESS_SOURCES
