"""Table, figures and plots of the bench of the tasks."""

import json
import math
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path

from lumitip.tasks.bench import Result

_NAMES = {
    "centre": "dark centre (published)", "line": "line angle", "pose": "line angle, pose estimator"
}  # fmt: skip
_FEW = 0.05
_TITLES = {"cloth": "edge of a cloth", "cable": "cable", "corner": "cloth up to its corner"}


def write(results: Sequence[Result], folder: Path) -> list[Path]:
    """Write `tasks.md` and `tasks.json`, and `tasks.svg` where matplotlib is installed.

    Returns:
        What was written.
    """
    folder.mkdir(parents=True, exist_ok=True)
    table, figures = folder / "tasks.md", folder / "tasks.json"
    table.write_text(markdown(results), encoding="utf-8")
    text = json.dumps(_plain([asdict(r) for r in results]), indent=1, sort_keys=True)
    figures.write_text(text + "\n", encoding="utf-8")
    written = [table, figures]
    try:
        import matplotlib  # noqa: F401
    except ImportError:
        return written
    return [*written, _plot(results, folder / "tasks.svg")]


def markdown(results: Sequence[Result]) -> str:
    """The table."""
    lines = [
        "Simulated closed loop, no hardware. Errors are those at the speed of at most "
        f"{100.0 * _FEW:g} % loss.",
        "",
        "| task | controller | K_p, K_θ (1/s) | no loss up to | at most "
        f"{100.0 * _FEW:g} % loss up to | lateral rms | angle rms | corner rms |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for r in results:
        sure, at = r.fastest(), r.fastest(_FEW)
        turn = "–" if r.controller == "centre" else f"{r.tuning.turn_per_s:g}"
        cells = [_TITLES[r.task], _NAMES[r.controller], f"{r.tuning.gain_per_s:g}, {turn}"]
        cells += [f"{row.speed_mm_s:.0f} mm/s" if row else "–" for row in (sure, at)]
        cells += ["–"] * 3 if at is None else [
            f"{at.lateral_rms_mm:.2f} mm", f"{at.angle_rms_deg:.1f}°",
            "–" if math.isnan(at.corner_rms_mm) else f"{at.corner_rms_mm:.2f} mm",
        ]  # fmt: skip
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def _plain(told: object) -> object:
    """NaN has no place in JSON."""
    if isinstance(told, dict):
        return {k: _plain(v) for k, v in told.items()}
    if isinstance(told, list | tuple):
        return [_plain(v) for v in told]
    return None if isinstance(told, float) and math.isnan(told) else told


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
                speeds, [100.0 * row.loss_rate for row in r.rows], "o-", ms=3,
                label=_NAMES[r.controller],
            )  # fmt: skip
            axes[1][column].plot(speeds, [row.lateral_rms_mm for row in r.rows], "o-", ms=3)
        axes[0][column].set_title(_TITLES[task])
        axes[1][column].set_xlabel("speed (mm/s)")
        for row in (0, 1):
            axes[row][column].grid(alpha=0.3)
            axes[row][column].set_ylim(bottom=0.0)
    axes[0][0].set_ylabel("curves lost (%)")
    axes[1][0].set_ylabel("lateral rms (mm)")
    handles, labels = axes[0][0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3, frameon=False)
    with rc_context({"svg.hashsalt": "tasks", "svg.fonttype": "none"}):
        figure.savefig(path, metadata={"Date": None})
    return path
