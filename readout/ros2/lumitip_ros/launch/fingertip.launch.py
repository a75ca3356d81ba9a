"""Start a fingertip, configure and activate it.

ros2 launch lumitip_ros fingertip.launch.py url:=ble://Lumitip layout:=/path/to/layout.json
"""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, EmitEvent, RegisterEventHandler
from launch.event_handlers import OnProcessStart
from launch.events import matches_action
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import LifecycleNode
from launch_ros.event_handlers import OnStateTransition
from launch_ros.events.lifecycle import ChangeState
from launch_ros.substitutions import FindPackageShare
from lifecycle_msgs.msg import Transition

ARGUMENTS = {
    "name": ("fingertip", "name of the node, and of its topics"),
    "namespace": ("", "namespace of the node"),
    "url": ("twin://demo", "address of the fingertip"),
    "layout": ("", "layout.json of its firmware; not needed for a twin or a shared fingertip"),
    "frame_id": ("lumitip_receiver", "link of the receiver in the robot's URDF"),
}


def generate_launch_description() -> LaunchDescription:
    """The node, with what it does when it has started."""
    config = PathJoinSubstitution([FindPackageShare("lumitip_ros"), "config", "fingertip.yaml"])
    values = {name: LaunchConfiguration(name) for name in ARGUMENTS}
    node = LifecycleNode(
        package="lumitip_ros",
        executable="fingertip",
        name=values["name"],
        namespace=values["namespace"],
        parameters=[config, {name: values[name] for name in ("url", "layout", "frame_id")}],
        output="screen",
        respawn=True,
        respawn_delay=2.0,
    )

    def change(transition: int) -> EmitEvent:
        return EmitEvent(
            event=ChangeState(lifecycle_node_matcher=matches_action(node), transition_id=transition)
        )

    configure = OnProcessStart(
        target_action=node, on_start=[change(Transition.TRANSITION_CONFIGURE)]
    )
    activate = OnStateTransition(
        target_lifecycle_node=node,
        start_state="configuring",
        goal_state="inactive",
        entities=[change(Transition.TRANSITION_ACTIVATE)],
    )
    arguments = [
        DeclareLaunchArgument(name, default_value=default, description=text)
        for name, (default, text) in ARGUMENTS.items()
    ]
    return LaunchDescription(
        [*arguments, RegisterEventHandler(configure), RegisterEventHandler(activate), node]
    )
