"""Recordings that broke off: killed, cut short, overwritten. What is whole in them is saved."""

import io
import random
import signal
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from mcap.reader import make_reader
from mcap.records import Chunk, Message
from mcap.stream_reader import StreamReader, breakup_chunk
from rosbags.highlevel import AnyReader

from lumitip import Layout
from lumitip.frame import Frame
from lumitip.recording import DamagedError, Reader, RecordingError, recover, summarise
from lumitip.recording.message import decode, encode

pytestmark = pytest.mark.slow

Make = Callable[..., list[Frame]]
Record = Callable[..., Path]
CUTS = 500

# Records at 55 Hz until it is killed, and tells after each frame that it was given to the writer.
# After a stall of the machine it does not catch up: that would be many frames at once.
_WORKER = """
import sys, time
import numpy as np
from lumitip import Layout
from lumitip.cli import main
from lumitip.recording import RecordedFrame, Writer

layout = Layout.load(sys.argv[1])
writer = Writer(sys.argv[2], layout, device_id="x")
for seq in range(100_000):
    time.sleep(1 / 55.0)
    raw = np.full(len(layout), seq % 256, np.uint8)
    writer.write(RecordedFrame(seq, seq / 55.0, time.monotonic(), time.time(), raw, 8, 0))
    print(seq, flush=True)
"""


@pytest.mark.parametrize("heard", [61, 95])
def test_a_killed_process_loses_under_half_a_second(
    tmp_path: Path, layout: Layout, heard: int
) -> None:
    (tmp_path / "layout.json").write_text(layout.to_json())
    path = tmp_path / "run.mcap"
    command = [sys.executable, "-c", _WORKER, str(tmp_path / "layout.json"), str(path)]
    worker = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    assert worker.stdout is not None
    for _ in range(heard):
        worker.stdout.readline()
    worker.send_signal(signal.SIGKILL)
    rest, _ = worker.communicate(timeout=10)
    written = heard + len(rest.split())

    with pytest.raises(DamagedError, match=f"`lumitip recover {path}`"):
        list(Reader(path))
    found = recover(path, tmp_path / "saved.mcap")
    assert found.damage
    lost_s = (written - found.frames) / 55.0
    assert lost_s < 0.5, f"{found.frames} of {written} frames were saved"

    saved = list(Reader(tmp_path / "saved.mcap"))
    assert [f.seq for f in saved] == list(range(found.frames))
    assert all((f.raw == f.seq % 256).all() for f in saved)
    with AnyReader([tmp_path / "saved.mcap"]) as bag:
        assert bag.message_count == found.frames


def test_a_recording_cut_at_any_place_gives_all_that_is_whole(
    make_frames: Make, record: Record, tmp_path: Path
) -> None:
    sent = make_frames(400)
    whole = record(sent).read_bytes()
    cut, saved = tmp_path / "cut.mcap", tmp_path / "saved.mcap"
    ends = _chunk_ends(whole)
    assert len(ends) > 25
    chance = random.Random(9)
    places = [chance.randrange(len(whole)) for _ in range(CUTS)]
    recovered, refused = 0, 0
    for place in places:
        cut.write_bytes(whole[:place])
        frames = sum(n for end, n in ends if end <= place)
        if not frames:
            with pytest.raises(RecordingError):
                recover(cut, saved)
            assert not saved.exists()
            refused += 1
            continue
        found = recover(cut, saved)
        assert found.frames == frames
        assert found.damage
        recovered += 1
        if recovered % 10 == 0:
            _is_the_beginning(saved, sent, frames)
        saved.unlink()
    assert recovered + refused == CUTS
    assert recovered > 0.8 * CUTS


def _chunk_ends(data: bytes) -> list[tuple[int, int]]:
    """Where each chunk of a recording ends, and how many frames it holds."""
    summary = make_reader(io.BytesIO(data)).get_summary()
    assert summary is not None
    ends = [c.chunk_start_offset + c.chunk_length for c in summary.chunk_indexes]
    records = StreamReader(io.BytesIO(data), emit_chunks=True).records
    chunks = [breakup_chunk(r) for r in records if isinstance(r, Chunk)]
    counts = [sum(isinstance(r, Message) for r in chunk) for chunk in chunks]
    return list(zip(ends, counts, strict=True))


def _is_the_beginning(path: Path, sent: list[Frame], frames: int) -> None:
    with AnyReader([path]) as bag:
        (connection,) = bag.connections
        read = [bag.deserialize(data, connection.msgtype) for _, _, data in bag.messages()]
    assert [m.sequence for m in read] == [f.seq for f in sent[:frames]]
    for message, frame in zip(read, sent, strict=False):
        np.testing.assert_array_equal(message.values, frame.raw)


def test_a_hole_costs_its_own_chunk_alone(
    make_frames: Make, record: Record, tmp_path: Path
) -> None:
    sent = make_frames(400)
    path = record(sent)
    data = bytearray(path.read_bytes())
    ends = _chunk_ends(bytes(data))
    (end, lost), before = ends[10], sum(n for _, n in ends[:10])
    data[end - 40 : end - 20] = bytes(20)
    path.write_bytes(data)
    strict = Reader(path)
    read = []
    with pytest.raises(DamagedError, match=f"after {before} frames"):
        read.extend(strict)
    found = recover(path, tmp_path / "saved.mcap")
    assert found.frames == 400 - lost
    assert len(found.damage) == 1 and "cannot be read (ZstdError" in found.damage[0]
    kept = [f.seq for f in Reader(tmp_path / "saved.mcap")]
    seqs = [f.seq for f in sent]
    assert kept == seqs[:before] + seqs[before + lost :]


