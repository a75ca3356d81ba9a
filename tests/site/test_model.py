"""The 3D view of the page: pixels, bodies, and the cell."""

from io import BytesIO
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Page

from lumitip_fab.checks.readers.scene import read_scene
from lumitip_fab.checks.readers.vertices import corners_mm
from lumitip_fab.site.library import three_js
from site_page import Opened, differ, marked, seen

pytestmark = pytest.mark.slow

PLACES = """names => names.map(name => {
    const { model } = lumitip, box = model.canvas.getBoundingClientRect();
    const at = model.middleOf(model.bodies.get(name)).project(model.camera);
    return [box.x + box.width * (at.x + 1) / 2, box.y + box.height * (1 - at.y) / 2];
})"""


def bodies(tab: Page) -> set[str]:
    """Names of the bodies that are switched on."""
    script = "[...lumitip.model.bodies.values()].filter(b => b.visible).map(b => b.name)"
    return set(tab.evaluate(script))


def orange(pixels: np.ndarray) -> np.ndarray:
    """Where the colour of the chosen cell is, shape `(n, 2)`: rows and columns."""
    red, green, blue = np.moveaxis(pixels, 2, 0)
    return np.argwhere((red > 200) & (abs(green - 90) < 45) & (blue < 70))


def test_every_body_of_the_file_is_drawn_in_its_place(opened: Opened, site: Path) -> None:
    scene = read_scene(site / "assembly/system.glb")
    tab = opened("", color_scheme="light")
    middles = tab.evaluate(
        "[...lumitip.model.bodies].map(([name, b]) => [name, ...lumitip.model.middleOf(b)])"
    )
    assert {name for name, *_ in middles} == set(scene.nodes)
    for name, *middle in middles:
        points = scene.nodes[name].in_scene_mm
        wanted = (points.min(axis=0) + points.max(axis=0)) / 2
        # The browser bounds corners of the box in the body's own frame.
        assert np.abs(np.array(middle) - wanted).max() < 0.8, name


def test_parts_go_on_and_off_and_apart(opened: Opened) -> None:
    tab = opened("#cell-17", color_scheme="light", viewport={"width": 1440, "height": 900})
    first = seen(tab)
    assert 0.03 < (abs(first - first[2, 2]) > 30).any(axis=2).mean() < 0.6
    tab.locator('#switches [data-kind="emitter.backing"]').uncheck()
    assert "emitter.backing" not in bodies(tab)
    without = seen(tab)
    assert differ(first, without) > 0.01
    tab.locator('#switches [data-kind="emitter.backing"]').check()
    assert differ(first, seen(tab)) < 0.001
    tab.locator("#explode").fill("100")
    apart = seen(tab)
    assert differ(first, apart) > 0.03
    tab.locator("#explode").fill("0")
    assert differ(first, seen(tab)) < 0.001
    tab.locator("#cut").select_option("1")
    assert differ(first, seen(tab)) > 0.03
    tab.locator("#cut").select_option("")
    assert differ(first, seen(tab)) < 0.001


def test_the_whole_system_and_back(opened: Opened) -> None:
    tab = opened()
    assert not any(name.startswith(("gripper", "flange")) for name in bodies(tab))
    tab.locator("#look-all").click()
    assert {"gripper.envelope", "flange.lower", "holder.tray"} <= bodies(tab)
    tab.locator("#look-fingers").click()
    assert not any(name.startswith(("gripper", "flange")) for name in bodies(tab))


OUTSIDE = """() => [...lumitip.model.bodies].filter(([, body]) => {
    const { min, max } = new THREE.Box3().setFromObject(body);
    return [0, 1, 2, 3, 4, 5, 6, 7].some(corner => {
        const at = ["x", "y", "z"].map((axis, bit) => (corner >> bit & 1 ? max : min)[axis]);
        return new THREE.Vector3(...at).project(lumitip.model.camera).toArray()
            .some(v => Math.abs(v) > 1);
    });
}).map(([name]) => name)"""


def test_all_of_the_exploded_system_is_in_the_picture(opened: Opened) -> None:
    tab = opened("", viewport={"width": 1440, "height": 900})
    tab.locator("#look-all").click()
    tab.locator("#explode").fill("100")
    assert tab.evaluate(OUTSIDE) == []


