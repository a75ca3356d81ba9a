"""The commands for recordings, as a user runs them."""

import csv
import json
import os
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from pyarrow import parquet

from lumitip import Layout
from lumitip.calibration import Calibration
from lumitip.cli import main
from lumitip.frame import Frame, RecordedFrame
from lumitip.recording import Reader, export

Make = Callable[..., list[Frame]]
Record = Callable[..., Path]


def test_record_writes_what_a_fingertip_sends(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "run.mcap"
    url = "twin://demo?rate=400&seed=3"
    assert main(["record", url, str(path), "--frames", "40"]) == 0
    said = capsys.readouterr().out
    assert "40 frames recorded" in said and "Ctrl-C" in said
    frames = list(Reader(path))
    assert len(frames) == 40
    assert {b.seq - a.seq for a, b in pairwise(frames)} == {1}
    assert Reader(path).metadata.device_id == "twin:demo"


def test_record_ends_by_the_clock(tmp_path: Path) -> None:
    path = tmp_path / "run.mcap"
    assert main(["record", "twin://edge?rate=200", str(path), "--seconds", "0.4"]) == 0
    assert 20 < len(list(Reader(path))) <= 120


def test_record_refuses_what_no_other_program_would_open(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["record", "twin://edge", str(tmp_path / "run.bin")]) == 2
    assert "must end in .mcap" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_a_new_file_in_a_folder_that_does_not_exist_says_what_to_do(
    make_frames: Make, record: Record, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path, new = str(record(make_frames(3))), str(tmp_path / "none" / "new.mcap")
    for command in (
        ["record", "twin://demo", new, "--frames", "3"],
        ["recover", path, new],
        ["export", path, new.replace(".mcap", ".csv")],
        ["foxglove", f"left={path}", "--out", new, "--no-estimate"],
    ):
        assert main(command) == 2
        assert f"there is no folder {tmp_path / 'none'}. Create it first" in capsys.readouterr().err


def test_recover_refuses_what_no_other_program_would_open(
    make_frames: Make, record: Record, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = record(make_frames(3))
    assert main(["recover", str(path), str(tmp_path / "new.txt")]) == 2
    assert "must end in .mcap" in capsys.readouterr().err
    assert not (tmp_path / "new.txt").exists()


def test_info_tells_what_a_recording_holds(
    make_frames: Make,
    record: Record,
    calibration: Calibration,
    capsys: pytest.CaptureFixture[str],
) -> None:
    path = record(make_frames(111), calibration=calibration)
    assert main(["info", str(path)]) == 0
    said = dict(line.split(None, 1) for line in capsys.readouterr().out.splitlines())
    assert said["device"] == "C0:FF:EE"
    assert said["frames"] == "111 in 2.000 s, 55.0 a second"
    assert said["lost"] == "11"
    assert said["damage"] == "none"
    assert said["calibration"] == "empty and dark"
    assert said["begun"] == "2026-09-21 14:13:20+00:00"


def test_info_and_recover_of_a_broken_recording(
    make_frames: Make, record: Record, capsys: pytest.CaptureFixture[str]
) -> None:
    path = record(make_frames(200))
    path.write_bytes(path.read_bytes()[:9000])
    assert main(["info", str(path)]) == 1
    assert f"`lumitip recover {path}`" in capsys.readouterr().out
    assert main(["recover", str(path)]) == 0
    saved = path.with_suffix(".recovered.mcap")
    assert f"{saved}: {len(list(Reader(saved)))} frames" in capsys.readouterr().out
    assert main(["info", str(saved)]) == 0
    assert main(["recover", str(path)]) == 2
    assert "exists" in capsys.readouterr().err


def test_replay_tells_the_contact_of_every_frame(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "run.mcap"
    assert main(["record", "twin://cable?rate=300&noise=1", str(path), "--frames", "30"]) == 0
    capsys.readouterr()
    assert main(["replay", str(path), "--speed", "0"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == 30
    assert lines[0].split()[:2] == ["0.000", "s"]
    assert any("cable" in line and "mm wide" in line for line in lines)
    assert main(["replay", str(path), "--speed", "-1"]) == 2


def test_replay_keeps_the_times_of_the_recording(
    make_frames: Make, record: Record, monkeypatch: pytest.MonkeyPatch
) -> None:
    slept: list[float] = []
    monkeypatch.setattr("time.sleep", slept.append)
    monkeypatch.setattr("time.monotonic", lambda: 50.0)
    assert main(["replay", str(record(make_frames(56))), "--speed", "2"]) == 0
    assert slept[0] == 0.0 and slept[-1] == pytest.approx(0.5)


def recorded(frame: Frame, later_s: float) -> RecordedFrame:
    """The frame as of a recording, whose times a writer takes as they are."""
    times = frame.t_host, frame.t_wall + later_s
    numbers = frame.raw, frame.bits, frame.dropped_before
    return RecordedFrame(frame.seq, frame.t_device, *times, *numbers)


def test_replay_cuts_gaps_to_a_second(
    make_frames: Make,
    record: Record,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    sent = make_frames(5)
    late_s = [0.0, 0.0, 0.0, 36_000.0, 36_000.0]
    path = record([recorded(f, late) for f, late in zip(sent, late_s, strict=True)])
    slept: list[float] = []
    monkeypatch.setattr("time.sleep", slept.append)
    monkeypatch.setattr("time.monotonic", lambda: 50.0)
    assert main(["replay", str(path)]) == 0
    assert slept == pytest.approx([0.0, 1 / 55, 2 / 55, 2 / 55 + 1.0, 3 / 55 + 1.0], abs=1e-6)
    assert capsys.readouterr().out.splitlines()[3].split()[0] == "36000.055"


@pytest.mark.parametrize(
    "option",
    [
        ("--seconds", "nan"),
        ("--seconds", "-1"),
        ("--seconds", "0"),
        ("--seconds", "x"),
        ("--frames", "-3"),
        ("--frames", "0"),
        ("--frames", "1.5"),
        ("--timeout", "nan"),
    ],
)
def test_record_refuses_times_and_numbers_that_are_none(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], option: tuple[str, str]
) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["record", "twin://edge", str(tmp_path / "run.mcap"), *option])
    assert ended.value.code == 2
    assert f"argument {option[0]}: the value is {option[1]};" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_export_to_csv(make_frames: Make, record: Record, tmp_path: Path) -> None:
    sent = make_frames(30, legacy=True)
    table = tmp_path / "run.csv"
    assert main(["export", str(record(sent)), str(table)]) == 0
    with table.open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 30
    assert len(rows[0]) == 6 + 2 * 32
    for frame, row in zip(sent, rows, strict=True):
        assert float(row["t_wall"]) == frame.t_wall and int(row["seq"]) == frame.seq
        assert (row["t_device"], row["dropped_before"]) == ("", "")
        assert [int(row[f"raw_{i}"]) for i in range(32)] == frame.raw.tolist()
        assert float(row["value_3"]) == pytest.approx(255 - int(frame.raw[3]), abs=1e-3)


def test_export_to_parquet(
    make_frames: Make, record: Record, tmp_path: Path, calibration: Calibration
) -> None:
    sent = make_frames(5000, 12)
    path = record(sent, calibration=calibration)
    assert export(path, tmp_path / "run.parquet") == 5000
    table = parquet.read_table(tmp_path / "run.parquet")
    assert table.num_rows == 5000 and table.num_columns == 6 + 2 * 32
    assert table["t_wall"].to_pylist() == [f.t_wall for f in sent]
    assert table["t_device"].to_pylist() == [f.t_device for f in sent]
    raw = np.stack([table[f"raw_{i}"].to_numpy() for i in range(32)], axis=1)
    np.testing.assert_array_equal(raw, [f.raw for f in sent])
    reader = Reader(path)
    values = [reader.metadata.values(f)[7] for f in reader]
    np.testing.assert_array_equal(table["value_7"].to_numpy(), np.array(values))
    metadata = json.loads(table.schema.metadata[b"lumitip"])
    assert metadata["device_id"] == "C0:FF:EE" and metadata["design_hash"] in metadata["layout"]


@pytest.mark.parametrize("suffix", [".csv", ".parquet"])
def test_export_leaves_no_half_table(
    make_frames: Make,
    record: Record,
    tmp_path: Path,
    suffix: str,
    capsys: pytest.CaptureFixture[str],
) -> None:
    path, table = record(make_frames(200)), tmp_path / f"run{suffix}"
    path.write_bytes(path.read_bytes()[:9000])
    assert main(["export", str(path), str(table)]) == 2
    assert "lumitip recover" in capsys.readouterr().err
    assert not table.exists()


def test_export_refuses_other_tables_and_never_writes_over_one(
    make_frames: Make, record: Record, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = record(make_frames(5))
    assert main(["export", str(path), str(tmp_path / "run.xlsx")]) == 2
    assert "must end in .csv or .parquet" in capsys.readouterr().err
    (tmp_path / "run.csv").write_text("mine")
    assert main(["export", str(path), str(tmp_path / "run.csv")]) == 2
    assert (tmp_path / "run.csv").read_text() == "mine"


def test_a_pipe_is_refused_in_one_line(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    pipe = tmp_path / "run.mcap"
    os.mkfifo(pipe)
    held = os.open(pipe, os.O_RDWR)
    try:
        assert main(["info", str(pipe)]) == 2
    finally:
        os.close(held)
    assert "a file is needed" in capsys.readouterr().err


def test_replay_refuses_a_speed_that_never_ends(
    make_frames: Make, record: Record, capsys: pytest.CaptureFixture[str]
) -> None:
    path = record(make_frames(3))
    for speed in ("-1", "nan", "1e-300"):
        assert main(["replay", str(path), "--speed", speed]) == 2
        assert f"--speed is {speed};" in capsys.readouterr().err


def test_doctor_of_a_recording_looks_at_what_there_is(
    make_frames: Make, record: Record, capsys: pytest.CaptureFixture[str]
) -> None:
    url = f"replay://{record(make_frames(60))}?speed=0"
    assert main(["doctor", url]) in (0, 1)
    assert "60 frames, " in capsys.readouterr().out
    assert main(["doctor", f"replay://{record(make_frames(5), 'short.mcap')}?speed=0"]) == 2
    assert "5 frames came" in capsys.readouterr().err


def test_what_is_kept_for_a_device_is_not_changed_by_its_recording(
    make_frames: Make, record: Record, layout: Layout, capsys: pytest.CaptureFixture[str]
) -> None:
    kept = Calibration("C0:FF:EE", layout.design_hash, np.full(32, 200.0, np.float32)).save()
    url = f"replay://{record(make_frames(60))}?speed=0"
    for arguments in (["tare", url], ["tare", url, "--forget"]):
        before = kept.read_bytes()
        assert main(arguments) == 2
        assert "Open the device" in capsys.readouterr().err
        assert kept.read_bytes() == before
