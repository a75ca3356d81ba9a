"""The files of a finger's mask and of its mould, each with its note as a whole build writes it."""

from lumitip_fab.design import Design, Finger
from lumitip_fab.docs.casting import casting_note, silicone_mix
from lumitip_fab.docs.wrapping import wrapping_note
from lumitip_fab.mask.files import mask_files
from lumitip_fab.parts.mould import mould_files
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
