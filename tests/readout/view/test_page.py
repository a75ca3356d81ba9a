"""What is seen in Chromium."""

import re
from collections.abc import Callable

import numpy as np
import pytest
from playwright.sync_api import Page, expect

from live_page import opened, pixels, places
from lumitip import Layout
from lumitip.links.base import LinkEvent
from lumitip.processing import Processor
from lumitip.view.finger import Finger
from lumitip.view.server import ViewServer
from page_colours import ramp

pytestmark = pytest.mark.slow

Serve = Callable[..., ViewServer]
WaitFor = Callable[[Callable[[], bool]], None]
TWIN = "twin://edge"


@pytest.fixture
def finger(still: Callable[[Layout, np.ndarray], Finger], layout: Layout) -> Finger:
    """A cable 10 mm wide that lies aslant and does not move."""
    turn = np.deg2rad(20.0)
    across = np.abs(layout.y_mm * np.cos(turn) - layout.x_mm * np.sin(turn))
    return still(layout, 20 + 205 * np.clip(0.5 - (across - 5.0) / 4.0, 0, 1))


def values_of(finger: Finger) -> np.ndarray:
    """The values of every frame of the finger that stands still."""
    return finger.tip.read().values


def test_every_cell_of_a_known_frame_has_its_colour(
    serve: Serve, page: Page, finger: Finger
) -> None:
    opened(page, serve(finger))
    page.keyboard.press("v")
    page.keyboard.press("o")
    layout, values = finger.tip.layout, values_of(finger)
    assert len(set(values.tolist())) > 4
    centres = places(page, np.column_stack((layout.x_mm, layout.y_mm)))
    expected = np.array([ramp(v) for v in values])
    np.testing.assert_allclose(pixels(page, centres), expected, atol=1)
    # Towards the borders too: the hexagons fill their cells.
    pitch = np.hypot(*(centres[1] - centres[0]))
    for turn in np.arange(0, 360, 60) + 30:
        way = 0.44 * pitch * np.array([np.cos(np.deg2rad(turn)), np.sin(np.deg2rad(turn))])
        np.testing.assert_allclose(pixels(page, centres + way), expected, atol=1)


def test_cells_stand_as_in_the_sensor_frame_tip_up(
    serve: Serve, page: Page, finger: Finger
) -> None:
    opened(page, serve(finger))
    layout = finger.tip.layout
    centres = places(page, np.column_stack((layout.x_mm, layout.y_mm)))
    scale = (centres[-1, 0] - centres[0, 0]) / (layout.x_mm[-1] - layout.x_mm[0])
    assert scale > 10
    np.testing.assert_allclose(np.diff(centres[:, 0]), scale * np.diff(layout.x_mm), atol=1e-6)
    np.testing.assert_allclose(np.diff(centres[:, 1]), -scale * np.diff(layout.y_mm), atol=1e-6)
    box = page.evaluate("lumitip.panels.get(1).grid.canvas.getBoundingClientRect().toJSON()")
    assert (centres > 0).all()
    assert (centres < [box["width"], box["height"]]).all()


def test_centre_markers_and_borders_are_drawn_where_they_are(
    serve: Serve, page: Page, finger: Finger
) -> None:
    opened(page, serve(finger))
    page.keyboard.press("v")
    contact = Processor(finger.tip.layout)(values_of(finger))
    assert contact.shape == "cable"
    assert contact.cable
    assert contact.markers_mm is not None
    expect(page.locator(".shape")).to_have_text("cable")
    centre = pixels(page, places(page, np.array([contact.centre_mm])))
    np.testing.assert_allclose(centre[0], [0xE8, 0x59, 0x0C], atol=8)
    # Markers that are closer than a disc is wide cover each other.
    assert (pixels(page, places(page, contact.markers_mm)) > 240).mean() > 0.85
    turn = np.deg2rad(contact.cable.angle_deg)
    along, across = np.array([np.cos(turn), np.sin(turn)]), np.array([-np.sin(turn), np.cos(turn)])
    middle = np.array(contact.cable.axis_point_mm)
    way = np.linspace(-8, 8, 41)[:, None] * along
    for side in (0.5, -0.5):
        border = pixels(page, places(page, middle + side * contact.cable.width_mm * across + way))
        assert (border > 200).all(axis=1).mean() > 0.7
    page.keyboard.press("o")
    bare = pixels(page, places(page, np.array([contact.centre_mm])))
    assert abs(bare[0] - [0xE8, 0x59, 0x0C]).max() > 40


