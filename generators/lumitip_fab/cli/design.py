"""`lumitip-fab design`: search the design that meets goals."""

import argparse
from pathlib import Path

from rich.console import Console
from rich.table import Table

from lumitip_fab.checks.run import run_checks
from lumitip_fab.cli.build import build
from lumitip_fab.cli.limits import SEEDS, require_in_range
from lumitip_fab.cli.screen import ERR, FAILED, OUT, counted
from lumitip_fab.config.load import Input
from lumitip_fab.errors import FabError
from lumitip_fab.explore.accuracy import Sample
from lumitip_fab.solve import files
from lumitip_fab.solve.confirm import EVIDENCE
from lumitip_fab.solve.folder import STUDY, outdated, require_own
from lumitip_fab.solve.goals import read_goals
from lumitip_fab.solve.holes import FIELD
from lumitip_fab.solve.judge import excesses
from lumitip_fab.solve.study import MOST_GROSS_PERCENT, Options, Study, study

_LONG = 8  # numbers
_REASONS = 5  # why designs are refused
_LIMITS = {"designs": (8, 100_000), "points": (1, 50), "seed": SEEDS}


def run(options: argparse.Namespace) -> int:
    """Search, write the study, and build its points if asked for."""
    require_in_range(options, _LIMITS)
    task = read_goals(options.goals)
    asked = Options(options.designs, options.points, options.seed, Sample(seed=options.seed))
    silent = options.quiet or options.json
    require_own(options.out, files.catalogue(task.base))
    with counted("designs", silent) as progress:
        found = study(task, options.out, asked, options.scheduler, progress)
    written = files.write(found, options.out)
    if options.json:
        print((options.out / "study.json").read_text(encoding="utf-8"), end="")
    elif not options.quiet:
        print_study(found, OUT)
        OUT.print("wrote " + ", ".join(map(str, written)), soft_wrap=True)
    failed = not found.search.front
    if failed and silent:
        why = "no design keeps all limits" if found.nearest else "every design is refused"
        ERR.print(f"{options.goals}: {why}: see {options.out / STUDY}", soft_wrap=True)
    for point in found.points[1:] if options.build else ():
        failed |= _fails(options.out / point.name, silent)
    for folder in outdated(options.out):
        ERR.print(
            f"{folder}: is not built of a point-N.toml that is here now: remove the folder, or "
            "build it again",
            soft_wrap=True,
        )
    return FAILED if failed else 0


def _fails(folder: Path, silent: bool) -> bool:
    """Build a point and check it; whether a check fails."""
    try:
        build(folder.with_suffix(".toml"), folder)
        outcome = run_checks(folder)
    except FabError as error:
        ERR.print(f"{folder}: not built and checked: {error}", soft_wrap=True)
        return True
    if not silent:
        failed = ", ".join(sorted({m.check for m in outcome.failed}))
        result = f"fails {failed}" if failed else f"passes {len(outcome.names)} checks"
        OUT.print(f"{folder}: built, {result}", soft_wrap=True)
    return bool(outcome.failed)


def print_study(found: Study, console: Console) -> None:
    """Print the points, and what no design met."""
    search, targets = found.search, found.task.targets
    how = "all" if search.complete else f"of {found.task.designs}"
    table = Table(
        title=f"{len(search.designs)} designs judged ({how}), {search.evaluated} of them now",
        caption=f"errors: expected / of the estimator ({EVIDENCE}); rms over all grasps",
    )
    some = found.task.joined(tuple((axis.field, axis.values[0]) for axis in found.task.axes))
    fields = [field for field, _ in some]
    errors = ("edge mm", "edge °", "cable mm", "cable °", "gross %")
    for heading in ("", *fields, *errors, "cost", "LEDs mA"):
        table.add_column(heading, justify="right")
    for point in found.points:
        values, figures = dict(found.task.joined(point.judged.changes)), point.judged.figures
        cells = (
            f"{figures[name]:.3g} / {point.confirmed[name]:.3g}" if name in figures else ""
            for name in ("edge_mm", "edge_deg", "cable_mm", "cable_deg")
        )
        table.add_row(
            point.name,
            *(_brief(values.get(field, _of_base(found.task.base, field))) for field in fields),
            *cells,
            f"{point.confirmed['gross_percent']:.1f}",
            f"{figures['cost']:.2f}",
            f"{figures['current_ma']:.1f}",
        )
    console.print(table)
    console.print(
        "goals: "
        + ", ".join(f"{name} {goal:g}" for name, goal in targets.errors.items())
        + f"; gaps {_listed(targets.gaps_mm)} mm, cables {_listed(targets.cables_mm)} mm"
    )
    if search.reference.with_fixed:
        console.print(
            "[fixed] names another LED or photodetector, and how much light it gives is not known: "
            "current and pull-up of [fixed] are taken as well exposed. Choose the pull-up again "
            "when you have the first frames.",
            soft_wrap=True,
        )
    if nearest := found.nearest:
        limits = found.task.limits
        over = ", ".join(
            f"{name} is {nearest.figures[name]:.4g}, the limit {getattr(limits, name):g}"
            for name, share in excesses(nearest.figures, limits).items()
            if share > 0.0
        )
        console.print(
            f"No design keeps all limits. Of the nearest, {dict(nearest.changes)}, {over}. Relax "
            "limits, or vary more parameters.",
            style="bold red",
        )
    elif not search.front:
        console.print("Every design is refused:", style="bold red")
        for text, count in found.refused[:_REASONS]:
            console.print(f"  {text} ({count} of {len(search.designs)})", soft_wrap=True)
        if (more := len(found.refused) - _REASONS) > 0:
            console.print(f"  and for {more} more reasons, which study.json has")
    else:
        best = min(one.figures["error"] for one in search.front)
        met = [point.name for point in found.points if found.meets(point)]
        expected = "some" if best <= 1.0 else "none"
        console.print(
            f"Within all limits, and with gross errors in at most {MOST_GROSS_PERCENT:g} % of its "
            f"poses, the estimator keeps the goals with {', '.join(met) or 'none of these designs'}"
            f". By expected errors, which know no ambiguous poses, {expected} of all designs do.",
            soft_wrap=True,
        )


def _of_base(base: Input, field: str) -> object:
    if field == FIELD and not base.value(FIELD):
        return base.value("mask.hole_mm")
    return "auto" if field in base.automatic else base.value(field)


def _brief(value: object) -> str:
    """A value; of long lists of numbers, the smallest and the largest."""
    sizes = [of for of in value if isinstance(of, float)] if isinstance(value, tuple) else []
    return f"{min(sizes)} … {max(sizes)}" if len(sizes) > _LONG else f"{value}"


def _listed(values: tuple[float, ...]) -> str:
    return ", ".join(f"{value:g}" for value in values)
