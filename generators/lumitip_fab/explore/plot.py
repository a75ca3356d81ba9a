"""The front of a study as a picture: what accuracy costs in cells, money, current and size."""

import io
from collections.abc import Collection, Sequence
from typing import Any

from lumitip_fab.explore.run import Found, Study

_DOTS_PER_INCH = 150


def plot(study: Study, best: Collection[int]) -> dict[str, bytes]:
    """`pareto.svg` and `pareto.png`; nothing if every design is refused."""
    shown = [(found, n in best) for n, found in enumerate(study.designs) if found.figures]
    if not shown:
        return {}
    from matplotlib import rc_context
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(13.0, 4.2), layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.subplots(1, 4, sharey=True)
    label, marks = _coloured_by(study, [found for found, _ in shown])
    headings = {
        "cells": "cells", "cost": f"parts and boards ({study.currency})",
        "current_ma": "LED current (mA)", "grid_cm2": "grid (cm²), more is better",
    }  # fmt: skip
    for axis, (name, heading) in zip(axes, headings.items(), strict=True):
        _panel(axis, name, shown, marks)
        axis.set_xlabel(heading)
        axis.grid(alpha=0.25)
        axis.margins(0.08)
    axes[0].set_yscale("log")
    axes[0].yaxis.set_major_formatter(lambda value, _: f"{value:g}")
    axes[0].yaxis.set_minor_formatter(lambda value, _: f"{value:g}")
    axes[0].tick_params(axis="y", which="minor", labelsize=8)
    axes[0].set_ylabel("estimation error, rms (mm), simulated")
    figure.colorbar(axes[-1].collections[0], ax=axes, label=label, pad=0.01)
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3, frameon=False)
    pictures = {}
    with rc_context({"svg.hashsalt": "pareto", "svg.fonttype": "none"}):
        for kind, metadata in (("svg", {"Date": None}), ("png", {"Software": None})):
            written = io.BytesIO()
            figure.savefig(written, format=kind, metadata=metadata, dpi=_DOTS_PER_INCH)
            pictures[f"pareto.{kind}"] = written.getvalue()
    return pictures


def _panel(
    axis: Any, name: str, shown: Sequence[tuple[Found, bool]], marks: Sequence[float]
) -> None:
    x = [found.figures[name] for found, _ in shown]
    y = [found.figures["error_mm"] for found, _ in shown]
    axis.scatter(x, y, c=marks, cmap="viridis", s=34, zorder=3, label="design")
    ring = [(a, b) for a, b, (_, is_best) in zip(x, y, shown, strict=True) if is_best]
    axis.scatter(
        *zip(*ring, strict=True), s=90, facecolors="none", edgecolors="#c0392b", zorder=4,
        label="on the front of all five objectives",
    )  # fmt: skip
    if name != "grid_cm2":
        _steps(axis, x, y)


def _steps(axis: Any, x: Sequence[float], y: Sequence[float]) -> None:
    steps: list[tuple[float, float]] = []
    for a, b in sorted(zip(x, y, strict=True)):
        if not steps or b < steps[-1][1]:
            steps.append((a, b))
    axis.plot(
        *zip(*steps, strict=True), drawstyle="steps-post", color="#888888", lw=1.2,
        label="least error up to here",
    )  # fmt: skip


def _coloured_by(study: Study, shown: Sequence[Found]) -> tuple[str, list[float]]:
    """The first varied field that is a number, and its value of each design; else their number."""
    for place, axis in enumerate(study.axes):
        if all(isinstance(v, int | float) and not isinstance(v, bool) for v in axis.values):
            return axis.field, [float(found.changes[place][1]) for found in shown]
    return "number of the design", [float(i) for i in range(len(shown))]
