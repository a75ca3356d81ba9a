"""The assembly's files and drawing."""

import json
import struct
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import trimesh

from lumitip_fab.design.encoding import read_design
from lumitip_fab.scenes import assembly

SLOW = [pytest.param(preset, marks=pytest.mark.slow) for preset in ("asymmetric", "dense")]


@pytest.mark.slow
def test_the_same_design_gives_the_same_files_in_any_process(outputs: Path) -> None:
    made = assembly.assembly(read_design(outputs / "design.json"))
    assert [a.path for a in made] == [
        "assembly/assembly.step",
        "assembly/assembly.glb",
        "assembly/emitter_exploded.svg",
        "assembly/receiver_exploded.svg",
    ]
    for artefact in made:
        assert artefact.data == (outputs / artefact.path).read_bytes(), artefact.path


@pytest.mark.parametrize("preset", ["published", *SLOW])
def test_other_programs_read_the_scene_in_metres(preset: str, built: Callable[[str], Path]) -> None:
    folder = built(preset)
    design = read_design(folder / "design.json")
    scene = trimesh.load(folder / "assembly/assembly.glb")
    names = set(scene.graph.nodes_geometry)
    parts = {finger.body_name(part) for finger in design.fingers for part in finger.parts}
    layers = {f"{f.name}.{k}" for f in design.fingers for k in ("backing", "board", "film")}
    assert parts | layers < names
    assert scene.extents[1] == pytest.approx(design.outline.length_mm / 1000, abs=0.002)
    matrix, shape = scene.graph["receiver.film"]
    assert scene.geometry[shape].is_watertight
    assert matrix[2, 2] == pytest.approx(np.cos(np.radians(design.mount.tilt_deg)))


def test_the_scene_is_valid_gltf(outputs: Path) -> None:
    data = (outputs / "assembly/assembly.glb").read_bytes()
    magic, version, length, size, kind = struct.unpack_from("<4sIII4s", data)
    assert (magic, version, length, kind) == (b"glTF", 2, len(data), b"JSON")
    assert size % 4 == 0
    told = json.loads(data[20 : 20 + size])
    assert told["asset"]["version"] == "2.0"
    for view in told["bufferViews"]:
        assert view["byteOffset"] % 4 == 0
        assert view["byteOffset"] + view["byteLength"] <= told["buffers"][0]["byteLength"]
    for material in told["materials"]:
        clear = material["pbrMetallicRoughness"]["baseColorFactor"][3] < 1
        assert (material.get("alphaMode") == "BLEND") == clear


def test_step_names_every_body(outputs: Path) -> None:
    text = (outputs / "assembly/assembly.step").read_text(encoding="latin-1")
    for finger in ("emitter", "receiver"):
        for layer in ("backing", "board", "silicone", "film"):
            assert f"'{finger}.{layer}'" in text
    assert "'receiver.photodetectors'" in text
    assert "COLOUR_RGB" in text
