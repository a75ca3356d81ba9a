"""Run the unmodified `lerobot-record` on two simulated fingertips and an arm, and compare its
dataset with MCAP recordings of the same session, bit for bit. Not a part of `make test`.

In an environment that has LeRobot and its plugin, see `readout/lerobot/README.md`:

    python tests/lerobot_real.py [FOLDER]

`left` is a twin of 12 bits that the plugin itself records. `right` is shared by `lumitip serve`, so
that another process records it too; this one numbers the frames from another one on.
"""

import abc
import dataclasses
import importlib
import inspect
import json
import os
import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import numpy as np

import lerobot_stand_ins
from lumitip.frame import RecordedFrame, complement
from lumitip.recording import Reader

TESTS = Path(__file__).parent
BIN = Path(sys.executable).parent
PORT = 8655
EPISODES, EPISODE_S, RESET_S = 3, 6, 2
MOST_AGE_ERROR_S = 1e-5


def differences(
    windows: Any, frames: Sequence[RecordedFrame], episodes: Sequence[int], offset: int = 0
) -> list[str]:
    """Where the windows of a dataset differ from a recording.

    Args:
        windows: of one finger, `lerobot_robot_lumitip.Windows`.
        frames: of the recording.
        episodes: number of the episode of each row; between two of them frames may be left out.
        offset: of the numbers in the dataset from those in the recording.
    """
    found: list[str] = []
    recorded = {frame.seq + offset: frame for frame in frames}
    light = windows.values()
    for row, valid in enumerate(windows.valid):
        if (np.diff(valid.astype(int)) < 0).any():
            found.append(f"row {row}: frames are not at the end of the window")
        seq = windows.seq[row][valid].tolist()
        if not seq:
            continue
        if row and episodes[row] == episodes[row - 1] and windows.valid[row - 1].any():
            came = seq[-1] - windows.seq[row - 1][-1]
            if came != len(seq) + windows.missed[row]:
                found.append(f"row {row}: {came} frames came, {len(seq)} are there")
        if missing := [number for number in seq if number not in recorded]:
            found.append(f"row {row}: frames {missing} are not in the recording")
            continue
        own = [recorded[number] for number in seq]
        if (np.array([frame.raw for frame in own]) != windows.codes[row][valid]).any():
            found.append(f"row {row}: codes differ")
        if {frame.bits for frame in own} != {windows.bits[row]}:
            found.append(f"row {row}: bits differ")
        if not np.array_equal(light[row][valid], [complement(f.raw, f.bits) for f in own]):
            found.append(f"row {row}: light differs")
        t_s = np.array([frame.t_wall for frame in own])
        age_s = windows.age_s[row][valid]
        if offset == 0 and abs((age_s - age_s[-1]) - (t_s[-1] - t_s)).max() > MOST_AGE_ERROR_S:
            found.append(f"row {row}: ages differ")
    return found


def offset_of(windows: Any, frames: Sequence[RecordedFrame]) -> int:
    """The number of a frame in the dataset less that in another recording, by its codes.

    Raises:
        ValueError: if there is not exactly one frame with these codes.
    """
    row, place = np.argwhere(windows.valid)[0]
    codes, number = windows.codes[row, place], int(windows.seq[row, place])
    (offset,) = [number - frame.seq for frame in frames if np.array_equal(frame.raw, codes)]
    return offset


def stand_in_differences() -> list[str]:
    """Where the stand-ins of CI differ from the LeRobot that is installed."""
    found = []
    for name, module in lerobot_stand_ins.lerobot_modules().items():
        real = importlib.import_module(name)
        for member, ours in vars(module).items():
            if member.startswith("__"):
                continue
            theirs = getattr(real, member, None)
            if _facts(ours) != _facts(theirs):
                found.append(f"{name}.{member}: {_facts(ours)} here, {_facts(theirs)} there")
    utils = importlib.import_module("lerobot.utils.import_utils")
    source = inspect.getsource(utils.register_third_party_plugins)
    found += [f"no prefix {p}" for p in lerobot_stand_ins.PREFIXES if f'"{p}"' not in source]
    return found


def _facts(thing: Any) -> Any:
    """What a plugin depends on."""
    if dataclasses.is_dataclass(thing):
        return sorted(field.name for field in dataclasses.fields(thing))
    if inspect.isclass(thing):
        assert issubclass(thing, abc.ABC)
        abstract = sorted(thing.__abstractmethods__)
        return [(name, _parameters(getattr(thing, name))) for name in abstract]
    return _parameters(thing)


