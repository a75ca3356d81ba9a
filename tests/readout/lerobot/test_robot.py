"""The robot `lumitip` on simulated fingertips, alone and on an arm."""

import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lerobot_real import differences
from lerobot_stand_ins import (
    DeviceAlreadyConnectedError,
    DeviceNotConnectedError,
    build_dataset_frame,
    hw_to_dataset_features,
)
from lumitip import Fingertip
from lumitip.errors import (
    ArgumentError,
    LayoutError,
    LinkError,
    LinkTimeout,
    StaleFrame,
    UrlError,
)
from lumitip.recording import Reader, RecordingError, Writer

Make = Callable[..., Any]
ARM = {"type": "small_arm", "id": "follower"}
TWO = {"left": "twin://edge?rate=200&bits=12", "right": "twin://cable?rate=200&seed=1"}


def observed(plugin: Any, robot: Any, count: int, pause_s: float = 0.03) -> dict[str, Any]:
    """Windows of all fingers, as a dataset would store them."""
    features = hw_to_dataset_features(robot.observation_features, "observation")
    rows = []
    for _ in range(count):
        time.sleep(pause_s)
        values = robot.get_observation()
        assert list(values) == list(robot.observation_features)
        rows.append(build_dataset_frame(features, values, "observation")["observation.state"])
    found: dict[str, Any] = plugin.read_windows(features["observation.state"]["names"], rows)
    return found


def links() -> list[str]:
    """Threads of fingertips that still run, once others had time to end."""
    until = time.monotonic() + 5.0
    while True:
        found = [t.name for t in threading.enumerate() if t.name.startswith("lumitip")]
        if not found or time.monotonic() > until:
            return found
        time.sleep(0.01)


def test_features_are_known_before_connecting_and_are_one_vector(make_robot: Make) -> None:
    robot = make_robot(fingers=TWO, window=3)
    features = robot.observation_features
    assert not robot.is_connected and links() == []
    assert set(features.values()) == {float}
    assert len(features) == 2 * (3 * (32 + 2) + 3 + 2 * 32)
    assert robot.action_features == {} and robot.cameras == {}
    (only,) = hw_to_dataset_features(features, "observation")
    assert only == "observation.state"
    assert len(make_robot(window=3, trace=False).observation_features) == 3 * (32 + 2) + 1


def test_windows_of_two_fingers_are_equal_to_their_recordings(
    plugin: Any, make_robot: Make, tmp_path: Path
) -> None:
    with make_robot(fingers=TWO, window=16, recordings=tmp_path / "new") as robot:
        found = observed(plugin, robot, 12)
    for finger, bits in (("left", 12), ("right", 8)):
        windows, frames = found[finger], list(Reader(tmp_path / "new" / f"{finger}.mcap"))
        assert differences(windows, frames, [0] * 12) == []
        seq = windows.seq[windows.valid]
        assert (np.diff(seq) >= 1).all()  # no frame is in two windows
        assert seq[-1] - seq[0] + 1 <= seq.size + windows.missed.sum()
        assert set(windows.bits.tolist()) <= {bits, -1}
    assert links() == []


def test_frames_that_do_not_fit_are_counted(plugin: Any, make_robot: Make, tmp_path: Path) -> None:
    with make_robot(window=2, recordings=tmp_path) as robot:
        windows = observed(plugin, robot, 6, 0.05)["left"]
    assert windows.missed.sum() >= 2
    assert differences(windows, list(Reader(tmp_path / "left.mcap")), [0] * 6) == []


def test_a_window_without_frames_is_marked(plugin: Any, make_robot: Make) -> None:
    with make_robot(fingers={"left": "twin://edge?rate=1"}) as robot:
        windows = observed(plugin, robot, 5, 0.0)["left"]
    row = [count == 0 for count in windows.valid.sum(axis=1)].index(True)
    assert (windows.codes[row] == -1).all() and (windows.age_s[row] == -1).all()
    assert (windows.seq[row] == -1).all() and windows.missed[row] == 0
    assert np.isnan(windows.values()[row]).all()


