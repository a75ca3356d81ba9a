"""Files for Foxglove that are refused, of damaged recordings, and read again one by one."""

import json
from pathlib import Path

import pytest

from lumitip import Layout, LumitipError
from lumitip.cli import main
from lumitip.foxglove import FoxgloveError, write_scene
from lumitip.frame import Frame
from lumitip.recording import Reader, RecordingError, Writer, export, fingers, summarise

Sources = dict[str, tuple[Path, list[Frame]]]


@pytest.mark.slow
def test_the_same_recordings_give_the_same_bytes(
    scene: Path, sources: Sources, tmp_path: Path
) -> None:
    again = tmp_path / "again.mcap"
    write_scene(again, {name: file for name, (file, _) in sources.items()})
    assert again.read_bytes() == scene.read_bytes()


@pytest.mark.parametrize(
    ("name", "why"),
    [("", "letters"), ("2nd", "a letter first"), ("a b", "letters"), ("lumitip", "not 'lumitip'")],
)
def test_a_name_that_no_topic_can_have_is_refused(
    tmp_path: Path, sources: Sources, name: str, why: str
) -> None:
    with pytest.raises(FoxgloveError, match=why):
        write_scene(tmp_path / "scene.mcap", {name: sources["left"][0]})
    assert not list(tmp_path.iterdir())


def test_what_cannot_be_written_leaves_nothing(tmp_path: Path, sources: Sources) -> None:
    path = sources["left"][0]
    with pytest.raises(FoxgloveError, match=r"must end in \.mcap"):
        write_scene(tmp_path / "scene.txt", {"left": path})
    with pytest.raises(FoxgloveError, match="recordings by name are needed"):
        write_scene(tmp_path / "scene.mcap", {})
    with pytest.raises(RecordingError, match="cannot be read"):
        write_scene(tmp_path / "scene.mcap", {"left": tmp_path / "none.mcap"})
    with pytest.raises(LumitipError, match="gap_mm"):
        write_scene(tmp_path / "scene.mcap", {"left": path}, gap_mm=-1.0)
    with pytest.raises(FoxgloveError, match="cannot be written"):
        write_scene(tmp_path / "no folder" / "scene.mcap", {"left": path}, estimates=False)
    assert not list(tmp_path.iterdir())
    (tmp_path / "scene.mcap").write_text("mine")
    with pytest.raises(FoxgloveError, match="exists"):
        write_scene(tmp_path / "scene.mcap", {"left": path}, estimates=False)
    assert (tmp_path / "scene.mcap").read_text() == "mine"


def test_a_file_with_several_fingertips_asks_which(scene: Path, tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match=r"no finger was named; .* has 'left', 'right'"):
        Reader(scene)
    with pytest.raises(RecordingError, match=r"finger is 'third'; .* has 'left', 'right'"):
        Reader(scene, finger="third")
    assert summarise(scene, "right").frames == 8
    assert export(scene, tmp_path / "left.csv", "left") == 8


def test_a_recording_of_one_fingertip_has_no_names(
    sources: Sources,
) -> None:
    with pytest.raises(RecordingError, match="has one fingertip, which has no name"):
        Reader(sources["left"][0], finger="left")


