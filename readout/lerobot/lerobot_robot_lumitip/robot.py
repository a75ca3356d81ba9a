"""`--robot.type=lumitip`: fingertips, alone or on another robot."""

from contextlib import ExitStack
from functools import cached_property
from typing import Any

import draccus
from lerobot.robots import Robot, RobotConfig, make_robot_from_config
from lerobot.utils.decorators import check_if_already_connected, check_if_not_connected

from lerobot_robot_lumitip.config import LumitipConfig
from lerobot_robot_lumitip.finger import Finger
from lerobot_robot_lumitip.windows import WindowFeatures
from lumitip import FingertipGroup, Layout
from lumitip.errors import ArgumentError
from lumitip.links import open_link


class Lumitip(Robot):
    """A robot whose observations have the frames of its fingertips since the observation before.

    All else is that of the robot in `config.robot`, if there is one.
    """

    config_class = LumitipConfig
    name = "lumitip"

    def __init__(self, config: LumitipConfig) -> None:
        super().__init__(config)
        self.config = config
        self.robot: Robot | None = None
        if config.robot:
            self.robot = make_robot_from_config(draccus.decode(RobotConfig, config.robot))
        self.cameras: dict[str, Any] = getattr(self.robot, "cameras", {})
        self._group: FingertipGroup | None = None
        self._fingers: list[Finger] = []
        self._closing = ExitStack()

    @cached_property
    def layouts(self) -> dict[str, Layout]:
        """Cells of each finger, from its file, its server or this computer's memory.

        Raises:
            LumitipError: as `Fingertip.open`.
        """
        found = {}
        for name, url in self.config.fingers.items():
            path = self.config.layouts.get(name)
            own = None if path is None else Layout.load(path)
            found[name] = open_link(url, own, timeout_s=self.config.timeout_s).layout
        return found

    @cached_property
    def observation_features(self) -> dict[str, Any]:
        """Those of the robot, then all features of each finger, see `windows`.

        Raises:
            ArgumentError: if the robot has one of the same name.
            LumitipError: if the cells of a finger are not known.
        """
        features: dict[str, Any] = dict(self.robot.observation_features) if self.robot else {}
        for name in (name for one in self._windows() for name in one.names()):
            if name in features:
                raise ArgumentError(
                    f"{self.robot} has a feature {name!r} too; choose another name of the finger"
                )
            features[name] = float
        return features

    @property
    def action_features(self) -> dict[str, Any]:
        """Those of the robot; none without a robot."""
        return self.robot.action_features if self.robot else {}

    @property
    def is_connected(self) -> bool:
        """Whether it was connected, and not disconnected since."""
        return self._group is not None

    @check_if_already_connected
    def connect(self, calibrate: bool = True) -> None:
        """Connect to all, or to none: the fingers, then the robot.

        Raises:
            LumitipError: as `Fingertip.open`, or if a finger sends nothing or its recording cannot
                be written.
            Exception: of the robot.
        """
        config = self.config
        with ExitStack() as stack:
            group = FingertipGroup.open(config.fingers, self.layouts, timeout=config.timeout_s)
            stack.enter_context(group)
            fingers = [
                stack.enter_context(
                    Finger.reading(one, group.tips[one.finger], config.recordings, config.timeout_s)
                )
                for one in self._windows()
            ]
            stack.callback(self._disconnect_robot)
            if self.robot:
                self.robot.connect(calibrate)
            self._closing = stack.pop_all()
        self._group, self._fingers = group, fingers

    @property
    def is_calibrated(self) -> bool:
        """Whether the robot is, and each finger has the reference of an empty grasp."""
        fingers = self._group is not None and all(
            tip.calibration.empty is not None for tip in self._group.tips.values()
        )
        return fingers and (self.robot is None or self.robot.is_calibrated)

    @check_if_not_connected
    def calibrate(self) -> None:
        """Measure and save the empty grasp of each finger, then calibrate the robot.

        Raises:
            CalibrationError: if the grasp is not empty.
        """
        assert self._group is not None
        for tip in self._group.tips.values():
            tip.tare()
        if self.robot:
            self.robot.calibrate()

    def configure(self) -> None:
        """Configure the robot."""
        if self.robot:
            self.robot.configure()

    @check_if_not_connected
    def get_observation(self) -> dict[str, Any]:
        """The observation of the robot, then the frames of each finger since the last call.

        The fingers come last: reading an arm and cameras takes time, and frames that come
        meanwhile belong to this observation.

        Raises:
            StaleFrame: if a finger is silent for longer than `max_silence_s`.
            LumitipError: why a finger sends no more, or cannot be recorded.
        """
        values: dict[str, Any] = dict(self.robot.get_observation()) if self.robot else {}
        for finger in self._fingers:
            values |= finger.observe(self.config.max_silence_s)
        return values

    @check_if_not_connected
    def send_action(self, action: dict[str, Any]) -> dict[str, Any]:
        """Pass an action on to the robot.

        Raises:
            ArgumentError: if there is no action for it.
        """
        if self.robot is None:
            return action
        if self.action_features and not action:
            raise ArgumentError(
                f"there is no action for {self.robot}; lumitip_idle is for fingertips without a "
                "robot: choose the robot's own teleoperator"
            )
        return self.robot.send_action(action)

    @check_if_not_connected
    def disconnect(self) -> None:
        """Disconnect the robot, then the fingers; all of them, even if one fails."""
        self._group, self._fingers = None, []
        self._closing.close()

    def _disconnect_robot(self) -> None:
        if self.robot and self.robot.is_connected:
            self.robot.disconnect()

    def _windows(self) -> list[WindowFeatures]:
        window, trace = self.config.window, self.config.trace
        return [WindowFeatures(n, window, len(one), trace) for n, one in self.layouts.items()]