def test_figures_are_those_of_the_processor(serve: Serve, page: Page, finger: Finger) -> None:
    opened(page, serve(finger))
    contact = Processor(finger.tip.layout)(values_of(finger))
    assert contact.cable
    text = page.locator(".contact").inner_text().replace("−", "-")
    assert f"{contact.cable.angle_deg:.1f}°" in text
    assert f"{contact.cable.width_mm:.2f} mm" in text
    assert f"{contact.threshold:.1f}" in text


def test_scale_gets_lighter_for_every_kind_of_colour_vision(serve: Serve, page: Page) -> None:
    opened(page, serve(TWIN))
    told = page.evaluate("import('/canvas.js').then((m) => m.RAMP)")
    coded = np.array(told) / 255
    linear = np.where(coded <= 0.04045, coded / 12.92, ((coded + 0.055) / 1.055) ** 2.4)
    # Machado, Oliveira and Fernandes 2009, severity 1: protan, deutan, tritan; then luminance.
    visions = [
        [
            [0.152286, 1.052583, -0.204868],
            [0.114503, 0.786281, 0.099216],
            [-0.003882, -0.048116, 1.051998],
        ],
        [
            [0.367322, 0.860646, -0.227968],
            [0.280085, 0.672501, 0.047413],
            [-0.011820, 0.042940, 0.968881],
        ],
        [
            [1.255528, -0.076749, -0.178779],
            [-0.078411, 0.930809, 0.147602],
            [0.004733, 0.691367, 0.303900],
        ],
        np.eye(3).tolist(),
    ]
    for vision in visions:
        light = linear @ np.array(vision).T @ [0.2126, 0.7152, 0.0722]
        assert (np.diff(light[::4]) > 0).all()
        assert light[-1] / light[0] > 10


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_page_follows_light_and_dark(serve: Serve, page: Page, scheme: str) -> None:
    page.emulate_media(color_scheme=scheme)  # type: ignore[arg-type]
    opened(page, serve(TWIN))
    colour = page.evaluate("getComputedStyle(document.body).backgroundColor")
    light = np.mean([int(part) for part in colour[4:-1].split(",")])
    assert (light > 128) == (scheme == "light")


def test_several_fingers_side_by_side(serve: Serve, page: Page) -> None:
    opened(page, serve("twin://cable", "twin://edge"))
    expect(page.locator(".finger")).to_have_count(2)
    one, two = (page.locator(".finger").nth(i).bounding_box() for i in range(2))
    assert one
    assert two
    assert one["y"] == two["y"]
    assert two["x"] >= one["x"] + one["width"]
    assert page.evaluate("lumitip.panels.get(2).grid.scale") > 8
    page.keyboard.press("2")
    expect(page.locator(".finger").nth(1)).to_have_class("finger chosen")


def test_keys_go_to_the_finger_that_has_the_focus(
    serve: Serve, page: Page, wait_for: WaitFor
) -> None:
    server = serve("twin://cable", "twin://edge")
    opened(page, server)
    expect(page.locator(".finger").nth(0)).to_have_class("finger chosen")
    page.locator(".finger").nth(1).locator(".tare").focus()
    expect(page.locator(".finger").nth(1)).to_have_class("finger chosen")
    page.keyboard.press("r")
    wait_for(lambda: server.registry.fingers[2].status()["recording"] is not None)
    assert server.registry.fingers[1].status()["recording"] is None
    page.keyboard.press("1")
    expect(page.locator(".finger").nth(0)).to_have_class("finger chosen")


