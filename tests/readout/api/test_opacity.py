"""Light through the coupon of a mask: `lumitip.health.opacity` and `lumitip doctor --opacity`."""

import math

import numpy as np
import pytest

from lumitip.cli import main
from lumitip.errors import ArgumentError
from lumitip.frame import complement
from lumitip.health.opacity import MOST_LEAK, Opacity, most_transmission, opacity
from lumitip.links import twin
from lumitip.links.twin import Matter, Scene, packet_at, published_layout

LAYOUT = published_layout()


def _light(shape: str, clear: float = 0.0, seed: int = 0) -> np.ndarray:
    scene = Scene(shape, 30.0, 1.5, 200.0, 8, seed, matter=Matter(clear=clear))
    return complement(packet_at(LAYOUT, scene, 0, 200).values, 8)


def _measured(clear: float) -> Opacity:
    return opacity(_light("empty"), _light("sheet", 0.0, 1), _light("sheet", clear, 2), LAYOUT)


@pytest.mark.parametrize("clear", [0.0, 0.02, 0.1, 0.5])
def test_the_transmission_of_a_sheet_between_twin_fingers(clear: float) -> None:
    result = _measured(clear)
    off = np.abs(result.transmission - clear)
    assert (off < 3 * result.error + 0.03 * clear).all(), "saturated cells look larger"
    assert result.opaque == (clear == 0.0)


def test_the_limit_is_a_share_of_the_light_through_the_holes() -> None:
    optics, most = LAYOUT.optics, most_transmission(LAYOUT)
    hole = optics.hole_mm**2 * math.sqrt(3) / 2
    rest = LAYOUT.pitch_mm**2 * math.sqrt(3) / 2 - hole
    assert most * rest == pytest.approx(MOST_LEAK * hole)


def test_a_hole_in_the_coupon_is_seen_at_its_cell() -> None:
    behind = _light("sheet", 0.0, 2)
    behind[:, 17] = _light("empty", seed=3)[:, 17]
    result = opacity(_light("empty"), _light("sheet", 0.0, 1), behind, LAYOUT)
    assert result.worst == 17
    assert not result.opaque


def test_cells_with_too_little_light_are_not_judged() -> None:
    dark = _light("sheet")
    result = opacity(dark, dark, dark, LAYOUT)
    assert not result.judged
    assert not result.opaque
    with pytest.raises(ArgumentError, match="no cell has enough light"):
        _ = result.worst


@pytest.mark.parametrize("wrong", [np.zeros((1, 32)), np.zeros((5, 31)), np.zeros(32)])
def test_frames_of_another_shape(wrong: np.ndarray) -> None:
    with pytest.raises(ArgumentError, match=r"coupon has shape .*; \(2 or more, 32\) is needed"):
        opacity(_light("empty"), _light("sheet"), wrong, LAYOUT)


class Hands:
    """What a user holds between the fingers: changed at each Enter."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, coupon: float) -> None:
        self.states = iter((("empty", 0.0), ("sheet", 0.0), ("sheet", coupon)))
        self.asked: list[str] = []
        self.held: tuple[str, float] = ("empty", 0.0)
        monkeypatch.setattr("builtins.input", self.enter)
        monkeypatch.setattr(twin, "packet_at", self.packet)

    def enter(self, text: str) -> str:
        self.asked.append(text)
        self.held = next(self.states)
        return ""

    def packet(self, layout, _, first, count):
        shape, clear = self.held
        return packet_at(
            layout, Scene(shape, 30.0, 1.5, 500.0, 8, 0, matter=Matter(clear=clear)), first, count
        )


@pytest.mark.slow
@pytest.mark.parametrize(("coupon", "verdict", "code"), [(0.0, "opaque", 0), (0.3, "NOT", 1)])
def test_the_command_asks_for_three_states(
    coupon: float,
    verdict: str,
    code: int,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    hands = Hands(monkeypatch, coupon)
    assert main(["doctor", "twin://empty?rate=500", "--opacity"]) == code
    assert [("metal" in text, "coupon" in text) for text in hands.asked] == [
        (False, False),
        (True, False),
        (False, True),
    ]
    printed = capsys.readouterr().out
    assert printed.splitlines()[-1].startswith(verdict)
    assert "at most 1.05% is allowed" in printed


def test_without_a_keyboard(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def closed(_: str) -> str:
        raise EOFError

    monkeypatch.setattr("builtins.input", closed)
    assert main(["doctor", "twin://empty?rate=500", "--opacity"]) == 2
    assert "run it in a terminal" in capsys.readouterr().err
