"""The masks' files: every preset passes its checks, and the same design gives the same bytes."""

import hashlib
import os
import re
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pikepdf
import pytest

from finger_notes import noted_mask
from lumitip_fab.checks import mask as mask_check
from lumitip_fab.checks.mask_holes import black_of, place, registration_of
from lumitip_fab.checks.readers.mask_page import read_page
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.design import Design
from lumitip_fab.design.frames import applied
from lumitip_fab.docs.wrapping import wrapping_note
from lumitip_fab.mask.files import mask_files
from lumitip_fab.pipeline.artefact import Artefact, Facts

pytestmark = pytest.mark.slow

PRESETS = ("published", "asymmetric", "dense")


@pytest.fixture(scope="module")
def preset(design_dir: Path) -> Callable[[str], Design]:
    return lambda name: derive(load(design_dir / "presets" / f"{name}.toml"))


def made(design: Design) -> list[Artefact]:
    return [artefact for finger in design.fingers for artefact in noted_mask(design, finger)]


def written(design: Design, out: Path) -> list[Artefact]:
    artefacts = made(design)
    for artefact in artefacts:
        path = out / artefact.path
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(artefact.data)
    return artefacts


def failures(design: Design, out: Path) -> list[str]:
    return [
        f"{m.check} {m.subject}: {m.measured:g}, {m.limit}"
        for m in mask_check.measure(out, design)
        if not m.passed
    ]


@pytest.mark.parametrize("name", PRESETS)
@pytest.mark.parametrize(
    "change",
    [
        {},
        {"hole_shape": "circle"},
        {"measured_ruler_mm": (99.2, 100.4)},
        {"allowance_mm": 1.5},
    ],
    ids=["as it is", "circles", "stretched", "more allowance"],
)
def test_passes_its_checks(
    name: str, change: dict[str, object], preset: Callable[[str], Design], tmp_path: Path
) -> None:
    design = preset(name)
    design = replace(design, mask=replace(design.mask, **change))
    written(design, tmp_path)
    assert not failures(design, tmp_path)


def test_shortest_and_longest_flaps(preset: Callable[[str], Design], tmp_path: Path) -> None:
    for flap_mm in (8.0, 20.0):
        design = preset("published")
        design = replace(design, mask=replace(design.mask, flap_mm=flap_mm))
        written(design, tmp_path)
        failed = {line.split()[0] for line in failures(design, tmp_path)}
        assert not failed - {"mask.mirrored"}  # the letter's place is derived from the flap


def test_uneven_grid_is_mirrored(preset: Callable[[str], Design], tmp_path: Path) -> None:
    """On the page a receiver's cell is at -x, an emitter's at +x, right of the artwork's middle
    by the marks alone; the grid is its own image under no mirror."""
    design = preset("asymmetric")
    written(design, tmp_path)
    cells = np.stack([design.layout.x_mm, design.layout.y_mm], axis=1)
    for finger, sign in (("receiver", -1.0), ("emitter", 1.0)):
        page = read_page(tmp_path / f"mask/{finger}_mask_a4.pdf")
        placed = place(registration_of(page), design.mask)
        on_page = black_of(page, placed).centres * (-1.0, 1.0)
        wanted = cells * (sign, 1.0)
        assert np.abs(on_page - wanted).max() < 1e-4
        wrong = cells * (-sign, 1.0)
        assert np.hypot(*(on_page[:, None] - wrong[None]).T).min(axis=0).max() > 0.5


def test_ruler_stretches_the_whole_page(preset: Callable[[str], Design], tmp_path: Path) -> None:
    design = preset("published")
    written(design, tmp_path / "true")
    stretched = replace(design, mask=replace(design.mask, measured_ruler_mm=(99.2, 100.4)))
    written(stretched, tmp_path / "stretched")
    for paper, size in mask_check.PAPERS_MM.items():
        file = f"mask/receiver_mask_{paper}.pdf"
        before, after = (read_page(tmp_path / f / file) for f in ("true", "stretched"))
        assert after.size_mm == before.size_mm
        middle = np.array(size) / 2
        wanted = (before.texts - middle) * (100 / 99.2, 100 / 100.4) + middle
        # One line of text tells the readings, so only its place can be compared.
        near = np.abs(after.texts - wanted).max(axis=1) < 1e-2
        assert near.mean() > 0.8
        spans = [np.ptp(registration_of(page), axis=0) for page in (before, after)]
        assert np.allclose(spans[1] / spans[0], (100 / 99.2, 100 / 100.4), atol=1e-5)


