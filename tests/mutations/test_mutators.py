"""Each mutator changes a file, the same way for the same seed, and leaves one that can be read."""

import csv
import io
import json
import re
import struct
import tomllib
import zipfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import ezdxf
import numpy as np
import pikepdf
import pytest
from numpy.random import default_rng
from PIL import Image

from mutations.amounts import LEAST_MM, LEAST_SHARE, NUMBER, changed, number_changed
from mutations.damage import NotApplicableError
from mutations.expressions import parsed
from mutations.formats import BY_SUFFIX, suffix
from mutations.meshes import Mesh, mirrored, part_moved
from mutations.pages import PDF
from mutations.records import JSON
from mutations.robots import ROBOT
from mutations.sample import files_of, made
from mutations.solids import STL, read_stl, write_stl

SEEDS = range(40)
CUT = ("truncate", "syntax")
"""Kinds after which a file cannot be read, on purpose."""


def _glb(data: bytes) -> None:
    size = struct.unpack("<I", data[12:16])[0]
    assert struct.unpack("<I", data[8:12])[0] == len(data)
    json.loads(data[20 : 20 + size])


def _zip(data: bytes) -> None:
    assert zipfile.ZipFile(io.BytesIO(data)).testzip() is None


READERS: dict[str, Callable[[bytes], object]] = {
    ".stl": read_stl,
    ".3mf": _zip,
    ".zip": _zip,
    ".pdf": lambda data: pikepdf.open(io.BytesIO(data)).pages[0],
    ".svg": ElementTree.fromstring,
    ".urdf": ElementTree.fromstring,
    ".xacro": ElementTree.fromstring,
    ".dxf": lambda data: ezdxf.read(io.StringIO(data.decode())),
    ".json": json.loads,
    ".kicad_pro": json.loads,
    ".toml": lambda data: tomllib.loads(data.decode()),
    ".csv": lambda data: list(csv.reader(io.StringIO(data.decode()))),
    ".png": lambda data: Image.open(io.BytesIO(data)).load(),
    ".glb": _glb,
} | {
    name: lambda data: parsed(data.decode())
    for name in (".kicad_pcb", ".kicad_sch", ".kicad_mod", ".kicad_sym", "")
}
CASES = [(name, kind) for name, kinds in BY_SUFFIX.items() if name != ".xml" for kind in kinds]
NEVER = {
    ("", "number"),
    ("", "move"),
    ("", "duplicate"),
    (".kicad_sym", "duplicate"),
    (".ino", "number"),
}
"""Library tables and the sketch have no numbers, and a symbol has no tracks or pads to repeat."""


@pytest.mark.slow_cases
@pytest.mark.parametrize(("name", "kind"), CASES, ids=lambda case: case or "table")
def test_a_mutator_changes_bytes_by_its_seed_and_the_file_can_be_read(
    name: str, kind: str, outputs: Path
) -> None:
    paths = [p for p in files_of(outputs) if suffix(p) == name]
    found = []
    for seed in SEEDS:
        path = paths[seed % len(paths)]
        try:
            found.append(made(outputs, path, kind, seed))
        except NotApplicableError:
            continue
        if len(found) == 3:
            break
    assert bool(found) != ((name, kind) in NEVER)
    for mutant in found:
        (data,) = mutant.files.values()
        assert data != (outputs / mutant.path).read_bytes()
        assert mutant.description
        assert made(outputs, mutant.path, kind, mutant.seed) == mutant
        if kind not in CUT and name in READERS:
            READERS[name](data)


@pytest.mark.parametrize("text", ["0", "0.0", "-7", "12", "0.25", "250.000", "-3.5e-06", "0.1"])
def test_a_number_changes_by_an_amount_that_matters(text: str) -> None:
    for seed in range(50):
        by = abs(float(changed(text, default_rng(seed))) - float(text))
        assert by >= 0.9 * LEAST_SHARE * abs(float(text))
        assert by > 0
        by = abs(float(changed(text, default_rng(seed), LEAST_MM)) - float(text))
        assert by >= 0.9 * LEAST_MM


def test_the_words_round_a_number_say_that_it_is_a_length() -> None:
    mutate = number_changed()
    for text in ("a film of 0.1 mm", "film_mm = 0.1"):
        for seed in range(20):
            new, _ = mutate(text.encode(), default_rng(seed))
            (number,) = NUMBER.findall(new.decode())
            assert abs(float(number) - 0.1) >= 0.9 * LEAST_MM


@pytest.mark.parametrize("text", ["R12", "v1.2.3", "#ffffff", "x86_64", "2026-11-27"])
def test_names_versions_colours_and_dates_are_no_numbers(text: str) -> None:
    assert not NUMBER.findall(text)


def _box(*size: float) -> Mesh:
    corners = np.array(
        [[x, y, z] for x in (0, size[0]) for y in (0, size[1]) for z in (0, size[2])]
    )
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    return Mesh(corners.astype(np.float64), np.array(faces))


def test_a_body_that_looks_the_same_in_a_mirror_is_no_mutant() -> None:
    with pytest.raises(NotApplicableError):
        mirrored(_box(10, 20, 30), default_rng(1))


def test_a_part_that_moved_changes_the_body() -> None:
    box = _box(10, 20, 30)
    assert np.isclose(box.moments[0], 6000)
    for seed in range(20):
        try:
            new, _ = part_moved(box, default_rng(seed))
        except NotApplicableError:
            continue
        assert np.abs(new.moments - box.moments).max() > 0.5


def test_the_text_before_the_mesh_of_an_stl_stays() -> None:
    data = write_stl(_box(10, 20, 30), b"Lumitip".ljust(80))
    new, _ = STL["move"](data, default_rng(1))
    assert new[:80] == data[:80]
    assert np.allclose(np.ptp(read_stl(new).corners, axis=0), (10, 20, 30), atol=1e-5)


def test_pages_that_look_alike_are_no_mutants() -> None:
    """An empty page scaled, mirrored or moved stays empty."""
    with pikepdf.new() as pdf:
        pdf.add_blank_page(page_size=(200, 300))
        target = io.BytesIO()
        pdf.save(target)
    for kind in ("transform", "transparent", "empty"):
        with pytest.raises(NotApplicableError):
            PDF[kind](target.getvalue(), default_rng(1))


@pytest.mark.slow
def test_what_nobody_reads_stays_in_the_manifest(outputs: Path) -> None:
    """The build's memory of its steps, and matrices of files that have no place."""
    before = json.loads((outputs / "manifest.json").read_bytes())
    for kind in ("number", "word", "remove", "swap items"):
        for after in _manifests(outputs, kind):
            assert after.get("tasks") == before["tasks"]
            for path, entry in after.get("files", {}).items():
                if not entry.get("frame", "-"):
                    assert entry.get("to_sensor") in (None, before["files"][path]["to_sensor"])


def _manifests(outputs: Path, kind: str) -> Iterator[Any]:
    data = (outputs / "manifest.json").read_bytes()
    for seed in range(20):
        try:
            new, _ = JSON[kind](data, default_rng(seed))
        except NotApplicableError:
            continue
        yield json.loads(new)


def test_a_robot_s_looks_stay() -> None:
    looks = b'<visual name="v"><material name="m"/></visual>'
    data = b'<robot name="r"><link name="a">' + looks + b"</link></robot>"
    for seed in range(30):
        new, _ = ROBOT["word"](data, default_rng(seed))
        assert re.findall(rb'name="[vm]"', new) == [b'name="v"', b'name="m"']
