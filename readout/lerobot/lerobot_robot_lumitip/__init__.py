"""Fingertips of Lumitip in LeRobot, alone or on another robot.

LeRobot imports this package by its name, and finds each device beside its configuration.
"""

from lerobot_robot_lumitip.config import LumitipConfig, LumitipIdleConfig
from lerobot_robot_lumitip.idle import LumitipIdle
from lerobot_robot_lumitip.robot import Lumitip
from lerobot_robot_lumitip.windows import Windows, read_windows

__all__ = [
    "Lumitip",
    "LumitipConfig",
    "LumitipIdle",
    "LumitipIdleConfig",
    "Windows",
    "read_windows",
]
