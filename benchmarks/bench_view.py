"""The live view at 200 Hz in Chromium: age of the frames when drawn, cost, memory over time.

Run by `make bench`; exits 1 if a goal is missed. `bench_view.py 300` runs for five minutes. The age
of a frame is the time from reading the cells until the server is informed that it is drawn. Server
and browser share this machine, and the browser draws without a GPU.
"""

import os
import shutil
import statistics
import sys
import tempfile
import time
from pathlib import Path

from playwright.sync_api import Page, sync_playwright

from common import Goals
from lumitip.view.finger import Finger
from lumitip.view.registry import FingerRegistry
from lumitip.view.server import ViewServer

URLS = ("twin://demo?rate=200", "twin://cable?rate=200")
INTERVAL_S = 10.0
GOAL_MS = 50.0
_TICKS = os.sysconf("SC_CLK_TCK")
_PAGE = os.sysconf("SC_PAGE_SIZE")


def offspring(pid: int, program: str) -> list[int]:
    """All child processes that run a program, and theirs."""
    found = []
    for entry in Path("/proc").glob("[0-9]*"):
        try:
            name, _, rest = (entry / "stat").read_text().partition("(")[2].rpartition(")")
        except OSError:
            continue
        if int(rest.split()[1]) == pid:
            below = int(entry.name)
            found += [below] * name.startswith(program) + offspring(below, program)
    return found


def usage(pids: list[int]) -> tuple[float, float]:
    """CPU time (s) and resident memory (MB) of processes; shared pages count in each."""
    ticks = pages = 0
    for pid in pids:
        fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
        ticks += int(fields[11]) + int(fields[12])
        pages += int(fields[21])
    return ticks / _TICKS, pages * _PAGE / 1e6


def measure(page: Page, fingers: list[Finger], seconds: float) -> tuple[list[float], int]:
    """Print a row for each interval; returns the p99 of all but the first (ms), and the number of
    lost frames."""
    print(
        f"{'after':>7}{'age p50':>9}{'p99':>8}{'pictures':>10}{'estimates':>11}"
        f"{'skipped':>9}{'lost':>6}{'server':>9}{'':>8}{'browser':>9}{'':>8}{'heap':>8}{'load':>6}"
    )
    p99_ms, begun = [], time.monotonic()
    own = os.getpid()
    servers = [own, *offspring(own, "python")]  # and the processes of the estimates
    cpu_before = usage(servers)[0], usage(offspring(own, "chrom"))[0]
    for interval in range(1, max(2, round(seconds / INTERVAL_S)) + 1):
        page.wait_for_timeout(1e3 * (begun + interval * INTERVAL_S - time.monotonic()))
        server, browser = usage(servers), usage(offspring(own, "chrom"))
        panels = page.evaluate(
            "[...lumitip.panels.values()].map((p) => ({ ...p.status, pictures: p.pictures,"
            f" estimates: p.estimates.points.filter(({{ t }}) => t > p.history.last - {INTERVAL_S})"
            ".length }))"
        )
        age = [max(panel["age_ms"][i] for panel in panels) for i in range(2)]
        lost = sum(sum((finger.tip.stats.dropped or {}).values()) for finger in fingers)
        heap = page.evaluate("performance.memory.usedJSHeapSize") / 1e6
        print(
            f"{interval * INTERVAL_S:5.0f} s{age[0]:6.1f} ms{age[1]:5.1f} ms"
            f"{min(panel['pictures'] for panel in panels):7.0f}/s"
            f"{min(panel['estimates'] for panel in panels) / INTERVAL_S:9.0f}/s"
            f"{sum(panel['skipped'] for panel in panels):9d}{lost:6d}"
            f"{100 * (server[0] - cpu_before[0]) / INTERVAL_S:7.0f} %{server[1]:5.0f} MB"
            f"{100 * (browser[0] - cpu_before[1]) / INTERVAL_S:7.0f} %{browser[1]:5.0f} MB"
            f"{heap:5.1f} MB{os.getloadavg()[0]:6.1f}",
            flush=True,
        )
        cpu_before = server[0], browser[0]
        p99_ms.append(age[1])
    return p99_ms[1:], lost


def main(seconds: float) -> int:
    """One finger, then two, each at 200 Hz; the exit code."""
    goals = Goals()
    chromium = shutil.which("chromium")
    if chromium is None:
        goals.not_measured("age of frames in the live view", "chromium is not installed")
        return goals.exit_code()
    arguments = ["--no-sandbox", "--disable-gpu", "--enable-precise-memory-info"]
    for urls in (URLS[:1], URLS):
        print(f"live view, {len(urls)} × 200 Hz, 32 cells; CPU of one core; memory resident")
        fingers = [Finger.open(url) for url in urls]
        with (
            tempfile.TemporaryDirectory() as folder,
            ViewServer(FingerRegistry(fingers, Path(folder)), port=0) as server,
            sync_playwright() as playwright,
        ):
            browser = playwright.chromium.launch(executable_path=chromium, args=arguments)
            page = browser.new_page(viewport={"width": 1280, "height": 800})
            page.goto(server.url)
            page.wait_for_selector(".finger[data-seq]")
            p99_ms, lost = measure(page, fingers, seconds)
            browser.close()
        load = f"{len(urls)} × 200 Hz"
        quietest = f"{min(p99_ms):.0f} ms in the best interval, load {os.getloadavg()[0]:.1f}"
        goals.at_most(
            f"{load}: median p99 of the ages after {INTERVAL_S:.0f} s ({quietest})",
            statistics.median(p99_ms),
            GOAL_MS,
            "ms",
        )
        goals.at_most(f"{load}: lost on the way to the server", lost, 0, "frames")
    return goals.exit_code()


if __name__ == "__main__":
    sys.exit(main(float(sys.argv[1]) if len(sys.argv) > 1 else 30.0))
