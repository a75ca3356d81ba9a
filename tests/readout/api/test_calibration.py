"""Calibration: measured, kept for one device and design, refused for any other; drift."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from lumitip import Calibration, Fingertip
from lumitip.calibration import user_folder
from lumitip.errors import CalibrationError, CalibrationMismatch
from lumitip.session.drift import DriftWatch

HASH = "ab" * 32


def _measured(empty: float = 200.0, dark: float | None = None) -> Calibration:
    made = Calibration("dev", HASH)
    if dark is not None:
        made = made.measured("dark", np.full((5, 4), dark, np.float32))
    return made.measured("empty", np.full((5, 4), empty, np.float32))


def test_an_empty_grasp_reads_full_light_and_darkness_none() -> None:
    correction = _measured(205.0, 5.0).correction()
    light = np.array([[205.0, 5.0, 105.0, 250.0], [0.0, 55.0, 205.0, 155.0]], np.float32)
    values = correction.apply(light)
    assert values.tolist() == [[255.0, 0.0, 127.5, 255.0], [0.0, 63.75, 255.0, 191.25]]
    assert values.dtype == np.float32


def test_one_reference_alone() -> None:
    only_empty = _measured(204.0).correction().apply(np.full(4, 102.0, np.float32))
    assert only_empty == pytest.approx(np.full(4, 127.5))
    only_dark = Calibration("dev", HASH).measured("dark", np.full((5, 4), 55.0, np.float32))
    assert only_dark.correction().apply(np.full(4, 155.0, np.float32)) == pytest.approx(
        np.full(4, 127.5)
    )
    assert Calibration("dev", HASH).correction() is None


def test_what_is_no_empty_grasp_is_refused_with_the_cells() -> None:
    light = np.full((20, 4), 200.0, np.float32)
    covered, restless = light.copy(), light.copy()
    covered[:, 2] = 12.0
    restless[::2, [0, 3]] = 150.0
    none = Calibration("dev", HASH)
    with pytest.raises(CalibrationError, match=r"^cell 2: the empty grasp is less than 80 of 255"):
        none.measured("empty", covered)
    with pytest.raises(CalibrationError, match=r"^cells 0, 3: the noise is above 8 of"):
        none.measured("empty", restless)
    with pytest.raises(CalibrationError, match=r"^all 4 cells: the light is above 76\.5"):
        none.measured("dark", light)
    with pytest.raises(CalibrationError, match="less than 26 of 255 lighter"):
        _measured(60.0).measured("dark", np.full((5, 4), 50.0, np.float32))


def test_a_calibration_that_is_refused_is_not_in_use(open_feed) -> None:
    tip, feed = open_feed()
    feed.packet(0)
    design, cells = tip.layout.design_hash, len(tip.layout)
    empty = np.full(cells, 200.0, np.float32)
    good = tip.calibration = Calibration("feed", design, empty)
    with pytest.raises(CalibrationError, match="not lighter"):
        tip.calibration = Calibration("feed", design, empty, empty)
    assert tip.calibration is good
    feed.packet(1, value=155)
    assert tip.latest().values == pytest.approx(np.full(cells, 127.5))


def test_long_lists_of_cells_are_cut_so_that_the_remedy_is_read() -> None:
    none = Calibration("dev", HASH)
    for moving, said in (
        (32, "all 32 cells:"),
        (31, "cells 0, 1, 2 and 28 others:"),
        (7, "cells 0, 1, 2 and 4 others:"),
        (6, "cells 0, 1, 2, 3, 4, 5:"),
        (1, "cell 0:"),
    ):
        light = np.full((20, 32), 200.0, np.float32)
        light[::2, :moving] = 150.0
        with pytest.raises(CalibrationError, match=rf"^{said} the noise .* Hold the fingers still"):
            none.measured("empty", light)


def test_it_is_kept_and_found_again(tmp_path: Path) -> None:
    made = _measured(201.25, 3.5)
    path = made.save(tmp_path)
    found = Calibration.kept("dev", HASH, 4, tmp_path)
    assert found.empty == pytest.approx(made.empty)
    assert found.dark == pytest.approx(made.dark)
    assert path == made.save(tmp_path), "the same device and design have one file"
    assert Calibration.kept("dev", "cd" * 32, 4, tmp_path).empty is None
    assert Calibration.kept("other", HASH, 4, tmp_path).empty is None
    found.forget(tmp_path)
    assert Calibration.kept("dev", HASH, 4, tmp_path).empty is None


def test_no_two_devices_share_a_file(tmp_path: Path) -> None:
    ids = ["ble:C0:FF", "ble_C0_FF", "ble:C0/FF", "BLE:C0:FF", "ble:C0:FF.", "é"]
    paths = {Calibration(i, HASH).save(tmp_path) for i in ids}
    assert len(paths) == len(ids)
    assert all(path.parent == tmp_path for path in paths)


def test_another_designs_or_devices_calibration_is_refused(open_feed, tmp_path: Path) -> None:
    tip, feed = open_feed()
    cells = len(tip.layout)
    other = Calibration("feed", HASH).measured("empty", np.full((5, cells), 200.0, np.float32))
    with pytest.raises(CalibrationMismatch, match="has design abababababababab; the fingertip has"):
        tip.calibration = other
    with pytest.raises(CalibrationMismatch, match="of 'dev'; the fingertip is 'feed'"):
        tip.calibration = Calibration("dev", tip.layout.design_hash)
    path = Calibration("feed", HASH).save(tmp_path)
    path.rename(path.with_name(f"feed.{tip.layout.design_hash[:16]}.json"))
    with pytest.raises(CalibrationMismatch, match="Tare this fingertip"):
        Calibration.kept("feed", tip.layout.design_hash, cells, tmp_path)
    feed.packet(0, value=55)
    assert tip.latest().values[0] == 200.0, "nothing changed"


@pytest.mark.parametrize(
    "text",
    [
        "",
        "{}",
        "[]",
        '{"format": 2}',
        '{"format": 1, "device_id": "dev"}',
        '{"format": 1, "device_id": "dev", "design_hash": "HASH", "empty": ["x"], "dark": null}',
        '{"format": 1, "device_id": "dev", "design_hash": "HASH", "empty": [NaN], "dark": null}',
        '{"format": 1, "device_id": "dev", "design_hash": "HASH", "empty": [1], "dark": null}',
    ],
)
def test_a_damaged_file_is_told(tmp_path: Path, text: str) -> None:
    path = _measured().save(tmp_path)
    path.write_text(text.replace("HASH", HASH), encoding="utf-8")
    with pytest.raises(CalibrationError, match="Delete it and tare again"):
        Calibration.kept("dev", HASH, 4, tmp_path)


def test_a_folder_that_cannot_be_written_is_told(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("", encoding="utf-8")
    with pytest.raises(CalibrationError, match="cannot be written"):
        _measured().save(tmp_path / "file")


def test_taring_calibrates_now_and_the_next_time(tmp_path: Path) -> None:
    url = "twin://empty?rate=1000&seed=3"
    with Fingertip.open(url) as tip:
        before = tip.get_data(50).values.mean()
        tip.tare(num_samples=40)
        after = next(tip.frames(5.0)).values.mean()
    assert before == pytest.approx(233.1, abs=1.0)
    assert after > 253.0
    assert list((tmp_path / "user" / "lumitip" / "calibration").iterdir())
    with Fingertip.open(url) as tip:
        assert tip.read(5.0).values.mean() > 253.0
    with Fingertip.open(url, calibrated=False) as tip:
        assert tip.read(5.0).values.mean() < 240.0
    with (
        Fingertip.open("twin://disc?rate=1000&speed=0") as tip,
        pytest.raises(CalibrationError, match="Is the grasp empty"),
    ):
        tip.tare(num_samples=20)


@pytest.mark.parametrize(
    ("brighter", "cells", "said"),
    [
        (1.2, [3, 4, 17], "cells 3, 4, 17: up to 17 % darker than at the last tare"),
        (1.05, [3], ""),  # as a part ages
        (1.2, range(32), ""),  # as all LEDs dim while they warm
    ],
)
def test_a_tare_over_something_thin_is_doubted(
    caplog: pytest.LogCaptureFixture, brighter: float, cells: list[int], said: str
) -> None:
    with Fingertip.open("twin://empty?rate=1000") as tip:
        first = tip.tare(num_samples=40, keep=False)
        assert not caplog.records, "there is nothing to compare with"
        assert first.empty is not None
        empty = first.empty.copy()
        empty[list(cells)] *= brighter
        tip.calibration = replace(first, empty=empty)
        second = tip.tare(num_samples=40, keep=False)
        assert second.empty == pytest.approx(first.empty, rel=0.02), "it is a warning"
    if not said:
        assert not caplog.records
        return
    (record,) = caplog.records
    assert said in record.getMessage() and record.levelname == "WARNING"
    assert "Is something between the fingers? Take it out and tare again" in record.getMessage()


def test_the_users_folder_follows_the_platform(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_DATA_HOME", "/x")
    monkeypatch.setenv("LOCALAPPDATA", "/l")
    monkeypatch.setenv("HOME", "/h")
    for platform, folder in {
        "linux": "/x/lumitip",
        "win32": "/l/lumitip",
        "darwin": "/h/Library/Application Support/lumitip",
    }.items():
        monkeypatch.setattr("sys.platform", platform)
        assert user_folder() == Path(folder)
    monkeypatch.setattr("sys.platform", "linux")
    monkeypatch.delenv("XDG_DATA_HOME")
    assert user_folder() == Path("/h/.local/share/lumitip")


def _watch(first_s: float, seconds: float, legacy: bool = False) -> tuple[DriftWatch, list[float]]:
    """Cells lose 6 counts over 300 s; the last one is covered half of the time, the first always.
    Returns the watch and the times at which the warm-up ended."""
    watch, ended = DriftWatch(), []
    for t in np.arange(first_s, first_s + seconds, 0.05):
        lost = 6.0 * min(t, 300.0) / 300.0
        light = np.full(3, 230.0 - lost)
        light[0] = 20.0
        light[2] = 20.0 if int(t / 2) % 2 else light[2]
        raw = np.rint(255 - light).astype(np.uint8)
        if watch.add(raw, 8, 1000.0 + t, None if legacy else t):
            ended.append(float(t))
    return watch, ended


def test_drift_over_the_warm_up_is_told_and_its_end_reported_once() -> None:
    watch, ended = _watch(2.0, 400.0)
    assert watch.drift is not None
    assert watch.drift.warm
    assert watch.drift.change == pytest.approx([0.0, -6.0, -6.0], abs=1.01)
    assert watch.drift.watched_s == pytest.approx(385.0, abs=16.0)
    assert len(ended) == 1
    assert ended[0] == pytest.approx(307.0, abs=16.0)
    assert str(watch.drift).startswith("warm; cells changed by -")
    early, ended = _watch(2.0, 25.0)
    assert early.drift is None
    assert ended == []


def test_a_device_that_is_warm_already_has_no_end_of_warm_up() -> None:
    watch, ended = _watch(900.0, 60.0)
    assert watch.drift is not None
    assert watch.drift.warm
    assert ended == []


def test_a_legacy_device_is_warm_when_it_was_watched_long_enough() -> None:
    watch, ended = _watch(0.0, 60.0, legacy=True)
    assert watch.drift is not None
    assert not watch.drift.warm
    watch, ended = _watch(0.0, 400.0, legacy=True)
    assert watch.drift is not None
    assert watch.drift.warm
    assert len(ended) == 1


def test_a_fingertip_reports_the_end_of_its_warm_up(open_feed) -> None:
    events: list[str] = []
    tip, feed = open_feed(on_event=lambda event: events.append(event.kind))
    assert tip.drift is None
    for n in range(0, 33_000, 10):
        feed.packet(n, 1, value=20)
    assert tip.drift.warm
    assert events == ["connected", "warm"]


def test_a_reference_without_span_is_refused(tmp_path: Path) -> None:
    same = np.array([200.0, 50.0, 200.0, 200.0], np.float32)
    dark = np.full(4, 50.0, np.float32)
    path = Calibration("dev", HASH, same, dark).save(tmp_path)
    with pytest.raises(CalibrationError, match=r"cell 1: not lighter.*Tare again"):
        Calibration.load(path)


def test_a_folder_that_cannot_be_read_is_told(tmp_path: Path) -> None:
    # A file in the place of the folder: also the administrator cannot read through it.
    folder = tmp_path / "calibration"
    folder.write_text("", encoding="utf-8")
    with pytest.raises(CalibrationError, match="cannot be read"):
        Calibration.kept("dev", HASH, 4, folder)
    with pytest.raises(CalibrationError, match="cannot be deleted"):
        Calibration("dev", HASH).forget(folder)


def test_what_cannot_be_kept_changes_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "taken").write_text("", encoding="utf-8")
    with Fingertip.open("twin://empty?rate=500") as tip:
        monkeypatch.setattr("lumitip.calibration.user_folder", lambda: tmp_path / "taken")
        with pytest.raises(CalibrationError, match="cannot be written"):
            tip.tare()
        assert tip.calibration.empty is None
        with pytest.raises(ValueError, match="num_samples is 0"):
            tip.tare(num_samples=0)
