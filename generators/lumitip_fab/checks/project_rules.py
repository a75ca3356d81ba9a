"""Rules of a KiCad project by which its own checks would pass what the design forbids, or find
faults where there are none."""

import json
import math
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from lumitip_fab.design import Design, Rules
from lumitip_fab.design.board_rules import rules_of
from lumitip_fab.design.panel import in_copy

_LEAST_SPOKES = 2
_HOLE_TO_HOLE_MM = 0.25
"""Wall between two drills that every PCB fab makes."""
_SHEET_ERRORS = frozenset(
    {"endpoint_off_grid", "footprint_link_issues", "four_way_junction", "lib_symbol_issues"}
    | {"lib_symbol_mismatch", "multiple_net_names", "pin_to_pin", "unconnected_wire_endpoint"}
)
"""Faults of a schematic that KiCad by itself only warns of."""
_DRAWN = {
    "max_error": 0.005,
    "min_silk_clearance": 0.0,
    "min_text_height": 0.6,
    "min_text_thickness": 0.1,
    "use_height_for_length_calcs": 1.0,
}
"""Rules of round copper, print and lengths, the same for every design."""
_OF_A_CLASS = frozenset(
    {"name", "nets", "clearance", "track_width", "via_diameter", "via_drill"}
    | {"microvia_diameter", "microvia_drill", "bus_width", "wire_width", "line_style"}
    | {"diff_pair_gap", "diff_pair_via_gap", "diff_pair_width", "pcb_color", "schematic_color"}
)
_SAME_MM = 1e-6


def other_rules(folder: Path, design: Design) -> Iterator[str]:
    """Rules and classes unlike the design's, supplies in a class of other tracks, and faults that
    are no errors or are left out."""
    record = json.loads((folder / f"{folder.name}.kicad_pro").read_text(encoding="utf-8"))
    settings, nets = record["board"]["design_settings"], record["net_settings"]
    rules = rules_of(design, folder.name)
    yield from _unlike("", settings["rules"], _wanted(rules))
    yield from sorted(settings["rules"].keys() - _wanted(rules))
    classes = {each["name"]: each for each in nets["classes"]}
    supplies = _supplies(folder.name, design)
    patterns = nets["netclass_patterns"]
    rows = Counter(entry["pattern"] for entry in patterns)
    yield from (f"{net} in two classes" for net, times in rows.items() if times > 1)
    yield from (f"{net} in another class" for net in nets.get("netclass_assignments") or {})
    of_net = {entry["pattern"]: entry["netclass"] for entry in patterns}
    wide = {of_net.get(net, "") for net in supplies}
    for name, each in classes.items():
        yield from _unlike(f"{name} ", each, _wanted_of_class(rules, name in wide))
        yield from (f"{name} {more}" for more in sorted(each.keys() - _OF_A_CLASS))
    yield from (f"{net} in no class" for net in sorted(supplies) if of_net.get(net) not in classes)
    yield from _allowed(record, settings)


def _wanted(rules: Rules) -> dict[str, float]:
    """The value of each rule of a project."""
    return {
        **_DRAWN,
        "min_clearance": rules.copper_gap_mm,
        "min_track_width": rules.track_mm,
        "min_via_diameter": rules.via_mm,
        "min_via_annular_width": (rules.via_mm - rules.via_drill_mm) / 2,
        "min_through_hole_diameter": rules.via_drill_mm,
        "min_hole_clearance": rules.hole_gap_mm,
        "min_hole_to_hole": _HOLE_TO_HOLE_MM,
        "min_copper_edge_clearance": rules.edge_gap_mm,
        "min_resolved_spokes": _LEAST_SPOKES,
    }


def _wanted_of_class(rules: Rules, supply: bool) -> dict[str, float]:
    return {
        "clearance": rules.copper_gap_mm,
        "track_width": rules.supply_track_mm if supply else rules.track_mm,
        "via_diameter": rules.via_mm,
        "via_drill": rules.via_drill_mm,
    }


def _unlike(of: str, values: dict[str, Any], wanted: dict[str, float]) -> Iterator[str]:
    for name, value in wanted.items():
        if not abs(float(values.get(name, math.nan)) - value) <= _SAME_MM:
            yield f"{of}{name} {values.get(name)}, not {value:g}"


def _supplies(name: str, design: Design) -> set[str]:
    """Nets of a board or a panel that feed parts."""
    nets = {board.name: {*board.supplies} for board in design.auxiliary_boards}
    nets |= {finger.name: {"GND", finger.connector.supply} for finger in design.fingers}
    for panel in design.panels:
        numbers = range(1, len(panel.copies) + 1)
        nets[panel.name] = {in_copy(net, n) for net in nets[panel.board] for n in numbers}
    return nets[name]


def _allowed(record: dict[str, Any], settings: dict[str, Any]) -> Iterator[str]:
    """Faults of board and schematic that KiCad would not report as errors; it has all those of a
    board that matter as errors unless a project says otherwise."""
    board, sheet = settings.get("rule_severities") or {}, record["erc"]["rule_severities"]
    yield from sorted(rule for rule, severity in board.items() if severity != "error")
    yield from sorted(rule for rule in _SHEET_ERRORS if sheet.get(rule) != "error")
    for name, found in (
        ("drc_exclusions", settings.get("drc_exclusions")),
        ("erc_exclusions", record["erc"].get("erc_exclusions")),
        ("pin_map", record["erc"].get("pin_map")),
    ):
        if found:
            yield name