@pytest.mark.parametrize("measured", [(100.0, 100.0), (99.2, 100.4)])
def test_matrix_leads_to_the_sensor_frame(
    measured: tuple[float, float], preset: Callable[[str], Design], tmp_path: Path
) -> None:
    design = preset("asymmetric")
    design = replace(design, mask=replace(design.mask, measured_ruler_mm=measured))
    for artefact in written(design, tmp_path):
        if not artefact.path.endswith(".pdf"):
            continue
        marks = applied(artefact.to_sensor, registration_of(read_page(tmp_path / artefact.path)))
        nominal = np.array(design.mask.registration)
        assert np.hypot(*(marks[:, None, :2] - nominal[None]).T).min(axis=0).max() < 1e-3


def test_notes_name_every_flap(preset: Callable[[str], Design]) -> None:
    notes = [a for a in made(preset("published")) if a.path.endswith("wrapping.md")]
    assert len(notes) == 2
    for note in notes:
        text = note.data.decode()
        assert "90 °C" in text
        assert "measured_ruler_mm" in text
        assert max(len(line) for line in text.splitlines() if line[:1] != "|") <= 100
        rows = re.findall(r"^\| (\d+) \|", text, re.MULTILINE)
        assert rows == [str(number) for number in range(1, len(rows) + 1)]
        assert len(rows) == 21


def test_same_bytes_in_any_process(design_dir: Path) -> None:
    script = (
        "import hashlib, sys\n"
        "from pathlib import Path\n"
        "from lumitip_fab.derive import derive\n"
        "from lumitip_fab.config.load import load\n"
        "from lumitip_fab.mask.files import mask_files\n"
        "d = derive(load(Path(sys.argv[1])))\n"
        "for f in d.fingers:\n"
        "    for a in mask_files(d, f):\n"
        "        print(a.path, hashlib.sha256(a.data).hexdigest())\n"
    )
    file = design_dir / "presets" / "asymmetric.toml"
    told = [
        subprocess.run(
            [sys.executable, "-c", script, str(file)],
            env={**os.environ, "PYTHONHASHSEED": seed},
            check=True,
            capture_output=True,
            text=True,
        ).stdout
        for seed in ("0", "1", "4", "77")
    ]
    design = derive(load(file))
    files = [a for finger in design.fingers for a in mask_files(design, finger)]
    here = "".join(f"{a.path} {hashlib.sha256(a.data).hexdigest()}\n" for a in files)
    assert set(told) == {here}


def test_metadata(preset: Callable[[str], Design], tmp_path: Path) -> None:
    written(preset("published"), tmp_path)
    with pikepdf.open(tmp_path / "mask/receiver_mask_a4.pdf") as pdf:
        assert str(pdf.docinfo["/Title"]) == "Lumitip published A: receiver mask"
        assert str(pdf.docinfo["/CreationDate"]).startswith("D:20000101")  # no clock
        assert "/XObject" not in pdf.pages[0].resources  # no pictures


def test_the_flaps_at_the_tip_are_bonded_beyond_the_lip_of_silicone(
    preset: Callable[[str], Design],
) -> None:
    design = preset("published")
    (facts,) = (a.facts for a in mask_files(design, design.emitter) if a.facts)
    short = {**facts, "flaps": [{**flap, "reach_mm": 4.0} for flap in facts["flaps"]]}

    def bonded(of: Design, mask: Facts) -> str:
        return " ".join(wrapping_note(of, of.emitter, mask).split())

    assert "beyond, 3 mm or more from the tip edge" in bonded(design, facts)
    assert "bond these flaps with silicone adhesive" in bonded(design, short)
    edge = replace(design, mould=replace(design.mould, props=()))
    assert "lip of silicone" not in bonded(edge, facts)
