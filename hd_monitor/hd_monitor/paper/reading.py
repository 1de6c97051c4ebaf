"""Reading named values from YAML; errors are one clear line."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import ParameterError
from ..offline.parameters import read_yaml
from ..parameter import flatten


def read_file(path: Path) -> dict[str, Any]:
    """Read a YAML file with named values; refuse anything else in one line."""
    content = read_yaml(path)
    if not isinstance(content, Mapping):
        raise ParameterError(f"{path} holds no named values; see config/my_reducer.yaml for an example")
    return dict(content)


class Reader:
    """Takes values out of a flat mapping by their dotted names; leftover names can then be refused."""

    def __init__(self, source: str, values: Mapping[str, Any]) -> None:
        self.source = source
        self.left = flatten(values)

    def number(self, name: str, default: float) -> float:
        """Take a finite number."""
        if name not in self.left:
            return default
        value = self.left.pop(name)
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not np.isfinite(value):
            raise ParameterError(f"{self.source}: {name} = {value!r} is not a finite number")
        return float(value)

    def numbers_below(self, prefix: str, *names: str) -> dict[str, float]:
        """Take those finite numbers below `prefix` that are given, by their names there."""
        return {name: self.number(f"{prefix}.{name}", 0.0) for name in names if f"{prefix}.{name}" in self.left}

    def numbers(self, name: str) -> tuple[float, ...]:
        """Take a list of numbers; none if it is not given."""
        value = self.left.pop(name, ())
        if not isinstance(value, Sequence) or isinstance(value, str):
            raise ParameterError(f"{self.source}: {name} = {value!r} is not a list of numbers, one per harmonic")
        if any(isinstance(v, bool) or not isinstance(v, (int, float)) for v in value):
            raise ParameterError(f"{self.source}: {name} = {value!r} has an entry that is not a number")
        return tuple(float(v) for v in value)

    def range(self, name: str, start: float, stop: float, last: str, step: float) -> tuple[float, float, float]:
        """Take start, stop and the step or rate named `last`, refused if empty or endless; given are the defaults."""
        start, stop = self.number(f"{name}.start", start), self.number(f"{name}.stop", stop)
        step = self.number(f"{name}.{last}", step)
        if not (start < stop and step > 0.0):
            raise ParameterError(
                f"{self.source}: {name} from {start:g} to {stop:g} by {step:g} is empty or endless; "
                f"stop must be above start, and {last} must be above 0"
            )
        return start, stop, step
