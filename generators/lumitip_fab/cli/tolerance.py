"""`lumitip-fab tolerance`: share of built fingers that meet the goals."""

import argparse
import json
import math
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path
from typing import Any

from lumitip_fab.cli.screen import ERR, OUT
from lumitip_fab.config.load import load
from lumitip_fab.config.messages import shown_path
from lumitip_fab.derive import Resolved, resolve
from lumitip_fab.errors import InputError, Problem
from lumitip_fab.solve.goals import Targets, Task, read_goals
from lumitip_fab.solve.judge import MOST_EXPOSURE, Reference, exposure_of
from lumitip_fab.tolerance import report
from lumitip_fab.tolerance.options import Goals, Grasp, Options
from lumitip_fab.tolerance.study import study


def run(options: argparse.Namespace) -> int:
    """Run a study of tolerances."""
    task = read_goals(options.goals) if options.goals else None
    asked = _asked(options, task)
    if options.out:
        report.prepare(options.out)
    resolved = resolve(load(options.file))
    if task:
        asked = _exposed(asked, task, options.file, resolved)
    silent = options.quiet or options.json
    with nullcontext() if silent else ERR.status("building and trying fingers …"):
        found = study(resolved.config, resolved.design.layout, asked)
    written = report.write(found, options.out) if options.out else []
    if options.json:
        print(json.dumps(found, indent=1, ensure_ascii=False))
    elif not options.quiet:
        report.print_tables(found, OUT)
        if written:
            OUT.print("wrote " + ", ".join(map(str, written)), soft_wrap=True)
    return 0


def _exposed(asked: Options, task: Task, file: Path, resolved: Resolved) -> Options:
    """Settings with the exposure of a design against the base of the goals file.

    Raises:
        InputError: if free cells saturate, as a search refuses it.
    """
    reference = Reference.of(task)
    exposure = exposure_of(task, reference, resolved)
    if exposure is not None and exposure > MOST_EXPOSURE:
        text = (
            f"has {exposure:.2f} times the LED current times pull-up of {reference}, which "
            f"saturates free cells; at most {MOST_EXPOSURE:g} times is tried. Lower "
            "emitter.current_ma or receiver.pull_up_ohm."
        )
        raise InputError([Problem(shown_path(file), 0, "", text)])
    return replace(asked, exposure=exposure, against=str(reference))


def _asked(options: argparse.Namespace, task: Task | None) -> Options:
    """Goals, grasps and sizes of the command.

    Raises:
        InputError: if one is out of its limits, or the goals are in a file and in options.
    """
    sizes: dict[str, Any] = {
        "fingers": options.fingers,
        "poses": options.poses,
        "seed": options.seed,
    }
    own = {"position": options.position, "angle": options.angle, "gap": options.gap}
    written = {name: value for name, value in own.items() if value is not None}
    if task is None:
        usual = Goals.of_both()
        goals = Goals.of_both(
            written.get("position", usual.edge_mm), written.get("angle", usual.edge_deg)
        )
        return Options(goals, (Grasp(written.get("gap", Grasp.gap_mm)),), **sizes)
    if written:
        text = "is in the goals file too: --goals allows no other goal or gap. Remove one of them."
        raise InputError([Problem(f"--{name}", 0, "", text) for name in written])
    return _of_file(options.goals, task.targets, sizes)


def _of_file(file: Path, targets: Targets, sizes: dict[str, Any]) -> Options:
    """Goals and grasps of a file; a kind of object without a goal is not tried."""
    figures = ("edge_mm", "edge_deg", "cable_mm", "cable_deg")
    goals = Goals(*(targets.errors.get(name, math.inf) for name in figures))
    edges = min(goals.edge_mm, goals.edge_deg) < math.inf
    cables = targets.cables_mm if min(goals.cable_mm, goals.cable_deg) < math.inf else ()
    fitting = [(gap_mm, tuple(d for d in cables if d <= gap_mm)) for gap_mm in targets.gaps_mm]
    grasps = tuple(Grasp(gap_mm, thin, edges) for gap_mm, thin in fitting if thin or edges)
    return Options(goals, grasps, file=shown_path(file), **sizes)
