"""Time of one frame of the twin in the page of an output folder, and the size of the page.

    python benchmarks/bench_page.py [outputs]

Needs a folder that `make outputs` has filled, and Chromium. Run by `make bench`; exits 1 if a goal
is missed.
"""

import shutil
import sys
from pathlib import Path

from playwright.sync_api import sync_playwright

from common import Goals

MEDIAN_MS, LARGEST_MB = 8.0, 8.0
KINDS = ("edge", "cable", "corner")
_FRAMES = """kind => {
    const { grasp } = lumitip;
    grasp.change({ kind, diameter: 3 });
    const each = [];
    for (let i = 0; i < 400; i += 1) {
        const start = performance.now();
        const [x, y] = [10 * Math.sin(i / 9), 8 * Math.cos(i / 7)];
        grasp.change({ x, y, angle_deg: i % 180 });
        document.getElementById("grid").getBoundingClientRect();
        each.push(performance.now() - start);
    }
    return each.sort((a, b) => a - b);
}"""


def main(page: Path) -> int:
    """Print the times; the exit code."""
    goals = Goals()
    chromium = shutil.which("chromium") or shutil.which("chromium-browser")
    if not page.is_file() or not chromium:
        goals.not_measured("page", f"{page} or Chromium is missing: run make outputs first")
        return goals.exit_code()
    goals.at_most("size of the page", page.stat().st_size / 1e6, LARGEST_MB, "MB")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=chromium,
            args=["--no-sandbox", "--use-gl=swiftshader", "--ignore-gpu-blocklist"],
        )
        tab = browser.new_context(offline=True).new_page()
        tab.goto(page.resolve().as_uri())
        for kind in KINDS:
            times = tab.evaluate(_FRAMES, kind)
            middle, late = times[len(times) // 2], times[int(0.95 * len(times))]
            print(f"{kind:<8}{middle:>8.2f} ms median{late:>8.2f} ms at 95 %", flush=True)
            goals.at_most(f"frame of {kind}, median", middle, MEDIAN_MS, "ms")
        browser.close()
    return goals.exit_code()


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1] if len(sys.argv) > 1 else "outputs") / "index.html"))
