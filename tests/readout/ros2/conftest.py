"""The package `lumitip_ros`, imported without ROS."""

import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from ros_definitions import message_modules, typestore
from ros_node import Node, rclpy_modules

ROOT = Path(__file__).parents[3] / "readout" / "ros2"


@pytest.fixture(scope="session")
def store() -> Any:
    """Definitions of all messages, as rosbags has them."""
    return typestore()


@pytest.fixture
def ros(store: Any, monkeypatch: pytest.MonkeyPatch) -> Iterator[Any]:
    """`lumitip_ros.node`, with `messages`, `markers` and `health` beside it."""
    for name, module in (message_modules(store) | rclpy_modules()).items():
        monkeypatch.setitem(sys.modules, name, module)
    monkeypatch.syspath_prepend(str(ROOT / "lumitip_ros"))
    import lumitip_ros.node

    yield lumitip_ros.node
    for name in [name for name in sys.modules if name.partition(".")[0] == "lumitip_ros"]:
        del sys.modules[name]


@pytest.fixture
def make_node(ros: Any, monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[..., Any]]:
    """`make_node(url="twin://cable")`: a node with these parameters."""
    made = []

    def make(**parameters: Any) -> Any:
        monkeypatch.setattr(Node, "overrides", parameters)
        made.append(ros.FingertipNode())
        return made[-1]

    yield make
    for node in made:
        node.destroy_node()
