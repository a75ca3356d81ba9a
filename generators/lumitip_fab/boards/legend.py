"""What is printed on a board beyond its parts' outlines: cells, labels, references and title."""

import dataclasses
from collections.abc import Iterable, Iterator

import numpy as np
import shapely
from shapely import LineString

from lumitip_fab.boards.cells import cell_edges
from lumitip_fab.boards.clear import GAP_MM, LINE_MM, Clear, extent
from lumitip_fab.boards.geometry import courtyard
from lumitip_fab.boards.model import Component, Placement, Side, Stroke, Text
from lumitip_fab.design import Connector, Finger, Point

_HEIGHT_MM = 0.8
_TITLE_MM = 1.0
_ARROW_MM, _HEAD_MM = 2.4, 0.7
_APART_MM = 0.1  # more than the least gap round references, so that they do not run together
_STEP_MM = 0.25
_SHOWN = ("multiplexer", "resistor", "capacitor")
_AT_CELLS = ("led", "photodetector")


def with_legend(board: Placement, finger: Finger, pitch_mm: float, mark: str) -> Placement:
    """The board with its silkscreen.

    Args:
        board: parts in their places.
        finger: for its cells and its connector.
        pitch_mm: of the cells.
        mark: terminal that a bracket round one end of an LED or photodetector means.
    """
    front, back = Clear.of(board, "front"), Clear.of(board, "back")
    page = _Page(front, back)
    page.labels(board, finger.connector)
    cells = front.clipped(cell_edges(finger.cells, pitch_mm))
    page.lines("front", cells)
    components = page.references(board.components)
    page.side_title(board)
    page.back_title(board, finger, mark)
    return dataclasses.replace(
        board, components=components, silk=tuple(page.strokes), texts=tuple(page.texts)
    )