@pytest.mark.parametrize(
    "damage",
    {
        "zeros over the head of a chunk": lambda data, at: data.__setitem__(
            slice(at - 300, at + 300), bytes(600)
        ),
        "a chunk that claims to be longer": lambda data, at: data.__setitem__(at + 2, 0x40),
        "a chunk that claims to be shorter": lambda data, at: data.__setitem__(
            slice(at + 1, at + 3), b"\x20\0"
        ),
        "a hundred bytes gone": lambda data, at: data.__delitem__(slice(at - 50, at + 50)),
        "foreign bytes between": lambda data, at: data.__setitem__(
            slice(at, at), bytes(range(256)) * 5
        ),
    }.items(),
    ids=lambda item: item[0],
)
def test_a_damage_costs_the_chunks_at_it_alone(
    make_frames: Make,
    record: Record,
    tmp_path: Path,
    damage: tuple[str, Callable[[bytearray, int], None]],
) -> None:
    sent = make_frames(400)
    path = record(sent)
    data = bytearray(path.read_bytes())
    ends = _chunk_ends(bytes(data))
    at = data.index(b"\x04\0\0\0zstd", ends[10][0]) - 37  # the head of chunk 11
    damage[1](data, at)
    path.write_bytes(data)
    found = recover(path, tmp_path / "saved.mcap")
    most = sum(n for _, n in ends[10:13])
    assert 400 - most <= found.frames < 400 + 1
    assert found.damage and not found.damage[0].startswith("it ends")
    raws = {frame.seq: frame.raw for frame in sent}
    for frame in Reader(found.path):
        np.testing.assert_array_equal(frame.raw, raws[frame.seq])
    missing = 400 - found.frames
    assert summarise(path).lost == summarise(found.path).lost == 40 + missing


def test_the_first_chunk_with_schema_and_channel_may_be_lost(
    make_frames: Make, record: Record, tmp_path: Path
) -> None:
    path = record(make_frames(400))
    data = bytearray(path.read_bytes())
    end, lost = _chunk_ends(bytes(data))[0]
    data[end - 30] ^= 1
    path.write_bytes(data)
    found = recover(path, tmp_path / "saved.mcap")
    assert found.frames == 400 - lost and len(found.damage) == 1
    with AnyReader([found.path]) as bag:
        assert bag.message_count == found.frames


def test_changed_bytes_are_found_or_change_nothing(
    make_frames: Make, record: Record, tmp_path: Path
) -> None:
    """A checksum covers every chunk: no frame is read with another value."""
    sent = make_frames(120)
    whole = record(sent).read_bytes()
    raws = {f.seq: f.raw for f in sent}
    path, chance, noticed = tmp_path / "hurt.mcap", random.Random(11), 0
    for _ in range(150):
        hurt = bytearray(whole)
        for _ in range(chance.choice([1, 1, 4])):
            hurt[chance.randrange(len(hurt))] ^= 1 << chance.randrange(8)
        path.write_bytes(hurt)
        try:
            found = Reader(path, tolerant=True)
            read = list(found)
        except RecordingError:
            noticed += 1
            continue
        noticed += bool(found.damage)
        for frame in read:
            np.testing.assert_array_equal(frame.raw, raws[frame.seq])
    assert noticed > 60


def test_a_sound_recording_recovers_to_the_same(
    make_frames: Make, record: Record, tmp_path: Path
) -> None:
    path = record(make_frames(100))
    found = recover(path, tmp_path / "again.mcap")
    assert (found.frames, found.damage) == (100, ())
    assert found.path.read_bytes() == path.read_bytes()


def test_the_summary_counts_what_is_there(make_frames: Make, record: Record) -> None:
    path = record(make_frames(100))
    found = summarise(path)
    assert (found.frames, found.lost, found.damage) == (100, 10, ())
    assert found.rate_hz == pytest.approx(55.0)
    path.write_bytes(path.read_bytes()[:-2000])
    cut = summarise(path)
    assert 0 < cut.frames <= 100 and cut.damage


def test_a_disk_that_fails_ends_the_recording_there(
    make_frames: Make, record: Record, monkeypatch: pytest.MonkeyPatch
) -> None:
    class Failing(io.FileIO):
        def read(self, size: int | None = -1) -> bytes:
            if self.tell() > 12_000:
                raise OSError(5, "Input/output error")
            return super().read(size) or b""

    path = record(make_frames(300))
    whole = len(list(Reader(path)))
    monkeypatch.setattr("lumitip.recording.reader.opened", Failing)
    reader = Reader(path, tolerant=True)
    assert 10 < len(list(reader)) < whole
    assert "Input/output error" in reader.damage[-1]
    with pytest.raises(DamagedError, match="Input/output error"):
        list(Reader(path))


def test_a_number_beyond_any_table_is_damage(make_frames: Make) -> None:
    (frame,) = make_frames(1)
    assert decode(encode(replace(frame, seq=2**63 - 1), "dev", 0), 32).seq == 2**63 - 1
    with pytest.raises(RecordingError, match="out of range"):
        decode(encode(replace(frame, seq=2**63), "dev", 0), 32)
