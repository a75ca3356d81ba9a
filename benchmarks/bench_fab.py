"""Speed of the maker's side: builds of the published design, and growth with the cells.

Run by `make bench`. Wall time depends on the machine, so every figure comes with a ratio.
"""

import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from common import write_design

PRESETS = Path(__file__).parents[1] / "design" / "presets"
CELLS = (32, 128, 512, 2048)
STAGES = ("layout", "mask", "checks")


def lumitip_fab(*arguments: str) -> float:
    """Run the command in a fresh process; returns its wall time (s)."""
    begun = time.perf_counter()
    command = [sys.executable, "-m", "lumitip_fab", *arguments]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    return time.perf_counter() - begun


def builds() -> None:
    """Cold, unchanged, and after single changes."""
    with tempfile.TemporaryDirectory() as name:
        folder, out = Path(name), str(Path(name) / "out")
        (folder / "parts").mkdir()
        file = folder / "design.toml"
        published = (PRESETS / "published.toml").read_text(encoding="utf-8")

        def outputs(text: str) -> tuple[float, float]:
            file.write_text(text, encoding="utf-8")
            memory = str(Path(out) / ".checked.json")
            return (
                lumitip_fab("build", str(file), "--out", out, "--quiet"),
                lumitip_fab("check", "--out", out, "--quiet", "--memory", memory),
            )

        cold = outputs(published)
        print(
            f"{'make outputs: seconds to':<30}{'build':>9}{'check':>9}{'in all':>9}{'of cold':>9}"
        )
        for what, (build, check) in (
            ("cold", cold),
            ("nothing changed", outputs(published)),
            ("controller.name", outputs(_changed(published, "name", '"Lumitip"', '"Other"'))),
            ("mask.hole_mm", outputs(_changed(published, "hole_mm", "2.5", "2.0"))),
            ("grid.pitch_mm", outputs(_changed(published, "pitch_mm", "6.0", "6.1"))),
        ):
            both = build + check
            print(f"{what:<30}{build:>9.2f}{check:>9.2f}{both:>9.2f}{both / sum(cold):>9.3f}")
        print(f"{'every check':<39}{lumitip_fab('check', '--out', out, '--quiet'):>9.2f}")
        print(f"{'--help':<30}{lumitip_fab('--help'):>9.2f}")


def _changed(text: str, key: str, old: str, new: str) -> str:
    line = next(t for t in text.splitlines() if t.startswith(f"{key} = {old}"))
    return text.replace(line, line.replace(old, new))


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
    from lumitip_fab.cli.documents import documents
    from lumitip_fab.config.load import load
    from lumitip_fab.derive import derive
    from lumitip_fab.mask.files import mask_files

    with tempfile.TemporaryDirectory() as name:
        out = Path(name) / "out"
        file = write_design(cells, PRESETS / "published.toml", Path(name) / "design")
        derive(load(file))  # imports are not measured
        begun = time.perf_counter()
        config = load(file)
        design = derive(config)
        seconds = time.perf_counter() - begun
        if stage != "layout":
            begun = time.perf_counter()
            masks = [a for finger in design.fingers for a in mask_files(design, finger)]
            seconds = time.perf_counter() - begun
            for artefact in (*masks, *documents(config, design, out)):
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
