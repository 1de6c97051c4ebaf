"""ROS parameter files and overrides, read as a node would read them, without ROS."""

import itertools
import re
import reprlib
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import yaml

from ..errors import ParameterError
from ..parameter import flatten
from .errors import one_line

NODE = "hd_monitor_node"
"""Name of the monitor node, if nobody has renamed it."""

_PARAMETERS = "ros__parameters"
_LARGEST, _DEEPEST, _MOST = 4_000_000, 50, 300_000
"""Bytes, levels and values of the largest parameter file: a thousand joints with all their parameters have fewer."""

_WILD = {"**": r"(/[^/]+)*", "*": r"/[^/]+"}


class _Loader(yaml.SafeLoader):
    """YAML as ROS's parser understands numbers: 5e-2 is one, with or without a point. Depth and size are bounded."""

    _depth = 0

    def compose_node(self, parent: yaml.Node | None, index: int) -> yaml.Node | None:
        """Refuse to go too deep."""
        self._depth += 1
        if self._depth > _DEEPEST:
            raise yaml.YAMLError(f"it is nested too deeply, in more than {_DEEPEST} levels; see config/ for examples")
        node = super().compose_node(parent, index)
        self._depth -= 1
        return node

    def get_single_data(self) -> Any:
        """Return the only document, an alias counted as what it repeats: one that holds itself is too much."""
        root = self.get_single_node()
        inside: list[Any] = [root]
        count = 0
        while inside:
            node = inside.pop()
            count += 1
            if count > _MOST:
                raise yaml.YAMLError(f"an alias repeats itself, or there are more than {_MOST} values; write them out")
            if isinstance(node, yaml.MappingNode):
                inside += itertools.chain(*node.value)
            elif isinstance(node, yaml.SequenceNode):
                inside += node.value
        return None if root is None else self.construct_document(root)


_Loader.add_implicit_resolver(
    "tag:yaml.org,2002:float", re.compile(r"^[-+]?[0-9]+[eE][-+]?[0-9]+$"), list("-+0123456789")
)


class _PlainLoader(_Loader):
    """YAML without aliases, which ROS's parser refuses too: a few lines of them hold themselves or a billion values."""

    def compose_node(self, parent: yaml.Node | None, index: int) -> yaml.Node | None:
        """Refuse an alias."""
        if self.check_event(yaml.AliasEvent):
            raise yaml.YAMLError("ROS reads no aliases (*name); write the values out")
        return super().compose_node(parent, index)


def read_yaml(path: Path, loader: type[_Loader] = _Loader) -> Any:
    """Read a YAML file; raise a `ParameterError` of one line if it cannot be read or is not YAML."""
    try:
        with path.open("rb") as file:
            content = file.read(_LARGEST + 1)
    except OSError as error:
        raise ParameterError(f"{path} cannot be read: {error.strerror}; check the path") from None
    if len(content) > _LARGEST:
        raise ParameterError(f"{path} is larger than {_LARGEST / 1e6:g} MB, which no parameter file is; check the path")
    return _parsed(content, str(path), loader)


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
    content, sections = _read(path, _PlainLoader)
    if not sections:
        return flatten({str(name): value for name, value in content.items()})
    values: dict[str, Any] = {}
    for _, section in _chosen(sections, node, path):
        values.update(flatten(section))
    return values


def check_files(words: Sequence[str], option: str) -> None:
    """Refuse parameter files that hold no parameters, named after an option, before the imports that they set going.

    Raises
    ------
    ParameterError
        If a file cannot be read, is not YAML, or holds something else where parameters belong.
    """
    for before, word in itertools.pairwise(words):
        if before == option:
            _read(Path(word), _Loader)


def _read(path: Path, loader: type[_Loader]) -> tuple[Mapping[Any, Any], list[tuple[str, Mapping[str, Any]]]]:
    """Return what a parameter file holds, and its sections."""
    content = read_yaml(path, loader)
    if content is None:
        return {}, []
    if not isinstance(content, Mapping):
        raise ParameterError(f"{path} holds {reprlib.repr(content)} where parameters belong; see config/ for examples")
    return content, list(_sections(content, ""))


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
    return name, _parsed(value, f"the value in {text!r}", _PlainLoader)


def _parsed(text: str | bytes, what: str, loader: type[_Loader]) -> Any:
    """Return what YAML holds; bytes are UTF-8."""
    try:
        return yaml.load(text if isinstance(text, str) else text.decode(), loader)
    except Exception as error:  # PyYAML's constructors raise anything: "!!int x", "2001-13-01", "!!timestamp"
        raise ParameterError(f"{what} is not valid YAML: {one_line(error)}") from None


def _sections(content: Mapping[Any, Any], above: str) -> Iterator[tuple[str, Mapping[str, Any]]]:
    """Yield (fully qualified name, wildcards included; parameters) of every node in the file."""
    for key, value in content.items():
        if not isinstance(value, Mapping):
            continue
        name = re.sub("/+", "/", f"{above}/{key}")
        if _PARAMETERS in value:
            section = value[_PARAMETERS] or {}
            if not isinstance(section, Mapping):
                raise ParameterError(f"{_PARAMETERS} of {name} is {section!r}; give names with values below it")
            yield name, section
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
