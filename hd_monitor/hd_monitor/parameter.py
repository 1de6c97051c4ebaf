"""One parameter of a node or a command: its type, range and description, checked in one way everywhere."""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, fields
from typing import TYPE_CHECKING, Any

from .errors import ParameterError, did_you_mean

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

Value = bool | int | float | str | tuple[float, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Parameter:
    """One parameter: its dotted name, default, unit, range and description; the type is the default's.

    `low` and `high` bound numbers, each number of a list too (inclusive), and numbers are finite; `choices` lists the
    words allowed.
    """

    name: str
    default: Value
    description: str
    unit: str = ""
    low: float = -math.inf
    high: float = math.inf
    choices: tuple[str, ...] = ()

    def check(self, value: object) -> Value:
        """Return `value` in the parameter's type.

        Raises
        ------
        ParameterError
            If the type, the range or the word is wrong; the message names all three.
        """
        if isinstance(self.default, tuple):
            return self._check_list(value)
        if value is True and "y" in self.choices:
            value = "y"  # YAML as ROS reads it takes a bare y for true
        kind = type(self.default)
        if kind is float and isinstance(value, int) and not isinstance(value, bool):
            value = float(value)
        if not isinstance(value, kind) or (kind is int and isinstance(value, bool)):
            wanted = f"one of: {', '.join(self.choices)}" if self.choices else f"a {kind.__name__} ({self.description})"
            raise ParameterError(f"{self.name} = {value!r} has the wrong type; give {wanted}")
        if self.choices and value not in self.choices:
            raise ParameterError(f"{self.name} = {value!r} is unknown; choose one of: {', '.join(self.choices)}")
        if isinstance(value, (int, float)) and not isinstance(value, bool):
            self._check_number(value)
        return value

    def _check_list(self, value: object) -> tuple[float, ...]:
        items = list(value) if isinstance(value, Sequence) and not isinstance(value, (str, bytes)) else [value]
        numbers = [float(x) for x in items if isinstance(x, (int, float)) and not isinstance(x, bool)]
        if len(numbers) != len(items):
            raise ParameterError(
                f"{self.name} = {value!r} has the wrong type; give a list of numbers ({self.description})"
            )
        for number in numbers:
            self._check_number(number)
        return tuple(numbers)

    def _check_number(self, value: float) -> None:
        if not (math.isfinite(value) and self.low <= value <= self.high):
            raise ParameterError(
                f"{self.name} = {value!r} is outside [{self.low:g}, {self.high:g}] {self.unit}".rstrip()
                + f"; {self.description}"
            )


def number[T: (int, float, tuple[float, ...])](default: T, unit: str, low: float, high: float, description: str) -> T:
    """Declare a number or a list of numbers, whole if `default` is, from `low` to `high`: a field of a dataclass."""
    return _declare(default, unit=unit, low=low, high=high, description=description)


def choice(default: str, choices: Iterable[str], description: str) -> str:
    """Declare one word of several."""
    return _declare(default, choices=tuple(map(str, choices)), description=description)


def plain[T: (bool, str)](default: T, description: str) -> T:
    """Declare what is true or false, or any text."""
    return _declare(default, description=description)


def _declare[T](default: T, **declaration: Any) -> T:
    return field(default=default, metadata=declaration)


def table(prefix: str = "", **declared: Any) -> tuple[Parameter, ...]:
    """List parameters declared one by one: ``table("belt.", speed=number(2.5, "m/s", 0.0, 10.0, "of the belt"))``."""
    return tuple(
        Parameter(name=prefix + name, default=item.default, **item.metadata) for name, item in declared.items()
    )


def parameters_of(group: "type[DataclassInstance]", prefix: str = "") -> tuple[Parameter, ...]:
    """List the parameters that the fields of a dataclass declare, in their order.

    Examples
    --------
    >>> @dataclass(frozen=True, kw_only=True)
    ... class Belt:
    ...     speed: float = number(2.5, "m/s", 0.0, 10.0, "of the belt")
    >>> parameters_of(Belt, "belt.")[0].check(3)
    3.0
    """
    return table(prefix, **{item.name: item for item in fields(group)})


def check_all(parameters: Sequence[Parameter], given: Mapping[str, Any], *, owner: str) -> dict[str, Value]:
    """Check dotted or nested values against a table and fill in the defaults.

    Parameters
    ----------
    parameters : sequence of Parameter
    given : mapping
        Nested or dotted.
    owner : str
        Whose parameters these are, for the message.

    Raises
    ------
    ParameterError
        If a name is not in the table or a value is wrong.
    """
    table = {parameter.name: parameter for parameter in parameters}
    values: dict[str, Value] = {parameter.name: parameter.default for parameter in parameters}
    for name, value in flatten(given).items():
        if name not in table:
            hint = did_you_mean(name, table) or "; see msgs_doc/parameters.md for their list"
            raise ParameterError(f"{name} is not a parameter of {owner}{hint}")
        values[name] = table[name].check(value)
    return values


def fill_group[T: "DataclassInstance"](values: Mapping[str, Any], group: str, kind: type[T]) -> T:
    """Fill the fields of a dataclass from the parameters of the same names below a group, or of those without one.

    Examples
    --------
    >>> from hd_monitor.model import Dynamics
    >>> values = {"dynamics.natural_frequency": 34.0, "dynamics.damping_ratio": 0.03, "dynamics.inertia": 0.9}
    >>> fill_group(values, "dynamics", Dynamics).natural_frequency
    34.0
    """
    prefix = f"{group}." if group else ""
    return kind(**{field.name: values[prefix + field.name] for field in fields(kind)})


def flatten(nested: Mapping[str, Any], prefix: str = "") -> dict[str, Any]:
    """Turn nested mappings into one with dotted names."""
    flat: dict[str, Any] = {}
    for key, value in nested.items():
        name = f"{prefix}{key}"
        if isinstance(value, Mapping):
            flat.update(flatten(value, f"{name}."))
        else:
            flat[name] = value
    return flat
