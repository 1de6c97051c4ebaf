"""What other packages add to ``hd-monitor``, declared as entry points: commands, and the parameters of their nodes."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

COMMANDS = "hd_monitor.commands"
"""Group of subcommands, by name: modules with ``configure(parser)`` and ``run(arguments)`` that returns the status."""

PARAMETERS = "hd_monitor.parameters"
"""Group of parameter tables, by the name of the node: sequences of :class:`~hd_monitor.parameter.Parameter`."""

SIMULATOR_MISSING = (
    "needs the package hd_sim_node, which is not installed: build it too (colcon build --packages-up-to hd_sim_node), "
    "or run pip install '.[ros]' in the checkout"
)


def declared(group: str) -> dict[str, "EntryPoint"]:
    """Find what the installed packages declare in a group, by name; nothing is imported."""
    from importlib.metadata import entry_points  # takes as long as the rest of the command's start

    return {entry.name: entry for entry in entry_points(group=group)}
