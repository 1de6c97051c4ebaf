"""The monitor for a robot: one node for any number of joints, from a parameter file.

ros2 launch hd_monitor monitor.launch.py params_file:=/path/to/monitor.yaml namespace:=arm
"""

from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare

from launch import LaunchDescription


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
        DeclareLaunchArgument("use_sim_time", default_value="false", description="count silence by /clock"),
        DeclareLaunchArgument("autostart", default_value="true", description="come up active, without a manager"),
        DeclareLaunchArgument("log_level", default_value="info", description="debug, info, warn, error or fatal"),
    ]
    node = Node(
        package="hd_monitor",
        executable="hd_monitor_node",
        name=LaunchConfiguration("node_name"),
        namespace=LaunchConfiguration("namespace"),
        output="both",
        parameters=[
            LaunchConfiguration("params_file"),
            {
                "use_sim_time": ParameterValue(LaunchConfiguration("use_sim_time"), value_type=bool),
                "autostart": ParameterValue(LaunchConfiguration("autostart"), value_type=bool),
            },
        ],
        remappings=[("joint_states", LaunchConfiguration("joint_states"))],
        arguments=["--ros-args", "--log-level", LaunchConfiguration("log_level")],
    )
    return LaunchDescription([*arguments, node])
