"""A study as a table and as a picture, with its front: the designs that no other one is better
than."""

import csv
import io
import json
from collections.abc import Collection, Sequence
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table

from lumitip_fab.explore.front import undominated
from lumitip_fab.explore.picture import KINDS, pictures
from lumitip_fab.explore.run import Found, Study
from lumitip_fab.pipeline.manifest import write_file, writing


def plot(study: Study, best: Collection[int]) -> dict[str, bytes]:
    """`pareto.svg` and `pareto.png`; nothing if every design is refused."""
    shown = [(found, n in best) for n, found in enumerate(study.designs) if found.figures]
    if not shown:
        return {}
    from matplotlib.figure import Figure

    figure = Figure(figsize=(13.0, 4.2), layout="constrained")
    axes = figure.subplots(1, 4, sharey=True)
    label, marks = _coloured_by(study, [found for found, _ in shown])
    headings = {
        "cells": "cells",
        "cost": f"parts and boards ({study.currency})",
        "current_ma": "LED current (mA)",
        "grid_cm2": "grid (cm²), more is better",
    }
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
    return pictures(figure, "pareto")


def _panel(
    axis: Any, name: str, shown: Sequence[tuple[Found, bool]], marks: Sequence[float]
) -> None:
    x = [found.figures[name] for found, _ in shown]
    y = [found.figures["error_mm"] for found, _ in shown]
    axis.scatter(x, y, c=marks, cmap="viridis", s=34, zorder=3, label="design")
    ring = [(a, b) for a, b, (_, is_best) in zip(x, y, shown, strict=True) if is_best]
    axis.scatter(
        *zip(*ring, strict=True),
        s=90,
        facecolors="none",
        edgecolors="#c0392b",
        zorder=4,
        label="on the front of all five objectives",
    )
    if name != "grid_cm2":
        _steps(axis, x, y)


def _steps(axis: Any, x: Sequence[float], y: Sequence[float]) -> None:
    steps: list[tuple[float, float]] = []
    for a, b in sorted(zip(x, y, strict=True)):
        if not steps or b < steps[-1][1]:
            steps.append((a, b))
    axis.plot(
        *zip(*steps, strict=True),
        drawstyle="steps-post",
        color="#888888",
        lw=1.2,
        label="least error up to here",
    )


def _coloured_by(study: Study, shown: Sequence[Found]) -> tuple[str, list[float]]:
    """The first varied field that is a number, and its value of each design; else their number."""
    for place, axis in enumerate(study.axes):
        if all(isinstance(v, int | float) and not isinstance(v, bool) for v in axis.values):
            return axis.field, [float(found.changes[place][1]) for found in shown]
    return "number of the design", [float(i) for i in range(len(shown))]


OBJECTIVES = {"error_mm": 1, "cells": 1, "cost": 1, "current_ma": 1, "grid_cm2": -1}
"""Figures to optimise: 1 if less is better, -1 if more; a small grid is no merit."""
_UNITS = {"cost": "cost_{currency}"}


def front(designs: Sequence[Found]) -> set[int]:
    """Numbers of the designs of which no other is as good in all and better in one."""
    rated = {
        number: tuple(sign * found.figures[name] for name, sign in OBJECTIVES.items())
        for number, found in enumerate(designs)
        if found.figures
    }
    best = undominated(set(rated.values()))
    return {number for number, own in rated.items() if own in best}


def write(study: Study, folder: Path) -> list[Path]:
    """Write `designs.csv`, `designs.json`, and the front as `pareto.svg` and `pareto.png`, which
    are removed if every design is refused.

    Returns:
        What was written.

    Raises:
        OutputError: if a file cannot be written.
    """
    best = front(study.designs)
    rows = [_row(study, n, n in best) for n in range(len(study.designs))]
    files = {"designs.csv": _csv(rows), "designs.json": _json(study, rows)}
    files |= plot(study, best)
    with writing(folder):
        for name in {f"pareto.{kind}" for kind in KINDS} - files.keys():
            (folder / name).unlink(missing_ok=True)  # of an earlier study
        for name, data in files.items():
            write_file(folder / name, data)
    return [folder / name for name in files]


def print_table(study: Study, console: Console) -> None:
    """Print the front, and what was refused."""
    best = sorted(front(study.designs))
    names = [axis.field for axis in study.axes]
    table = Table(title="designs that no other one is better than in every way, simulated")
    for heading in (
        *names,
        "error mm",
        "error °",
        "gross %",
        "bound mm",
        "cells",
        "grid cm²",
        f"cost {study.currency}",
        "LEDs mA",
    ):
        table.add_column(heading, justify="right")
    for number in best:
        found = study.designs[number]
        f = found.figures
        table.add_row(
            *(_shown(value) for _, value in found.changes),
            f"{f['error_mm']:.3f}",
            f"{f['error_deg']:.2f}",
            f"{f['gross_percent']:.1f}",
            f"{f['bound_mm']:.3f}",
            f"{f['cells']:.0f}",
            f"{f['grid_cm2']:.1f}",
            f"{f['cost']:.2f}",
            f"{f['current_ma']:.1f}",
        )
    console.print(table)
    _print_refused(study, console)


def _print_refused(study: Study, console: Console) -> None:
    """Each reason once, with the first design that it holds for; the tables have every design."""
    by_reason: dict[str, list[Found]] = {}
    for found in study.designs:
        for reason in found.refused:
            by_reason.setdefault(reason, []).append(found)
    if by_reason:
        count = sum(bool(found.refused) for found in study.designs)
        console.print(f"{count} of {len(study.designs)} designs are refused:")
    for reason, those in by_reason.items():
        values = ", ".join(f"{field} = {_shown(value)}" for field, value in those[0].changes)
        others = f" and {len(those) - 1} more" if len(those) > 1 else ""
        console.print(f"  {values}{others}: {reason}", soft_wrap=True)


def _row(study: Study, number: int, best: bool) -> dict[str, Any]:
    found = study.designs[number]
    return {
        **{field: _plain(value) for field, value in found.changes},
        "columns": list(found.columns),
        **{_UNITS.get(n, n).format(currency=study.currency): v for n, v in found.figures.items()},
        "pareto": best,
        "refused": list(found.refused),
    }


def _csv(rows: Sequence[dict[str, Any]]) -> bytes:
    names = list(dict.fromkeys(name for row in rows for name in row if name != "refused"))
    text = io.StringIO()
    table = csv.DictWriter(text, [*names, "refused"], lineterminator="\n", restval="")
    table.writeheader()
    for row in rows:
        table.writerow({name: _cell(value) for name, value in row.items()})
    return text.getvalue().encode()


def _json(study: Study, rows: Sequence[dict[str, Any]]) -> bytes:
    record = {
        "varied": {axis.field: [_plain(v) for v in axis.values] for axis in study.axes},
        "objectives": {n: "least" if s > 0 else "most" for n, s in OBJECTIVES.items()},
        "currency": study.currency,
        "designs": list(rows),
    }
    return (json.dumps(record, indent=1, ensure_ascii=False) + "\n").encode()


def _cell(value: Any) -> Any:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, list):
        return (
            " | ".join(map(str, value))
            if value and isinstance(value[0], str)
            else " ".join(map(str, value))
        )
    return value


def _plain(value: Any) -> Any:
    return list(map(_plain, value)) if isinstance(value, tuple) else value


def _shown(value: Any) -> str:
    if isinstance(value, tuple):
        return f"[{', '.join(map(_shown, value))}]"
    return f"{value:g}" if isinstance(value, float) else str(value)