def test_the_face_of_a_finger_is_seen_without_its_film(opened: Opened) -> None:
    tab = opened()
    tab.locator("#cut").select_option("0")
    tab.get_by_role("button", name="Receiver face, film off").click()
    assert tab.locator("#cut").input_value() == "" and tab.locator("#cut-at").is_disabled()
    assert tab.evaluate("lumitip.model.renderer.clippingPlanes.length") == 0
    shown = bodies(tab)
    assert "receiver.film" not in shown and {"receiver.Q1", "receiver.board"} <= shown
    assert not tab.locator('#switches [data-kind="receiver.film"]').is_checked()
    tab.locator("#look-fingers").click()
    assert {"receiver.film", "emitter.film"} <= bodies(tab)


def test_a_cut_goes_through_a_finger_and_is_seen(opened: Opened) -> None:
    """Both fingers, but for a cut along their faces; the half before it is taken away."""
    tab = opened()
    for axis in ("1", "2", "0"):
        tab.locator("#cut").select_option(axis)
        across, side = tab.evaluate(
            """() => {
                const { plane, bodies, camera } = lumitip.model;
                const met = name =>
                    plane.intersectsBox(new THREE.Box3().setFromObject(bodies.get(name)));
                return [["emitter.board", "receiver.board"].filter(met).length,
                    plane.distanceToPoint(camera.position)];
            }"""
        )
        assert across >= (1 if axis == "0" else 2), axis
        assert side < 0
    labels = tab.locator("#switches label").all_text_contents()
    assert "gripper (outline only)" in labels


def test_a_marked_body_keeps_its_shading(opened: Opened) -> None:
    tab = opened("", color_scheme="light", viewport={"width": 1440, "height": 900})
    tab.locator("#query").fill("backing.min_wall emitter")
    tab.locator("#check-table tbody .show").first.click()
    tab.evaluate("byId('canvas').scrollIntoView({ block: 'center' })")
    tab.evaluate("lumitip.model.turnTo(lumitip.model.away, 1.4, 0.5)")
    pixels = seen(tab)
    red, green, blue = np.moveaxis(pixels, 2, 0)
    tinted = pixels[(blue - red > 60) & (abs(blue - green) < 50)].sum(axis=1)
    assert len(tinted) > 2000
    assert np.ptp(np.percentile(tinted, (10, 90))) > 15


def test_two_marked_bodies_differ_in_colour(opened: Opened) -> None:
    tab = opened()
    tab.locator("#query").fill("assembly.interference emitter")
    tab.locator("#check-table tbody .show").first.click()
    colours = "['emitter.backing', 'emitter.silicone'].map(n => lumitip.model.bodies.get(n)"
    one, other = tab.evaluate(f"{colours}.material.color.getHSL({{}}).h)")
    assert abs(one - other) > 0.05
    tab.keyboard.press("Escape")
    kept = tab.evaluate(f"{colours}).map(b => b.material.color.equals(b.userData.colour))")
    assert kept == [True, True]


def test_a_cell_is_marked_and_followed_in_3d(opened: Opened) -> None:
    tab = opened("#cell-17", color_scheme="light", viewport={"width": 1440, "height": 900})
    tab.locator("#look-receiver").click()
    for cell in (17, 0):
        tab.evaluate(f"choose({cell})")
        tab.locator("#canvas").scroll_into_view_if_needed()
        ((x, y),) = tab.evaluate(PLACES, [f"receiver.Q{cell + 1}"])
        box = tab.locator("#canvas").bounding_box()
        assert box is not None
        found = orange(seen(tab))
        assert len(found) > 5
        assert np.hypot(*(found - (y - box["y"], x - box["x"])).T).min() < 6


def test_a_click_on_a_device_chooses_its_cell(opened: Opened) -> None:
    tab = opened("#cell-0", viewport={"width": 1440, "height": 900})
    tab.locator("#look-receiver").click()
    tab.locator("#canvas").scroll_into_view_if_needed()
    for cell in (17, 4, 31):
        ((x, y),) = tab.evaluate(PLACES, [f"receiver.Q{cell + 1}"])
        tab.mouse.click(x, y)
        assert marked(tab, "view") == [cell]
        assert str(tab.locator("#hit").text_content()).startswith("receiver.")


