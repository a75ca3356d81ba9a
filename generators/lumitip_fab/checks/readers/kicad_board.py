"""A `.kicad_pcb` of KiCad 5 to 10 as copper: where it is, and what net the file says it is of.

Places are on KiCad's page: mm, y down.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from shapely.errors import ShapelyError
from shapely.geometry.base import BaseGeometry

from lumitip_fab.checks.readers import kicad_shapes as shapes
from lumitip_fab.checks.readers.kicad_mask import Opening, openings
from lumitip_fab.checks.readers.kicad_shapes import Node, child, children, nodes, numbers, words
from lumitip_fab.checks.readers.kicad_silk import Silk, silk
from lumitip_fab.errors import OutputError

_COPPER_KINDS = {"signal", "power", "mixed", "jumper"}
_THICK_FILLS_BEFORE = 20220000  # until KiCad 6 the outlines of fills were drawn with a pen


@dataclass(frozen=True, eq=False)
class Copper:
    """A connected piece of copper: a pad, a track, a via, a part of a zone."""

    kind: str
    """`"pad"`, `"track"`, `"via"`, `"fill"` or `"drawing"`."""
    net: str
    layers: frozenset[str]
    area: BaseGeometry
    width_mm: float = 0.0
    """Width of a track."""
    drill_mm: float = 0.0


@dataclass(frozen=True, eq=False)
class Terminal:
    """A pad of a part; its copper is empty where it has none."""

    number: str
    net: str
    at: shapes.Point
    copper: Copper | None
    drill_mm: float


@dataclass(frozen=True)
class Model:
    """The 3D model of a part, in the footprint's frame, y up."""

    path: str
    """As the file has it, such as `${KIPRJMOD}/../models/X.step`."""
    offset_mm: tuple[float, ...]
    scale: tuple[float, ...]
    rotate_deg: tuple[float, ...]


@dataclass(frozen=True, eq=False)
class Part:
    """A footprint."""

    ref: str
    value: str
    footprint: str
    texts: tuple[str, ...]
    """Everything else that it says of itself."""
    at: shapes.Point
    angle_deg: float
    front: bool
    attributes: frozenset[str]
    """Such as `exclude_from_bom`."""
    terminals: tuple[Terminal, ...]
    models: tuple[Model, ...] = ()
    fields: tuple[tuple[str, str], ...] = ()
    """Its properties, by name."""

    @property
    def bought(self) -> bool:
        """Whether it is no bare copper: it is in bills of materials, or has an order number."""
        return "exclude_from_bom" not in self.attributes or "MPN" in dict(self.fields)


@dataclass(frozen=True)
class Ply:
    """A layer of the stack-up."""

    kind: str
    thickness_mm: float
    material: str


@dataclass(frozen=True, eq=False)
class KicadBoard:
    """Contents of a board file."""

    parts: tuple[Part, ...]
    loose: tuple[Copper, ...]
    """Copper that belongs to no part."""
    layers: tuple[str, ...]
    """Copper layers from front to back."""
    edges: tuple[BaseGeometry, ...]
    """Lines of the outline."""
    silk: Silk
    """Silkscreen."""
    keep_outs: tuple[BaseGeometry, ...]
    """Areas where a rule keeps tracks, vias and fills off every copper layer."""
    plies: tuple[Ply, ...]
    """The stack-up, if the file has it."""
    regions: dict[str, BaseGeometry]
    """Rectangle on each layer for a user's own use."""
    thickness_mm: float
    """Of the finished board; NaN if the file does not state it."""
    openings: tuple[Opening, ...]
    title_block: dict[str, str]
    """As `kicad_shapes.title_block` has it."""

    def copper(self) -> Iterator[Copper]:
        """Every piece of copper."""
        for part in self.parts:
            yield from (t.copper for t in part.terminals if t.copper is not None)
        yield from self.loose


