"""Windows as features, and read back."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from lerobot_real import differences, offset_of
from lumitip import Calibration, Frame
from lumitip.errors import ArgumentError
from lumitip.frame import RecordedFrame

Make = Callable[..., list[Frame]]
BARE = Calibration("test", "design")


def as_recorded(frames: list[Frame]) -> list[RecordedFrame]:
    return [
        RecordedFrame(f.seq, f.t_device, f.t_host, f.t_wall, f.raw, f.bits, f.dropped_before)
        for f in frames
    ]


def stored(plugin: Any, observations: list[list[Frame]], **options: Any) -> Any:
    """Windows of three cells, stored as float32 and read back."""
    from lerobot_robot_lumitip.windows import WindowFeatures

    features = WindowFeatures("left", options.get("window", 4), 3, options.get("trace", True))
    rows, last = [], observations[0][0].seq - 1
    for frames in observations:
        newest = frames[-1].seq if frames else last
        now_s = 0.005 * newest + 0.002
        missed = newest - last - len(frames)
        rows.append(features.values(frames, now_s, missed, options.get("calibration", BARE)))
        last = newest
    names = ["shoulder.pos", *features.names(), "gripper.pos"]
    states = np.array([[9.0, *row, 9.0] for row in rows], dtype=np.float32)
    return plugin.read_windows(names, states)["left"]


def test_windows_are_read_back_exactly(plugin: Any, make_frames: Make) -> None:
    frames = make_frames([5, 6, 8, 9, 10, 11, 12])
    found = stored(plugin, [frames[:3], [], frames[3:]])
    assert found.seq.tolist() == [[-1, 5, 6, 8], [-1] * 4, [9, 10, 11, 12]]
    assert found.back.tolist() == [[-1, 3, 2, 0], [-1] * 4, [3, 2, 1, 0]]
    assert found.missed.tolist() == [1, 0, 0]
    assert found.bits.tolist() == [12, -1, 12]
    np.testing.assert_array_equal(found.codes[0, 1:], [f.raw for f in frames[:3]])
    assert (found.codes[0, 0] == -1).all() and (found.codes[1] == -1).all()
    np.testing.assert_allclose(found.age_s[2], [0.017, 0.012, 0.007, 0.002], atol=1e-6)
    assert differences(found, as_recorded(frames), [0, 0, 0]) == []


def test_every_code_of_12_bits_and_the_largest_number_are_exact(
    plugin: Any, make_frames: Make
) -> None:
    (frame,) = make_frames([(1 << 24) + 3])
    for code in (0, 1, 2047, 4094, 4095):
        same = replace(frame, raw=np.full(3, code, np.uint16))
        found = stored(plugin, [[same]])
        assert found.codes[0, -1].tolist() == [code] * 3
    assert found.seq[0, -1] == 3
    (frame,) = make_frames([(1 << 24) - 1])
    assert stored(plugin, [[frame]]).seq[0, -1] == (1 << 24) - 1


@pytest.mark.parametrize("bits", [8, 10, 12])
def test_light_is_that_of_the_frames(plugin: Any, make_frames: Make, bits: int) -> None:
    frames = make_frames([1, 2], bits=bits)
    light = stored(plugin, [frames]).values()
    assert np.isnan(light[0, :2]).all()
    np.testing.assert_array_equal(light[0, 2:], [f.values for f in frames])
    empty = np.array([251.3, 199.9, 254.1], np.float32)
    tared = Calibration("test", "design", empty, np.array([1.1, 0.0, 3.3], np.float32))
    correction = tared.correction()
    assert correction is not None
    light = stored(plugin, [frames], calibration=tared).values()
    expected = [correction.apply(f.values) for f in frames]
    np.testing.assert_array_equal(light[0, 2:], expected)


def test_without_trace_loss_is_still_visible(plugin: Any, make_frames: Make) -> None:
    found = stored(plugin, [make_frames([1, 2, 4])], trace=False)
    assert found.seq is None and found.missed.tolist() == [1]
    assert found.back.tolist() == [[-1, 3, 2, 0]]
    with pytest.raises(ArgumentError, match="trace=true"):
        found.values()


def test_other_features_are_rejected(plugin: Any) -> None:
    from lerobot_robot_lumitip.windows import WindowFeatures

    names = WindowFeatures("left", 2, 3, True).names()
    with pytest.raises(ArgumentError, match=r"shape \(1, 4\)"):
        plugin.read_windows(names, np.zeros((1, 4)))
    with pytest.raises(ArgumentError, match="no fingertip"):
        plugin.read_windows(["shoulder.pos"], np.zeros((1, 1)))
    for damaged in (names[1:], [names[1], names[0], *names[2:]]):
        with pytest.raises(ArgumentError, match="missing or in disorder"):
            plugin.read_windows(damaged, np.zeros((1, len(damaged))))


def test_the_comparison_finds_every_damage(plugin: Any, make_frames: Make) -> None:
    frames = make_frames(list(range(40, 60)))
    windows = stored(plugin, [frames[0:3], frames[3:7], frames[7:10]])
    recorded, episodes = as_recorded(frames), [0, 0, 0]
    assert differences(windows, recorded, episodes) == []

    def damaged(name: str, change: Callable[[Any], None]) -> list[str]:
        array = getattr(windows, name).copy()
        change(array)
        return differences(replace(windows, **{name: array}), recorded, episodes)

    shifted = damaged("codes", lambda codes: codes[1].__setitem__(slice(1, 4), codes[1, :3]))
    assert "row 1: codes differ" in shifted
    one = damaged("codes", lambda codes: codes[2].__setitem__((3, 1), codes[2, 3, 1] ^ 1))
    assert "row 2: codes differ" in one and "row 2: light differs" in one
    later = damaged("seq", lambda seq: seq.__setitem__(1, seq[1] + 1))
    assert "row 1: codes differ" in later and "row 1: 5 frames came, 4 are there" in later
    assert "row 1: bits differ" in damaged("bits", lambda bits: bits.__setitem__(1, 10))
    assert "row 0: ages differ" in damaged("age_s", lambda age_s: age_s[0].__setitem__(1, 0.1))
    assert damaged("missed", lambda missed: missed.__setitem__(1, 1)) == [
        "row 1: 4 frames came, 4 are there"
    ]
    disordered = damaged("back", lambda back: back[0].__setitem__(slice(0, 2), back[0, 1::-1]))
    assert "row 0: frames are not at the end of the window" in disordered
    assert differences(windows, recorded[1:], episodes) == [
        "row 0: frames [40] are not in the recording"
    ]


def test_a_recording_with_other_numbers_is_compared_by_its_codes(
    plugin: Any, make_frames: Make
) -> None:
    frames = make_frames(list(range(40, 60)))
    windows = stored(plugin, [frames[0:3], frames[3:7]])
    other = [replace(frame, seq=frame.seq + 100) for frame in as_recorded(frames)]
    assert offset_of(windows, other) == -100
    assert differences(windows, other, [0, 0], -100) == []
    assert differences(windows, other, [0, 0], -99) != []
