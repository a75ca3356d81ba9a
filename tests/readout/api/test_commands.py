"""The command `lumitip`, on the twin; and what importing costs."""

import json
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from lumitip import Fingertip, Layout
from lumitip.cli import main
from lumitip.errors import LinkError
from lumitip.links.twin import TwinLink, published_layout


def test_the_package_runs_as_its_command() -> None:
    whole = [sys.executable, "-m", "lumitip", "--version"]
    ran = subprocess.run(whole, capture_output=True, text=True, check=True)
    assert ran.stdout.split()[0] == "lumitip"
    wrong = subprocess.run([*whole[:3], "nothing"], capture_output=True, text=True, check=False)
    assert wrong.returncode == 2 and "Traceback" not in wrong.stderr


def test_doctor_finds_nothing_wrong_with_the_twin(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["doctor", "twin://disc?rate=300&speed=300", "--seconds", "1.5"]) == 0
    told = capsys.readouterr().out
    assert "twin:disc: testing 32 cells" in told
    assert "no fault found" in told
    assert "switched on 0 s ago" in told
    assert "swapped" not in told


def test_doctor_names_what_is_wrong(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    from lumitip.links import twin

    real = twin.packet_at

    def broken(*arguments):
        packet = real(*arguments)
        packet.values[:, 4] = 255
        packet.values[:, [2, 29]] = packet.values[:, [29, 2]]
        return packet

    monkeypatch.setattr(twin, "packet_at", broken)
    assert main(["doctor", "twin://disc?rate=300&speed=300", "--seconds", "1.5"]) == 1
    told = capsys.readouterr().out
    assert "cell 4 dark: never above 0 of 255" in told
    assert "cell 2 and 29 swapped" in told


def test_tare_keeps_and_forgets(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    kept = tmp_path / "user" / "lumitip" / "calibration"
    assert main(["tare", "twin://empty?rate=500"]) == 0
    told = capsys.readouterr().out
    assert told.startswith(
        "twin:empty: hold still with nothing between the fingers, waiting for 50"
    )
    assert "twin:empty: cells read 214." in told
    assert "tare again five minutes after switching on" in told
    (path,) = kept.iterdir()
    assert json.loads(path.read_text(encoding="utf-8"))["device_id"] == "twin:empty"
    assert main(["tare", "twin://empty", "--forget"]) == 0
    assert not list(kept.iterdir())
    assert main(["tare", "twin://disc?speed=0&rate=500"]) == 2
    assert "Is the grasp empty" in capsys.readouterr().err


def test_refusals_are_one_line(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    assert main(["doctor", "twin://pyramid"]) == 2
    assert capsys.readouterr().err.startswith(
        "lumitip: 'twin://pyramid': there is no shape 'pyramid'"
    )
    assert main(["tare", "twin://disc", "--layout", str(tmp_path / "none.json")]) == 2
    assert "cannot be read as a layout" in capsys.readouterr().err


def test_a_layout_built_here_is_found(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    make_layout,
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "outputs").mkdir()
    text = make_layout((4, 5, 4), 5.0).to_json()
    (tmp_path / "outputs" / "layout.json").write_text(text, encoding="utf-8")
    main(["doctor", "twin://disc?rate=300", "--seconds", "0.1"])
    assert "13 cells" in capsys.readouterr().out


def test_the_twins_own_layout_is_the_published_design() -> None:
    from lumitip_fab.config.load import load
    from lumitip_fab.derive import derive

    published = Path(__file__).parents[3] / "design" / "presets" / "published.toml"
    assert published_layout() == derive(load(published)).layout
    assert published_layout().to_json() == derive(load(published)).layout.to_json()


def test_a_twin_that_is_late_sends_what_is_due(layout: Layout) -> None:
    from lumitip.links.twin import Scene

    arrivals = []

    def deliver(arrival) -> None:
        arrivals.append(arrival)
        if len(arrivals) == 3:
            time.sleep(0.2)

    link = TwinLink(layout, Scene("disc", 12.0, 0.0, 100.0, 8, 0))
    link.start(deliver, lambda _: None)
    while len(arrivals) < 30:
        time.sleep(0.005)
    link.stop()
    times = np.array([a.content.time_us for a in arrivals[:30]])
    assert np.diff(times).tolist() == [10_000] * 29
    assert arrivals[29].t_host - arrivals[0].t_host < 0.45


def test_importing_takes_nothing_and_names_come_when_they_are_used() -> None:
    code = (
        "import sys, lumitip; before = set(sys.modules); lumitip.Fingertip; lumitip.AsyncFingertip;"
        "lumitip.FingertipGroup; assert all(getattr(lumitip, n) for n in lumitip.__all__);"
        "print(*sorted({m.partition('.')[0] for m in before}), '|',"
        "'lumitip.session.hub' in before,"
        "*sorted({m.partition('.')[0] for m in sys.modules} & {'bleak', 'serial', 'mcap'}))"
    )
    done = subprocess.run(
        [sys.executable, "-sP", "-c", code], capture_output=True, text=True, check=True
    )
    modules, _, after = done.stdout.partition("|")
    assert after.split() == ["False"], "links import their libraries when they are opened"
    assert not {"numpy", "bleak", "serial", "starlette", "mcap"} & set(modules.split())


def test_an_unknown_name_is_no_attribute() -> None:
    import lumitip

    assert issubclass(lumitip.errors.LinkError, lumitip.LumitipError)
    assert {"Fingertip", "OpenOptions", "errors", "layout"} <= set(dir(lumitip))
    with pytest.raises(AttributeError, match="has no attribute 'Fingertips'"):
        _ = lumitip.Fingertips


@pytest.mark.parametrize(
    ("url", "module", "extra"),
    [("ble://Lumitip", "bleak", "ble"), ("serial:///dev/ttyACM0", "serial", "serial")],
)
def test_a_missing_library_is_told_by_its_extra(
    layout: Layout, monkeypatch: pytest.MonkeyPatch, url: str, module: str, extra: str
) -> None:
    from lumitip import Fingertip
    from lumitip.errors import MissingExtra

    for name in [n for n in sys.modules if n.partition(".")[0] == module]:
        monkeypatch.setitem(sys.modules, name, None)
    monkeypatch.setitem(sys.modules, module, None)
    for name in ("ble", "ble_find", "ble_gatt", "serial"):
        monkeypatch.delitem(sys.modules, f"lumitip.links.{name}", raising=False)
    with pytest.raises(MissingExtra, match=rf"pip install '\.\[{extra}\]'") as caught:
        Fingertip.open(url, layout)
    assert caught.value.extra == extra


@pytest.mark.parametrize("seconds", ["0", "-1", "nan", "inf"])
def test_doctor_needs_time(capsys: pytest.CaptureFixture[str], seconds: str) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["doctor", "twin://demo", "--seconds", seconds])
    assert ended.value.code == 2
    assert f"--seconds: the value is {seconds};" in capsys.readouterr().err


def test_a_fault_of_the_twin_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    from lumitip.links import twin

    def fails(*_: object) -> None:
        raise ArithmeticError("mine")

    monkeypatch.setattr(twin, "packet_at", fails)
    with pytest.raises(LinkError, match="unexpected ArithmeticError: mine"):
        Fingertip.open("twin://demo", timeout=5.0)


@pytest.mark.parametrize("name", ["tasks.md", "tasks.json", "tasks.svg"])
def test_results_that_cannot_be_written_are_refused_before_the_trials(
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    name: str,
) -> None:
    def run(*_: object, **__: object) -> None:
        raise AssertionError("no trial may begin")

    monkeypatch.setattr("lumitip.tasks.bench.bench_tasks", run)
    (tmp_path / "out" / name).mkdir(parents=True)
    assert main(["bench-tasks", "--trials", "1", "--out", str(tmp_path / "out")]) == 2
    error = capsys.readouterr().err
    assert "cannot be written" in error and "Choose another folder" in error
    assert [file.name for file in (tmp_path / "out").iterdir()] == [name]
