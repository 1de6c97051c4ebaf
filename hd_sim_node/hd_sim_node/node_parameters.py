"""The node's parameters beside the rig's: how the simulation is published, not what is simulated."""

from hd_monitor.parameter import Parameter
from hd_monitor.settings import NODE_PARAMETERS as MONITOR_NODE_PARAMETERS

NODE_PARAMETERS: tuple[Parameter, ...] = (
    *(parameter for parameter in MONITOR_NODE_PARAMETERS if parameter.name == "autostart"),
    Parameter(
        name="time_scale",
        default=1.0,
        low=0.001,
        high=10_000.0,
        description="simulated seconds in a second; stamps start now and advance by simulated time",
    ),
    Parameter(
        name="wait_for_subscribers",
        default=0,
        low=0,
        high=100,
        description="start when joint_states and the vibration's topics each have so many subscribers; 0: at once",
    ),
    Parameter(name="exit_at_end", default=False, description="end the process when the programme has ended"),
    Parameter(
        name="queue_seconds",
        default=4.0,
        unit="s",
        low=0.1,
        high=60.0,
        description="depth of the publishers' queues, in seconds of real time; Fast DDS keeps 5000 messages",
    ),
)
"""Parameters of the node beside the rig's."""