def test_freeze_holds_the_picture_and_goes_on(serve: Serve, page: Page, wait_for: WaitFor) -> None:
    opened(page, serve("twin://demo"))
    frames, shown = "lumitip.panels.get(1).history.count", "lumitip.panels.get(1).newest.seq"
    drawn = "Number(document.querySelector('.finger').dataset.seq)"
    page.keyboard.press("Space")
    held, count = page.evaluate(drawn), page.evaluate(frames)
    wait_for(lambda: page.evaluate(frames) > count + 50)
    assert page.evaluate(shown) > held
    assert page.evaluate(drawn) == held
    # What redraws the page draws the same moment again.
    canvases = "[...document.querySelectorAll('.finger canvas')].map((c) => c.toDataURL())"
    words = "document.querySelector('aside').innerText.split('Link')[0]"
    redraw = "dispatchEvent(new Event('themed'))"
    page.evaluate(redraw)
    frozen, said = page.evaluate(canvases), page.evaluate(words)
    before = page.evaluate(frames)
    wait_for(lambda: page.evaluate(frames) > before + 50)
    for keys in ("vv", "oo", "www", "c"):
        for key in keys:
            page.keyboard.press(key)
            assert page.evaluate(drawn) == held
        assert page.evaluate(canvases) == frozen, keys
    page.set_viewport_size({"width": 1200, "height": 760})
    wait_for(lambda: page.evaluate(canvases) != frozen)
    page.locator(".grid").click(position={"x": 200, "y": 200})
    assert page.evaluate(drawn) == held
    page.set_viewport_size({"width": 1280, "height": 800})
    page.keyboard.press("c")
    wait_for(lambda: page.evaluate(canvases) == frozen)
    assert page.evaluate(words) == said
    page.keyboard.press("Space")
    wait_for(lambda: page.evaluate(drawn) > held + 50)


def test_what_is_old_does_not_look_as_if_it_were_now(
    serve: Serve, page: Page, finger: Finger
) -> None:
    server = serve(finger)
    opened(page, server)
    shown = page.locator(".finger")
    opacity = "getComputedStyle(document.querySelector('.well')).opacity"
    assert page.evaluate(opacity) == "1"
    state = shown.get_by_role("status").first
    expect(state).to_have_text("connected")
    finger.on_event(LinkEvent("lost", "out of reach, trying again"))
    expect(state).to_have_text("lost")
    expect(shown).to_have_class(re.compile("stale"))
    expect(shown.locator(".detail")).to_have_text("out of reach, trying again")
    assert float(page.evaluate(opacity)) < 0.5
    finger.on_event(LinkEvent("connected", "connected again"))
    expect(shown).not_to_have_class(re.compile("stale"))


def test_a_device_that_falls_silent_does_not_look_alive(
    serve: Serve, page: Page, still: Callable[..., Finger], layout: Layout
) -> None:
    page.goto(serve(still(layout, np.full(len(layout), 20), frames=100)).url)
    expect(page.locator(".finger")).to_have_class(re.compile("stale"))
    expect(page.locator(".detail")).to_have_text(re.compile("no frame for"))
    expect(page.locator(".finger [role=status]").first).to_have_text("silent")


def test_help_lists_the_keys_and_closes(serve: Serve, page: Page) -> None:
    opened(page, serve(TWIN))
    page.keyboard.press("?")
    expect(page.locator("#keys")).to_be_visible()
    for word in ("freeze", "tare", "recording", "choose a finger"):
        expect(page.locator("#keys")).to_contain_text(word)
    page.keyboard.press("Escape")
    expect(page.locator("#keys")).to_be_hidden()


def test_clicked_cells_are_plotted(serve: Serve, page: Page) -> None:
    server = serve(TWIN)
    opened(page, server)
    layout = server.registry.fingers[1].tip.layout
    x, y = places(page, np.array([[layout.x_mm[9], layout.y_mm[9]]]))[0]
    page.locator(".grid").click(position={"x": x, "y": y})
    expect(page.locator(".legend")).to_contain_text("cell 9")
    page.keyboard.press("c")
    expect(page.locator(".legend")).not_to_contain_text("cell 9")


def test_nothing_is_asked_of_another_computer(serve: Serve, page: Page) -> None:
    server, asked = serve(TWIN), set[str]()
    page.on("request", lambda request: asked.add(request.url))
    opened(page, server)
    assert len(asked) > 8
    assert all(url.startswith(server.url) for url in asked)
