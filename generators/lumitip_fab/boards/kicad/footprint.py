"""Parts and unplated holes as footprints, on a board or in a library."""

from collections.abc import Iterator
from dataclasses import replace

from lumitip_fab.boards.kicad import nodes, sexpr
from lumitip_fab.boards.model import (
    PlacedComponent,
    Text,
    fiducial_margin_mm,
    stable_uuid,
)
from lumitip_fab.boards.silk.strokes import angle_on_board_deg
from lumitip_fab.design import Footprint, Pad, Point
from lumitip_fab.design.frames import on_board_page


def effects(text: Text, mirrored: bool) -> sexpr.Node:
    """How a text is drawn: by its height, its stroke, and whether it is read from behind."""
    size = ("size", text.height_mm, text.height_mm)
    mirror = (("justify", "mirror"),) if mirrored else ()
    return ("effects", ("font", size, ("thickness", text.width_mm)), *mirror)


LIBRARY = "lumitip"
HOLE = "MountingHole"


def placed_footprint(
    component: PlacedComponent,
    numbers: dict[str, int],
    finger: str,
    solid: frozenset[tuple[str, str]] = frozenset(),
) -> sexpr.Node:
    """A part on its board.

    Args:
        component: the part.
        numbers: number of each net.
        finger: whose board it is on.
    """
    return _Writer(component, numbers, finger, solid).node()


def hole_footprint(number: int, at: Point, hole_mm: float, finger: str) -> sexpr.Node:
    """An unplated hole; `number` counts from 1."""
    ref = f"H{number}"
    own = stable_uuid(finger, "footprint", ref)
    x, y = on_board_page(at)
    head = (
        sexpr.Quoted(f"{LIBRARY}:{hole_name(hole_mm)}"),
        ("layer", sexpr.Quoted("F.Cu")),
        ("tstamp", own),
        ("at", x, y),
    )
    return ("footprint", *head, *_hole(ref, hole_mm, own, "board_only"))


def library_file(component: PlacedComponent) -> bytes:
    """The `.kicad_mod` of a part's footprint."""
    shape = component.footprint
    plain = replace(
        component,
        ref="REF**",
        value=shape.name,
        x_mm=0.0,
        y_mm=0.0,
        angle_deg=0.0,
        side="front",
        nets=(),
        ref_text=None,
    )
    return _library(shape.name, _Writer(plain, {}, LIBRARY).contents())


def hole_library_file(hole_mm: float) -> bytes:
    """The `.kicad_mod` of an unplated hole."""
    own = stable_uuid(LIBRARY, "footprint", HOLE)
    return _library(hole_name(hole_mm), iter(_hole("REF**", hole_mm, own)))


def hole_name(hole_mm: float) -> str:
    """Name of an unplated hole's footprint."""
    return f"{HOLE}_{hole_mm:g}mm"


def _library(name: str, contents: Iterator[sexpr.Node]) -> bytes:
    head = ("version", sexpr.FORMAT), ("generator", "lumitip"), ("layer", sexpr.Quoted("F.Cu"))
    return sexpr.written(("footprint", sexpr.Quoted(name), *head, *contents)).encode()


def _hole(ref: str, hole_mm: float, own: str, *attributes: str) -> tuple[sexpr.Node, ...]:
    return (
        ("attr", *attributes, "exclude_from_pos_files", "exclude_from_bom"),
        _text("reference", ref, Text("", 0.0, 0.0), 0.0, "F.SilkS", f"{own}/reference", hide=True),
        _text("value", HOLE, Text("", 0.0, 0.0), 0.0, "F.Fab", f"{own}/value", hide=True),
        (
            "pad",
            sexpr.Quoted(""),
            "np_thru_hole",
            "circle",
            ("at", 0, 0),
            ("size", hole_mm, hole_mm),
            ("drill", hole_mm),
            ("layers", sexpr.Quoted("*.Cu"), sexpr.Quoted("*.Mask")),
            ("tstamp", stable_uuid(own, "pad")),
        ),
    )


_SOLID = 2  # KiCad's number for a pad that a zone joins all round


