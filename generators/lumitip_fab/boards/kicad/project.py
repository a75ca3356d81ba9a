"""A board's KiCad project: net classes, design rules, footprint library, and its files."""

import json
from typing import Any

from lumitip_fab.boards.kicad.footprint import LIBRARY, hole_library_file, hole_name, library_file
from lumitip_fab.boards.kicad.nodes import library_table
from lumitip_fab.boards.kicad.pcb import board_file
from lumitip_fab.boards.model import LEAST_SPOKES, BoardModel, NetClass, Placement
from lumitip_fab.text import table_of

HOLE_TO_HOLE_MM = 0.25
"""Wall between two drills."""
_LEAST_TEXT_MM, _LEAST_STROKE_MM = 0.6, 0.1
_TABLES = "boards/kicad/tables.toml"


def project_file(board: Placement, name: str) -> bytes:
    """The `.kicad_pro` of a board; KiCad adds what it leaves out.

    Args:
        board: for its nets, classes and rules.
        name: of the file, with its ending.
    """
    settings = {
        "board": {"design_settings": {"rules": _rules(board)}},
        "erc": {"rule_severities": dict.fromkeys(table_of(_TABLES)["errors"], "error")},
        "meta": {"filename": name, "version": 1},
        "net_settings": {
            "classes": _classes(board),
            "meta": {"version": 3},
            "netclass_patterns": [
                {"netclass": net.net_class, "pattern": net.name} for net in board.nets
            ],
        },
    }
    return (json.dumps(settings, indent=2) + "\n").encode()


def _rules(board: Placement) -> dict[str, Any]:
    classes = board.classes
    return {
        "max_error": 0.005,
        "min_resolved_spokes": LEAST_SPOKES,
        "min_clearance": min(c.clearance_mm for c in classes),
        "min_track_width": min(c.track_mm for c in classes),
        "min_via_diameter": min(c.via_mm for c in classes),
        "min_via_annular_width": round(min((c.via_mm - c.via_drill_mm) / 2 for c in classes), 6),
        "min_through_hole_diameter": min(c.via_drill_mm for c in classes),
        "min_hole_clearance": board.hole_clearance_mm,
        "min_hole_to_hole": HOLE_TO_HOLE_MM,
        "min_copper_edge_clearance": board.edge_clearance_mm,
        "min_silk_clearance": 0.0,
        "min_text_height": _LEAST_TEXT_MM,
        "min_text_thickness": _LEAST_STROKE_MM,
        "use_height_for_length_calcs": True,
    }


def _classes(board: Placement) -> list[dict[str, Any]]:
    """The classes of the nets, after one by KiCad's name for what has no other."""
    finest = min(board.classes, key=lambda c: c.track_mm)
    nets = {c.name: [n.name for n in board.nets if n.net_class == c.name] for c in board.classes}
    named: list[tuple[str, NetClass, list[str]]] = [("Default", finest, [])]
    named += [(c.name, c, nets[c.name]) for c in board.classes]
    return [_class(*each) for each in named]


def _class(name: str, rules: NetClass, nets: list[str]) -> dict[str, Any]:
    return {
        "name": name,
        "clearance": rules.clearance_mm,
        "track_width": rules.track_mm,
        "via_diameter": rules.via_mm,
        "via_drill": rules.via_drill_mm,
        **table_of(_TABLES)["net_class"],
        "nets": nets,  # read by KiCad 6; later ones read the patterns
    }


def project_files(model: BoardModel, thickness_mm: float) -> dict[str, bytes]:
    """Board, project and footprint library, by their path beside the board.

    Args:
        model: the finished board.
        thickness_mm: of the finished board.
    """
    board = model.placement
    shapes = {c.footprint.name: c for c in board.components}
    sizes = {board.hole_mm, *(diameter_mm for _, diameter_mm in board.unplated)}
    holes = {hole_name(size): hole_library_file(size) for size in sorted(sizes)}
    mods = {name: library_file(c) for name, c in sorted(shapes.items())} | holes
    return {
        f"{board.name}.kicad_pcb": board_file(model, thickness_mm),
        f"{board.name}.kicad_pro": project_file(board, f"{board.name}.kicad_pro"),
        "fp-lib-table": library_table(
            "fp", LIBRARY, f"{LIBRARY}.pretty", "Footprints of this board"
        ).encode(),
        **{f"{LIBRARY}.pretty/{name}.kicad_mod": data for name, data in mods.items()},
    }
