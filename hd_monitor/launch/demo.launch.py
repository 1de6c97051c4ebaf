"""A simulated rig with a defect of your choice, and the monitor that finds it.

ros2 launch hd_monitor demo.launch.py defect:=circular_spline time_scale:=4.0
ros2 topic echo /diagnostics
"""

from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration, PythonExpression
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue

from launch import LaunchDescription


def generate_launch_description():
    arguments = [
        DeclareLaunchArgument(
            "defect",
            default_value="flexspline",
            choices=["flexspline", "circular_spline", "both", "none"],
            description="the bad spline",
        ),
        DeclareLaunchArgument(
            "programme",
            default_value="dwell",
            choices=["dwell", "fixed", "sweep", "strokes"],
            description="what the wave generator does",
        ),
        DeclareLaunchArgument("time_scale", default_value="1.0", description="simulated seconds in a second"),
        DeclareLaunchArgument("noise", default_value="0.1", description="noise of the accelerometer [rad/s²]"),
        DeclareLaunchArgument(
            "source",
            default_value="block",
            choices=["block", "accel_stamped", "imu"],
            description="form in which the vibration is published and heard",
        ),
        DeclareLaunchArgument("warn_index", default_value="0.05", description="limit of the index for a warning"),
        DeclareLaunchArgument("error_index", default_value="0.08", description="limit of the index for an error"),
        DeclareLaunchArgument("serial", default_value="demo", description="serial number of the reducer"),
        DeclareLaunchArgument("namespace", default_value="", description="namespace of both nodes and their topics"),
    ]
    source = LaunchConfiguration("source")
    rig = Node(
        package="hd_sim_node",
        executable="hd_sim_node",
        namespace=LaunchConfiguration("namespace"),
        output="both",
        parameters=[
            {
                "defect": LaunchConfiguration("defect"),
                "programme": LaunchConfiguration("programme"),
                "time_scale": number("time_scale"),
                "sensor.noise": number("noise"),
                "publish": PythonExpression(
                    ["{'block': 'block', 'accel_stamped': 'samples', 'imu': 'none'}['", source, "']"]
                ),
                "publish_imu": ParameterValue(PythonExpression(["'", source, "' == 'imu'"]), value_type=bool),
            }
        ],
    )
    monitor = Node(
        package="hd_monitor",
        executable="hd_monitor_node",
        namespace=LaunchConfiguration("namespace"),
        output="both",
        parameters=[
            {
                "input.source": source,
                # Loss counts by the stamps, which run as much faster as the rig does.
                "input.timeout": ParameterValue(
                    PythonExpression(["3.0 * max(1.0, ", LaunchConfiguration("time_scale"), ")"]), value_type=float
                ),
                "reducer.serial": ParameterValue(LaunchConfiguration("serial"), value_type=str),
                "diagnosis.warn_index": number("warn_index"),
                "diagnosis.error_index": number("error_index"),
            }
        ],
    )
    return LaunchDescription([*arguments, rig, monitor])


def number(name):
    return ParameterValue(LaunchConfiguration(name), value_type=float)
