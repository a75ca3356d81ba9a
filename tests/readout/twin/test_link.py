"""`twin://`: what its options change, and that its bytes are a device's."""

import numpy as np
import pytest

from lumitip import Fingertip
from lumitip.errors import UrlError
from lumitip.frame import complement
from lumitip.links import open_link
from lumitip.links.twin import SHAPES, Matter, Scene, moved, packet_at, published_layout
from lumitip.protocol.packet import decode, encode
from lumitip.twin import Twin


def _light(shape: str = "edge", **changed: object) -> np.ndarray:
    scene = Scene(
        **(
            {
                "shape": shape,
                "speed_mm_s": 40.0,
                "noise": 0.0,
                "rate_hz": 50.0,
                "bits": 12,
                "seed": 0,
                "warm_up": 0.0,
            }
            | changed
        )
    )  # type: ignore[arg-type]
    return complement(packet_at(published_layout(), scene, 100, 5).values, 12)


@pytest.mark.parametrize("shape", SHAPES)
def test_packets_carry_what_the_twin_computes(shape: str) -> None:
    layout = published_layout()
    light = _light(shape)
    twin = Twin(layout, noise=0.0, bits=12, warm_up=0.0)
    for frame, t in zip(light, 2.0 + np.arange(5) / 50.0, strict=True):
        expected = twin.uncalibrated(twin.light(moved(shape, layout, 40.0 * t, Matter())))
        assert frame == pytest.approx(expected, abs=0.15)


def test_packets_survive_the_wire() -> None:
    layout = published_layout()
    for bits in (8, 10, 12):
        packet = packet_at(layout, Scene("cable", 12.0, 1.5, 100.0, bits, 3), 70_000, 9)
        again = decode(encode(packet), len(layout))
        assert (again.values == packet.values).all()
        assert (again.sequence, again.time_us) == (70_000 % 2**16, 700_000_000)


def test_options_change_the_light_as_they_should() -> None:
    usual = _light()
    assert np.abs(_light(gap_mm=6.0) - usual).max() > 20.0
    assert _light("sheet", matter=Matter(diffuse=0.3)).mean() == pytest.approx(0.3 * 240, rel=0.2)
    thin, thick = (_light("cable", matter=Matter(diameter_mm=d)).sum() for d in (1.0, 5.0))
    assert thin > thick
    assert _light(warm_up=0.1).max() > usual.max() + 2.0
    assert (_light(noise=1.5, seed=1) != _light(noise=1.5, seed=2)).any()


def test_an_address_sets_them() -> None:
    url = "twin://sheet?rate=500&gap=6&material=towel&noise=0&warm=0&bits=12"
    with Fingertip.open(url, calibrated=False) as tip:
        values = tip.read(10.0).values
    empty = Fingertip.open(url.replace("sheet", "empty"), calibrated=False)
    with empty as tip:
        share = values / tip.read(10.0).values
    assert share.mean() == pytest.approx(72.5 / 255.0, abs=0.01)
    for wrong in ("material=silk", "gap=0", "diameter=100", "warm=-1"):
        with pytest.raises(UrlError, match=wrong):
            open_link(f"twin://edge?{wrong}")


@pytest.mark.parametrize("task", ["trace-cloth", "trace-cable"])
def test_a_task_says_how_it_is_run(task: str) -> None:
    with pytest.raises(UrlError, match=f"examples/{task.replace('-', '_')}.py 60 8642"):
        open_link(f"twin://{task}")