def test_keys_and_the_mouse_turn_it(opened: Opened) -> None:
    tab = opened("", color_scheme="light")
    canvas = tab.locator("#canvas canvas")
    canvas.focus()
    first = seen(tab)
    tab.keyboard.press("ArrowLeft")
    tab.keyboard.press("+")
    assert differ(first, seen(tab)) > 0.01
    tab.keyboard.press("0")
    assert differ(first, seen(tab)) < 0.002
    box = canvas.bounding_box()
    assert box is not None
    tab.mouse.move(box["x"] + 100, box["y"] + 60)
    tab.mouse.down()
    tab.mouse.move(box["x"] + 220, box["y"] + 90)
    tab.mouse.up()
    assert differ(first, seen(tab)) > 0.01


def on_bed(tab: Page) -> np.ndarray:
    """The colours of the view of the bed, once it stands still."""
    tab.locator("#bed canvas").scroll_into_view_if_needed()
    tab.wait_for_function("lumitip.bed.viewer.sized && !lumitip.bed.viewer.waiting")
    tab.evaluate("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")
    return np.asarray(Image.open(BytesIO(tab.locator("#bed").screenshot())).convert("RGB"), int)


def test_every_print_lies_on_the_bed_as_in_its_file(opened: Opened, site: Path) -> None:
    tab = opened("", color_scheme="light")
    tab.locator("#bed").scroll_into_view_if_needed()
    tab.wait_for_selector("#bed canvas")
    first = on_bed(tab)
    boxes = tab.evaluate(
        """[...lumitip.bed.viewer.bodies].map(([file, body]) => {
            body.geometry.computeBoundingBox();
            const { min, max } = body.geometry.boundingBox;
            return [file, [...min], [...max], body.geometry.index.count / 3];
        })"""
    )
    assert len(boxes) >= 8
    for file, low, high, triangles in boxes:
        corners = corners_mm(site / file)
        assert np.abs(low - corners.min(axis=0)).max() < 0.005, file
        assert np.abs(high - corners.max(axis=0)).max() < 0.005, file
        assert triangles == len(corners) / 3
    tab.get_by_role("button", name="Show holder/holder.stl").first.click()
    assert tab.locator("#bed-part").input_value() == "holder/holder.stl"
    assert "g of PETG" in str(tab.locator("#bed-text").text_content())
    assert differ(first, on_bed(tab)) > 0.02


def test_the_thinnest_wall_is_marked_in_its_place(opened: Opened) -> None:
    tab = opened("", color_scheme="light")
    tab.locator("#query").fill("holder.min_wall")
    note = str(tab.locator("#check-table tbody td").nth(6).text_content())
    tab.locator("#check-table tbody .show").click()
    tab.wait_for_selector("#bed canvas")
    assert len(orange(on_bed(tab))) > 20
    place = tab.evaluate("[...lumitip.bed.spot.position]")
    assert "({:.1f}, {:.1f}, {:.1f})".format(*place) in note
    assert tab.locator("#bed-part").input_value() == "holder/holder.stl"
    tab.locator("#bed-part").select_option("fit/fit_plate.stl")
    assert len(orange(on_bed(tab))) == 0


def test_a_line_of_a_table_is_shown_in_3d(opened: Opened) -> None:
    tab = opened("", color_scheme="light")
    tab.locator("#bill").get_by_role("button", name="Show holder/holder.stl").click()
    assert "holder.tray" in bodies(tab)
    marks = tab.evaluate("[...lumitip.model.marked]")
    assert "holder.tray" in marks
    tab.keyboard.press("Escape")
    assert "holder.tray" not in tab.evaluate("[...lumitip.model.marked]")


def test_the_library_has_its_licence_and_is_whole() -> None:
    script = three_js()
    assert "Permission is hereby granted, free of charge" in script
    assert 500_000 < len(script) < 800_000
    assert "</script" not in script
