"""The schematics: what KiCad reads in them against the circuit, and that they can be read."""

import json
import re
import shutil
import subprocess
from collections import defaultdict
from importlib.resources import files
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest

from lumitip_fab.boards.kicad.project import project_files
from lumitip_fab.boards.kicad.schematic import schematic_files
from lumitip_fab.boards.model import BoardModel, Placement, Routing
from lumitip_fab.boards.placement import place
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.design import Design
from programs import needs, program

pytestmark = pytest.mark.slow

PRESETS = ("published", "asymmetric", "dense", "mux16")
BOARDS = [(preset, finger) for preset in PRESETS for finger in ("emitter", "receiver")]
needs_kicad = needs("kicad-cli")
Drawn = dict[tuple[str, str], tuple[Design, Placement, Path]]


@pytest.fixture(scope="module")
def drawn(design_dir: Path, tmp_path_factory: pytest.TempPathFactory) -> Drawn:
    """Design, placement and project folder of every board; the boards have no tracks."""
    found = {}
    for preset in PRESETS:
        d = derive(load(design_dir / "presets" / f"{preset}.toml"))
        for finger in d.fingers:
            board = place(d, finger)
            folder = tmp_path_factory.mktemp(f"{preset}-{finger.name}")
            made = schematic_files(board, d)
            made |= project_files(BoardModel(board, Routing((), (), 0), ()), d.stack.pcb_mm)
            for path, data in made.items():
                (folder / path).parent.mkdir(exist_ok=True)
                (folder / path).write_bytes(data)
            found[preset, finger.name] = d, board, folder
    return found


def _kicad(*arguments: str | Path) -> None:
    command = [program("kicad-cli"), *map(str, arguments)]
    done = subprocess.run(command, check=False, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


def _report(folder: Path, kind: str, command: str, ending: str, *options: str) -> Any:
    file = folder / f"{command}.json"
    sheet = next(folder.glob(f"*.{ending}"))
    _kicad(kind, command, "--severity-all", "--format", "json", *options, "-o", file, sheet)
    return json.loads(file.read_text(encoding="utf-8"))


@needs_kicad
def test_kicad_opens_what_the_sheets_grow_from(tmp_path: Path) -> None:
    template = files("lumitip_fab.boards.kicad.schematic") / "template.kicad_sch"
    _kicad("sch", "export", "svg", "-o", tmp_path, str(template))
    assert "NET" in (tmp_path / "template.svg").read_text(encoding="utf-8")


@needs_kicad
@pytest.mark.parametrize("board", BOARDS, ids="-".join)
def test_kicads_rules_find_nothing(drawn: Drawn, board: tuple[str, str]) -> None:
    report = _report(drawn[board][2], "sch", "erc", "kicad_sch")
    assert [v for sheet in report["sheets"] for v in sheet["violations"]] == []


@needs_kicad
@pytest.mark.parametrize("board", BOARDS, ids="-".join)
def test_kicad_reads_the_nets_of_the_circuit(drawn: Drawn, board: tuple[str, str]) -> None:
    _, placement, folder = drawn[board]
    file = folder / "netlist.xml"
    _kicad(
        "sch",
        "export",
        "netlist",
        "--format",
        "kicadxml",
        "-o",
        file,
        folder / f"{placement.name}.kicad_sch",
    )
    told = ElementTree.parse(file)
    read = {
        net.attrib["name"]: {(n.attrib["ref"], n.attrib["pin"]) for n in net.iter("node")}
        for net in told.iter("net")
    }
    wanted = defaultdict(set)
    for part in placement.components:
        for pad, net in part.nets:
            wanted[net].add((part.ref, pad))
    assert read == dict(wanted)
    parts = {p.ref: p for p in placement.components if p.kind != "fiducial"}
    comps = {c.attrib["ref"]: c for c in told.iter("comp")}
    assert comps.keys() == parts.keys()
    for ref, comp in comps.items():
        assert comp.findtext("value") == parts[ref].value
        assert comp.findtext("footprint") == f"lumitip:{parts[ref].footprint.name}"
        fields = {f.attrib["name"]: f.text for f in comp.iter("field")}
        if parts[ref].part:
            assert fields["MPN"] == parts[ref].part


@needs_kicad
@pytest.mark.parametrize("board", BOARDS[:2], ids="-".join)
def test_board_and_schematic_agree(drawn: Drawn, board: tuple[str, str]) -> None:
    report = _report(drawn[board][2], "pcb", "drc", "kicad_pcb", "--schematic-parity")
    assert report["schematic_parity"] == []


@needs_kicad
def test_a_swapped_pair_of_detectors_is_seen(drawn: Drawn, tmp_path: Path) -> None:
    folder = Path(shutil.copytree(drawn["published", "receiver"][2], tmp_path / "damaged"))
    file = folder / "receiver.kicad_sch"
    text = file.read_text(encoding="utf-8")
    for old, new in (("Q7", "Q?"), ("Q8", "Q7"), ("Q?", "Q8")):
        text = text.replace(f'(global_label "{old}"', f'(global_label "{new}"')
    file.write_text(text, encoding="utf-8")
    report = _report(folder, "pcb", "drc", "kicad_pcb", "--schematic-parity")
    kinds = {difference["type"] for difference in report["schematic_parity"]}
    assert "net_conflict" in kinds


def test_everything_is_on_the_paper_and_on_the_grid(drawn: Drawn) -> None:
    sizes = {"A4": (297, 210), "A3": (420, 297), "A2": (594, 420), "A1": (841, 594)}
    for _, placement, folder in drawn.values():
        text = (folder / f"{placement.name}.kicad_sch").read_text(encoding="utf-8")
        width, height = sizes[re.search(r'\(paper "(A\d)"\)', text)[1]]
        body = text[text.index("(junction") :]
        ends = re.findall(r"\(xy (\S+) (\S+?)\)", body)
        assert ends
        for x, y in ((float(x), float(y)) for x, y in ends):
            assert 12 < x < width - 12
            assert 12 < y < height - 12
            assert x / 1.27 == pytest.approx(round(x / 1.27), abs=1e-6)
            assert y / 1.27 == pytest.approx(round(y / 1.27), abs=1e-6)


def test_the_same_board_gives_the_same_bytes(drawn: Drawn) -> None:
    design, placement, _ = drawn["asymmetric", "receiver"]
    first, again = (schematic_files(placement, design) for _ in range(2))
    assert first == again
