"""Stands in for `rclpy.node`."""

import sys
from types import SimpleNamespace

import rclpy


class Node:
    """A node; a parameter is its default, or what the command line says (`-p name:=value`)."""

    def __init__(self, name):
        self._name = name

    def declare_parameter(self, name, default):
        written = dict(text.split(":=", 1) for text in sys.argv if ":=" in text)
        return SimpleNamespace(value=written.get(name, default))

    def create_publisher(self, kind, topic, _):
        def publish(message):
            assert type(message) is kind
            rclpy.published.append((topic.replace("~", f"/{self._name}"), message))

        return SimpleNamespace(publish=publish)

    def get_logger(self):
        return SimpleNamespace(info=lambda text: print("info", text))

    def destroy_node(self):
        print("destroyed")
