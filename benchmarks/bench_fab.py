"""Speed of the maker's side: builds of the published design, and growth with the cells.

Run by `make bench`. Wall time depends on the machine, so every figure comes with a ratio.
"""

import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from designs import write_design

PRESETS = Path(__file__).parents[1] / "design" / "presets"
CELLS = (32, 128, 512, 2048)
STAGES = ("layout", "mask", "checks")


def lumitip_fab(*arguments: str) -> float:
    """Run the command in a fresh process; returns its wall time (s)."""
    begun = time.perf_counter()
    command = [sys.executable, "-m", "lumitip_fab.cli", *arguments]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    return time.perf_counter() - begun


def builds() -> None:
    """Cold, unchanged, and after single changes."""
    with tempfile.TemporaryDirectory() as name:
        folder, out = Path(name), str(Path(name) / "out")
        (folder / "parts").mkdir()
        file = folder / "design.toml"
        published = (PRESETS / "published.toml").read_text(encoding="utf-8")

        def built(text: str) -> float:
            file.write_text(text, encoding="utf-8")
            return lumitip_fab("build", str(file), "--out", out, "--quiet")

        cold = built(published)
        print(f"{'build':<34}{'seconds':>9}{'of cold':>9}")
        for what, seconds in (
            ("cold", cold),
            ("nothing changed", built(published)),
            ("controller.name", built(published.replace('name = "Lumitip"  ', 'name = "Other"  '))),
            ("mask.hole_mm", built(published.replace("hole_mm = 2.5 ", "hole_mm = 2.0 "))),
            ("grid.pitch_mm", built(published.replace("pitch_mm = 6.0", "pitch_mm = 6.1"))),
            ("check", lumitip_fab("check", "--out", out, "--quiet")),
            ("--help", lumitip_fab("--help")),
        ):
            print(f"{what:<34}{seconds:>9.2f}{seconds / cold:>9.3f}")


def growth() -> None:
    """Time and memory of each stage against the number of cells, a process each."""
    print(f"\n{'cells':>6}{'stage':>9}{'seconds':>10}{'µs a cell':>12}{'peak MiB':>10}")
    for cells in CELLS:
        for stage in STAGES:
            command = [sys.executable, __file__, stage, str(cells)]
            ended = subprocess.run(command, check=True, capture_output=True, text=True)
            count, seconds, peak = ended.stdout.split()
            each = 1e6 * float(seconds) / int(count)
            print(f"{count:>6}{stage:>9}{float(seconds):>10.3f}{each:>12.0f}{float(peak):>10.0f}")


def one_stage(stage: str, cells: int) -> None:
    """Run one stage in this process and print cells, seconds and peak memory (MiB)."""
    from lumitip_fab.checks import layout as layout_check
    from lumitip_fab.checks import mask as mask_check
    from lumitip_fab.derive import derive
    from lumitip_fab.documents import documents
    from lumitip_fab.graph import tasks
    from lumitip_fab.load import load
    from lumitip_fab.mask.files import mask_files

    with tempfile.TemporaryDirectory() as name:
        out = Path(name) / "out"
        file = write_design(cells, PRESETS / "published.toml", Path(name) / "design")
        derive(load(file))  # imports are not what is measured
        begun = time.perf_counter()
        given = load(file)
        design = derive(given)
        seconds = time.perf_counter() - begun
        if stage != "layout":
            begun = time.perf_counter()
            made = [a for t in tasks(design) if not t.step.heavy for a in mask_files(**t.arguments)]
            seconds = time.perf_counter() - begun
            for artefact in (*made, *documents(given, design)):
                path = out / artefact.path
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_bytes(artefact.data)
        if stage == "checks":
            begun = time.perf_counter()
            found = [*layout_check.measure(out, design), *mask_check.measure(out, design)]
            seconds = time.perf_counter() - begun
            failed = [m.check for m in found if not m.passed]
            if failed:
                sys.exit(f"{cells} cells: failed {failed}")
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(len(design.layout), seconds, peak)


if __name__ == "__main__":
    if len(sys.argv) > 1:
        one_stage(sys.argv[1], int(sys.argv[2]))
    else:
        builds()
        growth()
