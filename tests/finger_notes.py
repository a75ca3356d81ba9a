"""The files of a finger's mask and of its mould, each with its note as a whole build writes it."""

from pathlib import Path

from lumitip_fab.config.load import Input
from lumitip_fab.derive import derive
from lumitip_fab.design import Design, Finger
from lumitip_fab.design.encoding import design_text
from lumitip_fab.docs.casting import casting_note, silicone_mix
from lumitip_fab.docs.wrapping import wrapping_note
from lumitip_fab.mask.files import mask_files
from lumitip_fab.parts.coupon import coupon_files
from lumitip_fab.parts.mould import mould_files
from lumitip_fab.parts.sheet import sheet_files
from lumitip_fab.pipeline.artefact import Artefact


def noted_mask(design: Design, finger: Finger) -> list[Artefact]:
    """A finger's mask with the note on wrapping."""
    files = mask_files(design, finger)
    (facts,) = (a.facts for a in files if a.facts)
    note = wrapping_note(design, finger, facts).encode()
    return [*files, Artefact(f"mask/{finger.name}_wrapping.md", note, frame="")]


def noted_mould(design: Design, finger: Finger) -> list[Artefact]:
    """A finger's mould with the note on casting."""
    files = mould_files(design, finger)
    (cast_ml,) = (a.facts["cast_ml"] for a in files if "cast_ml" in a.facts)
    note = casting_note(design, finger, silicone_mix(cast_ml, design.mould)).encode()
    return [*files, Artefact(f"mould/{finger.name}_casting.md", note, frame="")]


def written_masks(config: Input, out: Path) -> Path:
    """Write the masks of a design by every route, and what their checks read, into a folder."""
    design = derive(config)
    for folder in ("mask", "manual"):
        (out / folder).mkdir(parents=True)
    (out / "design.json").write_text(design_text(design), encoding="utf-8")
    for finger in design.fingers:
        for artefact in (*noted_mask(design, finger), *sheet_files(design, finger)):
            (out / artefact.path).write_bytes(artefact.data)
    for artefact in coupon_files(design):
        (out / artefact.path).write_bytes(artefact.data)
    return out
