"""Start the simulated rig.

For example: ``ros2 launch hd_sim_node rig.launch.py defect:=circular_spline programme:=strokes``.
"""

from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.launch_context import LaunchContext
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

from launch import LaunchDescription

# Arguments that stand for a parameter of the same name: its type and what it is for. Empty leaves the parameter to the
# parameter file, or to its default.
PARAMETERS = {
    "drive": (str, "preset of the parameters that are not given: paper, catalogue or worn"),
    "defect": (str, "the bad spline: flexspline, circular_spline, both, none or custom"),
    "programme": (
        str,
        "what the wave generator does: dwell, fixed, sweep, strokes, profile, pick_and_place, short_strokes, "
        "commissioning or day",
    ),
    "publish": (str, "form of the torsional acceleration: block, samples, both or none"),
    "time_scale": (float, "simulated seconds in a second"),
    "duration": (float, "simulated time [s] after which the rig ends; 0: as long as the programme"),
    "seed": (int, "of all random numbers"),
    "wait_for_subscribers": (int, "start when every topic has so many subscribers; 0: at once"),
}


def start(context: LaunchContext) -> list[Node]:
    """Make the node with those parameters that are given."""

    def value(name: str) -> str:
        return LaunchConfiguration(name).perform(context)

    given = {name: kind(value(name)) for name, (kind, _) in PARAMETERS.items() if value(name)}
    return [
        Node(
            package="hd_sim_node",
            executable="hd_sim_node",
            name="hd_sim_node",
            namespace=value("namespace"),
            parameters=[*filter(None, [value("params_file")]), given],
            output="screen",
            emulate_tty=True,
        )
    ]


def generate_launch_description() -> LaunchDescription:
    return LaunchDescription(
        [
            DeclareLaunchArgument("params_file", default_value="", description="parameter file (YAML) of the rig"),
            DeclareLaunchArgument("namespace", default_value="", description="namespace of the rig's topics"),
            *(
                DeclareLaunchArgument(name, default_value="", description=description)
                for name, (_, description) in PARAMETERS.items()
            ),
            OpaqueFunction(function=start),
        ]
    )
