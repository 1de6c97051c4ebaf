"""ROS parameter files and overrides, read as a node would read them, without ROS."""

import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import yaml

from ..errors import ParameterError
from ..parameter import flatten

NODE = "hd_monitor_node"
"""Name of the monitor node, if nobody has renamed it."""

_PARAMETERS = "ros__parameters"
_WILD = {"**": r"(/[^/]+)*", "*": r"/[^/]+"}


class _Loader(yaml.SafeLoader):
    """YAML as ROS's parser understands it: 5e-2 is a number, with or without a point."""


_Loader.add_implicit_resolver(
    "tag:yaml.org,2002:float", re.compile(r"^[-+]?[0-9]+[eE][-+]?[0-9]+$"), list("-+0123456789")
)


def read_yaml(path: Path) -> Any:
    """Read a YAML file; raise a `ParameterError` of one line if it cannot be read or is not YAML."""
    try:
        return yaml.load(path.read_text(encoding="utf-8"), _Loader)
    except OSError as error:
        raise ParameterError(f"{path} cannot be read: {error.strerror}; check the path") from None
    except (yaml.YAMLError, UnicodeDecodeError) as error:
        raise ParameterError(f"{path} is not valid YAML: {' '.join(str(error).split())}") from None


def load_parameters(path: Path, node: str | None = None) -> dict[str, Any]:
    """Read the monitor's parameters from a file.

    Parameters
    ----------
    path : Path
        A ROS parameter file (nodes, wildcards and namespaces above ``ros__parameters``), or the bare parameters.
    node : str, optional
        Fully qualified name of the node whose parameters are wanted; by default those of the only node called
        ``hd_monitor_node``, or of the only node there is.

    Returns
    -------
    dict
        By dotted name.

    Raises
    ------
    ParameterError
        If the file cannot be read, is not such YAML, or does not say whose parameters are meant.
    """
    content = read_yaml(path)
    if content is None:
        return {}
    if not isinstance(content, Mapping):
        raise ParameterError(f"{path} holds no parameters but a {type(content).__name__}; see config/ for examples")
    sections = list(_sections(content, ""))
    if not sections:
        return flatten({str(name): value for name, value in content.items()})
    values: dict[str, Any] = {}
    for _, section in _chosen(sections, node, path):
        values.update(flatten(section))
    return values


def parse_override(text: str) -> tuple[str, Any]:
    """Read ``NAME:=VALUE``, the value written as in a parameter file.

    Raises
    ------
    ParameterError
        If there is no ``:=`` in it or the value is not valid YAML.
    """
    name, mark, value = text.partition(":=")
    if not mark or not name:
        raise ParameterError(f"{text!r} sets no parameter; write NAME:=VALUE, as in diagnosis.warn_index:=0.05")
    try:
        return name, yaml.load(value, _Loader)
    except yaml.YAMLError as error:
        raise ParameterError(f"the value in {text!r} is not valid YAML: {' '.join(str(error).split())}") from None


def _sections(content: Mapping[Any, Any], above: str) -> Iterator[tuple[str, Mapping[str, Any]]]:
    """Yield (fully qualified name, wildcards included; parameters) of every node in the file."""
    for key, value in content.items():
        if not isinstance(value, Mapping):
            continue
        name = re.sub("/+", "/", f"{above}/{key}")
        if _PARAMETERS in value:
            yield name, value[_PARAMETERS] or {}
        yield from _sections({k: v for k, v in value.items() if k != _PARAMETERS}, name)


def _chosen(
    sections: Sequence[tuple[str, Mapping[str, Any]]], node: str | None, path: Path
) -> list[tuple[str, Mapping[str, Any]]]:
    names = [name for name, _ in sections]
    if node is not None:
        wanted = re.sub("/+", "/", f"/{node}")
    else:
        exact = sorted({name for name in names if "*" not in name})
        ours = [name for name in exact if name.rpartition("/")[2] == NODE]
        candidates = ours or (exact if not any(_matches(name, f"/{NODE}") for name in names) else [])
        if len(candidates) > 1:
            raise ParameterError(
                f"{path} holds parameters of several nodes ({', '.join(candidates)}); choose one with --node"
            )
        wanted = candidates[0] if candidates else f"/{NODE}"
    chosen = [section for section in sections if _matches(section[0], wanted)]
    if not chosen:
        raise ParameterError(f"{path} holds parameters of {', '.join(names)}, but none of {wanted}; see --node")
    return chosen


def _matches(pattern: str, name: str) -> bool:
    parts = pattern.strip("/").split("/")
    expression = "".join(_WILD.get(part, "/" + re.escape(part)) for part in parts)
    return re.fullmatch(expression, name) is not None
