"""What is written is read: by `Reader`, and by rosbags, which knows nothing of Lumitip."""

import resource
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from mcap.reader import make_reader
from mcap.writer import Writer as McapWriter
from rosbags.highlevel import AnyReader

from lumitip import Layout, LumitipError
from lumitip.calibration import Calibration
from lumitip.frame import Frame
from lumitip.recording import Reader, RecordedFrame, RecordingError, Writer, recover

Make = Callable[..., list[Frame]]
Record = Callable[..., Path]
FIELDS = ("seq", "t_device", "t_host", "t_wall", "bits", "dropped_before")


def _same(given: list[Frame], read: list[RecordedFrame]) -> None:
    assert len(read) == len(given)
    for one, other in zip(given, read, strict=True):
        for name in FIELDS:
            assert getattr(one, name) == getattr(other, name), name
        assert one.raw.dtype == other.raw.dtype
        np.testing.assert_array_equal(one.raw, other.raw)


@pytest.mark.parametrize("legacy", [False, True], ids=["v2", "legacy"])
@pytest.mark.parametrize("bits", [8, 10, 12])
def test_frames_are_read_as_they_were_written(
    make_frames: Make, record: Record, bits: int, legacy: bool
) -> None:
    given = make_frames(300, bits, legacy)
    path = record(given)
    reader = Reader(path)
    _same(given, list(reader))
    _same(given, list(reader))
    assert reader.damage == ()


def test_frames_read_cannot_be_changed(make_frames: Make, record: Record) -> None:
    frame = next(iter(Reader(record(make_frames(1)))))
    with pytest.raises(ValueError, match="read-only"):
        frame.raw[0] = 1


@pytest.mark.parametrize("device_id", ["", "x", "C0:FF:EE", "/dev/ttyACM0", "Fühler 7", "x" * 99])
def test_every_device_id_keeps_the_fields_in_their_places(
    tmp_path: Path, layout: Layout, make_frames: Make, device_id: str
) -> None:
    given = make_frames(20)
    with Writer(tmp_path / "a.mcap", layout, device_id=device_id) as writer:
        for frame in given:
            writer.write(frame)
    _same(given, list(Reader(tmp_path / "a.mcap")))
    with AnyReader([tmp_path / "a.mcap"]) as bag:
        (connection,) = bag.connections
        read = [bag.deserialize(data, connection.msgtype) for _, _, data in bag.messages()]
    assert [m.header.frame_id for m in read] == [device_id] * 20
    assert [m.host_time for m in read] == [f.t_host for f in given]


@pytest.mark.parametrize("bits", [8, 12])
def test_rosbags_opens_a_recording_with_no_other_file(
    make_frames: Make, record: Record, bits: int
) -> None:
    given = make_frames(300, bits)
    with AnyReader([record(given)]) as bag:
        (connection,) = bag.connections
        assert connection.topic == "/lumitip/frames"
        assert connection.msgtype == "lumitip_msgs/msg/Frame"
        assert bag.message_count == 300
        for frame, (_, at_ns, data) in zip(given, bag.messages(), strict=True):
            message = bag.deserialize(data, connection.msgtype)
            stamp = message.header.stamp
            assert stamp.sec + stamp.nanosec / 1e9 == frame.t_wall
            assert at_ns == stamp.sec * 10**9 + stamp.nanosec
            assert message.header.frame_id == "C0:FF:EE"
            assert message.sequence == frame.seq
            assert message.device_time == frame.t_device
            assert message.dropped_before == frame.dropped_before
            assert message.bits == bits
            np.testing.assert_array_equal(message.values, frame.raw)


def test_what_a_legacy_device_does_not_tell_is_nan_and_minus_one(
    make_frames: Make, record: Record
) -> None:
    with AnyReader([record(make_frames(3, legacy=True))]) as bag:
        (connection,) = bag.connections
        for _, _, data in bag.messages():
            message = bag.deserialize(data, connection.msgtype)
            assert np.isnan(message.device_time) and message.dropped_before == -1