def test_the_command_writes_file_and_panels(
    sources: Sources, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    files = [str(file) for file, _ in sources.values()]
    out = tmp_path / "scene.mcap"
    assert main(["foxglove", *files, "--out", str(out), "--no-estimate"]) == 0
    printed = capsys.readouterr().out
    assert "16 frames of left, right" in printed and "scene.foxglove.json" in printed
    assert json.loads((tmp_path / "scene.foxglove.json").read_text())["configById"]
    assert main(["info", str(out), "--finger", "left"]) == 0
    assert main(["recover", str(out), str(tmp_path / "left.mcap"), "--finger", "left"]) == 0
    assert Reader(tmp_path / "left.mcap").metadata.device_id == "device 0"
    other = ["--out", str(tmp_path / "b.mcap"), "--no-estimate"]
    assert main(["foxglove", *files[:1], *files[:1], *other]) == 2
    assert "two recordings are called 'left'. Give one another name" in capsys.readouterr().err
    assert main(["foxglove", files[0], f"again={files[0]}", *other]) == 0
    assert "16 frames of left, again" in capsys.readouterr().out


def test_names_of_files_become_names_of_topics(
    sources: Sources, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    names = ("twin-cable-001", "a b", "2nd", "lumitip", "é", "a-b", "x")
    files = [tmp_path / f"{name}.mcap" for name in (*names, "a_b")]
    for file in files:
        file.write_bytes(sources["left"][0].read_bytes())
    out = tmp_path / "scene" / "scene.mcap"
    out.parent.mkdir()
    assert main(["foxglove", *map(str, files), "--out", str(out), "--no-estimate"]) == 0
    printed = capsys.readouterr().out
    called = "twin_cable_001, a_b_2, finger_2nd, finger_lumitip, finger__, a_b_3, x, a_b"
    assert f"64 frames of {called}\n" in printed
    assert set(fingers(out)) == set(called.split(", "))
    for name in called.split(", "):
        assert summarise(out, name).frames == 8
    other = ["--out", str(tmp_path / "other.mcap"), "--no-estimate"]
    assert main(["foxglove", f"a-b={files[0]}", *other]) == 2
    assert "a fingertip is called 'a-b'; letters, digits and _" in capsys.readouterr().err


def test_all_fingertips_of_a_file_are_taken(
    scene: Path, sources: Sources, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    again, more = tmp_path / "again.mcap", tmp_path / "more.mcap"
    assert fingers(scene) == ("left", "right") and fingers(sources["left"][0]) == ("",)
    assert main(["foxglove", str(scene), "--out", str(again)]) == 0
    assert "16 frames of left, right" in capsys.readouterr().out
    assert again.read_bytes() == scene.read_bytes()
    options = ["--no-estimate", "--out", str(more)]
    assert main(["foxglove", str(scene), str(sources["left"][0]), *options]) == 2
    assert "two recordings are called 'left'. Give one another name" in capsys.readouterr().err
    assert main(["foxglove", str(scene), f"old={scene}", *options]) == 0
    assert "32 frames of left, right, old_left, old_right" in capsys.readouterr().out
    assert [f.seq for f in Reader(more, finger="old_right")] == list(range(1, 9))


def test_the_command_overwrites_nothing(
    sources: Sources, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "scene.foxglove.json").write_text("mine")
    arguments = [str(sources["left"][0]), "--out", str(tmp_path / "scene.mcap"), "--no-estimate"]
    assert main(["foxglove", *arguments]) == 2
    assert "exists" in capsys.readouterr().err
    assert (tmp_path / "scene.foxglove.json").read_text() == "mine"
    assert not (tmp_path / "scene.mcap").exists()


def test_recordings_without_a_frame_make_no_file(layout: Layout, tmp_path: Path) -> None:
    Writer(tmp_path / "empty.mcap", layout, device_id="x").close()
    with pytest.raises(FoxgloveError, match="no recording has a frame"):
        write_scene(tmp_path / "scene.mcap", {"empty": tmp_path / "empty.mcap"}, estimates=False)
    assert not (tmp_path / "scene.mcap").exists()


def test_damaged_recordings_are_read_as_far_as_they_go(
    sources: Sources, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    short = tmp_path / "left.mcap"
    short.write_bytes(sources["left"][0].read_bytes()[:-400])
    out = tmp_path / "scene.mcap"
    assert main(["foxglove", str(short), "--out", str(out), "--no-estimate"]) == 1
    assert "left out: left: it ends near byte" in capsys.readouterr().out
    assert 0 < summarise(out, "left").frames <= 8
