"""The package `lerobot_robot_lumitip`, imported without LeRobot."""

import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lerobot_stand_ins import lerobot_modules
from lumitip import Frame
from lumitip.frame import complement

ROOT = Path(__file__).parents[3] / "readout" / "lerobot"
OURS = ("lerobot_robot_lumitip", "lerobot_arm")


@pytest.fixture
def lerobot(monkeypatch: pytest.MonkeyPatch) -> Iterator[dict[str, Any]]:
    """Stand-ins of LeRobot's modules by name; `import lerobot_robot_lumitip` works."""
    modules = lerobot_modules()
    for name, module in modules.items():
        monkeypatch.setitem(sys.modules, name, module)
    monkeypatch.syspath_prepend(str(ROOT))
    yield modules
    for name in [name for name in sys.modules if name.partition(".")[0] in OURS]:
        del sys.modules[name]


@pytest.fixture
def plugin(lerobot: dict[str, Any]) -> Any:  # noqa: ARG001
    """The package, and the small arm."""
    import lerobot_robot_lumitip

    import lerobot_arm  # noqa: F401

    return lerobot_robot_lumitip


@pytest.fixture
def make_robot(plugin: Any) -> Iterator[Callable[..., Any]]:
    """`make_robot(fingers={"left": "twin://edge?rate=200"})`: not yet connected."""
    made = []

    def make(**options: Any) -> Any:
        patient = {"timeout_s": 60.0, "max_silence_s": 60.0}  # other tests run beside this one
        options = {"fingers": {"left": "twin://edge?rate=200"}, **patient, **options}
        made.append(plugin.Lumitip(plugin.LumitipConfig(**options)))
        return made[-1]

    yield make
    for robot in made:
        if robot.is_connected:
            robot.disconnect()


@pytest.fixture
def make_frames() -> Callable[..., list[Frame]]:
    """`make_frames([7, 8, 10], cells=3, bits=12)`: frames with these numbers, at 200 Hz."""

    def make(numbers: list[int], cells: int = 3, bits: int = 12) -> list[Frame]:
        frames, last = [], numbers[0] - 1
        for number in numbers:
            rng = np.random.default_rng(number)
            raw = rng.integers(0, 1 << bits, cells).astype(np.uint8 if bits == 8 else np.uint16)
            t_s = 0.005 * number
            lost, last = number - last - 1, number
            frames.append(
                Frame(
                    seq=number,
                    t_device=t_s,
                    t_host=t_s,
                    t=t_s,
                    t_wall=1e9 + t_s,
                    raw=raw,
                    bits=bits,
                    values=complement(raw, bits),
                    dropped_before=lost,
                    device_id="test",
                )
            )
        return frames

    return make
