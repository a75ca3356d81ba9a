"""Recordings of two fingertips with other grids, and the file for Foxglove of both."""

import json
from collections import defaultdict
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory

from lumitip import Layout
from lumitip.calibration import Calibration
from lumitip.foxglove import write_scene
from lumitip.frame import Frame
from lumitip.recording import Writer
from lumitip.twin import HalfPlane, Twin

Messages = dict[str, list[tuple[Any, Any, Any]]]
ANGLE_DEG, OFFSET_MM = 20.0, 2.0
START = 1_790_000_000.0
CALIBRATED = "right"


def recorded(path: Path, layout: Layout, seed: int, calibrate: bool = False) -> list[Frame]:
    """A recording of an edge, and its frames; as 12 bits with a calibration, else as 8."""
    bits = 12 if calibrate else 8
    values = Twin(layout).values(HalfPlane(OFFSET_MM, ANGLE_DEG))
    light = np.round(values / 255.0 * ((1 << bits) - 1))
    codes = ((1 << bits) - 1 - light).clip(0).astype(np.uint16 if calibrate else np.uint8)
    frames = [
        Frame(
            seq=i + 1,
            t_device=i / 50.0,
            t_host=10.0 + i / 50.0,
            t=10.0 + i / 50.0,
            t_wall=START + 0.003 * seed + i / 50.0,
            raw=codes,
            bits=bits,
            values=np.zeros(len(layout), np.float32),
            dropped_before=0,
            device_id=f"device {seed}",
        )
        for i in range(8)
    ]
    full = np.full(len(layout), 250.0, np.float32)
    calibration = Calibration(f"device {seed}", layout.design_hash, full, None)
    with Writer(
        path,
        layout,
        device_id=f"device {seed}",
        calibration=calibration if calibrate else None,
        start_wall=START,
        made_with={"lumitip": "1"},
    ) as writer:
        for frame in frames:
            writer.write(frame)
    return frames


@pytest.fixture(scope="module")
def grids(make_layout: Callable[..., Layout]) -> dict[str, Layout]:
    return {"left": make_layout(), CALIBRATED: make_layout((3, 4, 3), 7.0)}


@pytest.fixture(scope="module")
def sources(
    grids: dict[str, Layout], tmp_path_factory: pytest.TempPathFactory
) -> dict[str, tuple[Path, list[Frame]]]:
    folder = tmp_path_factory.mktemp("recordings")
    return {
        name: (path, recorded(path, layout, seed, calibrate=name == CALIBRATED))
        for seed, (name, layout) in enumerate(grids.items())
        for path in [folder / f"{name}.mcap"]
    }


@pytest.fixture(scope="module")
def scene(
    sources: dict[str, tuple[Path, list[Frame]]], tmp_path_factory: pytest.TempPathFactory
) -> Path:
    """Both recordings in one file. Do not change it."""
    path = tmp_path_factory.mktemp("scene") / "scene.mcap"
    written = write_scene(path, {name: file for name, (file, _) in sources.items()})
    assert (written.path, written.frames, written.damage) == (path, 16, ())
    return path


@pytest.fixture(scope="module")
def messages(scene: Path) -> Messages:
    """`messages["/left/values"]`: schema, record of MCAP and decoded message of each."""
    found: Messages = defaultdict(list)
    with scene.open("rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()], validate_crcs=True)
        for schema, channel, message in reader.iter_messages():
            decoded: Any = None
            if channel.message_encoding == "json":
                decoded = json.loads(message.data)
            elif channel.message_encoding == "protobuf":
                decoder = DecoderFactory().decoder_for("protobuf", schema)
                assert decoder
                decoded = decoder(message.data)
            found[channel.topic].append((schema, message, decoded))
    return found
