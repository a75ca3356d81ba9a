"""Tables, figures and plots of the benchmark of all tasks."""

import json
import math
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path

from lumitip.tasks.bench import Advantage, Result, advantages

FILES = ("tasks.md", "tasks.json", "tasks.svg")
FASTER = 3.0
"""Goal for the speed with the line's angle, in times that of the published law, without loss."""
FEW = 0.05
"""Share of lost curves for a second comparison."""
_NAMES = {
    "centre": "dark centre (published)",
    "line": "line angle",
    "pose": "line angle, pose estimator",
}
_TITLES = {"cloth": "edge of a cloth", "cable": "cable", "corner": "cloth up to its corner"}


def prepare(folder: Path) -> None:
    """Make the folder of the results.

    Raises:
        OSError: if a file of them cannot be written there.
    """
    folder.mkdir(parents=True, exist_ok=True)
    for name in FILES:
        file = folder / name
        is_new = not file.exists()
        file.open("ab").close()
        if is_new:
            file.unlink()


def write(results: Sequence[Result], folder: Path) -> list[Path]:
    """Write `tasks.md` and `tasks.json`, and `tasks.svg` if matplotlib is installed.

    Args:
        results: of all tasks.
        folder: made if it does not exist.

    Returns:
        The written files.
    """
    prepare(folder)
    table, figures, plot = (folder / name for name in FILES)
    table.write_text(markdown(results), encoding="utf-8")
    text = json.dumps(_plain([asdict(r) for r in results]), indent=1, sort_keys=True)
    figures.write_text(text + "\n", encoding="utf-8")
    written = [table, figures]
    try:
        import matplotlib  # noqa: F401
    except ImportError:
        return written
    return [*written, _plot(results, plot)]


def markdown(results: Sequence[Result]) -> str:
    """Tuning of each controller, its top speed, and every speed that was tried."""
    return (
        "Simulated closed loop, no hardware; rms figures are of the curves that were kept.\n\n"
        + "\n".join([*_tunings(results), "", *_speeds(results), "", *_rows(results)])
        + "\n"
    )


def goals(results: Sequence[Result]) -> list[tuple[bool, str]]:
    """Whether each goal was met, and its text: the line's angle against the published law.

    The goal is for no loss and the same processing, so that only the law differs; the figures at
    few losses are added without a goal.
    """
    few = {(a.task, a.controller): a for a in advantages(results, FEW)}
    return [
        (
            a.times >= FASTER,
            f"{_TITLES[a.task]}: line angle {_told(a)} times as fast as the "
            f"published law at no loss (goal: at least {FASTER:g}); at most {100.0 * FEW:g} % "
            f"loss: {_told(few[a.task, a.controller])} times",
        )
        for a in advantages(results)
        if a.controller == "line"
    ]


def _told(advantage: Advantage) -> str:
    if math.isnan(advantage.times):
        return "–"
    speeds = f"{advantage.speed_mm_s:.0f} against {advantage.published_mm_s:.0f} mm/s"
    return f"{advantage.times:.1f} ({speeds})"


def _table(head: str, rows: Sequence[Sequence[str]]) -> list[str]:
    names = head.split(", ")
    lines = [f"| {' | '.join(cells)} |" for cells in (names, *rows)]
    return [lines[0], "|" + "---|" * len(names), *lines[1:]]


def _tunings(results: Sequence[Result]) -> list[str]:
    rows = []
    for r in results:
        tuned, tuning = r.tuned, r.tuned.tuning
        kept = (
            ["–", "–", f"{tuning.height_mm:+.2f} mm"]
            if r.controller == "centre"
            else [f"{tuning.turn_per_s:g}/s", f"{tuning.lead_s:g} s", "–"]
        )
        tried = [str(tuned.tried), f"{tuned.losses} at {tuned.speed_mm_s:g} mm/s"]
        cells = [_TITLES[r.task], _NAMES[r.controller], f"{tuning.gain_per_s:.3g}/s", *kept, *tried]
        rows.append([*cells, ", ".join(tuned.at_edge) or "–"])
    head = "task, controller, K_p, K_θ, lead, height, tried, lost, best at the edge"
    return _table(head, rows)


def _speeds(results: Sequence[Result]) -> list[str]:
    rows = []
    times = {
        (a.task, a.controller, a.loss_rate): a.times
        for rate in (0.0, FEW)
        for a in advantages(results, rate)
    }
    for r in results:
        cells = [_TITLES[r.task], _NAMES[r.controller]]
        for rate in (0.0, FEW):
            row = r.fastest(rate)
            faster = times.get((r.task, r.controller, rate), math.nan)
            cells += [f"{row.speed_mm_s:.0f} mm/s" if row else "–", _figure(faster, 1, "")]
        rows.append(cells)
    few = f"at most {100.0 * FEW:g} % loss up to"
    return _table(f"task, controller, no loss up to, times, {few}, times", rows)


def _rows(results: Sequence[Result]) -> list[str]:
    rows = [
        [
            _TITLES[r.task],
            _NAMES[r.controller],
            f"{row.speed_mm_s:.0f} mm/s",
            f"{row.losses} of {row.trials}",
            _figure(row.lateral_rms_mm, 2, " mm"),
            _figure(row.angle_rms_deg, 1, "°"),
            _figure(row.corner_rms_mm, 2, " mm"),
        ]
        for r in results
        for row in r.rows
    ]
    return _table("task, controller, speed, lost, lateral rms, angle rms, corner rms", rows)


def _figure(value: float, digits: int, unit: str) -> str:
    return "–" if math.isnan(value) else f"{value:.{digits}f}{unit}"


def _plain(value: object) -> object:
    """A value for JSON, with `null` for NaN."""
    if isinstance(value, dict):
        return {k: _plain(v) for k, v in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(v) for v in value]
    return None if isinstance(value, float) and math.isnan(value) else value


def _plot(results: Sequence[Result], path: Path) -> Path:
    from matplotlib import rc_context
    from matplotlib.figure import Figure

    tasks = list(dict.fromkeys(r.task for r in results))
    figure = Figure(figsize=(3.6 * len(tasks), 5.2), layout="constrained")
    axes = figure.subplots(2, len(tasks), sharex="col", sharey="row", squeeze=False)
    for column, task in enumerate(tasks):
        for r in (r for r in results if r.task == task):
            speeds = [row.speed_mm_s for row in r.rows]
            axes[0][column].plot(
                speeds,
                [100.0 * row.loss_rate for row in r.rows],
                "o-",
                ms=3,
                label=_NAMES[r.controller],
            )
            axes[1][column].plot(speeds, [row.lateral_rms_mm for row in r.rows], "o-", ms=3)
        axes[0][column].set_title(_TITLES[task])
        axes[1][column].set_xlabel("speed (mm/s)")
        for row in (0, 1):
            axes[row][column].grid(alpha=0.3)
    axes[0][0].set_ylim(bottom=-1.0)  # all columns share it; whole dots at no loss
    axes[1][0].set_ylim(bottom=0.0)
    axes[0][0].set_ylabel("curves lost (%)")
    axes[1][0].set_ylabel("lateral rms (mm)")
    handles, labels = axes[0][0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3, frameon=False)
    with rc_context({"svg.hashsalt": "tasks", "svg.fonttype": "none"}):
        figure.savefig(path, metadata={"Date": None})
    return path
