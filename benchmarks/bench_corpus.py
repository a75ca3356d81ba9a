"""Boards of random designs: routed or refused with a reason, clean by KiCad's own rules, how fast.

python benchmarks/bench_corpus.py --count 200 --seed 1 --jobs 2

Grids of 8 to 257 cells in uneven columns, pitches of 3 to 8 mm, every LED, photodetector and
multiplexer of the catalogue. Refusals are confirmed as by `bench_acceptance.py`. Boards that
are not routed count as missed. The contact sheet shows the back of every receiver, the worst first.
"""

import argparse
import io
import math
import multiprocessing
import statistics
import sys
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path

from PIL import Image, ImageDraw

from acceptance.confirm import confirm
from acceptance.generator import Design
from acceptance.trial import Trial as Refused
from acceptance.trial import design_folder
from common import Goals
from corpus.draw import board_design
from corpus.trial import Board, Trial, try_boards

MEDIAN_S = 5.0
LEAST_ROUTED = 0.97
ACROSS, TILE_PX, LINE_PX = 10, 260, 16


def main() -> int:
    """Route all boards; the exit code."""
    options = _options()
    context = multiprocessing.get_context("spawn")  # none has the locks of another one's threads
    with design_folder() as folder, ProcessPoolExecutor(options.jobs, mp_context=context) as pool:
        designs = {d.name: d for d in (board_design(options.seed, i) for i in range(options.count))}
        for drawn in designs.values():
            (folder / f"{drawn.name}.toml").write_text(drawn.text, encoding="utf-8")
        files = [folder / f"{name}.toml" for name in designs]
        trials = []
        for trial in pool.map(partial(try_boards, kicad=not options.without_kicad), files):
            _print(trial, designs[trial.name])
            trials.append(trial)
        refused = [t for t in trials if t.refusals]
        verdicts = [confirm(designs[t.name], Refused(t.name, t.refusals), False) for t in refused]
    for trial, verdict in zip(refused, verdicts, strict=True):
        print(f"refused {trial.name}: {verdict.text}")
    boards = [board for trial in trials for board in trial.boards]
    options.sheet.write_bytes(contact_sheet([b for b in boards if b.name.endswith("receiver")]))
    print(f"\n{len(boards)} boards; the contact sheet is {options.sheet}")
    return judged(trials, boards, sum(not verdict.confirmed for verdict in verdicts))


def judged(trials: list[Trial], boards: list[Board], unconfirmed: int) -> int:
    """Print the goals; the exit code, 0 if all are met."""
    routed = [board for board in boards if not board.unrouted]
    goals = Goals()
    goals.at_most("refusals not confirmed", unconfirmed, 0)
    goals.at_most("crashes", sum(bool(trial.crash) for trial in trials), 0)
    goals.at_least("boards routed", len(routed) / max(len(boards), 1), LEAST_ROUTED)
    goals.at_most("boards with a broken rule", sum(bool(board.faults) for board in routed), 0)
    seconds = statistics.median([board.seconds for board in boards] or [math.inf])
    goals.at_most("median of a board, processor time", seconds, MEDIAN_S, "s")
    return goals.exit_code()


def contact_sheet(boards: list[Board]) -> bytes:
    """The backs of all boards as one PNG, those with faults first, then by their cells."""
    boards = sorted(boards, key=lambda b: (not (b.unrouted or b.faults), b.cells))
    rows = -(-len(boards) // ACROSS)
    sheet = Image.new("RGB", (ACROSS * TILE_PX, rows * (TILE_PX + LINE_PX)), "white")
    draw = ImageDraw.Draw(sheet)
    for i, board in enumerate(boards):
        x, y = i % ACROSS * TILE_PX, i // ACROSS * (TILE_PX + LINE_PX)
        wrong = bool(board.unrouted or board.faults)
        told = f"{board.name.split()[0]}: {board.cells} cells, {board.seconds:.0f} s"
        draw.text((x + 4, y + 2), told, fill="red" if wrong else "black")
        if board.picture:
            picture = Image.open(io.BytesIO(board.picture)).convert("RGB")
            picture.thumbnail((TILE_PX - 8, TILE_PX - 8))
            sheet.paste(picture, (x + 4, y + LINE_PX))
    data = io.BytesIO()
    sheet.save(data, "png")
    return data.getvalue()


def _print(trial: Trial, drawn: Design) -> None:
    about = ", ".join(f"{field} {value}" for field, value in drawn.edits.items())
    if trial.refusals:
        told = "; ".join(f"{r.field}: {r.message}" for r in trial.refusals)
        print(f"{trial.name} refused: {told}\n  {about}", flush=True)
    if trial.crash:
        print(f"{trial.name} crashed\n{trial.crash}", flush=True)
    for board in trial.boards:
        wrong = "; ".join([board.unrouted, *board.faults]).strip("; ")
        print(
            f"{board.name:<18}{board.cells:>5} cells{board.vias:>6} vias{board.seconds:>8.1f} s  "
            + (f"WRONG: {wrong}\n  {about}" if wrong else "clean"),
            flush=True,
        )


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=200, help="designs")
    parser.add_argument("--seed", type=int, default=1, help="another seed draws other designs")
    parser.add_argument("--jobs", type=int, default=2, help="processes")
    parser.add_argument("--without-kicad", action="store_true", help="leave KiCad out")
    parser.add_argument("--sheet", type=Path, default=Path("corpus.png"), help="contact sheet")
    return parser.parse_args()


if __name__ == "__main__":
    sys.exit(main())