def recording(path: Path, numbers: list[int]) -> str:
    """Address of a replay of a recording of 200 Hz that has these frames."""
    from lumitip.frame import RecordedFrame
    from lumitip.links.twin import make, packet_at
    from lumitip.links.url import Url

    link = make(Url.parse("twin://cable?rate=200&bits=10"), None, False)
    began, clock_s, last = time.time(), time.monotonic(), numbers[0] - 1
    with Writer(path, link.layout, device_id="kept") as writer:
        for number in numbers:
            codes = packet_at(link.layout, link._options, number, 1).values[0]
            t_s, lost, last = 0.005 * number, number - last - 1, number
            writer.write(RecordedFrame(number, t_s, clock_s + t_s, began + t_s, codes, 10, lost))
    return f"replay://{path}"


@pytest.mark.slow
def test_lost_frames_and_the_end_are_visible(plugin: Any, make_robot: Make, tmp_path: Path) -> None:
    numbers = [n for n in range(200) if n % 7 and not 60 <= n < 70]
    url = recording(tmp_path / "kept.mcap", numbers)
    rows = []
    with make_robot(fingers={"left": url}, window=256, max_silence_s=1.0) as robot:
        names = list(robot.observation_features)
        with pytest.raises(StaleFrame, match=r"left: the newest frame is 1\.\d+ s old"):
            while True:
                rows.append(list(robot.get_observation().values()))
                time.sleep(0.03)
    windows = plugin.read_windows(names, rows)["left"]
    found = windows.seq[windows.valid].tolist()
    assert found == numbers[-len(found) :] and len(found) > 100
    kept = list(Reader(tmp_path / "kept.mcap"))
    assert differences(windows, kept, [0] * len(rows)) == []
    assert windows.missed.sum() == found[-1] - found[0] + 1 - len(found)
    assert links() == []


def test_an_arm_and_its_fingers_are_one_robot(plugin: Any, make_robot: Make) -> None:
    robot = make_robot(robot=ARM)
    assert list(robot.action_features) == ["shoulder.pos", "gripper.pos"]
    assert list(robot.observation_features)[:2] == ["shoulder.pos", "gripper.pos"]
    assert robot.cameras is robot.robot.cameras
    robot.connect()
    action = {"shoulder.pos": 1.5, "gripper.pos": -2.0}
    assert robot.send_action(action) == action
    values = robot.get_observation()
    assert (values["shoulder.pos"], values["gripper.pos"]) == (1.5, -2.0)
    with pytest.raises(ArgumentError, match="choose the robot's own teleoperator"):
        robot.send_action(plugin.LumitipIdle(plugin.LumitipIdleConfig()).get_action())
    with pytest.raises(DeviceAlreadyConnectedError):
        robot.connect()
    robot.configure()
    robot.disconnect()
    assert robot.robot.calls == ["connect", "configure", "disconnect"]
    with pytest.raises(DeviceNotConnectedError):
        robot.get_observation()
    robot.connect()
    assert robot.get_observation()["lumitip_left.bits"] in (8.0, -1.0)


def test_frames_that_come_while_the_arm_is_read_are_in_the_same_row(make_robot: Make) -> None:
    with make_robot(robot=ARM, window=1) as robot:
        tip, read = robot._group.tips["left"], robot.robot.get_observation
        seen = []

        def slow() -> Any:
            first = tip.wait_latest(60.0).seq
            while (last := tip.wait_latest(60.0).seq) < first + 40:
                pass
            seen.append((first, last))
            return read()

        robot.robot.get_observation = slow
        values = robot.get_observation()
    ((first, last),) = seen
    assert last - 20 <= values["lumitip_left.seq"] > first  # its own thread may be a little late


def test_the_first_row_has_a_frame(plugin: Any) -> None:  # noqa: ARG001
    from lerobot_robot_lumitip.finger import Finger
    from lerobot_robot_lumitip.windows import WindowFeatures

    with Fingertip.open("twin://edge?rate=2") as tip:
        while not tip.stats.received:
            time.sleep(0.001)
        features = WindowFeatures("left", 4, len(tip.layout), True)
        with Finger.reading(features, tip, None, 60.0) as finger:
            values = finger.observe(60.0)
    assert values["lumitip_left.f3.back"] == 0.0 and values["lumitip_left.f3.c0"] >= 0.0


