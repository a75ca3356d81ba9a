"""The figures in docs/making.md that say why a finger has a flare and no ribs."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from lumitip_fab.config.load import Input, load
from lumitip_fab.derive import resolve
from lumitip_fab.derive.auto.load import _body
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.derive.finger import strength
from lumitip_fab.derive.finger.strength import Body, borne_n
from lumitip_fab.derive.once import lay_out, optics_of
from lumitip_fab.design.beam import Block
from markdown_pages import ROOT

pytestmark = pytest.mark.slow
PAGE = ROOT / "docs" / "making.md"
RIB_MM = 2.4
"""Width: six printed lines."""
BEFORE_MM = 15.0
"""How far the ribs go on along the ramp."""
HIGH_MM, LOW_MM = 8.0, 4.0
"""Height of ribs in place of the flare, and beside it."""


def _finger(design_dir: Path, name: str) -> tuple[Input, Body]:
    config = resolve(load(design_dir / "presets" / f"{name}.toml")).config
    return config, _body(config, lay_out(config, Diagnostics(config)).plan)


def _borne_n(
    config: Input, body: Body, monkeypatch: pytest.MonkeyPatch, rib_mm: float = 0.0
) -> float:
    """Force that a finger bears with two ribs on its back, at the edges of the block's width, from
    the ramp to the end of the flare."""
    plain = strength._held

    def ribbed(body: Body, at: strength._Planes) -> tuple[list[Block], list[Block]]:
        blocks, taken = plain(body, at)
        mount, back = body.mount, blocks[-1][3]
        end_y = mount.ramp_end_y_mm(body.stack.back_z_mm, body.stack.rim_z_mm)
        along = (at.y > end_y - BEFORE_MM) & (at.y < end_y + mount.flare_mm)
        half = np.full_like(at.y, mount.block_width_mm / 2)
        top = np.maximum(back, at.back + rib_mm * along)
        return [*blocks, (half - RIB_MM, half, back, top)], taken

    with monkeypatch.context() as patched:
        patched.setattr(strength, "_held", ribbed)
        return borne_n(config, body, optics_of(config))


def _unflared(body: Body) -> Body:
    return replace(body, mount=replace(body.mount, flare_depth_mm=0.01))


@pytest.mark.parametrize("name", ["published", "franka_hand", "wsg50"])
def test_ribs_beside_the_flare_let_a_finger_bear_no_more(
    name: str, design_dir: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    config, body = _finger(design_dir, name)
    plain = _borne_n(config, body, monkeypatch)
    assert _borne_n(config, body, monkeypatch, LOW_MM) == pytest.approx(plain, rel=1e-3)
    assert _borne_n(config, _unflared(body), monkeypatch, HIGH_MM) < 0.8 * plain
    assert _borne_n(config, _unflared(body), monkeypatch) < 0.5 * plain


def test_the_page_has_the_figures(design_dir: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    config, body = _finger(design_dir, "published")
    bare = _unflared(body)
    found = [
        _borne_n(config, bare, monkeypatch),
        _borne_n(config, bare, monkeypatch, HIGH_MM),
        _borne_n(config, body, monkeypatch),
        _borne_n(config, body, monkeypatch, LOW_MM),
    ]
    text = " ".join(PAGE.read_text(encoding="utf-8").split())
    sentence = re.search(r"Without flare .*? low on the ramp", text)
    assert sentence, "the page says why there are no ribs"
    assert [int(n) for n in re.findall(r"(\d+) N", sentence[0])] == [round(n) for n in found]
    sizes_mm = [float(n) for n in re.findall(r"([\d.]+) mm", sentence[0])]
    assert sizes_mm == [RIB_MM, HIGH_MM, BEFORE_MM, LOW_MM]