class _Writer:
    """Writes one part; the parts of its footprint turn and flip with it."""

    def __init__(
        self,
        component: PlacedComponent,
        numbers: dict[str, int],
        finger: str,
        solid: frozenset[tuple[str, str]] = frozenset(),
    ) -> None:
        self.component, self.numbers = component, numbers
        self.solid = {number for ref, number in solid if ref == component.ref}
        self.front = component.side == "front"
        self.own = stable_uuid(finger, "footprint", component.ref)
        self.path = "/" + stable_uuid(finger, "symbol", component.ref)
        # KiCad turns a part over about x, the model about y: half a turn apart.
        self.angle = (component.angle_deg + (0 if self.front else 180)) % 360

    def node(self) -> sexpr.Node:
        """The whole footprint."""
        part, shape = self.component, self.component.footprint
        x, y = on_board_page((part.x_mm, part.y_mm))
        return (
            "footprint",
            sexpr.Quoted(f"{LIBRARY}:{shape.name}"),
            ("layer", sexpr.Quoted(self.layer("Cu"))),
            ("tstamp", self.own),
            ("at", x, y, self.angle),
            *_ordering(part),
            *((("path", sexpr.Quoted(self.path)),) if part.kind != "fiducial" else ()),
            *self.contents(),
        )

    def contents(self) -> Iterator[sexpr.Node]:
        """Content of a footprint that does not depend on its place."""
        yield ("attr", *_attributes(self.component))
        yield from self.texts()
        yield from self.lines()
        yield from (self.pad(i, p) for i, p in enumerate(self.component.footprint.pads))
        yield from nodes.model(self.component.footprint)

    def layer(self, kind: str) -> str:
        """A layer of the part's own side."""
        return f"{'F' if self.front else 'B'}.{kind}"

    def at(self, x_mm: float, y_mm: float) -> Point:
        """A point of the footprint's frame in the frame of the file's footprint, y down."""
        return (x_mm, -y_mm) if self.front else (x_mm, y_mm)

    def texts(self) -> Iterator[sexpr.Node]:
        """Reference and value, and the reference once more where assembly drawings have it."""
        part = self.component
        shown = part.ref_text or Text("", 0.0, 0.0)
        for kind, value, text, layer in (
            ("reference", part.ref, shown, "SilkS"),
            ("value", part.value, Text("", 0.0, 0.0), "Fab"),
            ("user", "${REFERENCE}", _on_body(part.footprint), "Fab"),
        ):
            hide = kind == "value" or (kind == "reference" and part.ref_text is None)
            yield _text(
                kind,
                value,
                text,
                angle_on_board_deg(part, text),
                self.layer(layer),
                f"{self.own}/{kind}",
                at=self.at(text.x_mm, text.y_mm),
                hide=hide,
                mirrored=not self.front,
            )

    def lines(self) -> Iterator[sexpr.Node]:
        """Silkscreen, body and courtyard."""
        shape = self.component.footprint
        drawn = [("SilkS", stroke) for stroke in self.component.outline]
        drawn += [("Fab", stroke) for stroke in nodes.body_strokes(shape)]
        drawn += [("CrtYd", stroke) for stroke in nodes.courtyard_strokes(self.component)]
        count = 0
        for layer, stroke in drawn:
            for start, end in zip(stroke.points, stroke.points[1:], strict=False):
                count += 1
                yield (
                    "fp_line",
                    ("start", *self.at(*start)),
                    ("end", *self.at(*end)),
                    ("layer", sexpr.Quoted(self.layer(layer))),
                    ("width", stroke.width_mm),
                    ("tstamp", stable_uuid(self.own, "line", str(count))),
                )

    def pad(self, index: int, pad: Pad) -> sexpr.Node:
        """A pad with its net."""
        net = dict(self.component.nets).get(pad.number, "")
        margin = fiducial_margin_mm(self.component)
        return (
            "pad",
            sexpr.Quoted(pad.number),
            "thru_hole" if pad.drill_mm else "smd",
            "circle" if pad.round else "rect",
            ("at", *self.at(pad.x_mm, pad.y_mm), self.angle),
            ("size", pad.width_mm, pad.height_mm),
            *((("drill", pad.drill_mm),) if pad.drill_mm else ()),
            ("layers", *map(sexpr.Quoted, self.pad_layers(pad))),
            *((("net", self.numbers[net], sexpr.Quoted(net)),) if net else ()),
            *((("solder_mask_margin", margin), ("clearance", margin)) if margin else ()),
            *((("zone_connect", _SOLID),) if pad.number in self.solid else ()),
            ("tstamp", stable_uuid(self.own, "pad", str(index))),
        )

    def pad_layers(self, pad: Pad) -> tuple[str, ...]:
        """Copper, mask and paste of a pad."""
        if pad.drill_mm:
            return "*.Cu", "*.Mask"
        paste = (self.layer("Paste"),) if pad.paste else ()
        return self.layer("Cu"), *paste, self.layer("Mask")


def _ordering(part: PlacedComponent) -> tuple[sexpr.Node, ...]:
    """Ordering fields as in the part's symbol: KiCad 10 compares them."""
    if not part.part:
        return ()
    properties = {"Manufacturer": part.manufacturer, "MPN": part.part}
    return tuple(
        ("property", sexpr.Quoted(name), sexpr.Quoted(value)) for name, value in properties.items()
    )


def _attributes(component: PlacedComponent) -> tuple[str, ...]:
    attributes = ["through_hole" if any(p.drill_mm for p in component.footprint.pads) else "smd"]
    if not component.assembled:
        attributes += ["exclude_from_pos_files", "exclude_from_bom"]
    if component.kind == "fiducial":
        attributes.append("board_only")
    return tuple(attributes)


def _on_body(shape: Footprint) -> Text:
    """The reference on the body, as large as it allows."""
    body = shape.body
    height = min(0.8, body.width_mm / 4, body.length_mm / 1.5)
    return Text("", *body.centre_mm, height_mm=height, width_mm=0.15 * height)


def _text(
    kind: str,
    value: str,
    text: Text,
    angle_deg: float,
    layer: str,
    own: str,
    at: Point = (0.0, 0.0),
    hide: bool = False,
    mirrored: bool = False,
) -> sexpr.Node:
    return (
        "fp_text",
        kind,
        sexpr.Quoted(value),
        ("at", *at, angle_deg, "unlocked"),
        ("layer", sexpr.Quoted(layer)),
        *(("hide",) if hide else ()),
        effects(text, mirrored),
        ("tstamp", stable_uuid(own)),
    )
