"""A panel as a board: copies of a finished one with names of their own, and frame; its files."""

from collections.abc import Iterator
from dataclasses import replace

from shapely import affinity

from lumitip_fab.boards.fab.notes import assembly_note, fabrication_note, panel_note, stop_note
from lumitip_fab.boards.fab.order import layers_of, order_files
from lumitip_fab.boards.fab.picture import picture_files
from lumitip_fab.boards.kicad.project import project_files
from lumitip_fab.boards.model import (
    SIDES,
    BoardModel,
    Fill,
    PlacedComponent,
    Routing,
    Stroke,
    Text,
    Track,
    Via,
)
from lumitip_fab.boards.panel.frame import label, marks, moved_box, slots, tooling
from lumitip_fab.boards.panel.tabs import bites, tab_places
from lumitip_fab.boards.placed import placed
from lumitip_fab.boards.silk.strokes import angle_on_board_deg
from lumitip_fab.boards.verify import require_clean_drc
from lumitip_fab.design import Design, Panel, Point, Rules, Side
from lumitip_fab.design.board_rules import rules_of
from lumitip_fab.design.panel import in_copy
from lumitip_fab.pipeline.artefact import Artefact

_NM = 6
_CORNER_MM = 1.0


def panel_model(panel: Panel, model: BoardModel, rules: Rules) -> BoardModel:
    """The panel of a finished board. A copy prints the references of the board; its parts and nets
    bear the number of the copy as well, since all names of a panel differ.

    Raises:
        BuildError: if a tab has no room.
    """
    board, tabs = model.placement, tab_places(panel, model)
    copies = [_Copy(model, number, at) for number, at in enumerate(panel.copies, start=1)]
    sides = tuple(s for s in SIDES if any(p.assembled and p.side == s for p in board.components))
    limits = panel.rules
    routed = [
        (copies[0].at(at, to), limits.bite_mm)
        for to in panel.copies
        for y in tabs
        for at in bites(limits, board.outline, y)
    ]
    holes = [(at, limits.tooling_mm) for at in tooling(panel)]
    placement = replace(
        board,
        name=panel.name,
        caption=f"{board.caption}, panel of {len(copies)}",
        outline=panel.box,
        corner_mm=_CORNER_MM,
        holes=tuple(copy.at(at) for copy in copies for at in board.holes),
        ties=(*(tie for copy in copies for tie in copy.ties()), *holes, *routed),
        keep_outs=tuple(moved_box(k, copy.by) for copy in copies for k in board.keep_outs),
        components=(
            *(part for copy in copies for part in copy.components()),
            *marks(panel, rules, sides or ("front",)),
        ),
        nets=tuple(
            replace(net, name=in_copy(net.name, copy.number))
            for copy in copies
            for net in board.nets
        ),
        silk=tuple(line for copy in copies for line in copy.silk()),
        texts=(*(t for copy in copies for t in copy.texts()), ("front", label(panel, board))),
        ground_only=(),
        slots=slots(panel, board, tabs),
        pours=tuple(
            (in_copy(board.ground, copy.number), moved_box(board.outline, copy.by))
            for copy in copies
        ),
    )
    routing = Routing(
        tuple(track for copy in copies for track in copy.tracks()),
        tuple(via for copy in copies for via in copy.vias()),
        model.routing.iterations,
    )
    fills = tuple(fill for copy in copies for fill in copy.fills())
    solid = frozenset(
        (in_copy(ref, copy.number), pad) for copy in copies for ref, pad in model.solid
    )
    return BoardModel(placement, routing, fills, solid)


class _Copy:
    """A board moved to its place in a panel.

    Args:
        model: the board by itself.
        number: of the copy, from 1.
        by: its origin.
    """

    def __init__(self, model: BoardModel, number: int, by: Point) -> None:
        self.model, self.board, self.number, self.by = model, model.placement, number, by

    def at(self, point: Point, by: Point | None = None) -> Point:
        """A point of the board in the panel."""
        x, y = by or self.by
        return round(point[0] + x, _NM) + 0.0, round(point[1] + y, _NM) + 0.0

    def named(self, net: str) -> str:
        """A net's name in the panel."""
        return in_copy(net, self.number)

    def components(self) -> Iterator[PlacedComponent]:
        """Parts; their references are printed as texts of the panel."""
        for part in self.board.components:
            x, y = self.at((part.x_mm, part.y_mm))
            nets = tuple((pad, self.named(net)) for pad, net in part.nets)
            ref = in_copy(part.ref, self.number)
            yield replace(part, ref=ref, x_mm=x, y_mm=y, nets=nets, ref_text=None)

    def texts(self) -> Iterator[tuple[Side, Text]]:
        """Printed references and the board's own texts."""
        for part in self.board.components:
            if (text := part.ref_text) is not None:
                x, y = self.at(placed(part, text.x_mm, text.y_mm))
                angle = angle_on_board_deg(part, text)
                yield part.side, replace(text, text=part.ref, x_mm=x, y_mm=y, angle_deg=angle)
        for side, text in self.board.texts:
            x, y = self.at((text.x_mm, text.y_mm))
            yield side, replace(text, x_mm=x, y_mm=y)

    def silk(self) -> Iterator[tuple[Side, Stroke]]:
        """Lines of the silkscreen outside footprints."""
        for side, stroke in self.board.silk:
            yield side, replace(stroke, points=tuple(map(self.at, stroke.points)))

    def ties(self) -> Iterator[tuple[Point, float]]:
        """Holes for threads."""
        yield from ((self.at(at), size) for at, size in self.board.ties)

    def tracks(self) -> Iterator[Track]:
        """Tracks."""
        for t in self.model.routing.tracks:
            yield replace(t, net=self.named(t.net), start=self.at(t.start), end=self.at(t.end))

    def vias(self) -> Iterator[Via]:
        """Vias."""
        for via in self.model.routing.vias:
            x, y = self.at((via.x_mm, via.y_mm))
            yield replace(via, net=self.named(via.net), x_mm=x, y_mm=y)

    def fills(self) -> Iterator[Fill]:
        """Filled parts of the pour."""
        for fill in self.model.fills:
            area = affinity.translate(fill.area, *self.by)
            yield replace(fill, net=self.named(fill.net), area=area)


def panel_files(design: Design, panel: Panel, board: BoardModel) -> tuple[Artefact, ...]:
    """Every file of the panel of a finished board.

    Raises:
        BuildError: if a tab has no room, or the panel's copper breaks its rules.
    """
    model = require_clean_drc(panel_model(panel, board, rules_of(design, panel.name)))
    placement, layers = model.placement, layers_of(model)
    notes = {
        **stop_note(placement),
        f"{panel.name}_fabrication.txt": fabrication_note(model) + panel_note(panel).encode(),
    }
    files = {
        **project_files(model, placement.thickness_mm),
        **picture_files(model, placement.finish.mask),
    }
    for fab in design.fabs:
        texts = {**notes, f"{panel.name}_assembly.txt": assembly_note(placement, fab)}
        orders = order_files(model, layers, texts, fab, panel.name)
        files |= {f"order/{path}": data for path, data in orders.items()}
    return tuple(
        Artefact(f"boards/{panel.name}/{path}", data, frame="") for path, data in files.items()
    )
