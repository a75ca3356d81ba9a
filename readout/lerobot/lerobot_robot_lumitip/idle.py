"""`--teleop.type=lumitip_idle`: the teleoperator of fingertips without a robot."""

from typing import Any

from lerobot.teleoperators import Teleoperator

from lerobot_robot_lumitip.config import LumitipIdleConfig


class LumitipIdle(Teleoperator):
    """A teleoperator without actions."""

    config_class = LumitipIdleConfig
    name = "lumitip_idle"

    def __init__(self, config: LumitipIdleConfig) -> None:
        super().__init__(config)
        self._connected = False

    @property
    def action_features(self) -> dict[str, type]:
        """None."""
        return {}

    @property
    def feedback_features(self) -> dict[str, type]:
        """None."""
        return {}

    @property
    def is_connected(self) -> bool:
        """Whether `connect` was called."""
        return self._connected

    def connect(self, calibrate: bool = True) -> None:  # noqa: ARG002
        """Begin."""
        self._connected = True

    @property
    def is_calibrated(self) -> bool:
        """Always: there is nothing to calibrate."""
        return True

    def calibrate(self) -> None:
        """Do nothing."""

    def configure(self) -> None:
        """Do nothing."""

    def get_action(self) -> dict[str, Any]:
        """No action."""
        return {}

    def send_feedback(self, feedback: dict[str, Any]) -> None:
        """Do nothing."""

    def disconnect(self) -> None:
        """End."""
        self._connected = False
