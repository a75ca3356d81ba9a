"""Stands in for `rclpy.node`."""

from types import SimpleNamespace

import rclpy


class Node:
    """A node with the parameters' defaults."""

    def __init__(self, name):
        self._name = name

    def declare_parameter(self, _, default):
        return SimpleNamespace(value=default)

    def create_publisher(self, kind, topic, _):
        def publish(message):
            assert type(message) is kind
            rclpy.published.append((topic.replace("~", f"/{self._name}"), message))

        return SimpleNamespace(publish=publish)

    def get_logger(self):
        return SimpleNamespace(info=lambda text: print("info", text))

    def destroy_node(self):
        print("destroyed")
