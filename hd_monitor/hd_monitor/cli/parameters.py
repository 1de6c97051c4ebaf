"""``hd-monitor parameters``: every parameter with unit, range and description, as Markdown or as a parameter file."""

import argparse
import importlib
import math
import textwrap
from collections.abc import Iterator, Sequence

from ..parameter import Parameter
from ..settings import NODE_PARAMETERS, PARAMETERS

WIDTH = 110

HEAD = """\
# Parameters

<!-- Made by `hd-monitor parameters > msgs_doc/parameters.md`; a test holds this page to the code. -->

Both nodes take their parameters from ordinary ROS parameter files (`--ros-args --params-file FILE`) or one by one
(`-p NAME:=VALUE`); `hd-monitor parameters --format yaml` prints such a file with every default. A value out of its
range, of the wrong type or impossible beside the others ends the node with one line that says why and status 2; at run
time it is refused with the same words. A whole number will do where a real one is asked for.
"""

MONITOR = """\
## hd_monitor_node

With one joint the parameters stand at the top level. With several (`joints: [shoulder, elbow]`) those at the top level
are common to all, and each joint may override any of them below its name (`elbow.reducer.serial`). `diagnosis.*` may be
changed while the node runs (with several joints: below the joint's name); everything else is fixed at the start. A
parameter file may be shared with other nodes: names outside the groups below are ignored with a warning.

| name | default | description |
|---|---|---|
| `joints` | `[joint]` | names of the joints watched; one alone called `joint` takes the only one in joint_states |
"""

RIG = """\
## hd_sim_node

The rig's reducer and dynamics have the monitor's names, so that one file serves both nodes.
"""


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.add_argument(
        "--format",
        choices=("markdown", "yaml"),
        default="markdown",
        help="a page that lists them, or a parameter file with every default (default: %(default)s)",
    )
    parser.add_argument("--node", choices=("monitor", "sim"), help="of one node only (default: both)")


def run(arguments: argparse.Namespace) -> int:
    """Print the parameters."""
    nodes = (arguments.node,) if arguments.node else ("monitor", "sim")
    print(markdown(nodes) if arguments.format == "markdown" else yaml(nodes), end="")
    return 0


def markdown(nodes: Sequence[str]) -> str:
    """Write the page ``msgs_doc/parameters.md``."""
    parts = [HEAD]
    if "monitor" in nodes:
        parts.append(MONITOR + "\n".join(map(_brief, NODE_PARAMETERS)) + "\n")
        parts += _groups(PARAMETERS)
    if "sim" in nodes:
        rig, node = _rig_parameters()
        parts.append(RIG)
        parts += _groups((*node, *rig))
    return "\n".join(parts)


def _rig_parameters() -> tuple[tuple[Parameter, ...], tuple[Parameter, ...]]:
    # By name: this package must not depend on the simulator's, which may not even be installed.
    rig = importlib.import_module("hd_sim_node.parameters").PARAMETERS
    node = importlib.import_module("hd_sim_node.node_parameters").NODE_PARAMETERS
    return rig, node


def _groups(parameters: Sequence[Parameter]) -> Iterator[str]:
    groups: dict[str, list[Parameter]] = {}
    for parameter in parameters:
        group = parameter.name.partition(".")[0] if "." in parameter.name else ""
        groups.setdefault(group, []).append(parameter)
    for name, members in groups.items():
        head = f"### {name}" if name else "### Without a group"
        rows = "\n".join(map(_row, members))
        yield f"{head}\n\n| name | default | unit | range | description |\n|---|---|---|---|---|\n{rows}\n"


def _brief(parameter: Parameter) -> str:
    return f"| `{parameter.name}` | `{_value(parameter)}` | {parameter.description} |"


def _row(parameter: Parameter) -> str:
    return (
        f"| `{parameter.name}` | `{_value(parameter)}` | {parameter.unit or '–'} | {_range(parameter)} | "
        f"{parameter.description} |"
    )


def _value(parameter: Parameter) -> str:
    default = parameter.default
    if isinstance(default, bool):
        return str(default).lower()
    if isinstance(default, tuple):
        return f"[{', '.join(map(str, default))}]"
    if isinstance(default, str):
        return default if default and default not in {"y", "none", "x"} else f'"{default}"'
    return str(default)


def _range(parameter: Parameter) -> str:
    if parameter.choices:
        return ", ".join(f"`{choice}`" for choice in parameter.choices)
    if isinstance(parameter.default, bool):
        return "true, false"
    if not math.isfinite(parameter.low) and not math.isfinite(parameter.high):
        return "–"
    return f"{parameter.low:g} … {parameter.high:g}" if math.isfinite(parameter.high) else f"from {parameter.low:g}"


def yaml(nodes: Sequence[str]) -> str:
    """Write a parameter file with every default and its description."""
    lines = []
    if "monitor" in nodes:
        lines += ["hd_monitor_node:", "  ros__parameters:", "    joints: [joint]"]
        lines += _yaml_lines((*NODE_PARAMETERS, *PARAMETERS))
    if "sim" in nodes:
        rig, node = _rig_parameters()
        lines += ["hd_sim_node:", "  ros__parameters:", *_yaml_lines((*node, *rig))]
    return "\n".join(lines) + "\n"


def _yaml_lines(parameters: Sequence[Parameter]) -> Iterator[str]:
    for parameter in parameters:
        unit = f" [{parameter.unit}]" if parameter.unit else ""
        allowed = "" if _range(parameter) in ("–", "true, false") else f"; {_range(parameter).replace('`', '')}"
        comment = f"{parameter.description}{unit}{allowed}"
        yield from textwrap.wrap(comment, WIDTH, initial_indent="    # ", subsequent_indent="    # ")
        yield f"    {parameter.name}: {_value(parameter)}"
