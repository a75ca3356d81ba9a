"""The channel map of boards that others wrote: formats of KiCad 5 to 10, any name of a part."""

import json
import re
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

from board_damages import in_part
from lumitip.layout import Layout
from lumitip_fab.checks.connections import ChannelMap, read_channels
from lumitip_fab.cli import main
from lumitip_fab.design.encoding import read_design
from lumitip_fab.errors import OutputError
from programs import program

pytestmark = pytest.mark.slow

BOARD = "boards/receiver/receiver.kicad_pcb"


@pytest.fixture(scope="module")
def written(boards: Callable[[str], Path]) -> str:
    return (boards("small") / BOARD).read_text()


@pytest.fixture(scope="module")
def wanted(boards: Callable[[str], Path]) -> ChannelMap:
    layout: Layout = read_design(boards("small") / "design.json").layout
    told: ChannelMap = {}
    for cell in layout.cells:
        told.setdefault(f"U{cell.mux + 1}", {})[str(cell.channel)] = f"Q{cell.index + 1}"
    return {mux: dict(sorted(told[mux].items(), key=lambda i: int(i[0]))) for mux in sorted(told)}


def as_kicad_5(text: str) -> str:
    """Modules, bare words where they need no quotes, nets by number, fills drawn with a pen."""
    text = text.replace("(version 20211014)", "(version 20171130)").replace(
        "(footprint ", "(module "
    )
    text = re.sub(r" \(tstamp [0-9a-f-]+\)", " (tstamp 5F68FEEE)", text)
    text = re.sub(r"\n\s*\(filled_areas_thickness no\)", "", text)
    text = re.sub(r'(\(filled_polygon)\s+\(layer "\S+"\)', r"\1", text)
    return re.sub(r'"([A-Za-z0-9_.:*-]+)"', r"\1", text)


def as_kicad_10(text: str) -> str:
    """Nets by name alone, and reference and value as properties."""
    text = text.replace("(version 20211014)", "(version 20251028)")
    names = dict(re.findall(r'\n  \(net (\d+) ("[^"]*")\)', text))
    text = re.sub(r'\n  \(net \d+ "[^"]*"\)', "", text)
    text = re.sub(r'\(net \d+ ("[^"]+")\)', r"(net \1)", text)
    text = re.sub(r"\(net (\d+)\)", lambda m: f"(net {names[m[1]]})", text)
    text = re.sub(r"\s*\(net_name \S+\)", "", text)
    text = text.replace('(31 "B.Cu" signal)', '(2 "B.Cu" signal)')
    text = text.replace("(fp_text reference ", '(property "Reference" ')
    return text.replace("(fp_text value ", '(property "Value" ')


def unnamed(text: str) -> str:
    """Nothing says multiplexer any more, and detectors have another letter."""
    text = re.sub(r'\(fp_text reference "U(\d)"', r'(fp_text reference "IC\1"', text)
    text = re.sub(r'\(fp_text reference "Q(\d+)"', r'(fp_text reference "PD\1"', text)
    text = re.sub(r'"lumitip:[^"]+"', '"own:part"', text)
    return text.replace("74HC4051PW", "SELECTOR")


@pytest.mark.parametrize("change", [str, as_kicad_5, as_kicad_10], ids=lambda c: c.__name__)
def test_formats(
    written: str, wanted: ChannelMap, tmp_path: Path, change: Callable[[str], str]
) -> None:
    file = tmp_path / "other.kicad_pcb"
    file.write_text(change(written))
    found = read_channels(file)
    assert found.by_copper == found.by_name == found.best == wanted
    assert found.doubts == ()


def test_the_format_of_kicad_9(written: str, wanted: ChannelMap, tmp_path: Path) -> None:
    program("kicad-cli")  # whose Python module this is
    (tmp_path / "old.kicad_pcb").write_text(written)
    new = tmp_path / "new.kicad_pcb"
    code = "import sys, pcbnew; pcbnew.LoadBoard(sys.argv[1]).Save(sys.argv[2])"
    command = ["/usr/bin/python3", "-c", code, str(tmp_path / "old.kicad_pcb"), str(new)]
    subprocess.run(command, check=True, env={"HOME": str(tmp_path)}, capture_output=True)
    assert "(version 2024" in new.read_text()
    assert read_channels(new).by_copper == wanted


