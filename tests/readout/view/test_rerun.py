"""The file for the Rerun viewer, read back with Rerun's own reader."""

import builtins
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lumitip import Layout
from lumitip.errors import LinkError, MissingExtra
from lumitip.frame import Frame
from lumitip.links.base import LinkEvent
from lumitip.processing import Processor
from lumitip.recording import summarise
from lumitip.view.drawn import borders
from lumitip.view.finger import Finger
from lumitip.view.rerun_sink import RerunSink

COMPONENTS = {
    "cells": "Points2D:positions",
    "markers": "Points2D:positions",
    "centre": "Points2D:positions",
    "border": "LineStrips2D:strips",
    "mean": "Scalars:scalars",
    "shape": "TextLog:text",
}


def read(path: Path) -> dict[str, list[Any]]:
    """Rows of each entity's component, in order."""
    from rerun.chunk import RrdReader

    found: dict[str, list[tuple[int, Any]]] = {name: [] for name in COMPONENTS}
    for chunk in RrdReader(path).stream().collect().stream():
        name = str(chunk.entity_path).rpartition("/")[2]
        if name in COMPONENTS and not chunk.is_static:
            table = chunk.to_record_batch()
            seq, told = (table[column].to_pylist() for column in ("seq", COMPONENTS[name]))
            found[name] += zip(seq, told, strict=True)
    return {name: [row for _, row in sorted(rows, key=_first)] for name, rows in found.items()}


def _first(row: tuple[int, Any]) -> int:
    return row[0]


@pytest.mark.slow
def test_file_holds_what_the_view_shows(
    tmp_path: Path, layout: Layout, still: Callable[[Layout, np.ndarray], Finger]
) -> None:
    path = tmp_path / "run.rrd"
    sink = RerunSink(path)
    dark = np.abs(layout.y_mm - 0.2 * layout.x_mm) < 4.0
    finger = still(layout, np.where(dark, 235, 15))
    given: list[Frame] = []
    for _ in range(120):
        given.append(finger.tip.read())
        sink.take(finger, given[-1])
    finger.close()
    sink.close()
    contact = Processor(layout)(given[0].values)
    assert contact.cable
    assert contact.markers_mm is not None

    rows = read(path)
    # 120 frames at 100 Hz, cut to at most 60 Hz: every second one, give or take a late one.
    assert 55 <= len(rows["cells"]) <= 65
    np.testing.assert_allclose(
        rows["cells"][0], np.column_stack((layout.x_mm, -layout.y_mm)), atol=1e-5
    )
    assert contact.centre_mm is not None
    np.testing.assert_allclose(
        rows["centre"][0], [np.multiply(contact.centre_mm, [1, -1])], atol=1e-5
    )
    np.testing.assert_allclose(rows["markers"][0], contact.markers_mm * [1, -1], atol=1e-5)
    np.testing.assert_allclose(
        rows["border"][0], np.array(borders(contact, np.ptp(layout.x_mm))) * [1, -1], atol=1e-4
    )
    np.testing.assert_allclose(rows["mean"][0], given[0].values.mean(), rtol=1e-6)
    assert rows["shape"] == [["cable"]]


@pytest.mark.slow
def test_fingers_of_one_name_are_kept_apart(
    tmp_path: Path, layout: Layout, still: Callable[[Layout, np.ndarray], Finger]
) -> None:
    from rerun.chunk import RrdReader

    path = tmp_path / "run.rrd"
    sink = RerunSink(path)
    for code in (20, 60):
        finger = still(layout, np.full(len(layout), code))
        for _ in range(3):
            sink.take(finger, finger.tip.read())
        finger.close()
    sink.close()
    chunks = RrdReader(path).stream().collect().stream()
    found = {str(chunk.entity_path) for chunk in chunks}
    cells = {name for name in found if name.endswith("cells")}
    assert cells == {
        "/still/cells",
        "/still\\ 2/cells",
    }


class _Panic(BaseException):
    """As Rerun's, which is no `Exception`."""


@pytest.mark.parametrize("fault", [OSError("the disk is full"), _Panic("the disk is full")])
def test_a_sink_that_fails_ends_neither_reading_nor_recording(
    fault: BaseException,
    layout: Layout,
    still: Callable[[Layout, np.ndarray], Finger],
    wait_for: Callable[..., None],
    tmp_path: Path,
) -> None:
    class Failing:
        calls = 0

        def take(self, _: Finger, __: Frame) -> None:
            self.calls += 1
            raise fault

    class Sound:
        calls = 0

        def take(self, _: Finger, __: Frame) -> None:
            self.calls += 1

    failing, sound = Failing(), Sound()
    tip = still(layout, np.full(len(layout), 20)).tip
    finger = Finger("still://", tip, sinks=(failing, sound))
    finger.record(tmp_path / "run.mcap")
    finger.start(lambda: None)
    wait_for(lambda: finger.status()["recording"]["frames"] > 20)
    status = finger.status()
    assert (failing.calls, status["state"], status["recording"]["on"]) == (1, "connected", True)
    assert sound.calls >= 20
    assert status["warning"] == (
        f"Failing has failed and gets no more frames: {type(fault).__name__}: the disk is full"
    )
    finger.close()


def test_a_link_that_fails_ends_the_recording_with_an_error(
    layout: Layout,
    still: Callable[[Layout, np.ndarray], Finger],
    wait_for: Callable[..., None],
    tmp_path: Path,
) -> None:
    tip = still(layout, np.full(len(layout), 20)).tip
    finger = Finger("still://", tip)
    finger.record(tmp_path / "run.mcap")
    finger.start(lambda: None)
    wait_for(lambda: finger.status()["recording"]["frames"] > 5)
    tip._hub._report(LinkEvent("failed", "unplugged", LinkError("unplugged")))
    wait_for(lambda: finger.status()["state"] == "failed")
    wait_for(lambda: not finger.status()["recording"]["on"])
    assert finger.status()["recording"]["error"] == "the recording ended: unplugged"
    assert summarise(tmp_path / "run.mcap").damage == ()
    for kind in ("lost", "connected", "warm"):
        finger.on_event(LinkEvent(kind, "the link lives on"))
        assert finger.status()["state"] == "failed"
        assert finger.status()["detail"] == "unplugged"
    finger.close()


def test_borders_are_the_fitted_lines(layout: Layout) -> None:
    dark = np.abs(layout.y_mm - 0.2 * layout.x_mm) < 4.0
    contact = Processor(layout)(np.where(dark, 20.0, 240.0))
    assert contact.cable
    one, two = borders(contact, 10.0)
    turn = np.deg2rad(contact.cable.angle_deg)
    across = np.array((-np.sin(turn), np.cos(turn)))
    for strip in (one, two):
        assert np.ptp(strip @ across) < 1e-9
        assert np.hypot(*(strip[1] - strip[0])) == pytest.approx(20.0)
    assert abs((one[0] - two[0]) @ across) == pytest.approx(contact.cable.width_mm)


def test_without_rerun_it_is_said_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    real = builtins.__import__

    def without(name: str, *rest: Any, **more: Any) -> Any:
        if name == "rerun":
            raise ModuleNotFoundError(name=name)
        return real(name, *rest, **more)

    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(MissingExtra, match=r"'\.\[rerun\]'"):
        RerunSink()
