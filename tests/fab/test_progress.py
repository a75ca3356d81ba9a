"""How much of a build is done, in the seconds that its steps take."""

from pathlib import Path

import pytest

from lumitip_fab.cli.build import build
from lumitip_fab.cli.steps import STEPS


@pytest.mark.slow
def test_progress_rises_to_all_that_there_is(design_dir: Path, damaged: Path) -> None:
    (damaged / "mask/emitter_mask.svg").unlink()
    (damaged / "wiring/cables.csv").unlink()
    (damaged / "bom.csv").unlink()
    seen: list[tuple[str, int, int]] = []
    file = design_dir / "presets" / "published.toml"
    asked = ["mask", "wiring", "firmware", "bom"]
    build(file, damaged, lambda *step: seen.append(step), only=asked)
    names, done, total = zip(*seen, strict=True)
    assert {"mask.emitter", "wiring", "bom"} <= set(names)
    assert "firmware" not in names  # kept, and so done before
    assert len(set(total)) == 1
    assert list(done) == sorted(set(done))
    assert done[0] > 1 and done[-1] == total[0]


def test_long_steps_count_more() -> None:
    takes_s = {step.name: step.takes_s for step in STEPS}
    assert min(takes_s.values()) >= 1
    assert takes_s["finger_board"] == max(takes_s.values()) > takes_s["mask"]
