"""A study of tolerances as tables, as JSON, and as a picture."""

import io
import json
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table

from lumitip_fab.errors import OutputError
from lumitip_fab.pipeline.manifest import write_file
from lumitip_fab.tolerance.estimate import MOST_DEG, MOST_MM
from lumitip_fab.tolerance.options import GOOD_PERCENT
from lumitip_fab.tolerance.study import LEAST_DRAWS

_DOTS_PER_INCH = 150
_SHOWN = 6  # tolerances in the terminal; the files have all
_DIM = 0.5  # exposure that is much less than that of the base
_FIGURES = ("position", "angle")
_NO_INDICES = (
    f"No Sobol indices: they need {LEAST_DRAWS} draws or more. Use --fingers {2 * LEAST_DRAWS} or "
    "more."
)
OPTIMISTIC = (
    "Optimistic: self-calibration learns in the gap and with the drift that it is tested with, "
    "fits begin near the true pose or at the bank's, and frames that PoseEstimator flags as "
    "ambiguous count as found."
)
_UNITS = {"mm": " mm", "deg": "°", "share": " %"}


def print_tables(study: dict[str, Any], console: Console) -> None:
    """Print yield, errors, and the tolerances that matter most."""
    table = Table(
        title=f"{study['fingers']} built pairs of fingers, {_tried(study)}; {study['evidence']}",
        caption=f"Fingers are tried at {study['poses']['sets']} sets of poses in turn; intervals "
        "are as wide as differences between these make them.",
    )
    table.add_column("")
    for heading in ("good", "95 % interval", "gross errors", "edge mm, °", "cable mm, °"):
        table.add_column(heading, justify="right")
    for name, column in study["columns"].items():
        low, high = column["yield_95"]
        edge, cable = (
            f"{column[f'{kind}_mm']['95']:.2f}, {column[f'{kind}_deg']['95']:.1f}"
            if f"{kind}_mm" in column
            else "not tried"
            for kind in ("edge", "cable")
        )
        interval = f"{100 * low:.0f} to {100 * high:.0f} %"
        good, gross = f"{100 * column['yield']:.1f} %", f"{100 * column['gross_errors']:.2f} %"
        table.add_row(name, good, interval, gross, edge, cable)
    console.print(table)
    console.print(
        f"Good: rms errors of {goals_text(study['goals'])} or less, and no gross error "
        f"({MOST_MM:g} mm or {MOST_DEG:g}°). Errors: 95 % of the fingers have less, "
        "rms over their poses.",
        soft_wrap=True,
    )
    if "exposure" in study:
        console.print(_exposure_line(study["exposure"], study["exposure_against"]), soft_wrap=True)
    console.print(mask_line(study["mask_shift"]), soft_wrap=True)
    if study["sobol_draws"]:
        console.print(_sensitive(study))
    else:
        console.print(_NO_INDICES, soft_wrap=True)
    compared = study["pose_estimator"]
    console.print(
        "Frames are estimated many at once. PoseEstimator gives the same pose in "
        f"{compared['agree_percent']:.0f} % of {compared['frames']:.0f} frames after a tare, and "
        f"flags {compared['ambiguous_percent']:.0f} % as ambiguous.",
        soft_wrap=True,
    )
    console.print(OPTIMISTIC, soft_wrap=True)


def _tried(study: dict[str, Any]) -> str:
    """What each pair of fingers was tried with."""
    poses, tried = study["poses"], []
    for grasp in study["grasps"]:
        objects = [f"{poses['edge']} edges"] if grasp["edges"] else []
        if diameters := [f"{diameter_mm:g}" for diameter_mm in grasp["cables_mm"]]:
            each = " each" * (len(diameters) > 1)
            objects.append(f"{poses['cable']} cables of {', '.join(diameters)} mm{each}")
        tried.append(f"gap {grasp['gap_mm']:g} mm: {', '.join(objects)}")
    return "; ".join(tried)


def _exposure_line(exposure: float | None, against: str) -> str:
    """LED current times pull-up of the design, against that of the goals file's base."""
    if exposure is None:
        return (
            f"Exposure: not known, since LED or photodetector are not those of {against}; 1 was "
            "taken."
        )
    line = f"Exposure: LED current times pull-up is {exposure:.2f} times that of {against}"
    if exposure > _DIM:
        return f"{line}."
    return (
        f"{line}, which is taken as well exposed: noise counts {1 / exposure:.1f} times as much. "
        "If this design's pull-up was chosen for the light of its cells, name goals with a base "
        "of the same circuit."
    )


