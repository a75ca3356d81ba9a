"""LeRobot without LeRobot and torch: as much as `lerobot_robot_lumitip` uses, with the abstract
methods, signatures and rules of discovery of release 0.4.4. `python tests/lerobot_real.py` compares
them with the LeRobot that is installed."""

import abc
import importlib
import importlib.metadata
from collections.abc import Callable
from dataclasses import dataclass, fields
from functools import wraps
from pathlib import Path
from types import ModuleType
from typing import Any, ClassVar

import numpy as np

PREFIXES = ("lerobot_robot_", "lerobot_camera_", "lerobot_teleoperator_", "lerobot_policy_")


class ChoiceRegistry:
    """Of draccus: configurations by the word in `--robot.type`."""

    choices: ClassVar[dict[str, type]] = {}

    @classmethod
    def register_subclass(cls, name: str) -> Callable[[type], type]:
        def register(choice: type) -> type:
            assert name not in cls.choices, f"{name} is registered twice"
            cls.choices[name] = choice
            return choice

        return register

    @property
    def type(self) -> str:
        return next(name for name, choice in self.choices.items() if choice is type(self))


def decode(cls: Any, raw_value: Any) -> Any:
    """Of draccus."""
    options = dict(raw_value)
    choice = cls.choices[options.pop("type")]
    assert set(options) <= {field.name for field in fields(choice)}
    return choice(**options)


class Device(abc.ABC):
    """What robots and teleoperators have in common."""

    config_class: type
    name: str

    def __init__(self, config: Any) -> None:
        self.id = config.id

    def __str__(self) -> str:
        return f"{self.id} {self.__class__.__name__}"

    def __enter__(self) -> Any:
        self.connect()
        return self

    def __exit__(self, *_: object) -> None:
        self.disconnect()

    @property
    @abc.abstractmethod
    def action_features(self) -> dict[str, Any]: ...

    @property
    @abc.abstractmethod
    def is_connected(self) -> bool: ...

    @property
    @abc.abstractmethod
    def is_calibrated(self) -> bool: ...

    @abc.abstractmethod
    def connect(self, calibrate: bool = True) -> None: ...

    @abc.abstractmethod
    def calibrate(self) -> None: ...

    @abc.abstractmethod
    def configure(self) -> None: ...

    @abc.abstractmethod
    def disconnect(self) -> None: ...


class Robot(Device):
    def __init__(self, config: Any) -> None:
        super().__init__(config)
        self.robot_type = self.name

    @property
    @abc.abstractmethod
    def observation_features(self) -> dict[str, Any]: ...

    @abc.abstractmethod
    def get_observation(self) -> dict[str, Any]: ...

    @abc.abstractmethod
    def send_action(self, action: dict[str, Any]) -> dict[str, Any]: ...


class Teleoperator(Device):
    @property
    @abc.abstractmethod
    def feedback_features(self) -> dict[str, Any]: ...

    @abc.abstractmethod
    def get_action(self) -> dict[str, Any]: ...

    @abc.abstractmethod
    def send_feedback(self, feedback: dict[str, Any]) -> None: ...


class DeviceNotConnectedError(ConnectionError): ...


class DeviceAlreadyConnectedError(ConnectionError): ...


def check_if_not_connected(func: Any) -> Any:
    @wraps(func)
    def wrapper(self: Any, *args: Any, **kwargs: Any) -> Any:
        if not self.is_connected:
            raise DeviceNotConnectedError(f"{self.__class__.__name__} is not connected.")
        return func(self, *args, **kwargs)

    return wrapper


def check_if_already_connected(func: Any) -> Any:
    @wraps(func)
    def wrapper(self: Any, *args: Any, **kwargs: Any) -> Any:
        if self.is_connected:
            raise DeviceAlreadyConnectedError(f"{self.__class__.__name__} is already connected.")
        return func(self, *args, **kwargs)

    return wrapper


def make_device_from_device_class(config: Any) -> Any:
    """The class is named as its configuration, without `Config`, and stands in the package or in a
    module of its own name."""
    module = type(config).__module__
    package = module.rpartition(".")[0] or module
    name = type(config).__name__
    assert name.endswith("Config")
    device = name.removesuffix("Config")
    for place in (package, f"{package}.{device.lower()}"):
        try:
            found = getattr(importlib.import_module(place), device, None)
        except ImportError:
            continue
        if found is not None:
            return found(config)
    raise ImportError(f"Could not locate device class '{device}' for config '{name}'")


def register_third_party_plugins() -> None:
    """Import each distribution with one of the prefixes, as it is written."""
    for distribution in importlib.metadata.distributions():
        name = distribution.metadata.get("Name")
        if name and name.startswith(PREFIXES):
            importlib.import_module(name)


def hw_to_dataset_features(
    hw_features: dict[str, Any], prefix: str, use_video: bool = True
) -> dict[str, dict[str, Any]]:
    """All floats are one feature; a tuple is an image."""
    names = [name for name, kind in hw_features.items() if kind is float]
    key = "action" if prefix == "action" else f"{prefix}.state"
    features = {key: {"dtype": "float32", "shape": (len(names),), "names": names}} if names else {}
    for name, shape in hw_features.items():
        if isinstance(shape, tuple):
            dtype = "video" if use_video else "image"
            features[f"{prefix}.images.{name}"] = {"dtype": dtype, "shape": shape}
    return features


def build_dataset_frame(
    ds_features: dict[str, dict[str, Any]], values: dict[str, Any], prefix: str
) -> dict[str, Any]:
    """The row of a dataset."""
    return {
        key: np.array([values[name] for name in feature["names"]], dtype=np.float32)
        for key, feature in ds_features.items()
        if key.startswith(prefix) and feature["dtype"] == "float32"
    }


def lerobot_modules() -> dict[str, ModuleType]:
    """The modules by name, with new registries."""

    @dataclass(kw_only=True)
    class RobotConfig(ChoiceRegistry):
        choices: ClassVar[dict[str, type]] = {}
        id: str | None = None
        calibration_dir: Path | None = None

        def __post_init__(self) -> None: ...

    @dataclass(kw_only=True)
    class TeleoperatorConfig(ChoiceRegistry):
        choices: ClassVar[dict[str, type]] = {}
        id: str | None = None
        calibration_dir: Path | None = None

    names: dict[str, dict[str, Any]] = {
        "draccus": {"decode": decode},
        "lerobot": {},
        "lerobot.robots": {
            "Robot": Robot,
            "RobotConfig": RobotConfig,
            "make_robot_from_config": make_device_from_device_class,
        },
        "lerobot.teleoperators": {
            "Teleoperator": Teleoperator,
            "TeleoperatorConfig": TeleoperatorConfig,
            "make_teleoperator_from_config": make_device_from_device_class,
        },
        "lerobot.utils": {},
        "lerobot.utils.decorators": {
            "check_if_already_connected": check_if_already_connected,
            "check_if_not_connected": check_if_not_connected,
        },
    }
    modules = {}
    for name, members in names.items():
        modules[name] = ModuleType(name)
        vars(modules[name]).update(members)
    return modules
