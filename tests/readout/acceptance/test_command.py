"""`lumitip accept`: its steps, its report, its exit codes."""

import hashlib
import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from acceptance_frames import Bench, record
from lumitip.acceptance.page import page
from lumitip.acceptance.report import Circumstances
from lumitip.acceptance.verdict import Judge
from lumitip.calibration import Calibration
from lumitip.cli import main
from lumitip.commands import stage
from lumitip.links import twin
from lumitip.links.twin import Scene, packet_at, published_layout
from lumitip.twin import Twin
from printer_stand_in import StandIn

LAYOUT = published_layout()


class Hands:
    """A builder who follows the steps: each Enter changes what the fingertip reads."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, bench: Bench, **off: float) -> None:
        frames = bench.frames(off)
        self._states = [frames.empty, frames.sheet, frames.moving, *frames.gauge]
        self.asked: list[str] = []
        monkeypatch.setattr("builtins.input", self._enter)
        monkeypatch.setattr(twin, "packet_at", self._packet)

    def _enter(self, text: str) -> str:
        self.asked.append(text)
        return ""

    def _packet(self, _: object, scene: Scene, first: int, count: int) -> object:
        made = packet_at(LAYOUT, scene, first, count)
        light = self._states[max(len(self.asked) - 1, 0)]
        rows = light[(first + np.arange(count)) % len(light)]
        object.__setattr__(made, "values", (255.0 - rows).astype(np.uint8))
        return made


@pytest.fixture
def gauge_file(tmp_path: Path) -> Path:
    file = tmp_path / "gauge.json"
    file.write_text(json.dumps(record()), encoding="utf-8")
    return file


@pytest.fixture(autouse=True)
def data(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A folder without data of devices, and without outputs, whose layout the twin would take."""
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "data"))
    monkeypatch.chdir(tmp_path)


def arguments(gauge: Path, out: Path) -> list[str]:
    url = "twin://empty?rate=500"
    return ["accept", url, "--gauge", str(gauge), "--out", str(out), "--seconds", "1"]


@pytest.mark.slow
def test_an_emitter_that_is_not_plugged_in_gets_its_verdict(
    gauge_file: Path, tmp_path: Path, bench: Bench, monkeypatch, capsys
) -> None:
    hands = Hands(monkeypatch, bench)
    dark = np.tile([[0.0], [1.0]], (50, len(LAYOUT)))
    hands._states = [dark] * 9
    out = tmp_path / "out"
    assert main(arguments(gauge_file, out)) == 1
    assert len(hands.asked) == 9  # the step with the moving sheet three times
    text = capsys.readouterr().out
    assert text.count("once more: ") == 2
    assert text.count("going on without: ") == 1
    assert "of 255 in the empty grasp" in text, text
    report = json.loads((out / "acceptance.json").read_text())
    assert report["accepted"] is False


