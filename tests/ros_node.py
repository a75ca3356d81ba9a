"""A ROS 2 node in Python without ROS: as much of rclpy as `lumitip_ros` uses. Publishers keep what
is published, timers and services are called by the test."""

import sys
import threading
from collections.abc import Callable
from contextlib import suppress
from enum import Enum
from types import ModuleType, SimpleNamespace
from typing import Any, ClassVar


class Returned(Enum):
    """Of a transition."""

    SUCCESS, FAILURE, ERROR = range(3)


class Node:
    """A node; tests may set `overrides` before it is made."""

    overrides: ClassVar[dict[str, Any]] = {}
    made: ClassVar[list["Node"]] = []

    def __init__(self, name: str) -> None:
        self.name = name
        self.parameters: dict[str, Any] = {}
        self.published: dict[str, list[Any]] = {}
        self.qos: dict[str, Any] = {}
        self.services: dict[str, Callable[..., Any]] = {}
        self.timers: list[Callable[[], None]] = []
        self.groups: dict[str, Any] = {}
        self.acknowledged: dict[str, int] = {}
        self.logged: list[tuple[str, str]] = []
        self.destroyed = False
        Node.made.append(self)

    def declare_parameter(self, name: str, default: Any) -> None:
        assert name not in self.parameters
        self.parameters[name] = type(default)(self.overrides.get(name, default))

    def get_parameter(self, name: str) -> Any:
        return SimpleNamespace(value=self.parameters[name])

    def get_fully_qualified_name(self) -> str:
        return f"/{self.name}"

    def get_clock(self) -> Any:
        stamp = sys.modules["builtin_interfaces.msg"].Time(sec=1, nanosec=2)
        return SimpleNamespace(now=lambda: SimpleNamespace(to_msg=lambda: stamp))

    def get_logger(self) -> Any:
        def log(level: str) -> Callable[[str], None]:
            return lambda text: self.logged.append((level, text))

        return SimpleNamespace(**{n: log(n) for n in ("info", "warning", "error", "fatal")})

    def create_publisher(self, kind: type, topic: str, qos: Any) -> Any:
        return self._publisher(kind, topic, qos, lambda: True)

    def create_service(
        self, kind: type, name: str, answer: Callable[..., Any], callback_group: Any = None
    ) -> None:
        self.services[name] = lambda: answer(kind.Request(), kind.Response())
        self.groups[name] = callback_group

    def create_timer(
        self, period_s: float, call: Callable[[], None], callback_group: Any = None
    ) -> None:
        assert period_s > 0.0
        self.timers.append(call)
        self.groups["timer"] = callback_group

    def destroy_node(self) -> None:
        self.destroyed = True

    def _publisher(self, kind: type, topic: str, qos: Any, active: Callable[[], bool]) -> Any:
        kept = self.published.setdefault(topic, [])
        self.qos[topic] = qos

        def publish(message: Any) -> None:
            assert type(message) is kind, (topic, message)
            if active():
                kept.append(message)

        def wait_for_all_acked(_: Any) -> None:
            self.acknowledged[topic] = len(kept)

        return SimpleNamespace(publish=publish, wait_for_all_acked=wait_for_all_acked)


class LifecycleNode(Node):
    """Its publishers are silent unless it is active."""

    def __init__(self, name: str) -> None:
        super().__init__(name)
        self.active = False

    def create_lifecycle_publisher(self, kind: type, topic: str, qos: Any) -> Any:
        return self._publisher(kind, topic, qos, lambda: self.active)

    def on_activate(self, _: Any) -> Returned:
        self.active = True
        return Returned.SUCCESS

    def on_deactivate(self, _: Any) -> Returned:
        self.active = False
        return Returned.SUCCESS


class Executor:
    """Runs until the test's time is over."""

    rounds = 50
    shut_down = False

    def __init__(self, threads: int) -> None:
        assert threads > 1, "a service that waits would block the timers"
        self._left = self.rounds
        Executor.shut_down = False

    def add_node(self, node: Node) -> None:
        self._node = node
        with suppress(AttributeError):
            node.on_configure(None)
            node.on_activate(None)

    def shutdown(self) -> None:
        Executor.shut_down = True

    def spin_once(self, timeout_sec: float) -> None:
        threading.Event().wait(timeout_sec)
        self._left -= 1
        if not self._left:
            raise KeyboardInterrupt


SENSOR_DATA = object()


def rclpy_modules() -> dict[str, ModuleType]:
    """`rclpy`, `tf2_ros` and `std_srvs`, by name."""
    contents: dict[str, dict[str, Any]] = {
        "rclpy": {"init": lambda: None, "ok": lambda: True, "try_shutdown": lambda: None},
        "rclpy.callback_groups": {"MutuallyExclusiveCallbackGroup": type("Group", (), {})},
        "rclpy.duration": {"Duration": SimpleNamespace},
        "rclpy.executors": {
            "ExternalShutdownException": type("ExternalShutdownException", (Exception,), {}),
            "MultiThreadedExecutor": Executor,
        },
        "rclpy.lifecycle": {
            "LifecycleNode": LifecycleNode,
            "State": object,
            "TransitionCallbackReturn": Returned,
        },
        "rclpy.qos": {"qos_profile_sensor_data": SENSOR_DATA},
        "std_srvs": {},
        "std_srvs.srv": {"Trigger": _Trigger},
        "tf2_ros": {"TransformBroadcaster": _Broadcaster},
    }
    modules = {}
    for name, values in contents.items():
        modules[name] = ModuleType(name)
        for key, value in values.items():
            setattr(modules[name], key, value)
    return modules


class _Trigger:
    Request = type("Request", (), {})

    class Response:
        """As ROS makes it."""

        success, message = False, ""


class _Broadcaster:
    def __init__(self, node: Node) -> None:
        self._sent = node.published.setdefault("/tf", [])

    def sendTransform(self, placed: Any) -> None:  # noqa: N802 - ROS's name
        assert placed._kind == "geometry_msgs/msg/TransformStamped"
        self._sent.append(placed)
