"""A drawing as the text of a `.kicad_sch` in the format of KiCad 6, which 6 to 10 open."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from lumitip_fab.boards.kicad.schematic import symbols
from lumitip_fab.boards.kicad.schematic.sheet import Drawn, Sheet
from lumitip_fab.boards.kicad.sexpr import Node, written
from lumitip_fab.boards.model import Placement, stable_uuid
from lumitip_fab.design import Component, Point

if TYPE_CHECKING:
    from lumitip_fab.boards.kicad.schematic.template import Template


def sheet_text(
    board: Placement,
    paper: str,
    sheet: Sheet,
    shapes: dict[str, Node],
    parts: Mapping[str, Component],
) -> str:
    """The whole sheet; the same drawing gives the same text.

    Args:
        board: whose schematic it is.
        paper: name of the paper.
        sheet: the drawing.
        shapes: symbols by name.
        parts: the board's parts by reference.
    """
    # Imported here: only what draws a schematic needs kicad-skip.
    from lumitip_fab.boards.kicad.schematic.template import Template

    page = Template()
    _Writer(board, parts, page).draw(paper, sheet)
    library = (symbols.named(name, shape, False) for name, shape in shapes.items())
    return written(page.finished(tuple(library)))


class _Writer:
    """Copies the things of the template, each under an identifier that stays the same."""

    def __init__(self, board: Placement, parts: Mapping[str, Component], page: "Template") -> None:
        self.board, self.parts, self.page = board, parts, page

    def draw(self, paper: str, sheet: Sheet) -> None:
        """All that is on the sheet, and its title."""
        whole, board = self.page.sheet, self.board
        whole.uuid.value = stable_uuid(board.name, "sheet")
        whole.paper.value = paper
        whole.title_block.title.value = f"{board.title}: {board.name}"
        whole.title_block.date.value = board.date
        whole.title_block.rev.value = board.revision
        whole.title_block.comment.value = [1, f"Design {board.design_hash}"]
        for i, at in enumerate(sheet.junctions):
            self.copy("junction", "junction", i).at.value = [*at]
        for i, (start, end) in enumerate(sheet.wires):
            wire = self.copy("wire", "wire", i)
            wire.start.value, wire.end.value = [*start], [*end]
        for i, (corner, opposite) in enumerate(sheet.frames):
            (x0, y0), (x1, y1) = corner, opposite
            around = (x0, y0), (x1, y0), (x1, y1), (x0, y1), (x0, y0)
            frame = self.copy("polyline", "frame", i)
            for point, (x, y) in zip(frame.pts.xy, around, strict=True):
                point.value = [x, y]
        for i, (words, at, height) in enumerate(sheet.texts):
            text = self.copy("text", "text", i)
            text.value, text.at.value = words, [*at, 0]
            text.effects.font.size.value = [height, height]
        for i, (net, at, angle_deg) in enumerate(sheet.labels):
            label = self.copy("global_label", "label", i)
            label.value, label.at.value = net, [*at, angle_deg]
            label.effects.justify.value = "right" if angle_deg in (180, 270) else "left"
            label.property.at.value = [*at, 0]
        for drawn in sheet.symbols:
            self.symbol(drawn)

    def copy(self, pattern: str, kind: str, number: int) -> Any:
        """A thing that has no name."""
        thing = self.page.copy(pattern)
        thing.uuid.value = stable_uuid(self.board.name, "schematic", kind, str(number))
        return thing

    def symbol(self, drawn: Drawn) -> None:
        """A symbol in its place, and its entry in the list at the end.

        The entry has no value and no footprint: KiCad would prefer them to the fields, and what
        is changed in the fields would be lost; and kicad-skip could not save the file.
        """
        more = (str(drawn.unit),) if drawn.unit > 1 else ()
        uuid = stable_uuid(self.board.name, "symbol", drawn.ref, *more)  # a footprint names it too
        part = self.parts.get(drawn.ref)
        symbol = self.page.copy("symbol")
        symbol.lib_id.value = f"{symbols.LIBRARY}:{drawn.symbol}"
        symbol.at.value = [drawn.x_mm, drawn.y_mm, drawn.angle_deg]
        symbol.unit.value = drawn.unit
        symbol.in_bom.value = part is None or part.assembled
        symbol.uuid.value = uuid
        fields = _field_texts(drawn, part)
        for field in symbol.property:
            if field.name in fields:
                _fill(field, drawn, *fields[field.name])
            else:
                field.delete()
        pattern = symbol.wrapped_parsed_value.pin
        for number in drawn.pins:
            pin = pattern.clone()
            pin.value, pin.uuid.value = number, stable_uuid(uuid, number)
        pattern.delete()
        entry = self.page.copy("path")
        entry.value, entry.reference.value = f"/{uuid}", drawn.ref
        entry.unit.value = drawn.unit


def _field_texts(drawn: Drawn, part: Component | None) -> dict[str, tuple[str, Point | None]]:
    """Text of each field of a symbol and its place beside it; a field without a place is hidden."""
    footprint = f"{symbols.LIBRARY}:{part.footprint.name}" if part else ""
    texts = {
        "Reference": (drawn.ref, drawn.ref_at),
        "Value": (drawn.value, drawn.value_at),
        "Footprint": (footprint, None),
        "Datasheet": (part.data_page if part else "", None),
    }
    if part and part.part:
        texts |= {"Manufacturer": (part.manufacturer, None), "MPN": (part.part, None)}
        texts |= {"LCSC": (part.lcsc, None)} if part.lcsc else {}
    return texts


def _fill(field: Any, drawn: Drawn, text: str, beside: Point | None) -> None:
    """A field, which is hidden on the template, and turns with its symbol."""
    dx, dy = beside or (0.0, 0.0)
    field.value = text
    field.at.value = [drawn.x_mm + dx, drawn.y_mm + dy, drawn.angle_deg % 180]
    if beside is not None:
        field.effects.raw.pop()  # the last word, which is "hide"
