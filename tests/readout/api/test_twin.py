"""Addresses of links, and the twin behind one."""

import threading
import time

import numpy as np
import pytest

from lumitip import Fingertip, Layout, LinkEvent
from lumitip.errors import ArgumentError, LinkError, LinkTimeout, UrlError
from lumitip.links.base import Deliver, Report
from lumitip.links.thread import ThreadedLink, UnexpectedError
from lumitip.links.twin import published_layout
from lumitip.links.url import Url
from lumitip.twin import Model
from lumitip.twin.pairs import Emitter, Pairs


def test_an_address_is_checked_before_anything_is_opened() -> None:
    for url, told in {
        "Lumitip": "one like ble://Lumitip",
        "usb://x": "allowed are ble://…, serial://…",
        "twin://pyramid": "there is no shape 'pyramid'; allowed are demo, disc",
        "twin://disc?rates=3": "no option 'rates'; allowed are speed, noise, rate, bits, seed",
        "twin://disc?rate=0": "rate is 0; a number from 1 to 5000 is needed",
        "twin://disc?rate=nan": "a number from 1",
        "twin://disc?bits=9": "bits is 9; allowed are 8, 10, 12",
        "twin://disc?rate=1&rate=2": "an option occurs twice",
        "twin://disc?rate": "options like",
        "twin://" + 5000 * "a": "'twin://a+'… has 5007 characters; the limit is 4096",
        "ble://Lumitip?adapter=../hci0": "adapter is ../hci0; a name like hci0 is needed",
    }.items():
        with pytest.raises(UrlError, match=told):
            Fingertip.open(url, published_layout())


@pytest.mark.parametrize("odd", ["%00", "%0A", "a%1B[31m", "~%00", "\x7f", "\ud800"])
@pytest.mark.parametrize(
    "place",
    [
        "ble://{}",
        "serial://{}",
        "replay://{}",
        "twin://{}",
        "serial:///dev/ttyACM0?baud={}",
        "ble://a?{}=1",
    ],
)
def test_characters_that_no_name_has_are_refused(place: str, odd: str) -> None:
    with pytest.raises(UrlError, match="is not allowed") as caught:
        Fingertip.open(place.format(odd), published_layout())
    assert str(caught.value).isprintable(), "it may be printed to a terminal as it is"


def test_odd_but_possible_names_are_taken() -> None:
    for text in ("ble://Ä 1", "replay://a%20b", "replay://\udcff.mcap", "ble://100%", "ble://"):
        assert Url.parse(text).scheme in ("ble", "replay")
    assert Url.parse("replay://a%20b").target == "a b"
    assert Url.parse("ble://100%").target == "100%"


def test_a_twin_needs_nothing(make_layout) -> None:
    with Fingertip.open("twin://cable?rate=1000&bits=12") as tip:
        block = tip.get_data(40, timeout=10.0)
    assert block.values.shape == (40, 32)
    assert block.dropped == 0
    assert block.raw.dtype == np.uint16
    assert 0 < (block.values[0] < 128).sum() < 32, "a cable covers some cells, not all"
    own = make_layout((4, 5, 6, 5), 5.0)
    with Fingertip.open("twin://empty", own, calibrated=False) as tip:
        assert tip.layout == own
        assert tip.read(5.0).values.min() > 200


def test_what_a_twin_shows_is_always_the_same(layout: Layout) -> None:
    from lumitip.links.twin import SHAPES, Scene, packet_at

    shown = set()
    for shape in SHAPES:
        scene = Scene(shape, 12.0, 1.5, 100.0, 8, 0)
        one, again = packet_at(layout, scene, 500, 3), packet_at(layout, scene, 500, 3)
        assert (one.values == again.values).all()
        shown.add(one.values.tobytes())
    assert len(shown) >= len(SHAPES) - 1, "demo shows one of the others"


def test_a_fingertip_of_one_cell_is_shown_and_examined(make_layout) -> None:
    from lumitip.frame import complement
    from lumitip.health.doctor import examine
    from lumitip.links.twin import SHAPES, Scene, packet_at

    alone = make_layout((1,))
    for shape in SHAPES:
        packet = packet_at(alone, Scene(shape, 60.0, 1.5, 20.0, 8, 0), 0, 40)
        report = examine(complement(packet.values, 8), alone)
        assert not any(finding.kind == "swapped" for finding in report.findings)
    assert report.noise.shape == (1,)


def test_a_twin_that_still_makes_its_tables_is_not_waited_for(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    from lumitip.links import twin

    made, begun, threads, real = threading.Event(), threading.Event(), [], twin.packet_at

    def slow(*given):
        threads.append(threading.current_thread())
        begun.set()
        made.wait()
        return real(*given)

    monkeypatch.setattr(twin, "packet_at", slow)
    events: list[LinkEvent] = []
    release = threading.Timer(20.0, made.set)  # so that a fault fails this test, not hangs it
    release.start()
    try:
        with pytest.raises(LinkTimeout, match=r"tables of 32 cells are still being computed"):
            Fingertip.open("twin://disc", timeout=0.05, on_event=events.append)
        assert not made.is_set()
    finally:
        release.cancel()
        begun.wait(10.0)
        made.set()
    threads[0].join(10.0)
    assert not threads[0].is_alive()
    assert events == []


@pytest.mark.parametrize(
    ("problem", "told"),
    [
        (LinkTimeout("late"), LinkTimeout("late")),
        (ArgumentError("odd"), LinkError("odd")),
        (KeyError("x"), UnexpectedError(KeyError("x"))),
    ],
)
def test_what_ends_the_thread_of_a_link_is_told(problem: Exception, told: LinkError) -> None:
    class Failing(ThreadedLink):
        def _run(self, *_: Deliver | Report) -> None:
            raise problem

    link, events = Failing(), list[LinkEvent]()
    link.start(lambda _: None, events.append)
    link.stop()
    [event] = events
    assert (event.kind, type(event.error), event.detail) == ("failed", type(told), str(told))


def test_pairs_of_a_large_twin_are_sorted_without_holding_up_other_threads(make_layout) -> None:
    """Sorted row by row they held the interpreter for seconds, in which no timeout could count;
    that took forty times as long as the distances, this takes a few times as long."""
    large = make_layout((46, 45) * 22 + (46,), 1.5)
    emitter = Emitter(Model.from_layout(large))
    begun = time.thread_time()
    pairs = Pairs.of(large, emitter)
    spent_s = time.thread_time() - begun
    begun = time.thread_time()
    np.hypot(large.x_mm - large.x_mm[:, None], large.y_mm - large.y_mm[:, None])
    assert spent_s < 15.0 * (time.thread_time() - begun)
    ways = {kind[1:3] for kind in pairs.kinds}
    assert len(ways) == len(pairs.kinds), "each way from a cell to an LED is there once"
    assert {(-x, -y) for x, y in ways} == ways
    x_mm, y_mm = np.array([pairs.kinds[k][1:3] for k in pairs.kind[pairs.cell == 0]]).T
    beside = np.hypot(large.x_mm - large.x_mm[0], large.y_mm - large.y_mm[0])
    assert np.sort(np.hypot(x_mm, y_mm)) == pytest.approx(np.sort(beside)[: x_mm.size], abs=2e-3)
