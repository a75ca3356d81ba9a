"""Servers of simulated fingertips on free ports."""

import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from typing import Any

import pytest

from lumitip import LinkEvent
from lumitip.links.base import Deliver, Report
from lumitip.links.twin import published_layout
from lumitip.sharing import FingertipServer

Until = Callable[[Callable[[], bool]], None]


@pytest.fixture
def serve() -> Iterator[Callable[..., FingertipServer]]:
    """`serve(url, …)`: a server on a free port."""
    with ExitStack() as stack:

        def start(url: str = "twin://disc?rate=200", **options: Any) -> FingertipServer:
            return stack.enter_context(FingertipServer(url, **{"port": 0, **options}))

        yield start


@pytest.fixture
def until() -> Until:
    """`until(condition)`: returns once it holds, fails if it never does."""

    def wait(condition: Callable[[], bool], timeout_s: float = 60.0) -> None:
        end = time.monotonic() + timeout_s
        while not condition():
            assert time.monotonic() < end, "it never happened"
            time.sleep(0.01)

    return wait


class Legacy:
    """A link of the published sensor, which the test drives."""

    device_id = "legacy"

    def __init__(self) -> None:
        self.layout = published_layout()
        self.deliver: Deliver
        self.report: Report

    def start(self, deliver: Deliver, report: Report) -> None:
        self.deliver, self.report = deliver, report
        report(LinkEvent("connected", "connected"))

    def stop(self) -> None:
        pass


@pytest.fixture
def link(monkeypatch: pytest.MonkeyPatch) -> Legacy:
    """The link of the next server."""
    link = Legacy()
    monkeypatch.setattr("lumitip.sharing.server.open_link", lambda *_: link)
    return link