def _parameters(function: Any) -> list[tuple[str, object]] | None:
    if not callable(function):
        return None  # a property
    parameters = inspect.signature(function).parameters.values()
    return [(one.name, one.default) for one in parameters]


def record(folder: Path) -> None:
    """Record a session into a folder."""
    program = dict(os.environ, PYTHONPATH=str(TESTS), HF_HUB_OFFLINE="1", HF_HOME=f"{folder}/hf")
    address = f"tcp://127.0.0.1:{PORT}"
    serve = [BIN / "lumitip", "serve", "twin://cable?rate=200", "--port", str(PORT)]
    other = [BIN / "lumitip", "record", address, folder / "right_other.mcap"]
    fingers = f'{{left: "twin://edge?rate=200&bits=12", right: "{address}"}}'
    lerobot = [
        BIN / "lerobot-record",
        "--robot.type=lumitip",
        "--robot.discover_packages_path=lerobot_arm",
        f"--robot.fingers={fingers}",
        "--robot.robot={type: small_arm, id: follower}",
        f"--robot.recordings={folder / 'recordings'}",
        "--robot.window=16",
        "--robot.max_silence_s=600",  # this process may wait for others
        "--teleop.type=small_leader",
        "--dataset.repo_id=lumitip/check",
        f"--dataset.root={folder / 'dataset'}",
        "--dataset.single_task=Feel",
        f"--dataset.num_episodes={EPISODES}",
        f"--dataset.episode_time_s={EPISODE_S}",
        f"--dataset.reset_time_s={RESET_S}",
        "--dataset.push_to_hub=false",
        "--play_sounds=false",
    ]
    with ExitStack() as stack:
        stack.enter_context(_running(serve, "shared at"))
        stack.enter_context(_running(other, "recording to"))
        subprocess.run(lerobot, env=program, check=True)


@contextmanager
def _running(command: list[Any], ready: str) -> Iterator[None]:
    """A process that has printed that it is ready; ended by Ctrl-C."""
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout is not None
            line = process.stdout.readline()
            assert ready in line, f"{command[0]} has printed {line!r}"
            yield
        finally:
            process.send_signal(signal.SIGINT)


def compare(folder: Path) -> list[str]:
    """Differences between dataset and recordings; prints figures."""
    from lerobot.datasets.lerobot_dataset import LeRobotDataset
    from lerobot_robot_lumitip import read_windows

    info = json.loads((folder / "dataset" / "meta" / "info.json").read_text("utf-8"))
    print(f"dataset {info['codebase_version']}, {info['total_frames']} rows of {info['fps']} Hz")
    dataset = LeRobotDataset("lumitip/check", root=folder / "dataset")
    rows = dataset.hf_dataset.with_format("numpy")[:]
    names = dataset.features["observation.state"]["names"]
    episodes = rows["episode_index"].tolist()
    found = [] if info["codebase_version"] == "v3.0" else ["the dataset is not of version 3.0"]
    for finger, windows in read_windows(names, rows["observation.state"]).items():
        frames = list(Reader(folder / "recordings" / f"{finger}.mcap"))
        own = differences(windows, frames, episodes)
        if finger == "right":
            other = list(Reader(folder / "right_other.mcap"))
            offset = offset_of(windows, other)
            own += differences(windows, other, episodes, offset)
            print(f"right: another process numbers the same frames {offset:+d}")
        found += [f"{finger}: {text}" for text in own]
        count = windows.valid.sum(axis=1)
        print(
            f"{finger}: {count.sum()} frames of {windows.bits.max()} bits in {len(count)} windows "
            f"({count.min()} to {count.max()}, mean {count.mean():.2f}), {windows.missed.sum()} "
            f"missed, {(count == 0).sum()} windows empty, {len(frames)} frames recorded, "
            f"newest {1e3 * np.median(windows.age_s[:, -1]):.1f} ms old (median)"
        )
    return found


def main() -> int:
    """Compare the stand-ins, record and compare; 1 if anything differs."""
    found = stand_in_differences()
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(sys.argv[1] if len(sys.argv) > 1 else scratch)
        if not (folder / "dataset").exists():
            record(folder)
        found += compare(folder)
    print(*found[:20], f"{len(found)} differences", sep="\n")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
