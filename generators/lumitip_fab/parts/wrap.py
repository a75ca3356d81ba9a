"""Silicone beside the skin: in the keys of the plate, and round its tip.

Side view of the tip, gripping face up, beside the mould's stop:

                skin        ╲ taper
     ────────────────────┐   ╲
     plate               │    │ slot, and the mould's gap
     ──────╲╌╌╌╌╌╌╌╌╌╌╌╌╌┘    │
            ╲─────────────────╯ level of the silicone
                    lip
"""

from build123d import Solid

from lumitip_fab.design import Key, Mould, Outline, Stack, Tip
from lumitip_fab.parts import skin
from lumitip_fab.parts.plate import key_fillings, plate_solid
from lumitip_fab.parts.shapes import side_prism

BEYOND_MM = 1.0
_FAR_MM = 400.0


def fillings(
    keys: tuple[Key, ...], stack: Stack, outline: Outline, tip: Tip, mould: Mould
) -> list[Solid]:
    """The silicone in the keys, and round the tip."""
    return [*key_fillings(keys, stack, outline, tip), *_round_tip(stack, outline, tip, mould)]


def _round_tip(stack: Stack, outline: Outline, tip: Tip, mould: Mould) -> list[Solid]:
    """The silicone between rim plane and level, as far from the tip edge as it covers the back."""
    if not tip.slots:
        return []
    rim, far = stack.face_z_mm, outline.tip_y_mm + BEYOND_MM
    start = outline.tip_y_mm - mould.lip_length_mm(outline, tip)
    corners = [
        (start, rim),
        (far, rim),
        (far, rim - mould.level_mm(far)),
        (start, rim - mould.level_mm(start)),
    ]
    over = rim - stack.plate_mm
    within = skin.drafted_prism(stack, outline, mould, over, rim)
    room = within & side_prism(corners, -_FAR_MM, _FAR_MM)
    return list((room - plate_solid(stack, outline, tip)).solids())