def test_rosbags_encodes_the_same_bytes(make_frames: Make, record: Record) -> None:
    """Its encoder follows the schema alone."""
    with AnyReader([record(make_frames(30, 10))]) as bag:
        (connection,) = bag.connections
        for _, _, data in bag.messages():
            message = bag.deserialize(data, connection.msgtype)
            again = bytes(bag.typestore.serialize_cdr(message, connection.msgtype))
            # Padding between fields is of no value, and none of ours is at the end.
            assert len(again) == len(bytes(data))
            assert again == bytes(data)


def test_the_recording_tells_of_what_it_is(
    layout: Layout, make_frames: Make, record: Record, calibration: Calibration
) -> None:
    about = Reader(record(make_frames(5), calibration=calibration)).metadata
    assert about.layout == layout and about.layout.to_json() == layout.to_json()
    assert about.device_id == "C0:FF:EE"
    assert about.start_wall == 1_790_000_000.0
    assert set(about.versions) == {"lumitip", "mcap", "numpy", "python"}
    assert about.calibration is not None
    np.testing.assert_array_equal(about.calibration.empty, calibration.empty)
    np.testing.assert_array_equal(about.calibration.dark, calibration.dark)
    about.calibration.check("C0:FF:EE", layout.design_hash)


def test_values_are_calibrated_as_when_recorded(
    make_frames: Make, record: Record, calibration: Calibration
) -> None:
    given = make_frames(5, 12)
    reader = Reader(record(given, calibration=calibration))
    light = 255.0 - given[2].raw * (255.0 / 4095.0)
    assert calibration.empty is not None and calibration.dark is not None
    expected = 255.0 * (light - calibration.dark) / (calibration.empty - calibration.dark)
    values = reader.metadata.values(list(reader)[2])
    np.testing.assert_allclose(values, np.clip(expected, 0.0, 255.0), atol=1e-3)
    plain = Reader(record(given, "plain.mcap"))
    np.testing.assert_allclose(plain.metadata.values(list(plain)[2]), light, atol=1e-3)


def test_the_same_frames_give_the_same_bytes(make_frames: Make, record: Record) -> None:
    one, other = record(make_frames(100), "a.mcap"), record(make_frames(100), "b.mcap")
    assert one.read_bytes() == other.read_bytes()


def test_chunks_are_small(make_frames: Make, record: Record) -> None:
    with record(make_frames(1000)).open("rb") as file:
        summary = make_reader(file).get_summary()
    assert summary is not None and summary.statistics is not None
    assert summary.statistics.message_count == 1000
    sizes = [chunk.uncompressed_size for chunk in summary.chunk_indexes]
    # The first chunk begins with the schema; a frame is about 160 bytes.
    assert max(sizes[1:]) < 2048 + 200
    assert min(sizes[1:-1]) > 1500


def test_a_recording_is_never_written_over(
    layout: Layout, make_frames: Make, record: Record
) -> None:
    path = record(make_frames(5))
    before = path.read_bytes()
    with pytest.raises(RecordingError, match="exists"):
        Writer(path, layout, device_id="x")
    assert path.read_bytes() == before


def test_what_cannot_be_written_is_refused(
    tmp_path: Path, layout: Layout, make_frames: Make
) -> None:
    with pytest.raises(RecordingError, match="cannot be written"):
        Writer(tmp_path / "none" / "a.mcap", layout, device_id="x")
    with Writer(tmp_path / "a.mcap", layout, device_id="x") as writer:
        with pytest.raises(RecordingError, match=r"shape \(31,\); the layout needs \(32,\)"):
            writer.write(make_frames(1, cells=31)[0])
        writer.write(make_frames(1)[0])
    writer.close()
    with pytest.raises(RecordingError, match="is closed"):
        writer.write(make_frames(1)[0])
    assert len(list(Reader(tmp_path / "a.mcap"))) == 1


@contextmanager
def full_disk(size: int) -> Iterator[None]:
    """Files of this process end at so many bytes meanwhile; the rest is refused as on a full disk.

    Not longer than the lines of a test that need it: a file that the test run prints to ends too.
    """
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


