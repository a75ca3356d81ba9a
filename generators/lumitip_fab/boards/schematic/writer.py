"""A drawing as the text of a `.kicad_sch` in the format of KiCad 6, which 6 to 10 open."""

from collections.abc import Iterator

from lumitip_fab.boards.ids import stable_uuid
from lumitip_fab.boards.model import Component, Placement
from lumitip_fab.boards.pcb.sexpr import FORMAT, Node, Quoted, written
from lumitip_fab.boards.schematic import symbols
from lumitip_fab.boards.schematic.sheet import Drawn, Sheet
from lumitip_fab.design import Point


def sheet_text(
    board: Placement,
    paper: str,
    sheet: Sheet,
    shapes: dict[str, Node],
    parts: dict[str, Component],
) -> str:
    """The whole sheet; the same drawing gives the same text.

    Args:
        board: whose schematic it is.
        paper: name of the paper.
        sheet: the drawing.
        shapes: symbols by name.
        parts: the board's parts by reference.
    """
    return written(("kicad_sch", *_Writer(board, parts).contents(paper, sheet, shapes)))


class _Writer:
    """Writes the things on a sheet, each under an identifier that stays the same."""

    def __init__(self, board: Placement, parts: dict[str, Component]) -> None:
        self.board, self.parts = board, parts

    def contents(self, paper: str, sheet: Sheet, shapes: dict[str, Node]) -> Iterator[Node]:
        """All that is in the file."""
        yield from (("version", FORMAT), ("generator", "lumitip"))
        yield ("uuid", stable_uuid(self.board.finger, "sheet"))
        yield ("paper", Quoted(paper))
        yield (
            "title_block", ("title", Quoted(f"{self.board.name}: {self.board.finger}")),
            ("rev", Quoted(self.board.revision)),
            ("comment", 1, Quoted(f"Design {self.board.design_hash}")),
        )  # fmt: skip
        yield ("lib_symbols", *(symbols.named(name, s, False) for name, s in shapes.items()))
        for i, at in enumerate(sheet.junctions):
            yield ("junction", ("at", *at), ("diameter", 0), ("color", 0, 0, 0, 0),
                   self.own("junction", i))  # fmt: skip
        for i, (start, end) in enumerate(sheet.wires):
            yield ("wire", ("pts", ("xy", *start), ("xy", *end)),
                   ("stroke", ("width", 0), ("type", "default"), ("color", 0, 0, 0, 0)),
                   self.own("wire", i))  # fmt: skip
        for i, (told, at, height) in enumerate(sheet.texts):
            yield ("text", Quoted(told), ("at", *at, 0), _font(height, "left", "bottom"),
                   self.own("text", i))  # fmt: skip
        for i, label in enumerate(sheet.labels):
            yield self.label(i, *label)
        yield from map(self.symbol, sheet.symbols)
        yield ("sheet_instances", ("path", Quoted("/"), ("page", Quoted("1"))))
        yield ("symbol_instances", *map(self.instance, sheet.symbols))

    def label(self, number: int, net: str, at: Point, angle_deg: int) -> Node:
        """A flag with the name of a net."""
        side = "right" if angle_deg in (180, 270) else "left"
        return (
            "global_label", Quoted(net), ("shape", "passive"), ("at", *at, angle_deg),
            _font(1.27, side), self.own("label", number),
            ("property", Quoted("Intersheet References"), Quoted("${INTERSHEET_REFS}"), ("id", 0),
             ("at", *at, 0), symbols.HIDDEN),
        )  # fmt: skip

    def symbol(self, drawn: Drawn) -> Node:
        """A symbol in its place."""
        part = self.parts.get(drawn.ref)
        bom = "no" if part and not part.part else "yes"
        uuid = self.symbol_uuid(drawn)
        fields = (
            ("Reference", drawn.ref, drawn.ref_at), ("Value", drawn.value, drawn.value_at),
            ("Footprint", self.footprint(drawn), None), ("Datasheet", "", None),
            *((("Manufacturer", part.manufacturer, None), ("MPN", part.part, None))
              if part and part.part else ()),
        )  # fmt: skip
        return (
            "symbol", ("lib_id", Quoted(f"{symbols.LIBRARY}:{drawn.symbol}")),
            ("at", drawn.x_mm, drawn.y_mm, drawn.angle_deg), ("unit", 1), ("in_bom", bom),
            ("on_board", "yes"), ("uuid", uuid),
            *(_field(drawn, i, *field) for i, field in enumerate(fields)),
            *(("pin", Quoted(pin), ("uuid", stable_uuid(uuid, pin))) for pin in drawn.pins),
        )  # fmt: skip

    def instance(self, drawn: Drawn) -> Node:
        """The symbol's entry in the list at the end."""
        return (
            "path", Quoted(f"/{self.symbol_uuid(drawn)}"), ("reference", Quoted(drawn.ref)),
            ("unit", 1), ("value", Quoted(drawn.value)),
            ("footprint", Quoted(self.footprint(drawn))),
        )  # fmt: skip

    def symbol_uuid(self, drawn: Drawn) -> str:
        """Identifier of a symbol, which the footprint of the same part names."""
        return stable_uuid(self.board.finger, "symbol", drawn.ref)

    def footprint(self, drawn: Drawn) -> str:
        """Library name of a symbol's footprint; empty of power symbols."""
        part = self.parts.get(drawn.ref)
        return f"{symbols.LIBRARY}:{part.footprint.name}" if part else ""

    def own(self, kind: str, number: int) -> Node:
        """Identifier of a thing that has no name."""
        return ("uuid", stable_uuid(self.board.finger, "schematic", kind, str(number)))


def _field(drawn: Drawn, number: int, key: str, told: str, beside: Point | None) -> Node:
    """A field of a symbol, hidden where it has no place; it turns with its symbol."""
    dx, dy = beside or (0.0, 0.0)
    return (
        "property", Quoted(key), Quoted(told), ("id", number),
        ("at", drawn.x_mm + dx, drawn.y_mm + dy, drawn.angle_deg % 180),
        symbols.HIDDEN if beside is None else _font(1.27),
    )  # fmt: skip


def _font(height_mm: float, *justify: str) -> Node:
    placed: tuple[Node, ...] = (("justify", *justify),) if justify else ()
    return ("effects", ("font", ("size", height_mm, height_mm)), *placed)
