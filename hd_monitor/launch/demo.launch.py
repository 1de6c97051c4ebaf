"""A simulated rig with a defect of your choice, and the monitor that finds it.

ros2 launch hd_monitor demo.launch.py defect:=circular_spline time_scale:=4.0
ros2 topic echo /diagnostics

The rig is the node of the package hd_sim_node, which depends on this one and is looked up only at the start.
"""

from ament_index_python.packages import PackageNotFoundError, get_package_prefix
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.launch_context import LaunchContext
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue

from launch import LaunchDescription

# What hd_sim_node publishes for each form of the vibration: its parameters publish and publish_imu.
SOURCES = {"block": ("block", False), "accel_stamped": ("samples", False), "imu": ("none", True)}


def start(context: LaunchContext) -> list[Node]:
    """Make both nodes."""

    def value(name: str) -> str:
        return LaunchConfiguration(name).perform(context)

    try:
        get_package_prefix("hd_sim_node")
    except PackageNotFoundError:
        raise RuntimeError(
            "demo.launch.py starts a simulated rig, whose package hd_sim_node is not installed: build it too "
            "(colcon build --packages-up-to hd_sim_node) and source the workspace again"
        ) from None
    publish, publish_imu = SOURCES[value("source")]
    time_scale = float(value("time_scale"))
    rig = Node(
        package="hd_sim_node",
        executable="hd_sim_node",
        namespace=value("namespace"),
        output="both",
        parameters=[
            {
                "defect": value("defect"),
                "programme": value("programme"),
                "time_scale": time_scale,
                "sensor.noise": float(value("noise")),
                "publish": publish,
                "publish_imu": publish_imu,
            }
        ],
    )
    monitor = Node(
        package="hd_monitor",
        executable="hd_monitor_node",
        namespace=value("namespace"),
        output="both",
        parameters=[
            {
                "input.source": value("source"),
                # Loss counts by the stamps, which run as much faster as the rig does.
                "input.timeout": 5.0 * max(1.0, time_scale),
                "reducer.serial": ParameterValue(value("serial"), value_type=str),  # 1147 is a text too
                "diagnosis.warn_index": float(value("warn_index")),
                "diagnosis.error_index": float(value("error_index")),
            }
        ],
    )
    return [rig, monitor]


def generate_launch_description() -> LaunchDescription:
    return LaunchDescription(
        [
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
                choices=list(SOURCES),
                description="form in which the vibration is published and heard",
            ),
            DeclareLaunchArgument("warn_index", default_value="0.05", description="index that gives a warning"),
            DeclareLaunchArgument("error_index", default_value="0.08", description="index that gives an error"),
            DeclareLaunchArgument("serial", default_value="demo", description="serial number of the reducer"),
            DeclareLaunchArgument("namespace", default_value="", description="namespace of both nodes and topics"),
            OpaqueFunction(function=start),
        ]
    )
