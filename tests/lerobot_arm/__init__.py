"""A small arm and its leader for LeRobot, of two joints: the robot that fingertips are on."""

from dataclasses import dataclass, field
from typing import Any

from lerobot.robots import Robot, RobotConfig
from lerobot.teleoperators import Teleoperator, TeleoperatorConfig

JOINTS = {"shoulder.pos": float, "gripper.pos": float}


@RobotConfig.register_subclass("small_arm")
@dataclass(kw_only=True)
class SmallArmConfig(RobotConfig):
    fails: list[str] = field(default_factory=list)
    """Names of methods that raise an error."""
    joints: list[str] = field(default_factory=lambda: list(JOINTS))


@TeleoperatorConfig.register_subclass("small_leader")
@dataclass(kw_only=True)
class SmallLeaderConfig(TeleoperatorConfig):
    pass


class Connects:
    """A device that is connected or not, and keeps what it was asked to do."""

    name: str

    def __init__(self, config: Any) -> None:
        super().__init__(config)  # type: ignore[call-arg]
        self.config = config
        self.connected = False
        self.calls: list[str] = []

    def note(self, call: str) -> None:
        """Note a call; it fails where it is to fail."""
        self.calls.append(call)
        if call in getattr(self.config, "fails", ()):
            raise ConnectionError(f"{self.name}: {call} fails")

    @property
    def is_connected(self) -> bool:
        return self.connected

    @property
    def is_calibrated(self) -> bool:
        return True

    def connect(self, calibrate: bool = True) -> None:  # noqa: ARG002
        self.connected = True
        self.note("connect")

    def calibrate(self) -> None:
        self.note("calibrate")

    def configure(self) -> None:
        self.note("configure")

    def disconnect(self) -> None:
        assert self.connected
        self.connected = False
        self.note("disconnect")


class SmallArm(Connects, Robot):
    """Its joints are where the last action has put them."""

    config_class = SmallArmConfig
    name = "small_arm"

    def __init__(self, config: SmallArmConfig) -> None:
        super().__init__(config)
        self.cameras: dict[str, Any] = {}
        self.at = dict.fromkeys(config.joints, 0.0)

    @property
    def observation_features(self) -> dict[str, Any]:
        return dict.fromkeys(self.at, float)

    @property
    def action_features(self) -> dict[str, Any]:
        return self.observation_features

    def get_observation(self) -> dict[str, Any]:
        return dict(self.at)

    def send_action(self, action: dict[str, Any]) -> dict[str, Any]:
        self.at = dict(action)
        return action


class SmallLeader(Connects, Teleoperator):
    """Its joints turn by one a call."""

    config_class = SmallLeaderConfig
    name = "small_leader"

    def __init__(self, config: SmallLeaderConfig) -> None:
        super().__init__(config)
        self.count = 0

    @property
    def action_features(self) -> dict[str, Any]:
        return JOINTS

    @property
    def feedback_features(self) -> dict[str, Any]:
        return {}

    def get_action(self) -> dict[str, Any]:
        self.count += 1
        return dict.fromkeys(JOINTS, float(self.count))

    def send_feedback(self, feedback: dict[str, Any]) -> None:
        pass