def goals_text(goals: dict[str, float]) -> str:
    """Goals in words, as in `0.6 mm and 2.5°`, or for edges and cables apart."""
    by_kind = {
        kind: " and ".join(
            f"{goals[f'{kind}_{unit}']:g}{sign}"
            for unit, sign in (("mm", " mm"), ("deg", "°"))
            if f"{kind}_{unit}" in goals
        )
        for kind in ("edge", "cable")
    }
    if by_kind["edge"] == by_kind["cable"]:
        return by_kind["edge"]
    return ", ".join(f"{text} ({kind}s)" for kind, text in by_kind.items() if text)


def mask_line(shift: dict[str, Any]) -> str:
    """How far both masks may be off, from `mask_shift` of a study."""
    low, high = (100 * end for end in shift["yield_95"])
    good = f"{100 * shift['yield']:.0f} % of {shift['fingers']} fingers"
    interval = f"95 % interval {low:.0f} to {high:.0f} %"
    if shift["mm"] is None:
        return (
            f"Even with every mask in its place fewer than {GOOD_PERCENT:g} % are good after a "
            f"tare: {good} ({interval})."
        )
    more = " or more" if shift["or_more"] else ""
    return (
        f"Both masks may be off by {shift['mm']:g} mm{more} against their fingers, in any "
        f"direction: {good} are then good after a tare ({interval}), with their other deviations. "
        f"With less it is {GOOD_PERCENT:g} % or more."
    )


def _sensitive(study: dict[str, Any]) -> Table:
    table = Table(
        title="tolerances that matter most, by their total Sobol index after a tare "
        f"(± standard deviation, n = {study['sobol_draws']})"
    )
    for heading in ("tolerance", "spread", "position", "angle", "level", "measure"):
        table.add_column(heading, justify="right" if heading in ("spread", *_FIGURES) else "left")
    for name, entry in list(study["tolerances"].items())[:_SHOWN]:
        exact = study["yield_if_exact"].get(name)
        by = "" if exact is None else f" (if exact: {100 * exact:.1f} % good)"
        times = 100.0 if entry["unit"] == "share" else 1.0
        table.add_row(
            entry["title"],
            f"{times * entry['spread']:.3g}{_UNITS[entry['unit']]}",
            *(_index(entry, figure) for figure in _FIGURES),
            entry["confidence"],
            entry["measure"] + by,
        )
    return table


def _index(entry: dict[str, Any], figure: str) -> str:
    return f"{entry['total'][figure]:.2f} ± {entry['total_sd'][figure]:.2f}"


def prepare(folder: Path) -> None:
    """Create the folder of the files, and test that it can be written.

    Raises:
        OutputError: if it cannot be created or written.
    """
    with _writing(folder):
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            pass


@contextmanager
def _writing(folder: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        raise OutputError(
            f"--out: is {folder}, which cannot be written ({error.strerror}); a folder that can be "
            "written is allowed, and is created where it does not exist. Choose another folder."
        ) from error


def write(study: dict[str, Any], folder: Path) -> list[Path]:
    """Write `tolerance.json` and `tolerance.png`; the same bytes for the same study.

    Returns:
        What was written.

    Raises:
        OutputError: if the folder cannot be written.
    """
    text = json.dumps(study, indent=1, ensure_ascii=False) + "\n"
    files = {"tolerance.json": text.encode(), "tolerance.png": picture(study)}
    with _writing(folder):
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
    columns = study["columns"]
    good = 100.0 * np.array([column["yield"] for column in columns.values()])
    ends = 100.0 * np.array([column["yield_95"] for column in columns.values()])
    whiskers = np.abs(ends.T - good)
    names = [name.replace(" ", "\n", 1) for name in columns]
    left.bar(names, good, yerr=whiskers, capsize=5, color="#4c78a8", width=0.6)
    for place, (share, top) in enumerate(zip(good, ends[:, 1], strict=True)):
        left.text(place, top + 1.0, f"{share:.1f}", ha="center")
    left.set(ylim=(0.0, 110.0), yticks=range(0, 101, 20))
    left.set_ylabel(f"good fingers (%): {goals_text(study['goals'])}")
    entries = [entry for entry in study["tolerances"].values() if "total" in entry]
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
    right.set_xlabel(
        f"total Sobol index after a tare, ± standard deviation, n = {study['sobol_draws']}"
    )
    if entries:
        right.invert_yaxis()
        right.legend(frameon=False, loc="lower right")
    else:
        right.set(xticks=[])
        right.set_xlabel(_NO_INDICES)
    for axis in (left, right):
        axis.spines[["top", "right"]].set_visible(False)
    figure.suptitle(f"{study['design']}: {study['fingers']} built pairs, {study['evidence']}")
    written = io.BytesIO()
    figure.savefig(written, format="png", metadata={"Software": None}, dpi=_DOTS_PER_INCH)
    return written.getvalue()
