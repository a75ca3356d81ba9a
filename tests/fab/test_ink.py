"""A mask's print that does not hold is seen before the film is cut, and has other ways out."""

from dataclasses import replace

from lumitip_fab.design import Design
from lumitip_fab.docs.wrapping import wrapping_note
from lumitip_fab.mask.files import mask_files


def note(design: Design) -> str:
    (facts,) = (a.facts for a in mask_files(design, design.receiver) if a.facts)
    return " ".join(wrapping_note(design, design.receiver, facts).split())


def test_ink_that_does_not_hold_has_a_sign_and_other_routes(designs: dict[str, Design]) -> None:
    design = designs["published"]
    assert design.mask.route == "film"
    text = note(design)
    tried = text.index("whether ink holds on this film was not tried")
    wiped = text.index("a dry cloth wiped over the black stays clean")
    again = text.index("print a second time over it, and let that dry as well")
    sign = text.index("ink beads, or is wet after a day")
    assert tried < wiped < again < sign < text.index("### Cut")
    assert '`mask.route` to `"tpu"` or `"cut"`' in text
    for route in ("tpu", "cut"):
        assert " ink " not in note(replace(design, mask=replace(design.mask, route=route)))