def test_a_full_disk_is_told_and_what_was_written_is_saved(
    tmp_path: Path, layout: Layout, make_frames: Make
) -> None:
    writer = Writer(tmp_path / "a.mcap", layout, device_id="x")
    with full_disk(12_000):
        with pytest.raises(RecordingError, match=r"a\.mcap: cannot be written"):
            for frame in make_frames(5000):
                writer.write(frame)
        with pytest.raises(RecordingError, match="is closed"):
            writer.write(make_frames(1)[0])
        writer.close()
    assert recover(tmp_path / "a.mcap", tmp_path / "b.mcap").frames > 10


def test_recovering_to_a_full_disk_leaves_nothing_in_the_way(
    tmp_path: Path, layout: Layout, make_frames: Make
) -> None:
    old, new = tmp_path / "a.mcap", tmp_path / "b.mcap"
    with Writer(old, layout, device_id="x") as writer:
        for frame in make_frames(400):
            writer.write(frame)
    with full_disk(12_000), pytest.raises(RecordingError, match=r"b\.mcap: cannot be written"):
        recover(old, new)
    assert not new.exists()
    assert recover(old, new).frames == 400
    with pytest.raises(RecordingError, match="exists"):
        recover(old, new)
    assert len(list(Reader(new))) == 400


def test_a_disk_that_is_full_keeps_no_empty_file(tmp_path: Path, layout: Layout) -> None:
    with full_disk(100), pytest.raises(RecordingError, match=r"a\.mcap: cannot be written"):
        Writer(tmp_path / "a.mcap", layout, device_id="x")
    assert not (tmp_path / "a.mcap").exists()


def test_a_disk_that_fills_at_the_very_end_is_told(
    tmp_path: Path, layout: Layout, make_frames: Make
) -> None:
    writer = Writer(tmp_path / "a.mcap", layout, device_id="x")
    with full_disk((tmp_path / "a.mcap").stat().st_size):
        writer.write(make_frames(1)[0])
        with pytest.raises(RecordingError, match="cannot be written"):
            writer.close()


def test_a_recording_without_frames_is_whole(layout: Layout, tmp_path: Path) -> None:
    Writer(tmp_path / "a.mcap", layout, device_id="x").close()
    reader = Reader(tmp_path / "a.mcap")
    assert list(reader) == [] and reader.layout == layout


def test_other_topics_are_passed_over(tmp_path: Path, layout: Layout, make_frames: Make) -> None:
    writer = Writer(tmp_path / "a.mcap", layout, device_id="x")
    given = make_frames(10)
    other = writer._mcap.register_channel("/notes", "json", 0)
    for frame in given:
        writer._mcap.add_message(other, 0, b"{}", 0)
        writer.write(frame)
    writer.close()
    _same(given, list(Reader(tmp_path / "a.mcap")))


def test_files_that_are_no_recordings_are_refused(tmp_path: Path) -> None:
    (tmp_path / "text.mcap").write_text("hello, this is not a recording")
    (tmp_path / "short.mcap").write_text("x")
    (tmp_path / "empty.mcap").touch()
    with (tmp_path / "other.mcap").open("wb") as file:
        other = McapWriter(file)
        other.start()
        other.finish()
    for name, said in (
        ("none.mcap", "cannot be read"),
        (".", "cannot be read"),
        ("a\0b", "cannot be read"),
        (
            "text.mcap",
            "no MCAP recording, or is cut off: not the bytes that begin an MCAP file",
        ),
        ("short.mcap", "not the bytes that begin an MCAP file"),
        ("empty.mcap", "not the bytes that begin an MCAP file"),
        ("other.mcap", "not a recording of a fingertip"),
    ):
        with pytest.raises(RecordingError, match=said) as caught:
            Reader(tmp_path / name)
        assert isinstance(caught.value, LumitipError)


def test_sequence_numbers_beyond_32_bits_are_kept(make_frames: Make, record: Record) -> None:
    frame = replace(make_frames(1)[0], seq=2**40 + 3)
    assert next(iter(Reader(record([frame])))).seq == 2**40 + 3
