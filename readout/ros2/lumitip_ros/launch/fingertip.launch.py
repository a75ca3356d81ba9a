"""Start a fingertip, configure and activate it; where it cannot be opened, try again.

ros2 launch lumitip_ros fingertip.launch.py url:=ble://Lumitip layout:=/path/to/layout.json
"""

from launch import Action, LaunchDescription
from launch.actions import DeclareLaunchArgument, EmitEvent, RegisterEventHandler, TimerAction
from launch.event_handlers import OnProcessStart
from launch.events import matches_action
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import LifecycleNode
from launch_ros.event_handlers import OnStateTransition
from launch_ros.events.lifecycle import ChangeState
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare
from lifecycle_msgs.msg import Transition

PLACES = {
    "name": ("fingertip", "name of the node, and of its topics"),
    "namespace": ("", "namespace of the node"),
}
PARAMETERS = {
    "url": ("twin://demo", "address of the fingertip"),
    "layout": ("", "layout.json of its firmware; not needed for a twin or a shared fingertip"),
    "frame_id": ("lumitip_receiver", "link of the receiver in the robot's URDF"),
    "line_frame_id": ("lumitip_line", "frame of the line; another one for each fingertip"),
}
RETRY_S = 5.0


def generate_launch_description() -> LaunchDescription:
    """The node, and the transitions that it goes through."""
    shipped = PathJoinSubstitution([FindPackageShare("lumitip_ros"), "config", "fingertip.yaml"])
    config = DeclareLaunchArgument(
        "config", default_value=shipped, description="file with the other parameters"
    )
    arguments = [
        DeclareLaunchArgument(name, default_value=default, description=text)
        for name, (default, text) in (PLACES | PARAMETERS).items()
    ]
    node = LifecycleNode(
        package="lumitip_ros",
        executable="fingertip",
        name=LaunchConfiguration("name"),
        namespace=LaunchConfiguration("namespace"),
        parameters=[LaunchConfiguration("config"), {name: _text(name) for name in PARAMETERS}],
        output="screen",
        respawn=True,
        respawn_delay=2.0,
    )

    def change(transition: int) -> EmitEvent:
        matcher = matches_action(node)
        event = ChangeState(lifecycle_node_matcher=matcher, transition_id=transition)
        return EmitEvent(event=event)

    def after_configuring(state: str, action: Action) -> OnStateTransition:
        return OnStateTransition(
            target_lifecycle_node=node,
            start_state="configuring",
            goal_state=state,
            entities=[action],
        )

    configure = change(Transition.TRANSITION_CONFIGURE)
    again = TimerAction(period=RETRY_S, actions=[change(Transition.TRANSITION_CONFIGURE)])
    handlers = [
        OnProcessStart(target_action=node, on_start=[configure]),
        after_configuring("inactive", change(Transition.TRANSITION_ACTIVATE)),
        after_configuring("unconfigured", again),
    ]
    return LaunchDescription([config, *arguments, *map(RegisterEventHandler, handlers), node])


def _text(name: str) -> ParameterValue:
    """An argument that stays text, whatever YAML would take it for."""
    return ParameterValue(LaunchConfiguration(name), value_type=str)