def test_parts_with_other_names(written: str, wanted: ChannelMap, tmp_path: Path) -> None:
    file = tmp_path / "other.kicad_pcb"
    file.write_text(unnamed(written))
    renamed = {
        mux.replace("U", "IC"): {k: q.replace("Q", "PD") for k, q in inputs.items()}
        for mux, inputs in wanted.items()
    }
    assert read_channels(file).by_copper == renamed


def test_a_16_to_1_multiplexer(tmp_path: Path) -> None:
    """Y0 of a 74HC4067 is lead 9, Y15 lead 16; a resistor at an input is no detector."""
    pads = "".join(
        f'(pad "{n}" smd rect (at 0 {n}) (size 1 0.5) (layers "F.Cu") (net {n} "N{n}"))'
        for n in range(1, 25)
    )
    parts = [("U9", "CD74HC4067", pads)]
    for ref, net in (("D1", 9), ("D2", 16), ("R1", 8), ("D3", 10)):
        two = "".join(
            f'(pad "{i}" smd rect (at {i} 0) (size 0.5 0.5) (layers "F.Cu") (net {k} "N{k}"))'
            for i, k in ((1, net), (2, 12))
        )
        parts.append((ref, "x", two))
    told = "".join(
        f'(footprint "a:b" (layer "F.Cu") (at {30 * i} 0) (fp_text reference "{ref}" (at 0 0)) '
        f'(fp_text value "{value}" (at 0 0)) {pads})'
        for i, (ref, value, pads) in enumerate(parts)
    )
    layers = '(layers (0 "F.Cu" signal) (31 "B.Cu" signal))'
    file = tmp_path / "mux.kicad_pcb"
    file.write_text(f"(kicad_pcb (version 20211014) {layers} {told})")
    found = read_channels(file)
    assert found.best == {"U9": {"0": "D1", "15": "D2"}}
    assert found.by_copper == {"U9": {}}
    assert not found.contradicted


def test_the_command(
    boards: Callable[[str], Path], wanted: ChannelMap, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["channel-map", "--json", str(boards("small") / BOARD)]) == 0
    assert json.loads(capsys.readouterr().out) == wanted
    assert main(["channel-map", str(boards("small") / BOARD)]) == 0
    assert capsys.readouterr().out.startswith("U1 (A0)  0:Q")


def test_copper_that_contradicts_the_names(
    written: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    one, other = (re.search(rf'\(net \d+ "Q{i}"\)', written) for i in (1, 2))
    assert one and other
    text = in_part(written, "Q1", re.escape(one[0]), other[0])
    file = tmp_path / "swapped.kicad_pcb"
    file.write_text(in_part(text, "Q2", re.escape(other[0]), one[0]))
    assert main(["channel-map", str(file)]) == 1
    assert "the copper leads to Q1, the net names to Q2" in capsys.readouterr().err


def test_a_board_without_copper_is_read_by_its_names(
    written: str, wanted: ChannelMap, tmp_path: Path
) -> None:
    file = tmp_path / "bare.kicad_pcb"
    bare = re.sub(r"\n  \((segment|via) [^\n]*", "", written)
    file.write_text(re.sub(r"\n  \(zone\n.*?\n  \)", "", bare, flags=re.DOTALL))
    found = read_channels(file)
    assert found.best == wanted
    assert len(found.doubts) == sum(map(len, wanted.values()))


def test_files_that_are_no_boards(written: str, tmp_path: Path) -> None:
    def refused(text: str) -> str:
        file = tmp_path / "bad.kicad_pcb"
        file.write_text(text)
        with pytest.raises(OutputError) as caught:
            read_channels(file)
        return str(caught.value)

    assert "cut short" in refused(written[:5000])
    assert "a .kicad_pcb is needed" in refused("(kicad_sch (version 1))")
    without = written.replace('reference "Q', 'reference "R9').replace("74HC4051PW", "part")
    assert "no multiplexer found" in refused(without)
    with pytest.raises(OutputError, match="cannot be read"):
        read_channels(tmp_path / "none.kicad_pcb")
