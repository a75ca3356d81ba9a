"""Every file of a carrier: its design has all parts in their places, so that only copper is left
to find."""

from lumitip_fab.artefact import Artefact
from lumitip_fab.boards.carrier_legend import with_legend
from lumitip_fab.boards.carrier_parts import component
from lumitip_fab.boards.fab.note import carrier_note
from lumitip_fab.boards.files import model_files
from lumitip_fab.boards.geometry import pad_at
from lumitip_fab.boards.model import BoardModel, Component, Net, NetClass, Placement
from lumitip_fab.boards.placement import refuse_overlaps
from lumitip_fab.boards.pour import pour
from lumitip_fab.boards.routing import route
from lumitip_fab.boards.schematic.carrier import carrier_sheet
from lumitip_fab.boards.verify import sound
from lumitip_fab.design import Box, Carrier, Fab, Reading, Rules, Stack, Title
from lumitip_fab.frames import board_page_to_carrier

GROUND = "GND"
SIGNAL, SUPPLY = "signal", "supply"


def carrier_files(
    title: Title,
    reading: Reading,
    stack: Stack,
    carrier: Carrier,
    rules: Rules,
    fabs: tuple[Fab, ...],
) -> tuple[Artefact, ...]:
    """The KiCad project, pictures of both sides, and a zip for each board house.

    Args:
        title: of the design.
        reading: for the identity that the board carries.
        stack: for the board's thickness.
        carrier: what is on it, and where.
        rules: what copper keeps.
        fabs: where it may be ordered.

    Raises:
        BuildError: if two parts overlap, a net cannot be routed, a label has no room, or the
            finished copper breaks its rules.
    """
    bare = _placement(title, reading, carrier, rules)
    refuse_overlaps(carrier.name, bare.components, "choose smaller parts")
    placement = with_legend(bare, carrier, rules)
    routing, fills = pour(placement, route(placement))
    model = sound(BoardModel(placement, routing, fills))
    sheet = carrier_sheet(placement, carrier)
    return model_files(
        model, sheet, lambda fab: carrier_note(model.placement, carrier.title, fab),
        stack.carrier_mm, fabs,
        board_page_to_carrier(stack), "carrier",
    )  # fmt: skip


def _hot_loop(carrier: Carrier, components: tuple[Component, ...]) -> tuple[Box, ...]:
    """The box round the middles of the hot loop's pads; none without a regulator."""
    parts = {part.ref: part for part in components}
    places = [pad_at(parts[ref], number) for ref, number in carrier.hot_loop]
    if not places:
        return ()
    xs, ys = zip(*places, strict=True)
    return (Box(min(xs), max(xs), min(ys), max(ys)),)


def _placement(title: Title, reading: Reading, carrier: Carrier, rules: Rules) -> Placement:
    components = tuple(component(device, rules) for device in carrier.devices)
    return Placement(
        finger=carrier.name,
        name=title.on_boards().name,
        revision=title.revision,
        design_hash=reading.design_hash,
        outline=carrier.box,
        corner_mm=carrier.corner_mm,
        holes=carrier.holes,
        hole_mm=carrier.hole_mm,
        keep_outs=carrier.keep_outs,
        edge_clearance_mm=rules.edge_gap_mm,
        components=components,
        ground_only=_hot_loop(carrier, components),
        nets=tuple(
            Net(name, SUPPLY if name in carrier.supplies else SIGNAL) for name in carrier.nets
        ),
        classes=(
            _net_class(SIGNAL, rules.track_mm, rules),
            _net_class(SUPPLY, rules.supply_track_mm, rules),
        ),
        ground=GROUND,
        silk=(),
        texts=(),
    )


def _net_class(name: str, track_mm: float, rules: Rules) -> NetClass:
    return NetClass(name, track_mm, rules.copper_gap_mm, rules.via_mm, rules.via_drill_mm)