@pytest.mark.parametrize("late", [False, True])
def test_where_the_arm_fails_all_is_closed(make_robot: Make, tmp_path: Path, late: bool) -> None:
    fails = "disconnect" if late else "connect"
    robot = make_robot(fingers=TWO, robot={**ARM, "fails": [fails]}, recordings=tmp_path)
    with pytest.raises(ConnectionError, match=f"small_arm: {fails} fails"):
        robot.connect()
        robot.disconnect()
    assert not robot.is_connected and not robot.robot.is_connected
    assert links() == []
    list(Reader(tmp_path / "left.mcap"))  # it is complete, or raises


def test_a_silent_finger_closes_all(make_robot: Make) -> None:
    url = "twin://disc?rate=1"
    Fingertip.open(url).close()  # its tables are computed now
    robot = make_robot(fingers={"thumb": url}, robot=ARM, timeout_s=0.3)
    with pytest.raises(LinkTimeout, match=r"thumb: .* is connected but sends nothing"):
        robot.connect()
    assert not robot.is_connected and robot.robot.calls == []
    assert links() == []


@pytest.mark.parametrize(
    ("fingers", "layouts", "error", "text"),
    [
        ({"left": "usb://edge"}, {}, UrlError, "allowed are ble://"),
        ({"left": "twin://ball"}, {}, UrlError, "there is no shape 'ball'"),
        ({"left": "tcp://127.0.0.1:9"}, {}, LinkError, "lumitip serve"),
        ({"left": "twin://edge"}, {"left": "none.json"}, LayoutError, "none.json"),
    ],
)
def test_a_wrong_address_fails_before_anything_moves(
    make_robot: Make,
    fingers: dict[str, str],
    layouts: dict[str, str],
    error: type[Exception],
    text: str,
) -> None:
    robot = make_robot(fingers=fingers, layouts=layouts, robot=ARM)
    for use in (lambda: robot.observation_features, robot.connect):
        with pytest.raises(error, match=text):
            use()
    assert robot.robot.calls == [] and links() == []


@pytest.mark.parametrize(
    ("options", "text"),
    [
        ({"fingers": {}}, "fingers is empty"),
        ({"fingers": {"a.b": "twin://edge"}}, "'a.b'"),
        ({"layouts": {"right": "layout.json"}}, "layouts has 'right'; the fingers are left"),
        ({"window": 0}, "window is 0; a number from 1 to 256"),
        ({"max_silence_s": -1.0}, "max_silence_s is -1.0"),
        ({"timeout_s": float("nan")}, "timeout_s is nan"),
    ],
)
def test_wrong_options(make_robot: Make, options: dict[str, Any], text: str) -> None:
    with pytest.raises(ArgumentError, match=text):
        make_robot(**options)


def test_a_name_of_the_arm_cannot_be_one_of_a_finger(make_robot: Make) -> None:
    robot = make_robot(robot={**ARM, "joints": ["lumitip_left.f0.c0"]})
    with pytest.raises(ArgumentError, match=r"follower SmallArm has a feature 'lumitip_left\.f0"):
        _ = robot.observation_features


def test_a_recording_that_exists_is_kept(make_robot: Make, tmp_path: Path) -> None:
    (tmp_path / "left.mcap").write_text("mine")
    robot = make_robot(recordings=tmp_path)
    with pytest.raises(RecordingError, match=r"left\.mcap exists"):
        robot.connect()
    assert (tmp_path / "left.mcap").read_text() == "mine" and links() == []


def test_a_recording_that_cannot_be_written_is_an_error(make_robot: Make, tmp_path: Path) -> None:
    with make_robot(recordings=tmp_path) as robot:
        robot._fingers[0]._writer.close()
        with pytest.raises(RecordingError, match="is closed"):
            for _ in range(200):
                robot.get_observation()
                time.sleep(0.03)
    assert links() == []


def test_calibrating_measures_the_empty_grasp(plugin: Any, make_robot: Make) -> None:
    robot = make_robot(fingers={"left": "twin://empty?rate=200"}, robot=ARM)
    robot.connect()
    assert not robot.is_calibrated
    robot.calibrate()
    assert robot.is_calibrated and robot.robot.calls == ["connect", "calibrate"]
    windows = observed(plugin, robot, 1)["left"]
    empty = robot._group.tips["left"].calibration.empty
    np.testing.assert_array_equal(windows.empty[0], empty)
    assert (windows.dark[0] == 0).all() and (empty < 255).all()
    frame = robot._group.tips["left"].wait_latest()
    light = observed(plugin, robot, 1)["left"].values()
    assert np.nanmin(light) > 230 and frame.values.min() > 230
