"""`lumitip-fab tolerance`: share of built fingers that meet the goals."""

import argparse
import json
import math
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path

from lumitip_fab.cli.screen import ERR, OUT
from lumitip_fab.config.load import load
from lumitip_fab.config.messages import shown_path
from lumitip_fab.derive import Resolved, resolve
from lumitip_fab.errors import InputError, Problem
from lumitip_fab.solve.goals import Targets, read_goals
from lumitip_fab.solve.judge import MOST_EXPOSURE, exposure_of
from lumitip_fab.tolerance import report
from lumitip_fab.tolerance.options import Goals, Grasp, Options
from lumitip_fab.tolerance.study import study


def run(options: argparse.Namespace) -> int:
    """Run a study of tolerances."""
    asked = _asked(options)
    if options.out:
        report.prepare(options.out)
    resolved = resolve(load(options.file))
    if options.goals:
        asked = replace(asked, exposure=_exposure(options, resolved))
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


def _exposure(options: argparse.Namespace, resolved: Resolved) -> float | None:
    """Exposure of the file against the base of the goals file.

    Raises:
        InputError: if free cells saturate, as a search refuses it.
    """
    exposure = exposure_of(read_goals(options.goals), resolved)
    if exposure is not None and exposure > MOST_EXPOSURE:
        text = (
            f"has {exposure:.2f} times the LED current times pull-up of the base of "
            f"{shown_path(options.goals)}, which saturates free cells; at most {MOST_EXPOSURE:g} "
            "times is tried. Lower emitter.current_ma or receiver.pull_up_ohm."
        )
        raise InputError([Problem(shown_path(options.file), 0, "", text)])
    return exposure


def _asked(options: argparse.Namespace) -> Options:
    """Goals, grasps and sizes of the command.

    Raises:
        InputError: if one is out of its limits, or the goals are in a file and in options.
    """
    sizes = {"fingers": options.fingers, "poses": options.poses, "seed": options.seed}
    own = {"position": options.position, "angle": options.angle, "gap": options.gap}
    written = {name: value for name, value in own.items() if value is not None}
    if options.goals is None:
        usual = Goals.of_both()
        goals = Goals.of_both(
            written.get("position", usual.edge_mm), written.get("angle", usual.edge_deg)
        )
        return Options(goals, (Grasp(written.get("gap", Grasp.gap_mm)),), **sizes)
    if written:
        text = "is in the goals file too: --goals allows no other goal or gap. Remove one of them."
        raise InputError([Problem(f"--{name}", 0, "", text) for name in written])
    return _of_file(options.goals, read_goals(options.goals).targets, sizes)


def _of_file(file: Path, targets: Targets, sizes: dict[str, int]) -> Options:
    """Goals and grasps of a file; a kind of object without a goal is not tried."""
    figures = ("edge_mm", "edge_deg", "cable_mm", "cable_deg")
    goals = Goals(*(targets.errors.get(name, math.inf) for name in figures))
    edges = min(goals.edge_mm, goals.edge_deg) < math.inf
    cables = targets.cables_mm if min(goals.cable_mm, goals.cable_deg) < math.inf else ()
    fitting = [(gap_mm, tuple(d for d in cables if d <= gap_mm)) for gap_mm in targets.gaps_mm]
    grasps = tuple(Grasp(gap_mm, thin, edges) for gap_mm, thin in fitting if thin or edges)
    return Options(goals, grasps, file=shown_path(file), **sizes)