def read_board(path: Path) -> KicadBoard:
    """Read a board file.

    Raises:
        OutputError: if it is missing, or is no board.
    """
    text = shapes.read_text(path)
    try:
        return _board(text)
    except (ValueError, ShapelyError) as error:
        raise OutputError(f"{path}: {error}") from error


@lru_cache(maxsize=8)
def _board(text: str) -> KicadBoard:
    """The board of a text, read once a process: six check modules open each board.

    Raises:
        ValueError: if it is no board.
    """
    root = nodes(text)
    if root[0] != "kicad_pcb":
        raise ValueError(f"is a {root[0]!r:.40}, a .kicad_pcb is needed")
    try:
        return _Reader(root).board()
    except (ValueError, LookupError, TypeError, ArithmeticError) as error:
        raise ValueError(f"cannot be understood: {error!r:.200}") from error


class _Reader:
    def __init__(self, root: Node) -> None:
        self.root = root
        self.version = int(numbers(child(root, "version"))[0])
        table = child(root, "layers") or []
        rows = [row for row in table if isinstance(row, list)]
        layers = [(int(str(r[0])), str(r[1])) for r in rows if len(r) > 2 and r[2] in _COPPER_KINDS]
        # KiCad 9 numbers the back 2 and the inner layers from 4.
        back = [name for _, name in layers if name in {"B.Cu", "Back"}] or [max(layers)[1]]
        inner = [name for _, name in sorted(layers) if name not in back]
        self.layers = (*inner, back[0])
        self.nets = {w[0]: w[1] for w in map(words, children(root, "net")) if len(w) == 2}

    def board(self) -> KicadBoard:
        loose = [*self.tracks(), *self.vias(), *self.fills(), *self.drawings()]
        parts = tuple(self.part(node) for node in children(self.root, "footprint", "module"))
        drawn = children(self.root, "gr_line", "gr_arc", "gr_circle", "gr_rect", "gr_poly")
        lines = list(drawn)
        edges = [shapes.outline(n) for n in lines if words(child(n, "layer")) == ["Edge.Cuts"]]
        own = {words(child(n, "layer"))[0]: n for n in lines if child(n, "layer")}
        regions = {w: shapes.outline(n).envelope for w, n in own.items() if w.startswith("User.")}
        return KicadBoard(
            parts,
            tuple(loose),
            self.layers,
            tuple(edges),
            silk(self.root),
            tuple(self.keep_outs()),
            tuple(self.plies()),
            regions,
            (numbers(child(child(self.root, "general") or [], "thickness")) or (math.nan,))[0],
            tuple(openings(self.root)),
            shapes.title_block(self.root),
        )

    def plies(self) -> Iterator[Ply]:
        """The stack-up's layers, but for print and paste, which have no thickness."""
        for node in children(child(child(self.root, "setup") or [], "stackup") or [], "layer"):
            thickness = numbers(child(node, "thickness"))
            if thickness:
                kind, material = (words(child(node, n)) for n in ("type", "material"))
                yield Ply("".join(kind), thickness[0], "".join(material))

    def net(self, node: Node) -> str:
        """Net of a pad, track, via or zone: by number until KiCad 9, then by name."""
        if (named := words(child(node, "net_name"))) and named[0]:
            return named[0]
        net = words(child(node, "net"))
        if not net:
            return ""
        return net[-1] if len(net) > 1 else self.nets.get(net[0], "" if net[0] == "0" else net[0])

    def on(self, node: Node) -> frozenset[str]:
        """Copper layers of a node."""
        layers = [*words(child(node, "layer")), *words(child(node, "layers"))]
        found: set[str] = set()
        for name in layers:
            if name == "*.Cu":
                found.update(self.layers)
            elif name == "F&B.Cu":
                found.update((self.layers[0], self.layers[-1]))
            elif name in self.layers:
                found.add(name)
        return frozenset(found)

    def tracks(self) -> Iterator[Copper]:
        for node in children(self.root, "segment", "arc"):
            width = numbers(child(node, "width"))[0]
            area = shapes.outline(node).buffer(width / 2, quad_segs=shapes.STEPS)
            yield Copper("track", self.net(node), self.on(node), area, width)

    def vias(self) -> Iterator[Copper]:
        for node in children(self.root, "via"):
            ends = [self.layers.index(w) for w in words(child(node, "layers")) if w in self.layers]
            first, last = min(ends, default=0), max(ends, default=len(self.layers) - 1)
            size, at = numbers(child(node, "size"))[0], numbers(child(node, "at"))
            drill = (numbers(child(node, "drill")) or (size / 2,))[0]
            through = frozenset(self.layers[first : last + 1])
            yield Copper("via", self.net(node), through, shapes.disc(at, size), 0.0, drill)

    def fills(self) -> Iterator[Copper]:
        for zone in children(self.root, "zone"):
            if child(zone, "keepout"):
                continue
            pen = 0.0
            if self.version < _THICK_FILLS_BEFORE and not child(zone, "filled_areas_thickness"):
                pen = (numbers(child(zone, "min_thickness")) or (0.0,))[0]
            for node in children(zone, "filled_polygon"):
                area = shapes.polygon(child(node, "pts") or []).buffer(pen / 2)
                layers = self.on(node) or self.on(zone)
                yield Copper("fill", self.net(zone), layers, area)

    def keep_outs(self) -> Iterator[BaseGeometry]:
        for zone in children(self.root, "zone"):
            rules = child(zone, "keepout")
            kept = (
                {tuple(words(child(rules, what))) for what in ("tracks", "vias", "copperpour")}
                if rules
                else set()
            )
            if kept == {("not_allowed",)} and self.on(zone) == frozenset(self.layers):
                yield shapes.polygon(child(child(zone, "polygon") or [], "pts") or [])

    def drawings(self) -> Iterator[Copper]:
        for node in children(self.root, "gr_line", "gr_arc", "gr_circle", "gr_rect", "gr_poly"):
            if layers := self.on(node):
                yield Copper("drawing", self.net(node), layers, shapes.inked(node))

    def part(self, node: Node) -> Part:
        place = shapes.Place.of(node)
        properties = {w[0]: w[1] for w in map(words, children(node, "property")) if len(w) > 1}
        for text in map(words, children(node, "fp_text")):
            properties.setdefault(
                {"reference": "Reference", "value": "Value"}.get(text[0], ""), text[1]
            )
        rest = [*properties.values(), *words(child(node, "descr")), *words(child(node, "tags"))]
        name = str(node[1]) if len(node) > 1 and isinstance(node[1], str) else ""
        return Part(
            ref=properties.get("Reference", ""),
            value=properties.get("Value", ""),
            footprint=name.rpartition(":")[2],
            texts=tuple(rest),
            at=place.at,
            angle_deg=place.angle_deg,
            front=words(child(node, "layer")) == [self.layers[0]],
            attributes=frozenset(words(child(node, "attr"))),
            terminals=tuple(self.terminal(pad, place) for pad in children(node, "pad")),
            models=tuple(map(_model, children(node, "model"))),
            fields=tuple(properties.items()),
        )

    def terminal(self, node: Node, place: "shapes.Place") -> Terminal:
        number, kind, layers = str(node[1]), str(node[2]), self.on(node)
        drill = (numbers(child(node, "drill")) or (0.0,))[0]
        at, net = place.of_pad(node), self.net(node)
        if kind == "np_thru_hole" or not layers:
            return Terminal(number, net, at, None, drill)
        through = frozenset(self.layers) if kind == "thru_hole" else layers
        copper = Copper("pad", net, through, shapes.pad(node, at), 0.0, drill)
        return Terminal(number, net, at, copper, drill)


def _model(node: Node) -> Model:
    named = (child(node, name) or [] for name in ("offset", "scale", "rotate"))
    return Model(str(node[1]), *(numbers(child(each, "xyz")) for each in named))