class OnAPrinter(Hands):
    """A builder who has the sheet on a printer's head, which hangs 4 degrees askew."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, bench: Bench, head: StandIn) -> None:
        super().__init__(monkeypatch, bench)
        self._head, self._twin = head, Twin(LAYOUT)
        empty, sheet, _, *gauge = self._states
        self._level = empty.mean(axis=0) / 255.0
        self._states = [empty, sheet, empty, empty, *gauge]

    def _packet(self, _: object, scene: Scene, first: int, count: int) -> object:
        made = super()._packet(_, scene, first, count)
        if len(self.asked) in (3, 4):  # each begins 3 mm beside the holes
            across = len(self.asked) == 3
            moved_mm = -self._head.place_mm["Z"] if across else self._head.place_mm["Y"]
            reach_mm = max(LAYOUT.x_mm if across else LAYOUT.y_mm) + LAYOUT.optics.hole_mm / 2.0
            way = (moved_mm - reach_mm - 3.0) * np.cos(np.radians(4.0))
            light = self._twin.edges([way], [94.0 if across else 4.0]) * self._level
            object.__setattr__(
                made, "values", (255.0 - np.repeat(light, count, 0)).astype(np.uint8)
            )
        return made


@pytest.mark.slow
def test_a_printer_moves_the_sheet_and_the_report_says_how_exactly_it_is_found(
    gauge_file: Path, tmp_path: Path, bench: Bench, monkeypatch, capsys
) -> None:
    monkeypatch.setattr(stage, "SETTLE_S", 0.01)
    head = StandIn(tmp_path / "printer")
    try:
        hands = OnAPrinter(monkeypatch, bench, head)
        out = tmp_path / "out"
        named = ["--stage", f"serial://{tmp_path / 'printer'}", "Z-", "Y+"]
        assert main([*arguments(gauge_file, out), *named]) == 0
    finally:
        head.close()
    assert len(hands.asked) == 8
    assert "mm along Z-, across the fingers, from one side, and back" in hands.asked[2]
    assert "mm along Y+, along the fingers, from the tip, and back" in hands.asked[3]
    assert head.place_mm == {"X": 0.0, "Y": 0.0, "Z": 0.0}, "it is back where it began"
    report = json.loads((out / "acceptance.json").read_text())
    assert [of["direction"] for of in report["traces"]] == ["Z-", "Y+"]
    for of in report["traces"]:
        assert of["places"] > 40
        assert of["missed"] == 0
        assert 0.0 < of["error_mm"] < 0.2
        assert of["scale"] == pytest.approx(1.0, abs=0.02)
    assert report["versions"]["printer"].startswith("Marlin 2.1")
    assert {"moved_mm_0", "moved_mm_1"} <= set(report["frames"]["steps"])
    printed = capsys.readouterr().out
    for line in ("printer: Marlin 2.1", "the edge along Z-: error 0.", "along Y+: error 0."):
        assert line in printed
    assert "The edge on the positioning stage" in (out / "acceptance.html").read_text()


@pytest.mark.parametrize(
    ("named", "said"),
    [
        (["ble://Lumitip", "Z-", "Y+"], "one like serial:///dev/ttyUSB1 is needed"),
        (["serial:///dev/none", "Z-", "Y"], "the direction 'Y'; an axis and a sign are needed"),
        (["serial:///dev/none", "E-", "Y+"], "the direction 'E-'"),
        (["serial:///dev/none", "Z-", "Z+"], "Z- and Z+; two different axes are needed"),
    ],
)
def test_a_stage_that_cannot_be_used_is_refused_before_the_first_step(
    gauge_file: Path, tmp_path: Path, capsys, named: list[str], said: str
) -> None:
    assert main([*arguments(gauge_file, tmp_path / "out"), "--stage", *named]) == 2
    assert said in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


@pytest.mark.slow
def test_good_fingers_are_accepted_reported_and_calibrated(
    gauge_file: Path, tmp_path: Path, bench: Bench, monkeypatch, capsys
) -> None:
    hands = Hands(monkeypatch, bench)
    out = tmp_path / "out"
    assert main(arguments(gauge_file, out)) == 0
    assert len(hands.asked) == 7
    assert "the end with the strip (S) of the gauge" in hands.asked[6]
    assert "its rails round the emitter" in hands.asked[6]
    assert "ACCEPTED" in capsys.readouterr().out.splitlines()
    report = json.loads((out / "acceptance.json").read_text())
    assert report["accepted"] is True
    assert report["design_hash"] == LAYOUT.design_hash
    assert report["gauge_sha256"] == hashlib.sha256(gauge_file.read_bytes()).hexdigest()
    data = (out / "frames.npz").read_bytes()
    assert report["frames"]["sha256"] == hashlib.sha256(data).hexdigest()
    with np.load(out / "frames.npz") as kept:
        for name, step in report["frames"]["steps"].items():
            assert step["frames"] == len(kept[name])
            assert step["sha256"] == hashlib.sha256(kept[name].tobytes()).hexdigest()
    assert {"lumitip", "numpy", "python"} <= set(report["versions"])
    saved = Calibration.kept(report["device_id"], LAYOUT.design_hash, 32)
    assert saved.empty is not None
    assert saved.empty.tolist() == pytest.approx(report["calibration"]["empty"], abs=0.01)
    assert saved.dark is not None
    page = (out / "acceptance.html").read_text()
    assert page.count("<circle") == 32
    assert "accepted" in page
    assert "http" not in page, "it needs no other file"


@pytest.mark.slow
def test_fingers_that_are_not_accepted_are_not_calibrated(
    gauge_file: Path, tmp_path: Path, bench: Bench, monkeypatch, capsys
) -> None:
    Hands(monkeypatch, bench, receiver_x=1.4)
    out = tmp_path / "out"
    assert main(arguments(gauge_file, out)) == 1
    printed = capsys.readouterr().out
    assert "receiver's mask: 1." in printed
    assert "NOT accepted" in printed.splitlines()
    report = json.loads((out / "acceptance.json").read_text())
    assert [finding["kind"] for finding in report["findings"]] == ["receiver mask"]
    assert report["deviations"]["receiver_x"]["value"] == pytest.approx(1.4, abs=0.15)
    assert Calibration.kept(report["device_id"], LAYOUT.design_hash, 32).empty is None
    assert "not accepted" in (out / "acceptance.html").read_text()
    assert "was not measured" in (out / "acceptance.html").read_text()
    command = arguments(gauge_file, tmp_path / "next")
    for other in (gauge_file, out / "acceptance.json"):
        assert main([*command, "--reference", str(other)]) == 2
        assert "as the report of accepted fingers of this design" in capsys.readouterr().err
    assert not (tmp_path / "next").exists()
    assert main(arguments(gauge_file, out)) == 2
    assert "has a report already. Choose another folder" in capsys.readouterr().err


@pytest.mark.slow
def test_a_measured_thickness_is_judged_and_reported(
    gauge_file: Path, tmp_path: Path, bench: Bench, monkeypatch, capsys
) -> None:
    Hands(monkeypatch, bench, emitter_silicone=-0.4)
    out = tmp_path / "out"
    assert main([*arguments(gauge_file, out), "--thicker-mm", "0.05", "-0.4"]) == 1
    assert "emitter's silicone: 0.40 mm thinner than drawn" in capsys.readouterr().out
    report = json.loads((out / "acceptance.json").read_text())
    assert report["thicker_mm"] == [0.05, -0.4]
    assert report["deviations"]["emitter_silicone"]["limit"] == 0.3
    assert "receiver +0.05 mm, emitter -0.40 mm" in (out / "acceptance.html").read_text()


@pytest.mark.parametrize("value", ["nan", "31"])
def test_a_thickness_out_of_range_is_refused(
    gauge_file: Path, tmp_path: Path, capsys, value: str
) -> None:
    command = [*arguments(gauge_file, tmp_path / "out"), "--thicker-mm", "0", value]
    assert main(command) == 2
    assert f"--thicker-mm has {value}; -2 to 2 is allowed" in capsys.readouterr().err


def test_the_gauge_of_another_design_is_refused_before_the_first_step(
    gauge_file: Path, tmp_path: Path, capsys
) -> None:
    gauge_file.write_text(json.dumps(record() | {"design_hash": "0" * 64}), encoding="utf-8")
    assert main(arguments(gauge_file, tmp_path / "out")) == 2
    assert "the gauge is of design 0000" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_without_a_keyboard_nothing_is_written(
    gauge_file: Path, tmp_path: Path, monkeypatch, capsys
) -> None:
    def closed(_: str) -> str:
        raise EOFError

    monkeypatch.setattr("builtins.input", closed)
    assert main(arguments(gauge_file, tmp_path / "out")) == 2
    assert "run it in a terminal" in capsys.readouterr().err
    assert not list((tmp_path / "out").iterdir())


@pytest.mark.slow
@pytest.mark.parametrize("entered", [0, 2])
def test_ctrl_c_at_a_step_ends_it_and_leaves_no_file(
    gauge_file: Path, tmp_path: Path, entered: int
) -> None:
    command = [sys.executable, "-m", "lumitip.cli", *arguments(gauge_file, tmp_path / "out")]
    pipe = subprocess.PIPE
    with subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=pipe, text=True) as process:
        try:
            assert process.stdin and process.stdout
            printed = ""
            for step in range(entered + 1):
                while not printed.endswith("press Enter: "):
                    letter = process.stdout.read(1)
                    assert letter, process.communicate()
                    printed += letter
                if step < entered:
                    process.stdin.write("\n")
                    process.stdin.flush()
                    printed = ""
            assert printed.splitlines()[-1].startswith(f"{entered + 1} of 7: ")
            process.send_signal(signal.SIGINT)
            rest, errors = process.communicate(timeout=60)
        finally:
            process.kill()
    assert (process.returncode, errors) == (130, "")
    assert rest == "\nended before the verdict: no report and no reference is saved\n"
    assert not list((tmp_path / "out").iterdir())
    assert not list(tmp_path.glob("data/**/*.json"))


@pytest.mark.slow
def test_ctrl_c_while_the_report_is_written_leaves_it_whole(
    gauge_file: Path, tmp_path: Path, bench: Bench, monkeypatch, capsys
) -> None:
    hands = Hands(monkeypatch, bench)
    hands._states = [np.tile([[0.0], [1.0]], (50, len(LAYOUT)))] * 9
    replace = Path.replace

    def interrupted(file: Path, target: Path) -> Path:
        os.kill(os.getpid(), signal.SIGINT)
        return replace(file, target)

    monkeypatch.setattr(Path, "replace", interrupted)
    out = tmp_path / "out"
    assert main(arguments(gauge_file, out)) == 130
    names = ["acceptance.html", "acceptance.json", "frames.npz"]
    assert sorted(file.name for file in out.iterdir()) == names
    assert f"report: {out / names[0]}" in capsys.readouterr().out.splitlines()


def test_an_output_folder_that_is_a_file_is_refused_before_the_first_step(
    gauge_file: Path, tmp_path: Path, capsys
) -> None:
    (tmp_path / "out").write_text("mine", encoding="utf-8")
    assert main(arguments(gauge_file, tmp_path / "out")) == 2
    assert "the report cannot be written" in capsys.readouterr().err
    assert (tmp_path / "out").read_text(encoding="utf-8") == "mine"


def test_names_from_outside_are_no_markup(bench: Bench, judge: Judge) -> None:
    judged = judge(bench.frames())
    made = Circumstances("<b>&", "2026-11-27", "", {"lumitip": "<i>"})
    record = {
        **{"device_id": "<b>&", "date": made.date, "design_hash": "0", "deviations": {}},
        **{
            "traces": [],
            "reference": None,
            "thicker_mm": None,
            "gauge_sha256": "",
            "frames": {"sha256": ""},
        },
        "versions": made.versions,
    }
    text = page(record, judged, LAYOUT)
    assert "&lt;b&gt;&amp;: <span" in text
    assert "<b>" not in text
    assert "<i>" not in text
