"""Printed fingers by themselves, without a whole build."""

from pathlib import Path

from lumitip_fab.design import Design
from lumitip_fab.design.encoding import design_text
from lumitip_fab.parts.backing import backing


def written(design: Design, of: Design, out: Path) -> Path:
    """A design, with the printed fingers of another one."""
    (out / "backing").mkdir(parents=True)
    (out / "interface").mkdir()
    (out / "design.json").write_text(design_text(design), encoding="utf-8")
    for finger in of.fingers:
        for artefact in backing(of, finger):
            (out / artefact.path).write_bytes(artefact.data)
    return out
