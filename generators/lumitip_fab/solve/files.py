"""Files of a study: parameter files of its points, figures of its front, and pictures."""

import csv
import io
import json
from pathlib import Path
from typing import Any

import numpy as np
import tomli_w

from lumitip_fab.config.load import Input, written
from lumitip_fab.explore.picture import pictures
from lumitip_fab.explore.vary import Changes
from lumitip_fab.paths import design_folder, packaged_design, resolved
from lumitip_fab.pipeline.manifest import write_file, writing
from lumitip_fab.solve.folder import STUDY, hashes, remove_old, require_own
from lumitip_fab.solve.goals import Task
from lumitip_fab.solve.judge import FIGURES
from lumitip_fab.solve.study import Point, Study, summary
from lumitip_fab.text import LONGEST

_SIZE_IN = (9.0, 4.2)
_BASE, _BEST = "#888888", "#1f6fb2"
_SECTOR_DEG = 15.0


def write(found: Study, folder: Path) -> list[Path]:
    """Write a study.

    Returns:
        Its files: `point-N.toml`, `study.json`, `front.csv`, and pictures.

    Raises:
        OutputError: if a file cannot be written, or a user's would be lost, see `require_own`.
    """
    files = {
        f"{point.name}.toml": parameter_file(found.task, point).encode()
        for point in found.points[1:]
    }
    parts = catalogue(found.task.base)
    require_own(folder, parts)
    if design_folder(found.task.base.sources[0].path) != resolved(folder):
        files |= parts
    record = {**summary(found), "files": hashes(files)}
    files[STUDY] = (json.dumps(record, indent=1, ensure_ascii=False) + "\n").encode()
    files["front.csv"] = _front(found)
    files |= _drawn(found)
    with writing(folder):
        remove_old(folder, {*files, *parts})
        for name, data in files.items():
            write_file(folder / name, data)
    return [folder / name for name in files]


def parameter_file(task: Task, point: Point) -> str:
    """The complete parameter file of a point: that of the base, with the point's values."""
    table = written(task.base)
    for field, value in _values(task, point.judged.changes):
        section, key = field.split(".")
        table.setdefault(section, {})[key] = value
    table["name"] = f"{table['name'][: LONGEST - len(point.name) - 1].strip()} {point.name}"
    changes = ", ".join(f"{f} = {v}" for f, v in _values(task, point.judged.changes))
    head = (
        f"# {point.name} of a search with lumitip-fab design: {changes}.\n"
        "# All other values are those of the file that was varied; study.json has the figures.\n\n"
    )
    return head + tomli_w.dumps(table)


def _values(task: Task, changes: Changes) -> Changes:
    """All values that differ from the base's file: fixed ones, those of the point, and columns
    that follow the pitch."""
    columns = list(task.design(changes).parameters.grid.columns)
    own = task.joined(changes)
    return (*task.fixed, *own, *((("grid.columns", columns),) if task.keep_size else ()))


def catalogue(base: Input) -> dict[str, bytes]:
    """The parts of a design folder that has its own: the points need them beside them."""
    folder = design_folder(base.sources[0].path)
    if folder.resolve() == packaged_design().resolve():
        return {}
    return {f"parts/{f.name}": f.read_bytes() for f in sorted(folder.glob("parts/*.toml"))}


def _front(found: Study) -> bytes:
    """`front.csv`: every design of the front, the least error first."""
    fields = [axis.field for axis in found.task.axes]
    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow([*fields, "columns", *FIGURES])
    for one in found.search.front:
        values = dict(one.changes)
        columns = " ".join(map(str, one.columns))
        figures = (one.figures.get(name, "") for name in FIGURES)
        rows.writerow([*(values[field] for field in fields), columns, *figures])
    return text.getvalue().encode()


def _drawn(found: Study) -> dict[str, bytes]:
    """`front` and `directions`, as SVG and PNG."""
    from matplotlib.figure import Figure

    files: dict[str, bytes] = {}
    for name, draw in (("front", _draw_front), ("directions", _draw_directions)):
        figure = Figure(figsize=_SIZE_IN, layout="constrained")
        draw(found, figure)
        files |= pictures(figure, name)
    return files


def _draw_front(found: Study, figure: Any) -> None:
    axes = figure.subplots(1, 2, sharey=True)
    currency = found.task.base.catalogue.prices.currency
    headings = {"cost": f"parts and boards ({currency})", "current_ma": "LED current (mA)"}
    allowed = [one.figures for one in found.search.designs if one.allowed]
    front = [one.figures for one in found.search.front]
    for axis, (name, heading) in zip(axes, headings.items(), strict=True):
        for rows, style in (
            (allowed, {"s": 14, "color": "#bbbbbb", "label": "design within all limits"}),
            (front, {"s": 40, "color": _BEST, "label": "front"}),
            (
                [found.search.base.figures],
                {"s": 60, "color": "#c0392b", "marker": "x", "label": "base"},
            ),
        ):
            axis.scatter([r[name] for r in rows], [r["error"] for r in rows], **style)
        axis.axhline(1.0, color="#2a7f3f", lw=1.0, ls="--", label="goals")
        axis.set_xlabel(heading)
        axis.grid(alpha=0.25)
        axis.margins(0.1)
    axes[0].set_ylabel("expected error, largest in units of its goal")
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=4, frameon=False)


def _draw_directions(found: Study, figure: Any) -> None:
    """Expected error of the position by direction of the line: where a grid sees badly."""
    axes = figure.subplots(1, 2, sharey=True)
    shown = [(found.points[0], _BASE), *((p, _BEST) for p in found.points[1:2])]
    for axis, kind in zip(axes, ("edges", "cables"), strict=True):
        for point, colour in shown:
            rows = getattr(point.expected, kind)
            if not rows.size:
                continue
            angles = np.resize(point.expected.directions_deg, len(rows))
            at, error = _by_direction(angles, rows[:, 0])
            axis.plot(at, error, color=colour, marker="o", ms=4, label=point.name)
        axis.set_title(kind)
        axis.set_xlabel("direction of the line (°), 0 is across the finger")
        axis.set_xticks(range(-90, 91, 30))
        axis.set_ylim(bottom=0.0)
        axis.grid(alpha=0.25)
    axes[0].set_ylabel("expected error, rms (mm)")
    axes[0].legend(frameon=False)


def _by_direction(angles_deg: Any, errors: Any) -> tuple[Any, Any]:
    """Middles of sectors of direction (degrees), and the rms error in each."""
    sector = np.round(np.asarray(angles_deg) / _SECTOR_DEG).astype(int)
    middles = np.unique(sector)
    values = [float(np.sqrt(np.mean(errors[sector == one] ** 2))) for one in middles]
    return _SECTOR_DEG * middles, np.array(values)
