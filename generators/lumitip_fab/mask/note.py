"""How to print a mask and wrap the finger with it, with this finger's own flaps."""

from lumitip_fab.design import HeatStep, Mask, Stack, Title
from lumitip_fab.mask.artwork import Artwork
from lumitip_fab.mask.flaps import BAND_MM, Flap
from lumitip_fab.mask.outline import FOOT_MM
from lumitip_fab.text import as_written

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
   Use an inkjet with pigment ink. A laser printer's fuser is hotter than this film bears: use
   one only with a film that its maker sells for laser printers.
4. Hold the print against a lamp. Print a second time over it if the black is not dense.
5. From the unprinted side the letter F on the tip flap and the name {NAME} must read right.

## 3. Cut
Cut along the solid line and cut out the connector's window. The {count} apertures are clear film:
leave them. For a plotter, `{name}_mask.dxf` has the layers `CUT`, `WINDOW` and `FOLD`.

## 4. Crease the folds
The folds are made off the finger, with local heat: its {weakest} keeps its shape only
up to {finger_c:g} °C.
1. Lay the film on a metal bar or a steel ruler, printed side down, a fold along its straight edge
   and the flap beyond it.
2. Bring that line alone to {soften_c:g} °C, with a narrow nozzle of hot air or an iron with its
   temperature set, until it goes limp.
3. Press the flap down over the edge and hold it until it is cold. Go on to the next fold, in the
   order of the flaps' numbers.

## 5. Wrap
Nothing is heated from here on.
1. Lay the film on the silicone, print inward, tip to tip; sight through the outer apertures to the
   parts below.
2. Fold each flap over the edge and flat onto the back, in the order of its number. The tip is 1,
   the gripper end 2 and 3, then opposite sides in turn from wide to narrow, 4 to {last}: the film
   is first taut lengthwise, then across, and the narrow flaps of the corners lap over their
   neighbours.
3. Bond the clear ends of the flaps with a thin film of silicone adhesive or double-sided tape,
   and hold each until the bond carries it.

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


def wrapping_note(
    artwork: Artwork, mask: Mask, stack: Stack, heat: tuple[HeatStep, ...], title: Title
) -> bytes:
    """The bytes of the note, in Markdown.

    Args:
        artwork: of this finger, for its flaps.
        mask: film and rulers.
        stack: for the height of the finger's side.
        heat: what the film and the finger bear.
        title: of the design.
    """
    steps = {step.name: step for step in heat}
    weakest = min(steps["cure"].parts, key=lambda part: part.limit_c)
    flaps = sorted(artwork.flaps, key=lambda flap: flap.number)
    across, up = mask.measured_ruler_mm
    shortened = [str(f.number) for f in flaps if f.length_mm < mask.flap_mm]
    shorter = (
        f"Flaps {', '.join(shortened)} are shorter than {mask.flap_mm:g} mm for that, or because\n"
        "neighbours would overlap where the outline bends inward."
        if shortened
        else f"All flaps are {mask.flap_mm:g} mm long."
    )
    text = _TEXT.format(
        title=as_written(f"{title.name} {title.revision}"),
        name=artwork.name.lower(),
        NAME=artwork.name,
        film=mask.film,
        film_mm=stack.film_mm,
        soften_c=steps["crease"].temperature_c,
        weakest=f"{weakest.name} of {weakest.material}",
        finger_c=weakest.limit_c,
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
