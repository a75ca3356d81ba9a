"""Settings in a board's file by which KiCad would fill, plot, check or assemble the board otherwise
than it is drawn."""

from collections.abc import Iterator
from pathlib import Path

import shapely
from shapely import affinity

from lumitip_fab.checks.board_read import on_page
from lumitip_fab.checks.readers.kicad_shapes import (
    Node,
    child,
    children,
    numbers,
    polygon,
    read_nodes,
    words,
)
from lumitip_fab.design import Design
from lumitip_fab.design.frames import BOARD_ON_PAGE_MM
from lumitip_fab.design.panel import in_copy

_SETUP = {
    "pad_to_mask_clearance": (0.05,),
    "aux_axis_origin": BOARD_ON_PAGE_MM,
    "grid_origin": BOARD_ON_PAGE_MM,
}
"""All that a board's setup has, but for the layers of a flexible one."""
_ZONE = {
    "connect_pads": ["connect_pads", ["clearance", "0.2"]],
    "min_thickness": ["min_thickness", "0.2"],
    "filled_areas_thickness": ["filled_areas_thickness", "no"],
    "fill": ["fill", "yes", ["thermal_gap", "0.25"], ["thermal_bridge_width", "0.3"]],
}
"""How a zone is filled: gaps, spokes, and every pad joined by them."""
_ZONE_HEADS = {*_ZONE, "net", "net_name", "layer", "tstamp", "hatch", "polygon", "filled_polygon"}
_ATTRIBUTES = {"smd", "through_hole", "board_only", "exclude_from_pos_files", "exclude_from_bom"}
_PART_HEADS = {
    *("at", "attr", "layer", "model", "pad", "path", "property", "tstamp"),
    *("fp_arc", "fp_circle", "fp_line", "fp_poly", "fp_rect", "fp_text"),
}
_PAD_HEADS = {"at", "drill", "layers", "net", "size", "tstamp", "roundrect_rratio"}
_SOLID = ["2"]
_SAME_MM = 0.001


def other_settings(folder: Path, design: Design) -> Iterator[str]:
    """Settings of a board or panel that it should not have, or that should be others."""
    root = read_nodes(folder / f"{folder.name}.kicad_pcb")
    yield from _setup(child(root, "setup") or [])
    yield from _zones(root, _outlines(folder.name, design))
    for part in children(root, "footprint", "module"):
        yield from _part(part)


def _setup(setup: Node) -> Iterator[str]:
    found = {str(node[0]): numbers(node) for node in setup[1:] if isinstance(node, list)}
    found.pop("stackup", None)
    for name in sorted({*found, *_SETUP}):
        if found.get(name) != _SETUP.get(name):
            yield f"{name} in the setup"


def _outlines(name: str, design: Design) -> dict[str, shapely.Polygon]:
    """The area that is filled, as the design has it, by net."""
    boxes = {board.name: board.box for board in design.auxiliary_boards}
    boxes |= {finger.name: design.board.box for finger in design.fingers}
    if name in boxes:
        return {"GND": on_page(boxes[name])}
    (panel,) = (panel for panel in design.panels if panel.name == name)
    whole = on_page(boxes[panel.board])
    return {
        in_copy("GND", copy): affinity.translate(whole, x, -y)
        for copy, (x, y) in enumerate(panel.copies, start=1)
    }


def _zones(root: Node, outlines: dict[str, shapely.Polygon]) -> Iterator[str]:
    """Zones that KiCad would fill otherwise, and fills that it would not make."""
    kept = []
    fills = []
    for zone in children(root, "zone"):
        area = _area(child(zone, "polygon"))
        layers = {*words(child(zone, "layer")), *words(child(zone, "layers"))}
        if child(zone, "keepout"):
            kept.append((layers, area))
            continue
        net = "".join(words(child(zone, "net_name")))
        of = f"zone of {net or 'no net'} on {'/'.join(sorted(layers))}"
        if net not in outlines or area.hausdorff_distance(outlines[net]) > _SAME_MM:
            yield f"outline of the {of}"
        for name, wanted in _ZONE.items():
            if child(zone, name) != wanted:
                yield f"{name} of the {of}"
        yield from (f"{name} of the {of}" for name in _others(zone, _ZONE_HEADS))
        own = [_area(node) for node in children(zone, "filled_polygon")]
        fills += [(layers, fill) for fill in own]
        if not own or not area.buffer(_SAME_MM).covers(shapely.union_all(own)):
            yield f"fill of the {of}"
    for layers, area in kept:
        if any(on & layers and fill.intersection(area).area for on, fill in fills):
            yield f"fill in a keep-out of {'/'.join(sorted(layers))}"


def _area(node: Node | None) -> shapely.Geometry:
    return polygon(child(node or [], "pts") or [])


def _part(part: Node) -> Iterator[str]:
    """What a part has that no part of these boards needs: it is not mounted, or its pads get
    another paste, gap or connection than the rules say."""
    ref = next((w[1] for w in map(words, children(part, "fp_text")) if w[0] == "reference"), "")
    attributes = words(child(part, "attr"))
    yield from (f"{name} of {ref}" for name in attributes if name not in _ATTRIBUTES)
    yield from (f"{name} of {ref}" for name in _others(part, _PART_HEADS))
    is_mark = str(part[1]).rpartition(":")[2].startswith("Fiducial")
    for pad in children(part, "pad"):
        margins = {name: words(child(pad, name)) for name in ("clearance", "solder_mask_margin")}
        if margins["clearance"] != margins["solder_mask_margin"] or (
            margins["clearance"] and not is_mark
        ):
            yield f"margins of {ref}.{pad[1]}"
        if words(child(pad, "zone_connect")) not in ([], _SOLID):
            yield f"zone_connect of {ref}.{pad[1]}"
        others = _others(pad, _PAD_HEADS | {*margins, "zone_connect"})
        yield from (f"{name} of {ref}.{pad[1]}" for name in others)


def _others(node: Node, heads: set[str]) -> list[str]:
    """Settings of a node that are in no list."""
    named = {str(each[0]) for each in node[1:] if isinstance(each, list)}
    return sorted(named - heads)
