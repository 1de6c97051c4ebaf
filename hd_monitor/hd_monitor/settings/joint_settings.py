"""The settings of one joint's monitor, checked against the table and against each other."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, Self

from ..errors import ParameterError
from ..model.parameters import Dynamics
from ..parameter import Value, check_all, fill_group
from ..reducer import Reducer
from ..sources import INPUT_SOURCES, JOINT_STATES, LOAD_SOURCES, TEMPERATURE, Quantity, Source
from .groups import AnalysisSettings, DiagnosisSettings, HistorySettings, InputSettings, LoadSettings
from .table import PARAMETERS
from .uncertainty import Uncertainty


@dataclass(frozen=True, slots=True, kw_only=True)
class JointSettings:
    """All settings of one joint, by group; `values` are all parameters by their dotted names, as checked.

    Examples
    --------
    >>> settings = JointSettings.from_mapping({"reducer.flexspline_teeth": 200, "reducer.circular_spline_teeth": 202})
    >>> settings.reducer.reduction, settings.diagnosis.both_ratio
    (100.0, 0.87)
    """

    values: tuple[tuple[str, Value], ...]
    reducer: Reducer
    serial: str
    transmission_error: float
    dynamics: Dynamics
    uncertainty: Uncertainty
    input: InputSettings
    load: LoadSettings
    analysis: AnalysisSettings
    diagnosis: DiagnosisSettings
    history: HistorySettings

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
        for name, reason in INPUT_SOURCES[str(values["input.source"])].needs:
            if not values[name]:
                raise ParameterError(f"{name} = 0 with input.source = {values['input.source']!r}: {reason}")
        if values["input.topic"] and INPUT_SOURCES[str(values["input.source"])] is JOINT_STATES:
            raise ParameterError(
                f"input.topic = {values['input.topic']!r} with input.source = {values['input.source']!r}: the "
                "vibration is in joint_states then; leave input.topic empty, and remap joint_states if need be"
            )
        return cls(
            values=tuple(values.items()),
            reducer=fill_group(values, "reducer", Reducer),
            serial=str(values["reducer.serial"]),
            transmission_error=float(values["reducer.transmission_error"]),  # type: ignore[arg-type]
            dynamics=fill_group(values, "dynamics", Dynamics),
            uncertainty=Uncertainty.of(values),
            input=fill_group(values, "input", InputSettings),
            load=fill_group(values, "load", LoadSettings),
            analysis=fill_group(values, "analysis", AnalysisSettings),
            diagnosis=fill_group(values, "diagnosis", DiagnosisSettings),
            history=fill_group(values, "history", HistorySettings),
        )

    @property
    def vibration(self) -> Source:
        """Where the vibration signal comes from."""
        return INPUT_SOURCES[self.input.source]

    @property
    def sensorless(self) -> bool:
        """Whether the vibration signal comes from joint_states alone."""
        return self.vibration.quantity is Quantity.MOTION

    @property
    def sources(self) -> dict[Quantity, Source]:
        """The inputs that the joint needs."""
        needed = [JOINT_STATES, replace(self.vibration, topic=self.input.topic or self.vibration.topic)]
        torque = LOAD_SOURCES[self.load.source]
        if torque is not None and not self.sensorless:
            needed.append(replace(torque, topic=self.load.topic or torque.topic))
        return {source.quantity: source for source in needed}

    @property
    def all_sources(self) -> dict[Quantity, Source]:
        """The inputs that the joint needs, and the temperature, which it does not."""
        if not self.input.temperature_topic:
            return self.sources
        return self.sources | {Quantity.TEMPERATURE: replace(TEMPERATURE, topic=self.input.temperature_topic)}
