"""Drawings with dimension lines that carry the names of parameters, as SVG with fixed bytes."""

import io
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure

Point = tuple[float, float]
_INK = "#b0431e"
_THIN: dict[str, Any] = {"color": _INK, "lw": 0.7}


@dataclass(frozen=True)
class Dimension:
    """A length between two points, and where its dimension line runs."""

    parameter: str
    start: Point
    end: Point
    text_at: Point
    """Where the name stands; a thin line leads to it from the middle of the dimension line."""
    beside: float = 0.0
    """How far the dimension line is from the points: to the right if the length runs up the page,
    up if it runs to the right."""

    @property
    def upright(self) -> bool:
        """Whether the length runs up the page."""
        return abs(self.end[1] - self.start[1]) > abs(self.end[0] - self.start[0])

    @property
    def length_mm(self) -> float:
        """The length that is drawn."""
        axis = 1 if self.upright else 0
        return abs(self.end[axis] - self.start[axis])


@dataclass
class Drawing:
    """A drawing with dimensions."""

    title: str
    section: str
    """Section of the parameter file beside which it is shown."""
    size_in: Point
    paint: Callable[[Axes], None]
    """Draws what is measured."""
    height_scale: float = 1.0
    """How much larger heights are drawn than widths."""
    dimensions: list[Dimension] = field(default_factory=list)

    def svg(self) -> str:
        """The drawing; the same bytes each time."""
        settings = {"svg.hashsalt": self.title, "font.size": 7.5, "font.family": "DejaVu Sans"}
        with mpl.rc_context(settings):
            figure = Figure(figsize=self.size_in, layout="constrained")
            FigureCanvasSVG(figure)
            axes = figure.add_subplot()
            axes.set_aspect(self.height_scale)
            axes.axis("off")
            self.paint(axes)
            for dimension in self.dimensions:
                _draw(axes, dimension)
            axes.autoscale_view()
            written = io.StringIO()
            figure.savefig(written, format="svg", bbox_inches="tight", metadata={"Date": None})
        return written.getvalue()


def _draw(axes: Axes, dimension: Dimension) -> None:
    """Two extension lines, the dimension line with arrows, and the name."""
    (x0, y0), (x1, y1) = dimension.start, dimension.end
    by = dimension.beside
    if dimension.upright:
        x = (x1 if by >= 0 else x0) + by
        line = (x, y0), (x, y1)
    else:
        y = max(y0, y1) + by if by >= 0 else min(y0, y1) + by
        line = (x0, y), (x1, y)
    for point, end in zip(((x0, y0), (x1, y1)), line, strict=True):
        axes.plot(*zip(point, end, strict=True), **_THIN, alpha=0.6)
    arrow = {"arrowstyle": "<|-|>", "mutation_scale": 6, "shrinkA": 0, "shrinkB": 0, **_THIN}
    axes.annotate("", line[0], line[1], arrowprops=arrow)
    middle = (line[0][0] + line[1][0]) / 2, (line[0][1] + line[1][1]) / 2
    lead = {"arrowstyle": "-", "shrinkA": 1, "shrinkB": 0, **_THIN}
    axes.annotate(
        dimension.parameter,
        middle,
        dimension.text_at,
        color=_INK,
        ha="right" if dimension.text_at[0] < middle[0] else "left",
        va="center",
        arrowprops=lead,
        annotation_clip=False,
    )
    axes.plot(*dimension.text_at, alpha=0.0)  # so that the view has room for it
