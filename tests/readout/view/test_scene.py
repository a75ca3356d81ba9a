"""The controls of a simulated fingertip's object."""

import http.client
import json
from collections.abc import Callable
from contextlib import closing
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import Page, expect

from live_page import opened, until
from lumitip import Fingertip, Layout
from lumitip.errors import ArgumentError
from lumitip.frame import complement
from lumitip.links.base import Placeable
from lumitip.recording import Writer
from lumitip.twin import Cable, Corner, HalfPlane, Thing, Twin
from lumitip.view.finger import Finger
from lumitip.view.server import ViewServer

Serve = Callable[..., ViewServer]
WaitFor = Callable[[Callable[[], bool]], None]
SCENES: dict[str, tuple[dict[str, float], Thing]] = {
    "edge": ({"offset_mm": 2.0, "angle_deg": 80.0}, HalfPlane(offset_mm=2.0, angle_deg=80.0)),
    "cable": (
        {"offset_mm": -1.0, "angle_deg": 30.0, "diameter_mm": 4.0},
        Cable(offset_mm=-1.0, angle_deg=30.0, diameter_mm=4.0),
    ),
    "corner": (
        {"x_mm": 1.0, "y_mm": -2.0, "angle_deg": 40.0, "opening_deg": 70.0},
        Corner(x_mm=1.0, y_mm=-2.0, angle_deg=40.0, opening_deg=70.0),
    ),
}


def control(tip: Fingertip) -> Placeable:
    assert tip.simulated is not None
    return tip.simulated


@pytest.mark.slow_cases
@pytest.mark.parametrize("name", SCENES)
def test_an_object_stands_where_it_is_put_and_moves_on_when_asked(
    name: str, wait_for: WaitFor
) -> None:
    values, thing = SCENES[name]
    with Fingertip.open("twin://demo?noise=0&warm=0&rate=200") as tip:
        assert control(tip).placement()["moving"] is True
        control(tip).place({"object": name, **values})
        placed = control(tip).placement()
        assert (placed["object"], placed["now"], placed["moving"]) == (name, name, False)
        assert placed["values"] == pytest.approx(values)
        twin = Twin(tip.layout)
        expected = twin.uncalibrated(twin.light(thing))

        def there() -> bool:
            frame = tip.read()
            return bool(np.abs(complement(frame.raw, frame.bits) - expected).max() < 1.1)

        wait_for(there)
        assert there()
        control(tip).place({"moving": True})
        wait_for(lambda: not there())
        assert control(tip).placement()["object"] == name


def test_what_is_not_asked_for_stays(wait_for: WaitFor) -> None:
    with Fingertip.open("twin://cable?diameter=5&material=napkin") as tip:
        control(tip).place({"offset_mm": 1.5, "angle_deg": 0.0})
        control(tip).place({"angle_deg": 10.0})
        assert control(tip).placement() == {
            "object": "cable",
            "material": "napkin",
            "moving": False,
            "now": "cable",
            "values": {"offset_mm": 1.5, "angle_deg": 10.0, "diameter_mm": 5.0},
        }
        control(tip).place({"object": "edge"})
        assert control(tip).placement()["values"] == {"offset_mm": 1.5, "angle_deg": 10.0}
        control(tip).place({"material": "opaque"})
        assert control(tip).placement()["moving"] is False
        control(tip).place({"object": "empty"})
        wait_for(lambda: float(tip.read().values.min()) > 200)


REFUSED: list[tuple[dict[str, object], str]] = [
    ({"object": "edge", "offset_mm": 99}, "offset_mm is 99; a number from -30 to 30 is needed"),
    ({"object": "edge", "angle_deg": "steep"}, "angle_deg is 'steep'; a number from -180 to 180"),
    ({"object": "edge", "angle_deg": None}, "angle_deg is None; a number"),
    ({"object": "edge", "offset_mm": float("nan")}, "offset_mm is nan; a number"),
    ({"object": "edge", "offset_mm": 10**400}, "offset_mm is 1000"),
    ({"object": "edge", "diameter_mm": 3}, "there is no 'diameter_mm' of edge; allowed are offset"),
    ({"object": "sheet", "offset_mm": 3}, "there is no 'offset_mm' of sheet; allowed are no numb"),
    ({"object": "brick"}, "object is 'brick'; allowed are demo, disc, edge"),
    ({"object": ["edge"]}, "object is ['edge']; allowed are"),
    ({"material": "gold"}, "material is 'gold'; allowed are opaque, cardboard"),
    ({"moving": 1}, "moving is 1; true or false is needed"),
    ({"moving": True, "offset_mm": 1.0}, "moving is true, so offset_mm cannot be set"),
]


