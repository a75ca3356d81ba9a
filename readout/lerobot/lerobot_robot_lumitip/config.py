"""The options of `--robot.type=lumitip` and `--teleop.type=lumitip_idle`."""

import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from lerobot.robots import RobotConfig
from lerobot.teleoperators import TeleoperatorConfig

from lumitip.errors import ArgumentError

MOST_FRAMES = 256
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*")


@RobotConfig.register_subclass("lumitip")
@dataclass(kw_only=True)
class LumitipConfig(RobotConfig):
    """One or more fingertips, and the robot that they are on.

    Raises:
        ArgumentError: if an option cannot be used.
    """

    fingers: dict[str, str] = field(default_factory=dict)
    """Addresses of the fingertips by name, such as `ble://Lumitip`; see `Fingertip.open`."""
    layouts: dict[str, str] = field(default_factory=dict)
    """Paths of `layout.json` by the names of the fingers that need one."""
    robot: dict[str, Any] = field(default_factory=dict)
    """Options of the robot, with its `type`; without them there are the fingertips alone. Not a
    `RobotConfig`: LeRobot's parser would look for this class in itself without end."""
    window: int = 8
    """Frames in an observation: at least the frame rate divided by `--dataset.fps`."""
    trace: bool = True
    """Whether observations have the number of their newest frame, bits and references."""
    recordings: Path | None = None
    """Folder for an MCAP recording of each finger, with every frame; default: none."""
    timeout_s: float = 10.0
    """Longest wait for the connection of a finger, and for its first frame (s)."""
    max_silence_s: float = 3.0
    """Age of a finger's newest frame that is an error (s)."""

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.fingers:
            raise ArgumentError(
                "fingers is empty; at least one fingertip is needed, such as "
                "--robot.fingers='{left: \"twin://demo\"}'"
            )
        for name in self.fingers:
            if not _NAME.fullmatch(name):
                raise ArgumentError(
                    f"fingers has the name {name!r}; a letter, then letters, digits and _ are "
                    "needed, such as left"
                )
        if unknown := sorted(set(self.layouts) - set(self.fingers)):
            raise ArgumentError(
                f"layouts has {unknown[0]!r}; the fingers are {', '.join(self.fingers)}"
            )
        if not 1 <= self.window <= MOST_FRAMES:
            raise ArgumentError(
                f"window is {self.window}; a number from 1 to {MOST_FRAMES} is needed"
            )
        for option in ("timeout_s", "max_silence_s"):
            if not getattr(self, option) > 0.0:
                raise ArgumentError(
                    f"{option} is {getattr(self, option)}; a number above 0 is needed"
                )


@TeleoperatorConfig.register_subclass("lumitip_idle")
@dataclass(kw_only=True)
class LumitipIdleConfig(TeleoperatorConfig):
    """No action: for fingertips without a robot."""
