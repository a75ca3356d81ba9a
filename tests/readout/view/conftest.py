"""A running live view, and a browser to look at it: Debian's Chromium, without a screen."""

import threading
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import Browser, ConsoleMessage, Page, expect, sync_playwright

from lumitip import Fingertip, Layout
from lumitip.links.base import Arrival, Deliver, LinkEvent, Report
from lumitip.protocol.packet import Packet, design_code
from lumitip.recording import Writer
from lumitip.session.hub import Hub
from lumitip.view.finger import Finger
from lumitip.view.registry import FingerRegistry
from lumitip.view.server import ViewServer
from programs import program

Serve = Callable[..., ViewServer]
BUSY_MS = 20_000  # that a page may take for a change while other tests run


@pytest.fixture(autouse=True)
def _own_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing of the user's calibration is read or written."""
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "data"))


@pytest.fixture(scope="session")
def wait_for() -> Callable[[Callable[[], bool]], None]:
    """`wait_for(condition)`: returns once it holds, fails if it never does."""

    def wait(condition: Callable[[], bool], timeout_s: float = 60.0) -> None:
        until = time.monotonic() + timeout_s
        while not condition():
            assert time.monotonic() < until, "it never happened"
            time.sleep(0.02)

    return wait


@pytest.fixture
def serve(tmp_path: Path) -> Iterator[Serve]:
    """`serve(url or finger, …, host=…, token=…)`: a live view on a free port."""
    with ExitStack() as stack:

        def start(*shown: str | Finger, **options: str) -> ViewServer:
            fingers = [Finger.open(one) if isinstance(one, str) else one for one in shown]
            registry = FingerRegistry(fingers, tmp_path / "recordings")
            return stack.enter_context(ViewServer(registry, port=0, **options))

        yield start


class Still:
    """A link that sends the same codes 100 times a second, and falls silent after `frames`."""

    device_id = "still"

    def __init__(self, layout: Layout, codes: np.ndarray, frames: int) -> None:
        self.layout = layout
        self._frames = frames
        self._codes = codes.astype(np.uint8)[None]
        self._stopping = threading.Event()

    def start(self, deliver: Deliver, report: Report) -> None:
        report(LinkEvent("connected", "connected"))
        threading.Thread(target=self._run, args=(deliver,), daemon=True).start()

    def stop(self) -> None:
        self._stopping.set()

    def _run(self, deliver: Deliver) -> None:
        design = design_code(self.layout.design_hash)
        for i in range(self._frames):
            packet = Packet(design, i % 2**16, 8, 10_000 * i % 2**32, 10_000, self._codes)
            deliver(Arrival(time.monotonic(), packet))
            if self._stopping.wait(0.01):
                return


@pytest.fixture
def still() -> Callable[..., Finger]:
    """`still(layout, codes, frames=…)`: a finger that reads these codes, for an hour at most."""

    def make(layout: Layout, codes: np.ndarray, frames: int = 360_000) -> Finger:
        hub = Hub(Still(layout, codes, frames), any_design=False, on_event=None)
        return Finger("still://", Fingertip(hub, 64, calibrated=False, timeout_s=5.0))

    return make


@pytest.fixture
def recording(tmp_path: Path) -> Path:
    """800 frames at 100 Hz of a cable that moves."""
    path = tmp_path / "recordings" / "run.mcap"
    path.parent.mkdir()
    with Fingertip.open("twin://cable?rate=2000&speed=240&noise=0") as tip:
        frames = [tip.read() for _ in range(800)]
        with Writer(path, tip.layout, device_id="finger", start_wall=1000.0) as writer:
            for i, frame in enumerate(frames):
                writer.write(replace(frame, t_wall=1000.0 + i / 100))
    return path


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    """Chromium, for one file: Playwright's event loop runs on while it is open, and no other
    test of this process could start one."""
    chromium = program("chromium")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=chromium, args=["--no-sandbox", "--disable-gpu"]
        )
        yield browser
        browser.close()


def _is_fault(said: ConsoleMessage) -> bool:
    # The server says no with 409, which the page tells its user and Chromium the console.
    return said.type == "error" and "409 (Conflict)" not in said.text


@pytest.fixture
def page(browser: Browser) -> Iterator[Page]:
    """A window of laptop size; the test fails if the page reports an error."""
    context = browser.new_context(viewport={"width": 1280, "height": 800}, color_scheme="light")
    page = context.new_page()
    errors: list[str] = []
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.on("console", lambda said: errors.append(said.text) if _is_fault(said) else None)
    page.set_default_timeout(BUSY_MS)
    expect.set_options(timeout=BUSY_MS)
    yield page
    context.close()
    assert errors == []