class _Page:
    """Both sides while they are drawn: what is printed takes its room."""

    def __init__(self, front: Clear, back: Clear) -> None:
        self.sides: dict[Side, Clear] = {"front": front, "back": back}
        self.strokes: list[tuple[Side, Stroke]] = []
        self.texts: list[tuple[Side, Text]] = []

    def lines(self, side: Side, lines: Iterable[LineString]) -> None:
        """Print lines."""
        for line in lines:
            self.strokes.append((side, Stroke(tuple(line.coords), LINE_MM)))
            self.sides[side].take(line.buffer(LINE_MM / 2))

    def first_free(self, side: Side, choices: Iterable[Text]) -> bool:
        """Print a text at the first of some places that is free."""
        for text in choices:
            if self.sides[side].free(box := extent(text, side)):
                self.texts.append((side, text))
                self.sides[side].take(box)
                return True
        return False

    def labels(self, board: Placement, wires: Connector) -> None:
        """Signals at the wire pads and, on the back, at the test points; pin 1."""
        half = wires.pad_mm / 2
        for signal, at in zip(wires.signals, wires.pads, strict=True):
            self.first_free("front", _beside(signal, at, half, wires.pitch_mm))
        (x, y), steps = wires.pads[0], np.arange(0.6, 5.0, _STEP_MM).tolist()
        self.first_free("front", (Text("1", x - half - step, y, _HEIGHT_MM) for step in steps))
        for part in board.components:
            if part.kind == "test point":
                around = part.footprint.body.length_mm / 2
                at = part.x_mm, part.y_mm
                self.first_free(part.side, _beside(part.value, at, around, wires.pitch_mm))

    def references(self, components: tuple[Component, ...]) -> tuple[Component, ...]:
        """Parts with their references where there is room: at the cells for all or for none."""
        shown = {part.ref: self.reference(part) for part in components if part.kind in _SHOWN}
        cells = [part for part in components if part.kind in _AT_CELLS]
        places = [self.place_of(part) for part in cells]
        if all(places):
            shown |= {part.ref: self.printed(part, text)
                      for part, text in zip(cells, places, strict=True) if text}  # fmt: skip
        return tuple(shown.get(part.ref, part) for part in components)

    def reference(self, part: Component) -> Component:
        """A part with its reference if there is room."""
        text = self.place_of(part)
        return self.printed(part, text) if text else part

    def place_of(self, part: Component) -> Text | None:
        """A free place for a part's reference, on the board."""
        yard = courtyard(part)
        middle = yard.centre_mm
        up = yard.length_mm / 2 + _HEIGHT_MM + _APART_MM
        aside = yard.width_mm / 2 + _HEIGHT_MM + _APART_MM
        (x, y), r = middle, part.ref
        long = yard.length_mm / 2 + _HEIGHT_MM / 2 + _width_mm(r, _HEIGHT_MM) / 2
        choices = [
            Text(r, x, y + up, _HEIGHT_MM), Text(r, x, y - up, _HEIGHT_MM),
            Text(r, x - aside, y, _HEIGHT_MM, angle_deg=90.0),
            Text(r, x + aside, y, _HEIGHT_MM, angle_deg=90.0),
            Text(r, x, y + long, _HEIGHT_MM, angle_deg=90.0),
        ]  # fmt: skip
        if part.kind == "multiplexer":
            choices.insert(0, Text(r, x, y, 1.2, 0.15))
        side = self.sides[part.side]
        room = (extent(text, part.side).buffer(_APART_MM) for text in choices)
        return next((t for t, box in zip(choices, room, strict=True) if side.free(box)), None)

    def printed(self, part: Component, text: Text) -> Component:
        """A part with its reference at a place on the board, told in its footprint's frame."""
        self.sides[part.side].take(extent(text, part.side))
        x, y = _in_footprint(part, (text.x_mm, text.y_mm))
        angle = text.angle_deg - part.angle_deg
        local = dataclasses.replace(
            text, text="", x_mm=x, y_mm=y, angle_deg=angle if part.side == "front" else -angle
        )
        return dataclasses.replace(part, ref_text=local)

    def side_title(self, board: Placement) -> None:
        """Along the long edges: arrow to the tip and name; finger, revision and design."""
        box = board.outline
        told = f"{board.finger} rev {board.revision}  {board.design_hash[:8]}"
        for sign, text in ((-1, board.name), (1, told)):
            edge = box.x_min_mm if sign < 0 else box.x_max_mm
            xs = [edge - sign * d for d in np.arange(_TITLE_MM, 4.0, _STEP_MM).tolist()]
            ys = np.arange(box.y_max_mm - 2.0, box.y_min_mm, -_STEP_MM).tolist()
            if sign < 0:
                self.arrow("front", xs, ys)
            for height in (_TITLE_MM, _HEIGHT_MM):
                if self.first_free(
                    "front",
                    (Text(text, x, y, height, 0.15 * height, 90.0) for x in xs for y in ys),
                ):
                    break

    def arrow(self, side: Side, xs: list[float], ys: list[float]) -> None:
        """An arrow to the tip with its word below, at the first free place."""
        for x in xs:
            for y in ys:
                word = Text("TIP", x, y - _ARROW_MM - 1.5, _HEIGHT_MM, angle_deg=90.0)
                room = shapely.box(x - _HEAD_MM / 2, y - _ARROW_MM, x + _HEAD_MM / 2, y)
                free = self.sides[side].free
                if free(room.buffer(LINE_MM)) and free(extent(word, side)):
                    head = LineString([(x - _HEAD_MM / 2, y - _HEAD_MM), (x, y),
                                       (x + _HEAD_MM / 2, y - _HEAD_MM)])  # fmt: skip
                    self.lines(side, [head, LineString([(x, y - _ARROW_MM), (x, y)])])
                    self.first_free(side, [word])
                    self.sides[side].take(extent(word, side).buffer(_TITLE_MM))
                    return

    def back_title(self, board: Placement, finger: Finger, mark: str) -> None:
        """On the back, where there are no cells: the whole title, and what the marks mean."""
        zone = next(zone.box for zone in finger.zones if zone.name == "cells")
        x, y = zone.centre_mm
        lines = (
            (board.name, 2.0), (f"{board.finger} board  rev {board.revision}", 1.5),
            (f"design {board.design_hash[:8]}", 1.5), (f"bracket: {mark}", 1.2),
        )  # fmt: skip
        widest = max(_width_mm(told, height) for told, height in lines)
        scale = min(1.0, (board.outline.width_mm - 4 * _TITLE_MM) / widest)
        y += scale * sum(height * 1.8 for _, height in lines) / 2
        for told, height in lines:
            h = scale * height
            y -= 0.9 * h
            self.first_free("back", [Text(told, x, y, h, 0.15 * h)])
            y -= 0.9 * h
        self.arrow("back", [x], np.arange(y - 0.5, zone.y_min_mm, -_STEP_MM).tolist())


def _beside(signal: str, at: Point, half_mm: float, pitch_mm: float) -> Iterator[Text]:
    """Places for the name of a pad in a row: above it, upright above it, below, to the left."""
    x, y = at
    flat = Text(signal, x, y + half_mm + _HEIGHT_MM * 0.75, _HEIGHT_MM)
    length = _width_mm(signal, _HEIGHT_MM)
    upright = Text(signal, x, y + half_mm + 0.25 + length / 2, _HEIGHT_MM, angle_deg=90.0)
    if length < pitch_mm - GAP_MM:
        yield flat
    yield upright
    yield dataclasses.replace(flat, y_mm=y - half_mm - _HEIGHT_MM * 0.75)
    yield dataclasses.replace(flat, x_mm=x - half_mm - 0.3 - length / 2, y_mm=y)


def _width_mm(told: str, height_mm: float) -> float:
    low, _, high, _ = extent(Text(told, 0.0, 0.0, height_mm), "front").bounds
    return float(high - low)


def _in_footprint(part: Component, at: Point) -> Point:
    """A place on the board in the frame of a part's footprint."""
    turn = np.radians(part.angle_deg)
    dx, dy = at[0] - part.x_mm, at[1] - part.y_mm
    x, y = dx * np.cos(turn) + dy * np.sin(turn), dy * np.cos(turn) - dx * np.sin(turn)
    return (-float(x) if part.side == "back" else float(x)), float(y)