@pytest.mark.parametrize(("asked", "said"), REFUSED)
def test_bad_values_are_refused_and_change_nothing(asked: dict[str, object], said: str) -> None:
    with Fingertip.open("twin://edge") as tip:
        control(tip).place({"offset_mm": 1.0, "angle_deg": 90.0})
        before = control(tip).placement()
        with pytest.raises(ArgumentError) as caught:
            control(tip).place(asked)
        assert str(caught.value).startswith(said)
        assert control(tip).placement() == before


def ask(server: ViewServer, number: int, body: dict[str, Any]) -> tuple[int, str]:
    connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=10)
    origin = {"Origin": f"http://127.0.0.1:{server.port}"}
    connection.request("POST", f"/api/fingers/{number}/scene", json.dumps(body), origin)
    with closing(connection), connection.getresponse() as answer:
        return answer.status, answer.read().decode()


@pytest.mark.slow
def test_the_estimate_expects_the_diameter_that_was_set(serve: Serve, wait_for: WaitFor) -> None:
    server = serve("twin://cable?noise=0")
    finger = server.registry.fingers[1]
    wait_for(lambda: finger.count > 0)

    def width_mm() -> float:
        finger.estimates.ask(finger.newer(finger.count - 1)[0][-1][0], finger.count)
        newest = finger.estimates.newest
        return (newest.shown["width_mm"] or 0.0) if newest else 0.0

    place = {"object": "cable", "offset_mm": 0.0, "angle_deg": 90.0}
    for diameter_mm in (8.0, 1.0):
        assert ask(server, 1, {**place, "diameter_mm": diameter_mm})[0] == 200
        wait_for(lambda: abs(width_mm() - diameter_mm) < 0.5)  # noqa: B023


@pytest.mark.slow
def test_devices_and_replays_have_no_controls(
    serve: Serve,
    page: Page,
    still: Callable[[Layout, np.ndarray], Finger],
    layout: Layout,
    tmp_path: Path,
) -> None:
    path = tmp_path / "run.mcap"
    with (
        Fingertip.open("twin://edge") as tip,
        Writer(path, tip.layout, device_id="twin:edge") as writer,
    ):
        for _ in range(3):
            writer.write(tip.read())
    server = serve(still(layout, np.full(len(layout), 20)), f"replay://{path}", "twin://edge")
    opened(page, server)
    expect(page.locator(".scene")).to_have_count(3)
    expect(page.locator(".scene:visible")).to_have_count(1)
    for number in (1, 2):
        status, text = ask(server, number, {"object": "edge", "offset_mm": 1.0})
        assert status == 409
        assert "only the object of a twin:// can be moved" in text
    assert ask(server, 3, {"object": "edge", "offset_mm": 1.0})[0] == 200


@pytest.mark.slow
def test_the_page_moves_the_object(serve: Serve, page: Page, wait_for: WaitFor) -> None:
    server = serve("twin://demo")
    tip = server.registry.fingers[1].tip
    opened(page, server)
    expect(page.locator(".moves")).to_have_attribute("aria-pressed", "true")
    page.locator("select.object").select_option("edge")
    offset = page.locator(".scene input[name=offset_mm]")
    offset.fill("3.5")
    offset.press("Enter")
    angle = page.locator(".scene input[name=angle_deg]")
    angle.fill("15")
    angle.press("Enter")
    wait_for(lambda: control(tip).placement()["values"] == {"offset_mm": 3.5, "angle_deg": 15.0})
    expect(page.locator(".moves")).to_have_attribute("aria-pressed", "false")
    newest = "lumitip.panels.get(1).estimate"
    near = f"Math.abs({newest}?.offset_mm - 3.5) < 0.3 && Math.abs({newest}.angle_deg - 15) < 1.5"
    until(page, near)
    # A slider moves it live.
    page.locator(".scene input[type=range]").first.fill("-2")
    until(page, f"Math.abs({newest}.offset_mm + 2) < 0.3")
    page.locator(".moves").click()
    wait_for(lambda: control(tip).placement()["moving"])


@pytest.mark.slow
def test_the_page_says_once_what_is_wrong(serve: Serve, page: Page) -> None:
    server = serve("twin://edge")
    opened(page, server)
    offset = page.locator(".scene input[name=offset_mm]")
    for typed, said in (
        ("99", "offset_mm is 99; a number from -30 to 30 is needed"),
        ("t r", "offset_mm is 't r'; a number from -30 to 30 is needed"),
    ):
        offset.fill("")
        offset.press_sequentially(typed)  # no key of the page is pressed by that
        offset.press("Enter")
        expect(page.locator("#notice")).to_have_text(said)
        expect(page.locator("#notice")).to_have_class("error")
        # The field shows again where the object is.
        expect(offset).not_to_have_value(typed)
    assert server.registry.fingers[1].status()["recording"] is None
