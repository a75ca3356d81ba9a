"""A study of tolerances as tables, as JSON, and as a picture."""

import io
import json
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table

from lumitip_fab.pipeline.manifest import write_file

_DOTS_PER_INCH = 150
_SHOWN = 6  # tolerances in the terminal; the files have all
_FIGURES = ("position", "angle")
_UNITS = {"mm": " mm", "deg": "°", "share": " %"}


def print_tables(study: dict[str, Any], console: Console) -> None:
    """Print yield, errors, and the tolerances that matter most."""
    goals, mask = study["goals"], study["mask_shift_mm"]
    table = Table(
        title=f"{study['fingers']} built pairs of fingers, {study['poses']['edge']} edges and "
        f"{study['poses']['cable']} cables each, gap {study['gap_mm']:g} mm; "
        f"{study['evidence']}"
    )
    table.add_column("")
    for heading in ("good", "95 % interval", "edge mm, °", "cable mm, °"):
        table.add_column(heading, justify="right")
    for name, column in study["columns"].items():
        low, high = column["yield_95"]
        edge, cable = (
            f"{column[f'{kind}_mm']['95']:.2f}, {column[f'{kind}_deg']['95']:.1f}"
            for kind in ("edge", "cable")
        )
        interval = f"{100 * low:.0f} to {100 * high:.0f} %"
        table.add_row(name, f"{100 * column['yield']:.1f} %", interval, edge, cable)
    console.print(table)
    console.print(
        f"Good: rms errors within {goals['position_mm']:g} mm and {goals['angle_deg']:g}°. "
        "Errors: 95 % of the fingers have less, rms over their poses.",
        soft_wrap=True,
    )
    console.print(_mask_line(mask), soft_wrap=True)
    console.print(_sensitive(study))
    compared = study["pose_estimator"]
    console.print(
        "Frames are estimated many at once. PoseEstimator gives the same pose in "
        f"{compared['agree_percent']:.0f} % of {compared['frames']:.0f} frames after a tare, and "
        f"flags {compared['ambiguous_percent']:.0f} % as ambiguous.",
        soft_wrap=True,
    )


def _mask_line(mask_mm: float | None) -> str:
    if mask_mm is None:
        return "Fewer than 95 % of the fingers are good even with every mask in its place."
    return (
        f"Each mask may be {mask_mm:g} mm off: 95 % of the fingers are then good after a tare, all "
        "else as it is made."
    )


def _sensitive(study: dict[str, Any]) -> Table:
    table = Table(title="tolerances that matter most, by their total Sobol index after a tare")
    for heading in ("tolerance", "spread", "position", "angle", "level", "measure"):
        table.add_column(heading, justify="right" if heading in ("spread", *_FIGURES) else "left")
    for name, entry in list(study["tolerances"].items())[:_SHOWN]:
        exact = study["yield_if_exact"].get(name)
        by = "" if exact is None else f" (if exact: {100 * exact:.1f} % good)"
        times = 100.0 if entry["unit"] == "share" else 1.0
        table.add_row(
            entry["title"],
            f"{times * entry['spread']:.3g}{_UNITS[entry['unit']]}",
            *(f"{entry['total'][figure]:.2f}" for figure in _FIGURES),
            entry["confidence"],
            entry["measure"] + by,
        )
    return table


def write(study: dict[str, Any], folder: Path) -> list[Path]:
    """Write `tolerance.json` and `tolerance.png`; the same bytes for the same study.

    Returns:
        What was written.

    Raises:
        OutputError: if the folder cannot be written.
    """
    text = json.dumps(study, indent=1, ensure_ascii=False) + "\n"
    files = {"tolerance.json": text.encode(), "tolerance.png": picture(study)}
    for name, data in files.items():
        write_file(folder / name, data)
    return [folder / name for name in files]


def picture(study: dict[str, Any]) -> bytes:
    """Yield and sensitivities, as PNG."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10.5, 5.0), layout="constrained")
    FigureCanvasAgg(figure)
    left, right = figure.subplots(1, 2, width_ratios=(1.0, 1.9))
    goals, columns = study["goals"], study["columns"]
    good = 100.0 * np.array([column["yield"] for column in columns.values()])
    ends = 100.0 * np.array([column["yield_95"] for column in columns.values()])
    whiskers = np.abs(ends.T - good)
    names = [name.replace(" ", "\n", 1) for name in columns]
    left.bar(names, good, yerr=whiskers, capsize=5, color="#4c78a8", width=0.6)
    for place, (share, top) in enumerate(zip(good, ends[:, 1], strict=True)):
        left.text(place, top + 1.0, f"{share:.1f}", ha="center")
    left.set(ylim=(0.0, 110.0), yticks=range(0, 101, 20))
    left.set_ylabel(
        f"good fingers (%): {goals['position_mm']:g} mm, {goals['angle_deg']:g}°, rms over poses"
    )
    entries = list(study["tolerances"].values())
    rows = np.arange(len(entries))
    for shift, figures, colour in zip((-0.2, 0.2), _FIGURES, ("#4c78a8", "#f58518"), strict=True):
        right.barh(
            rows + shift,
            [entry["total"][figures] for entry in entries],
            0.38,
            xerr=[entry["total_sd"][figures] for entry in entries],
            color=colour,
            ecolor="#555555",
            label=figures,
        )
    right.set(yticks=rows, yticklabels=[entry["title"] for entry in entries])
    right.invert_yaxis()
    right.set_xlabel("total Sobol index of the error after a tare, ± standard deviation")
    right.legend(frameon=False, loc="lower right")
    for axis in (left, right):
        axis.spines[["top", "right"]].set_visible(False)
    figure.suptitle(f"{study['design']}: {study['fingers']} built pairs, {study['evidence']}")
    written = io.BytesIO()
    figure.savefig(written, format="png", metadata={"Software": None}, dpi=_DOTS_PER_INCH)
    return written.getvalue()
