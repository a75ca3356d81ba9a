"""A line drawing on a page: collects lines, areas and words in mm, y up, and writes SVG."""

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from xml.sax.saxutils import escape

import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.float64]
LINE_MM = 9.0  # from label to label

_INK, _FAINT = "#1a1a1a", "#5a6b7a"
_ROUND = 'stroke-linecap="round" stroke-linejoin="round"'
_STROKES = {
    "area": f'stroke="{_INK}" stroke-width=".5" {_ROUND}',
    "body": f'stroke="{_INK}" stroke-width=".3" {_ROUND}',
    "part": f'stroke="{_INK}" stroke-width=".12" {_ROUND}',
    "line": f'fill="none" stroke="{_INK}" stroke-width=".22" {_ROUND}',
    "axis": f'fill="none" stroke="{_FAINT}" stroke-width=".18" stroke-dasharray="3 .8 .5 .8"',
    "leader": f'fill="none" stroke="{_FAINT}" stroke-width=".18"',
}
_WORDS = {
    "title": (6.0, f'font-weight="bold" fill="{_INK}"'),
    "name": (3.6, f'font-weight="bold" fill="{_INK}"'),
    "detail": (3.0, f'fill="{_FAINT}"'),
}


@dataclass
class Sheet:
    """A page that grows with what is drawn on it."""

    margin_mm: float = 8.0
    words_scale: float = 1.0
    """Size of words against those of a single finger's drawing."""
    drawn: list[str] = field(default_factory=list)
    low: Points = field(default_factory=lambda: np.full(2, np.inf))
    high: Points = field(default_factory=lambda: np.full(2, -np.inf))

    @contextmanager
    def group(self, name: str) -> Iterator[None]:
        """Everything drawn meanwhile is one element, with this id."""
        self.drawn.append(f'<g id="{name}">')
        yield
        self.drawn.append("</g>")

    def area(self, rings: Iterable[Points], style: str, fill: str) -> None:
        """A filled area; rings inside others are holes."""
        path = "".join(f"M{self._joined(ring)}Z" for ring in rings)
        self.drawn.append(f'<path {_STROKES[style]} fill="{fill}" fill-rule="evenodd" d="{path}"/>')

    def lines(self, lines: Sequence[Points], style: str) -> None:
        """Open lines."""
        if lines:
            path = "".join(f"M{self._joined(line)}" for line in lines)
            self.drawn.append(f'<path {_STROKES[style]} d="{path}"/>')

    def dot(self, x_mm: float, y_mm: float) -> None:
        """Where a leader points at."""
        self.drawn.append(f'<circle fill="{_FAINT}" cx="{x_mm:.2f}" cy="{0.0 - y_mm:.2f}" r=".6"/>')

    def words(self, x_mm: float, y_mm: float, text: str, style: str, anchor: str) -> None:
        """A line of text on its baseline.

        Args:
            x_mm, y_mm: where it is anchored.
            text: what it says.
            style: `"title"`, `"name"` or `"detail"`.
            anchor: `"start"` or `"end"`.
        """
        size, look = _WORDS[style]
        self.drawn.append(
            f'<text font-size="{size * self.words_scale:g}" {look} x="{x_mm:.2f}" '
            f'y="{0.0 - y_mm:.2f}" text-anchor="{anchor}">{escape(text)}</text>'
        )

    def leaders(self, told: list[tuple[tuple[str, str], Points]], x_mm: float, anchor: str) -> None:
        """A column of labels with a line from each to its place; labels keep apart.

        Args:
            told: name and detail of each, and where it points at.
            x_mm: where the words begin or end.
            anchor: `"start"` or `"end"`.
        """
        gap = 1.5 if anchor == "start" else -1.5
        scale = self.words_scale
        bend = x_mm - 4 * gap
        below = math.inf
        for words, at in sorted(told, key=lambda label: -float(label[1][1])):
            y = min(float(at[1]), below - LINE_MM * scale)
            below = y
            self.lines([np.array([at, (bend, y), (x_mm, y)])], "leader")
            self.dot(float(at[0]), float(at[1]))
            self.words(x_mm + gap, y + 0.4 * scale, words[0], "name", anchor)
            self.words(x_mm + gap, y - 3.2 * scale, words[1], "detail", anchor)

    def cover(self, x_mm: float, y_mm: float) -> None:
        """Make the page reach a point."""
        self._joined(np.array([[x_mm, y_mm]]))

    def svg(self, told: Mapping[str, float]) -> str:
        """The page, cut to what is on it.

        Args:
            told: figures that go with it, for programs; their names begin with `data-`.
        """
        left, bottom = self.low - self.margin_mm
        right, top = self.high + self.margin_mm
        width, height = right - left, top - bottom
        return "\n".join(
            [
                f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:.2f}mm" '
                f'height="{height:.2f}mm" viewBox="{left:.2f} {-top:.2f} {width:.2f} {height:.2f}" '
                'font-family="Helvetica, Arial, sans-serif"'
                + "".join(f' {name}="{value:g}"' for name, value in told.items())
                + ">",
                f'<rect x="{left:.2f}" y="{-top:.2f}" width="{width:.2f}" height="{height:.2f}" '
                'fill="#fff"/>',
                *self.drawn,
                "</svg>\n",
            ]
        )

    def _joined(self, points: Points) -> str:
        self.low = np.minimum(self.low, points.min(axis=0))
        self.high = np.maximum(self.high, points.max(axis=0))
        return "L".join(f"{x:.2f},{0.0 - y:.2f}" for x, y in points.tolist())
