"""Pictures of solids and layers, and the page in a browser."""

import io
import shutil
from pathlib import Path

import numpy as np
import pytest
import shapely
import trimesh
from PIL import Image
from playwright.sync_api import sync_playwright

from lumitip_fab.cli import main
from lumitip_fab.diff.copper import _svg
from lumitip_fab.diff.render import COLOURS, pictures
from lumitip_fab.parts.surface import Mesh
from programs import program


def _box(*bounds: float) -> Mesh:
    """A box from x, y, z to x, y, z (mm)."""
    box = trimesh.creation.box(bounds=np.reshape(bounds, (2, 3)))
    return Mesh(np.asarray(box.vertices, float), np.asarray(box.faces, np.int64))


def _seen(png: bytes) -> dict[str, np.ndarray]:
    """Where each colour is, shape `(height, width)`, by hue; and where anything is."""
    pixels = np.asarray(Image.open(io.BytesIO(png)), int)
    red, _, blue = pixels[..., :3].transpose(2, 0, 1)
    there = pixels[..., 3] > 128
    return {"all": there, "a": there & (red > blue + 30), "b": there & (blue > red + 30)}


@pytest.mark.slow
def test_each_side_has_its_colour_in_its_place() -> None:
    bodies = {
        "both": _box(-5, -5, 0, 5, 5, 2),
        "a": _box(-9, -5, 0, -5, 5, 2),
        "b": _box(5, -5, 0, 9, 5, 2),
    }
    front, behind = (_seen(png) for png in pictures(bodies))
    middle = [np.mean(np.nonzero(front[side])[1]) for side in "ab"]
    assert middle[0] < middle[1] - 100  # A is on the left
    middle = [np.mean(np.nonzero(behind[side])[1]) for side in "ab"]
    assert middle[0] > middle[1] + 100  # and on the right from behind
    for side in "ab":
        assert 0.1 < front[side].sum() / front["all"].sum() < 0.4
    edges = front["all"][[0, -1]].any(), front["all"][:, [0, -1]].any()
    assert edges == (False, False)
    assert pictures(bodies) == pictures(bodies)


@pytest.mark.slow
def test_a_difference_inside_shines_through_and_a_film_of_rounding_does_not() -> None:
    solid = _box(-5, -5, 0, 5, 5, 10)
    hidden = _seen(pictures({"both": solid, "b": _box(-1, -1, 4, 1, 1, 6)})[0])
    assert 0.01 < hidden["b"].sum() / hidden["all"].sum() < 0.2
    film = _seen(pictures({"both": solid, "a": _box(-5, -5, 10, 5, 5, 10 + 4e-6)})[0])
    assert film["a"].sum() == 0
    grey = np.array(COLOURS["both"])
    assert np.ptp(grey) < 30  # neither hue


def test_rings_are_round_few_small_pieces_alone() -> None:
    copper = shapely.box(0, 0, 40, 40)
    none, dot = shapely.Polygon(), shapely.box(50, 5, 50.5, 5.5)
    assert _svg({"both": copper, "only-a": none, "only-b": dot}).count("<circle") == 1
    assert "<circle" not in _svg({"both": copper, "only-a": none, "only-b": copper})
    hole = copper - shapely.box(10, 10, 20, 20)
    assert _svg({"both": hole, "only-a": none, "only-b": none}).count("M") == 2


@pytest.mark.slow
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_the_page_opens_without_network_and_without_errors(
    scheme: str, outputs: Path, other: Path, tmp_path: Path
) -> None:
    out = tmp_path / "diff"
    spare = Path(shutil.copytree(other, tmp_path / "other"))
    shutil.copyfile(spare / "mask/coupon.stl", spare / "mask/spare.stl")
    assert main(["diff", str(outputs), str(spare), "--out", str(out), "--no-checks"]) == 0
    said: list[str] = []
    requested: list[str] = []
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=program("chromium"), args=["--no-sandbox"]
        )
        tab = browser.new_context(color_scheme=scheme, offline=True).new_page()
        tab.on("console", lambda message: said.append(message.text))
        tab.on("pageerror", lambda error: said.append(str(error)))
        tab.on("request", lambda request: requested.append(request.url))
        for width in (1280, 420):
            tab.set_viewport_size({"width": width, "height": 900})
            tab.goto((out / "diff.html").as_uri())
            assert tab.evaluate("document.documentElement.scrollWidth") <= width
        sections = tab.eval_on_selector_all("section[id]", "all => all.map(s => s.id)")
        broken = tab.eval_on_selector_all(
            "img", "all => all.filter(i => !i.complete || !i.naturalWidth).length"
        )
        pictures_shown = tab.locator("img").count(), tab.locator(".card svg").count()
        background = tab.evaluate("getComputedStyle(document.body).backgroundColor")
        title = tab.locator(".side.b").inner_text()
        browser.close()
    assert said == []
    assert {url for url in requested if not url.startswith("data:")} == {
        (out / "diff.html").as_uri()
    }
    assert sections == ["parameters", "facts", "solids", "copper", "bill", "files"]
    assert broken == 0
    assert pictures_shown[0] >= 16
    assert pictures_shown[1] == 4
    dark = sum(map(int, background.removeprefix("rgb(").removesuffix(")").split(","))) < 200
    assert dark == (scheme == "dark")
    assert "<i>Other</i> & co A" in title  # the name as it is written
