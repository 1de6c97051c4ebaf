"""The monitor for a robot: one node for any number of joints, from a parameter file.

ros2 launch hd_monitor monitor.launch.py params_file:=/path/to/monitor.yaml namespace:=arm
"""

from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.launch_context import LaunchContext
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare

from launch import LaunchDescription


def start(context: LaunchContext) -> list[Node]:
    """Make the node; what is not given is left to the parameter file."""
    parameters = {
        "use_sim_time": ParameterValue(LaunchConfiguration("use_sim_time"), value_type=bool),
        "autostart": ParameterValue(LaunchConfiguration("autostart"), value_type=bool),
    }
    if topic := LaunchConfiguration("input_topic").perform(context):
        parameters["input.topic"] = topic
    node = Node(
        package="hd_monitor",
        executable="hd_monitor_node",
        name=LaunchConfiguration("node_name"),
        namespace=LaunchConfiguration("namespace"),
        output="both",
        parameters=[LaunchConfiguration("params_file"), parameters],
        remappings=[("joint_states", LaunchConfiguration("joint_states"))],
        arguments=["--ros-args", "--log-level", LaunchConfiguration("log_level")],
    )
    return [node]


def generate_launch_description():
    default_file = PathJoinSubstitution([FindPackageShare("hd_monitor"), "config", "monitor.yaml"])
    arguments = [
        DeclareLaunchArgument(
            "params_file", default_value=default_file, description="ROS parameter file with reducer, input and limits"
        ),
        DeclareLaunchArgument("namespace", default_value="", description="namespace of the node and its topics"),
        DeclareLaunchArgument("node_name", default_value="hd_monitor_node", description="name of the node"),
        DeclareLaunchArgument(
            "joint_states", default_value="joint_states", description="topic of the joint states, where it is another"
        ),
        DeclareLaunchArgument(
            "input_topic",
            default_value="",
            description="topic of the vibration, where input.topic of the parameter file does not say it; relative "
            "ones are below the joint's name with several joints",
        ),
        DeclareLaunchArgument("use_sim_time", default_value="false", description="count silence by /clock"),
        DeclareLaunchArgument("autostart", default_value="true", description="come up active, without a manager"),
        DeclareLaunchArgument("log_level", default_value="info", description="debug, info, warn, error or fatal"),
    ]
    return LaunchDescription([*arguments, OpaqueFunction(function=start)])
