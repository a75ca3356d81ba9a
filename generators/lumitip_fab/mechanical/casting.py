"""The note for the person who pours: how much of what, for how long, in which order."""

from lumitip_fab.design import Mould, Stack

_NOTE = """# Casting the {finger} finger

| what | how much |
|---|---|
| silicone that stays on the finger | **{volume_ml:.2f} mL** |
| to mix, with {waste:.0%} for the cup and the weir | {mix_ml:.2f} mL |
| {silicone}, part A | **{part_a_g:.2f} g** |
| {silicone}, part B | **{part_b_g:.2f} g** |
| curing at {cure_c:g} °C | {cure_h:g} h |

Print `{finger}_mould.3mf` with its own settings (`print/printing.md`): open side up, without
supports, in layers of {layer_mm:g} mm. {layers}
The stops set the thickness of the silicone: cut off blobs, sand nothing. The mould has an {letter}
in the end of its trough, and the backing that belongs to it an {letter} on {letter_on}.

{board}
2. Degrease the board. Keep sulphur, latex gloves and fresh superglue away: they stop the cure.
3. Weigh A and B, stir for three minutes, and degas until no bubbles rise.
4. Wet the parts of the board with a drop from a brush, so that no air stays between them.
5. Put the mould level on paper. Fill it from one corner until the silicone bulges over the rim.
6. Set the tip on its stop at the closed end, the coupling towards the weir, and lower the finger
   slowly about the tip: air and surplus leave through the wire notch and over the weir.
7. Press on the plate, not on the coupling, until it rests on the tip line and both pads; lay the
   wires out over the weir. The silicone must stand at the rim in the wire notch, not above it.
8. Leave it for {cure_h:g} h. Take the plate between two fingers in the gaps of the wall, hold the
   coupling with the other hand and pull straight out. Cut the flash along the rim.
"""
_IN_POCKET = """\
1. Glue the board into the backing, flush with its rim. Close every window on the back with tape,
   and fill the slit round the board with a thin line of silicone; let it cure."""
_ON_PLATE = """\
1. Glue the interface to the backing, its rim in the groove, with an adhesive that bends; let it
   cure. Lay the board on the backing's flat face and tie it on with thread through their holes,
   knots on the back. Close every window and hole on the back with tape."""
_WHOLE = """\
The floor at {floor_mm:g} mm and the stops at {rim_mm:g} mm are then whole layers."""
_PART = """\
The slicer rounds the floor at {floor_mm:g} mm and the stops at {rim_mm:g} mm to whole layers, one
by {off_mm:.2f} mm, and the silicone is as much thicker or thinner: its thickness is kept by a
`mould.wall_mm` and `stack.silicone_mm` that one layer of 0.05 mm or more divides."""


def casting_note(finger: str, volume_ml: float, stack: Stack, mould: Mould) -> str:
    """The note as Markdown.

    Args:
        finger: its name.
        volume_ml: silicone that stays on it.
        stack: for the height of the stops.
        mould: its layers, the silicone, and how much is wasted.
    """
    mix_ml = volume_ml * (1 + mould.waste_fraction)
    a, b = mould.mix_ratio
    mass_g = mix_ml * mould.density_g_ml
    rim_mm = mould.wall_mm + stack.cover_mm
    return _NOTE.format(
        finger=finger,
        letter=finger[0].upper(),
        letter_on="the back of its block" if stack.sunk else "its back",
        board=_IN_POCKET if stack.sunk else _ON_PLATE,
        volume_ml=volume_ml,
        waste=mould.waste_fraction,
        mix_ml=mix_ml,
        silicone=mould.silicone,
        part_a_g=mass_g * a / (a + b),
        part_b_g=mass_g * b / (a + b),
        cure_h=mould.cure_h,
        cure_c=mould.cure_c,
        layer_mm=mould.layer_mm,
        layers=(_PART if mould.off_layer_mm else _WHOLE).format(
            floor_mm=mould.wall_mm, rim_mm=rim_mm, off_mm=mould.off_layer_mm
        ),
    )
