"""Addresses of links, and the twin behind one."""

import threading

import numpy as np
import pytest

from lumitip import Fingertip, Layout, LinkEvent, LumitipError
from lumitip.errors import LinkTimeout, UrlError


def test_an_address_is_checked_before_anything_is_opened() -> None:
    for url, told in {
        "Lumitip": "an address like ble://Lumitip",
        "usb://x": "allowed are ble://…, serial://…",
        "twin://pyramid": "'pyramid' given, allowed are demo, disc",
        "twin://disc?rates=3": "option 'rates' given, allowed are speed, noise, rate, bits, seed",
        "twin://disc?rate=0": "rate=0 given, a number from 1 to 5000 is needed",
        "twin://disc?rate=nan": "a number from 1",
        "twin://disc?bits=9": "bits=9 given, allowed are 8, 10, 12",
        "twin://disc?rate=1&rate=2": "an option is given twice",
        "twin://disc?rate": "options like",
    }.items():
        with pytest.raises(UrlError, match=told):
            Fingertip.open(url)
    with pytest.raises(LumitipError, match=r"layout='outputs/layout\.json'"):
        Fingertip.open("ble://Lumitip")


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
    from lumitip.links.shapes import SHAPES
    from lumitip.links.twin import Scene, packet_at

    shown = set()
    for shape in SHAPES:
        scene = Scene(shape, 12.0, 1.5, 100.0, 8, 0)
        one, again = packet_at(layout, scene, 500, 3), packet_at(layout, scene, 500, 3)
        assert (one.values == again.values).all()
        shown.add(one.values.tobytes())
    assert len(shown) >= len(SHAPES) - 1, "demo shows one of the others"


def test_a_fingertip_of_one_cell_is_shown_and_examined(make_layout) -> None:
    from lumitip.doctor import examine
    from lumitip.intake import complement
    from lumitip.links.shapes import SHAPES
    from lumitip.links.twin import Scene, packet_at

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
