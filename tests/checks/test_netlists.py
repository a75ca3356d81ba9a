"""Netlists for ngspice against the boards beside them; damages."""

from pathlib import Path

import pytest

from damages import cut_short, edit, excerpt, failing
from lumitip_fab.checks.readers.spice import Element

EMITTER, RECEIVER = "boards/emitter/emitter.cir", "boards/receiver/receiver.cir"
DETECTORS = "boards/receiver/receiver_detectors.cir"
FLANGE = "boards/flange/flange_plug_in.cir"
EDITS = {
    "LED at another net": (EMITTER, "D5 S1_0 S1_1 led", "D5 S1_0 S2_1 led", {"loose", "nets"}),
    "LEDs swapped": (EMITTER, "D5 S1_0 S1_1", "D4 S1_0 S1_1", {"nets"}),
    "resistor changed": (EMITTER, "R1 24V S1_0 150", "R1 24V S1_0 180", {"values"}),
    "resistor in kilohm": (EMITTER, "R1 24V S1_0 150", "R1 24V S1_0 150k", {"values"}),
    "resistor shorted": (EMITTER, "R1 24V S1_0 150", "R1 24V 24V 150", {"loose", "nets"}),
    "model gone": (EMITTER, ".model led", ".model diode", {"loose"}),
    "unknown figure": (EMITTER, "print i_ma", "print i_mean", {"loose"}),
    "nothing printed": (FLANGE, "print ", "echo ", {"loose"}),
    "detector at another net": (RECEIVER, "CQ5 Q5 0", "CQ5 Q6 0", {"loose", "nets"}),
    "loose tolerance": (EMITTER, "reltol=1e-5", "reltol=1e-2", {"options"}),
    "loose voltages": (RECEIVER, "vntol=1e-7", "vntol=1m", {"options"}),
    "no tolerance": (FLANGE, ".options reltol=1e-4", "", {"options"}),
    "conductance beside a base": (DETECTORS, "gmin=1e-14", "gmin = 1e-12", {"options"}),
    "charge beside a base": (DETECTORS, " chgtol=1e-17", "", {"options"}),
    "another temperature": (EMITTER, "temp=26.85 tnom", "temp=80 tnom", {"options"}),
    "another option": (RECEIVER, ".options temp", ".options method=gear temp", {"options"}),
    "no nodes": (RECEIVER, "CQ5 Q5 0 10p", "CQ5", {"readable"}),
}


@pytest.fixture
def copied(outputs: Path, tmp_path: Path) -> Path:
    """Netlists and boards of the published design, to damage."""
    found = [*outputs.glob("boards/*/*.cir"), *outputs.glob("boards/*/*.kicad_pcb")]
    paths = [path.relative_to(outputs).as_posix() for path in found]
    return excerpt(outputs, tmp_path / "netlists", *paths)


def test_nothing_fails_as_it_is_written(copied: Path) -> None:
    assert failing(copied, "netlists") == set()


@pytest.mark.parametrize("case", EDITS)
def test_a_damage_fails_its_check(case: str, copied: Path) -> None:
    path, old, new, expected = EDITS[case]
    text = (copied / path).read_text()
    assert old in text
    (copied / path).write_text(text.replace(old, new))
    assert failing(copied, "netlists", path.split("/")[1]) == expected


def test_a_netlist_that_is_cut_short_or_binary_is_not_read(copied: Path) -> None:
    cut_short(copied / EMITTER, 300)
    assert failing(copied, "netlists", "emitter") == {"readable"}
    (copied / EMITTER).write_bytes(b"\xff" * 100)
    assert failing(copied, "netlists", "emitter") == {"readable"}


def test_a_board_that_changed_alone_is_found(copied: Path) -> None:
    edit(copied / "boards/emitter/emitter.kicad_pcb", '"150R"', '"180R"')
    assert failing(copied, "netlists", "emitter") == {"values"}


@pytest.mark.parametrize(
    ("text", "value"),
    [("4.7u", 4.7e-6), ("1g", 1e9), ("2meg", 2e6), ("1e-9", 1e-9), ("75000", 75e3), ("led", None)],
)
def test_values_are_read_as_ngspice_reads_them(text: str, value: float | None) -> None:
    read = Element("R1", ("a", "b"), (text,)).value
    assert read == (None if value is None else pytest.approx(value))
