"""Stands in for ROS 2's `rclpy`, as far as `examples/ros2_node.py` uses it.

`spin` runs until twenty messages are published, then interrupts as a user would.
"""

import time

published = []


def init():
    """Does nothing."""


def try_shutdown():
    """Tell what was published, for the test to read."""
    for topic, message in published:
        print(topic, message)


def spin(_):
    """Wait for messages."""
    until = time.monotonic() + 10.0
    while len(published) < 20 and time.monotonic() < until:
        time.sleep(0.01)
    raise KeyboardInterrupt
