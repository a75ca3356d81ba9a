"""How to print a mask and wrap the finger with it, with this finger's own flaps."""

from lumitip_fab.design import Mask, Stack, Title
from lumitip_fab.markdown_text import as_written
from lumitip_fab.mask.artwork import Artwork
from lumitip_fab.mask.back import FOOT_MM
from lumitip_fab.mask.flaps import BAND_MM, Flap

_TEXT = """\
# {title}: printing and wrapping the {name} mask

The film is {film}, {film_mm:g} mm thick. Black is printed on its **inside**, so the page is a
mirror image on purpose: turn off "fit to page", "scale" and "mirror" in the print dialogue.

## 1. Make the printer true
1. Print `{name}_mask_a4.pdf` or `{name}_mask_letter.pdf` on plain paper at 100 %.
2. Measure both rulers, over all 100 mm, with a steel ruler.
3. Not 100.0 mm? Write the readings into the parameter file, horizontal first, as
   `mask.measured_ruler_mm = [99.2, 100.4]`, and build again. The next page is stretched by
   100/reading, rulers included, and its rulers measure 100.0 mm. The readings always belong to a
   page that was made with `[100.0, 100.0]`. This page was made for
   `[{across:g}, {up:g}]`.

## 2. Print on the film
1. Print the page on paper once more: this sheet is the carrier.
2. Tape a piece of film over the print, its inside up, so that it reaches beyond all four
   registration marks; tape its leading edge over the full width so that it lies flat.
3. Feed the carrier again by the same tray and the same way round, in the setting for heavy film.
   A laser printer's fuser is hotter than the film's softening point ({soften_c:g} °C): use the
   setting with the least heat, or an inkjet with pigment ink, and try a scrap first.
4. Hold the print against a lamp. Print a second time over it if the black is not dense.
5. From the unprinted side the letter F on the tip flap and the name {NAME} must read right.

## 3. Cut
Cut along the solid line and cut out the connector's window. The {count} apertures are clear film:
leave them. For a plotter, `{name}_mask.dxf` has the layers `CUT`, `WINDOW` and `FOLD`.

## 4. Wrap
1. Lay the film on the silicone, print inward, tip to tip; sight through the outer apertures to the
   parts below.
2. Warm it to {soften_c:g} °C (hot air or an oven) until it goes limp.
3. Fold each flap over the edge and flat onto the back, in the order of its number, and hold it
   until it is cold. The tip is 1, the gripper end 2 and 3, then opposite sides in turn from wide to
   narrow, 4 to {last}: the film is first taut lengthwise, then across, and the narrow flaps of the
   corners lap over their neighbours.
4. Bond the clear ends of the flaps with a thin film of silicone adhesive or double-sided tape.

The flaps are black where they cover the side of the finger ({side_mm:.1f} mm of silicone and
plate) and, where they are long enough, {band_mm:g} mm beyond, so that no stray light comes in
through the silicone's edge. Their ends are left clear because glue holds better on bare film than
on ink.

| fold | width of fold (mm) | length of flap (mm) | onto the back (mm) |
|---:|---:|---:|---:|
{table}

Folded and drawn tight, no flap comes nearer than {foot_mm:g} mm to the block and ramp of the
coupling, and none lies over the wire notch or, where there is room, over a window behind a part.
{shorter}
"""


def wrapping_note(artwork: Artwork, mask: Mask, stack: Stack, title: Title) -> bytes:
    """The bytes of the note, in Markdown.

    Args:
        artwork: of this finger, for its flaps.
        mask: film and rulers.
        stack: for the height of the finger's side.
        title: of the design.
    """
    flaps = sorted(artwork.flaps, key=lambda flap: flap.number)
    across, up = mask.measured_ruler_mm
    shortened = [str(f.number) for f in flaps if f.length_mm < mask.flap_mm]
    shorter = (
        f"That is why flaps {', '.join(shortened)} are shorter than {mask.flap_mm:g} mm."
        if shortened
        else f"All flaps are {mask.flap_mm:g} mm long."
    )
    text = _TEXT.format(
        title=as_written(f"{title.name} {title.revision}"),
        name=artwork.name.lower(),
        NAME=artwork.name,
        film=mask.film,
        film_mm=stack.film_mm,
        soften_c=mask.soften_c,
        across=across,
        up=up,
        count=len(artwork.apertures),
        side_mm=stack.plate_mm + stack.cover_mm,
        band_mm=BAND_MM,
        last=len(flaps),
        table="\n".join(map(_row, flaps)),
        foot_mm=FOOT_MM,
        shorter=shorter,
    )
    return text.encode()


def _row(flap: Flap) -> str:
    return f"| {flap.number} | {flap.width_mm:.1f} | {flap.length_mm:.1f} | {flap.reach_mm:.1f} |"
