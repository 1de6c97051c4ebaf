"""``hd-monitor parameters``: every parameter with unit, range and description, as Markdown or as a parameter file."""

import argparse
import math
import textwrap
from collections.abc import Iterator, Mapping, Sequence
from itertools import groupby

from ..errors import HdMonitorError
from ..parameter import Parameter
from ..settings import CHANGEABLE, NODE_PARAMETERS, PARAMETERS
from ..settings.table import JOINTS
from . import extensions

WIDTH = 110
MONITOR, SIMULATOR = "hd_monitor_node", "hd_sim_node"

HEAD = """\
# Parameters

<!-- Made by `hd-monitor parameters > msgs_doc/parameters.md`; a test holds this page to the code. -->

The nodes take their parameters from ordinary ROS parameter files (`--ros-args --params-file FILE`) or one by one
(`-p NAME:=VALUE`); `hd-monitor parameters --format yaml` prints such a file with every default. A value that is out of
range, of the wrong type or in conflict with others ends the node with status 2 and one line that says why; at run time
it is refused with the same message. An integer is accepted where a real number is expected. A parameter that both nodes
have means the same in both, so that one file can serve both.
"""

MONITOR_HEAD = """
With one joint the parameters are at the top level. With several (`joints: [shoulder, elbow]`) those at the top level
are common to all, and each joint may override any of them below its name (`elbow.reducer.serial`). A parameter file may
be shared with other nodes: names outside the groups below are ignored with a warning; a joint's parameter below a name
that is not in `joints` ends the node.

`ros2 param set` works in every state of the node: at the top level it changes all joints that have no value of their
own, below a joint's name that joint alone. While the node is inactive, everything but `joints` and `autostart` may be
set; it takes effect when the node is activated, and a joint whose evidence is no longer valid with it starts anew.
While the node is active, these take effect at once:
{changeable}.
The others are refused: what the node knows of the joint was learnt with them. `load.torque` may not change from or to 0
either, which decides whether the indexes have a scale.
"""


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.add_argument(
        "--format",
        choices=("markdown", "yaml"),
        default="markdown",
        help="a page that lists them, or a parameter file with every default (default: %(default)s)",
    )
    parser.add_argument("--node", choices=("monitor", "sim"), help="of one node only (default: every one installed)")


def run(arguments: argparse.Namespace) -> int:
    """Print the parameters."""
    tables = node_tables()
    if arguments.node:
        name = MONITOR if arguments.node == "monitor" else SIMULATOR
        if name not in tables:
            raise HdMonitorError(extensions.SIMULATOR_MISSING)
        tables = {name: tables[name]}
    print(markdown(tables) if arguments.format == "markdown" else yaml(tables), end="")
    return 0


def node_tables() -> dict[str, Sequence[Parameter]]:
    """Gather the parameters of every installed node, by the node's name."""
    added = {name: entry.load() for name, entry in extensions.declared(extensions.PARAMETERS).items()}
    return {MONITOR: (JOINTS, *NODE_PARAMETERS, *PARAMETERS), **added}


def markdown(tables: Mapping[str, Sequence[Parameter]]) -> str:
    """Write the page ``msgs_doc/parameters.md``."""
    parts = [HEAD]
    for node, parameters in tables.items():
        parts += [f"## {node}\n{_monitor_head() if node == MONITOR else ''}", *_groups(parameters)]
    return "\n".join(parts)


def _monitor_head() -> str:
    names = ", ".join(f"`{name}*`" if name.endswith(".") else f"`{name}`" for name in CHANGEABLE)
    return MONITOR_HEAD.format(changeable=textwrap.fill(names, WIDTH, break_on_hyphens=False))


def _groups(parameters: Sequence[Parameter]) -> Iterator[str]:
    for name, members in groupby(parameters, lambda parameter: parameter.name.rpartition(".")[0]):
        rows = "\n".join(
            f"| `{p.name}` | `{_value(p)}` | {p.unit or '–'} | {_range(p)} | {p.description} |" for p in members
        )
        head = f"### {name or 'Without a group'}\n"
        yield f"{head}\n| name | default | unit | range | description |\n|---|---|---|---|---|\n{rows}\n"


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


def yaml(tables: Mapping[str, Sequence[Parameter]]) -> str:
    """Write a parameter file with every default and its description."""
    lines = []
    for node, parameters in tables.items():
        lines += [f"{node}:", "  ros__parameters:", *_yaml_lines(parameters)]
    return "\n".join(lines) + "\n"


def _yaml_lines(parameters: Sequence[Parameter]) -> Iterator[str]:
    for parameter in parameters:
        unit = f" [{parameter.unit}]" if parameter.unit else ""
        allowed = "" if _range(parameter) in ("–", "true, false") else f"; {_range(parameter).replace('`', '')}"
        comment = f"{parameter.description}{unit}{allowed}"
        yield from textwrap.wrap(comment, WIDTH, initial_indent="    # ", subsequent_indent="    # ")
        yield f"    {parameter.name}: {_value(parameter)}"
