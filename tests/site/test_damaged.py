"""A damaged file stops the page with an error that names it; what a browser cannot draw is said."""

import re
from collections.abc import Callable
from pathlib import Path

import pytest

from lumitip_fab.cli import main
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from site_page import Opened

pytestmark = pytest.mark.slow
Damage = Callable[[str], str]


def without(pattern: str) -> Damage:
    """A text without the first place that a pattern matches."""
    return lambda text: re.sub(pattern, "", text, count=1)


def cut(text: str) -> str:
    return text[: len(text) // 2]


def column(name: str) -> Damage:
    """A table whose column has another name."""
    return lambda text: text.replace(name, "other", 1)


def sum_of(word: str) -> Damage:
    """A table with a word where its last price is."""
    return lambda text: re.sub(r"[\d.]+\s*$", f"{word}\n", text)


def without_output(text: str) -> str:
    """A receiver whose U1 has no pad 3, the output of a 74HC4051."""
    head, mark, rest = text.partition('(fp_text reference "U1"')
    assert mark
    return head + mark + rest.replace('(pad "3"', '(pad "33"', 1)


def unlisted(path: str) -> Damage:
    """A manifest that does not list a file."""
    return lambda text: text.replace(f'"{path}": {{', f'"{path}.old": {{', 1)


DAMAGES = [
    ("wiring/wiring.svg", without("<svg")),
    ("wiring/wiring.svg", without(' viewBox="[^"]+"')),
    ("wiring/wiring.svg", cut),
    ("bom.csv", column("manufacturer")),
    ("bom.csv", sum_of("much")),
    ("bom.csv", lambda _: ""),
    ("order.csv", column(",price")),
    ("order.csv", sum_of("much")),
    ("wiring/cables.csv", column("signal")),
    ("wiring/cables.csv", column("length_mm")),
    ("wiring/cables.csv", lambda text: text.partition("\n")[0]),
    ("mask/receiver_mask.svg", without(r"\d+\.\d+,")),
    ("mask/emitter_mask.svg", lambda text: text.replace('evenodd" d="', 'evenodd" d="Z M', 1)),
    ("boards/receiver/receiver.kicad_pcb", without_output),
    ("boards/receiver/receiver.kicad_pcb", cut),
    ("boards/emitter/emitter.kicad_pcb", lambda text: text.replace("Edge.Cuts", "Dwgs.User")),
    ("boards/breakout/breakout.kicad_pcb", lambda text: text.replace("Edge.Cuts", "Dwgs.User")),
    ("firmware/layout.h", without(r"MUX(?=\[CELLS)")),
    ("layout.json", cut),
    ("manifest.json", without('"volume_mm3"')),
]


@pytest.mark.parametrize(
    ("file", "damage"), DAMAGES, ids=[f"{file}-{at}" for at, (file, _) in enumerate(DAMAGES)]
)
def test_a_damaged_file_is_named(
    edited: Path, capsys: pytest.CaptureFixture[str], file: str, damage: Damage
) -> None:
    path = edited / file
    text = path.read_text(encoding="utf-8")
    changed = damage(text)
    assert changed != text
    path.write_text(changed, encoding="utf-8")
    assert main(["page", "--quiet", "--out", str(edited)]) == 2
    assert file in capsys.readouterr().err


def test_a_layout_of_another_design_is_refused(
    edited: Path, design_dir: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    other = derive(load(design_dir / "presets/dense.toml")).layout
    (edited / "layout.json").write_text(other.to_json(), encoding="utf-8")
    assert main(["page", "--quiet", "--out", str(edited)]) == 2
    assert "layout.json: cannot be read (it is of another design)" in capsys.readouterr().err


@pytest.mark.parametrize("keep", [0, 10, 5000, -4])
def test_a_scene_cut_short_is_refused(
    edited: Path, capsys: pytest.CaptureFixture[str], keep: int
) -> None:
    scene = edited / "assembly/system.glb"
    scene.write_bytes(scene.read_bytes()[:keep])
    assert main(["page", "--quiet", "--out", str(edited)]) == 2
    assert "system.glb: cannot be read" in capsys.readouterr().err


def test_a_scene_that_cannot_be_drawn_leaves_the_rest(edited: Path, opened: Opened) -> None:
    """Such as one whose bodies have no colours."""
    scene = edited / "assembly/system.glb"
    data = scene.read_bytes()
    scene.write_bytes(data.replace(b'"baseColorFactor"', b'"baseColorFaktor"'))
    assert main(["page", "--quiet", "--out", str(edited)]) == 0
    tab = opened("#cell-17", edited)
    assert str(tab.locator("#no-model").text_content()).startswith("There is no 3D view: ")
    assert tab.locator("#no-model").is_visible()
    assert not tab.locator("#canvas").is_visible()
    assert tab.locator("#record-h").text_content() == "Cell 17"
    assert "Cell 17 reads" in str(tab.locator("#reads").text_content())
    tab.locator("#bed").scroll_into_view_if_needed()
    tab.wait_for_selector("#bed canvas")


def test_a_browser_without_webgl_shows_the_rest(edited: Path, opened: Opened) -> None:
    page = edited / "index.html"
    script = "<script>HTMLCanvasElement.prototype.getContext = () => null</script>"
    text = page.read_text(encoding="utf-8")
    page.write_text(text.replace("<body>", f"<body>{script}", 1), encoding="utf-8")
    tab = opened("", edited)
    text = "There is no 3D view: this browser has no WebGL 2."
    assert tab.locator("#no-model").text_content() == text
    assert tab.locator("#no-bed").text_content() == text
    assert not tab.locator("#bed-panel").is_visible()
    tab.evaluate("choose(3)")
    assert tab.locator("#record-h").text_content() == "Cell 3"
