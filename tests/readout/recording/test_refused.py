"""What a writer refuses before there is a file."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lumitip import Calibration, LayoutError, LumitipError
from lumitip.errors import CalibrationError, CalibrationMismatch
from lumitip.links.twin import published_layout
from lumitip.recording import Reader, RecordingError, Writer

CELLS = published_layout()


def test_a_recording_of_what_is_no_frame(tmp_path: Path) -> None:
    required: dict[str, Any] = {"device_id": "dev"}
    for more in ({"calibration": "empty"}, {"start_wall": -1.0}, {"start_wall": "now"}):
        with pytest.raises(RecordingError, match=r" is .*; "):
            Writer(tmp_path / "run.mcap", CELLS, **required, **more)  # type: ignore[arg-type]
    for versions in ("x", 3, ["lumitip"]):
        with pytest.raises(RecordingError, match=r"made_with is .*; versions by name"):
            Writer(tmp_path / "run.mcap", CELLS, **required, made_with=versions)  # type: ignore[arg-type]
    with pytest.raises(RecordingError, match="cannot be written"):
        Writer(tmp_path / "run.mcap", CELLS, device_id="\ud800")
    assert not list(tmp_path.iterdir())
    with (
        Writer(tmp_path / "run.mcap", CELLS, **required) as writer,
        pytest.raises(RecordingError, match=r"; a Frame is needed"),
    ):
        writer.write(np.zeros(32))  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("error", "calibration", "match"),
    [
        (CalibrationMismatch, Calibration("dev", "0"), "has design"),
        (CalibrationMismatch, Calibration("other", CELLS.design_hash), "of 'other'"),
        (
            CalibrationMismatch,
            Calibration("dev", CELLS.design_hash, np.ones(5, np.float32)),
            "has 5 cells",
        ),
        (
            CalibrationError,
            Calibration("dev", CELLS.design_hash, np.zeros(32, np.float32)),
            "not lighter with an empty grasp",
        ),
    ],
    ids=["design", "device", "cells", "dark"],
)
def test_a_recording_with_a_calibration_that_its_reader_would_refuse(
    error: type[LumitipError], calibration: Calibration, match: str, tmp_path: Path
) -> None:
    path = tmp_path / "run.mcap"
    with pytest.raises(error, match=match):
        Writer(path, CELLS, device_id="dev", calibration=calibration)
    for layout in ("layout.json", None):
        with pytest.raises(LayoutError, match="a Layout is needed"):
            Writer(path, layout, device_id="dev", calibration=calibration)  # type: ignore[arg-type]
    assert not list(tmp_path.iterdir())
    made_with: dict[Any, Any] = {"robot": 1, 2: np.float32(0.5)}
    own = Calibration("dev", CELLS.design_hash, np.full(32, 200.0, np.float32))
    Writer(path, CELLS, device_id="dev", calibration=own, made_with=made_with).close()
    assert Reader(path).metadata.versions == {"robot": "1", "2": "0.5"}
