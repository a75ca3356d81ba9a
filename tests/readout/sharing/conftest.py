"""Servers of simulated fingertips on free ports."""

import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from typing import Any

import pytest

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
