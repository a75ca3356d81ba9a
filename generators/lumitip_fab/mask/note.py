"""How to make a mask by its route and wrap the finger with it, with this finger's own flaps."""

from lumitip_fab.design import Design
from lumitip_fab.mask.artwork import Artwork
from lumitip_fab.mask.flaps import BAND_MM, Flap
from lumitip_fab.mask.outline import FOOT_MM
from lumitip_fab.text import as_written

_FILM = """\
# {title}: printing and wrapping the {name} mask

The film is {material}, {film_mm:g} mm thick. Black is printed on its **inside**, so the page is a
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

## 3. Test the black
{infrared}

## 4. Cut
Cut along the solid line and cut out the connector's window. The {count} apertures are clear film:
leave them. For a plotter, `{name}_mask.dxf` has the layers `CUT`, `WINDOW` and `FOLD`.

## 5. Crease the folds
The folds are made off the finger, with local heat: its {weakest} keeps its shape only
up to {finger_c:g} °C.
1. Lay the film on a metal bar or a steel ruler, printed side down, a fold along its straight edge
   and the flap beyond it.
{crease}
## 6. Wrap
Nothing is heated from here on.
1. Lay the film on the silicone, print inward, tip to tip; sight through the outer apertures to the
   parts below.
{fold}
3. Bond the clear ends of the flaps with a thin film of silicone adhesive or double-sided tape,
   and hold each until the bond carries it.

The flaps are black where they cover the side of the finger ({side_mm:.1f} mm of silicone and
plate) and, where they are long enough, {band_mm:g} mm beyond, so that no stray light comes in
through the silicone's edge. Their ends are left clear because glue holds better on bare film than
on ink.
"""
_CUT = """\
# {title}: cutting and wrapping the {name} mask

The film is {material}, {film_mm:g} mm thick and opaque. A plotter cuts it; nothing is printed.

## 1. Test the film
{infrared}

## 2. Cut
`{name}_cut.dxf` is in mm, 1:1, and shows the inside of the film. A film on a liner has its outside
up: mirror the drawing in the plotter's program. Each layer is one tool: `HOLES` and `WINDOW` are
cut out, `CUT` is the edge and comes last, `FOLD` is scored with little force or left out.
1. Cut it in paper first and measure it over all flaps: {wide_mm:.1f} mm across and {long_mm:.1f} mm
   lengthwise. If it is not so, correct the plotter's scale in that direction.
2. Cut the film. The {count} apertures are circles of {hole_mm:g} mm: take every piece out.

## 3. Crease the folds
The folds are made off the finger, with local heat: its {weakest} keeps its shape only
up to {finger_c:g} °C.
1. Lay the film on a metal bar or a steel ruler, inside down, a fold along its straight edge and the
   flap beyond it.
{crease}
## 4. Wrap
Nothing is heated from here on.
1. Lay the film on the silicone, tip to tip; sight through the outer apertures to the parts below.
{fold}
3. Bond the ends of the flaps with a thin film of silicone adhesive or double-sided tape, unless
   the film has adhesive of its own, and hold each until the bond carries it.

The flaps cover the side of the finger ({side_mm:.1f} mm of silicone and
plate), so that no stray light comes in through the silicone's edge.
"""
_TPU = """\
# {title}: printing and wrapping the {name} mask

The mask is a sheet of {material}, {layers} of {layer_mm:g} mm: {film_mm:g} mm thick.
`{name}_sheet.3mf` lies on the bed as it prints, with its **outer face down**.

## 1. Print the sheet
1. Print `{name}_sheet.3mf` with `{settings}`, on a clean and level bed: lines of
   {line_mm:g} mm, no brim.
2. Peel it off cold. With a knife, part flaps that the print has joined at their feet.
3. Hold it against a lamp. The {count} apertures are open, and no light comes through beside them.
   Clear an aperture with a drill of {hole_mm:g} mm, turned by hand.
4. {known}

## 2. Test the sheet
{infrared}

## 3. Wrap
The folds are bent cold. Nothing is heated.
1. Lay the sheet on the silicone, its smooth face outward, tip to tip; sight through the outer
   apertures to the parts below.
{fold}
3. Bond the ends of the flaps with silicone adhesive or double-sided tape, and hold each until
   the bond carries it.

The flaps cover the side of the finger ({side_mm:.1f} mm of silicone and
plate), so that no stray light comes in through the silicone's edge.
"""
_TEXTS = {"film": _FILM, "cut": _CUT, "tpu": _TPU}
_INFRARED = """\
Many black plastics and inks let infrared through. Make a piece without apertures,
{coupon}.
Hold it between the fingers before they have masks:
`lumitip doctor URL --opacity` compares it with sheet metal and says whether it is opaque. If it is
not, take {other}."""
_OTHERS = {
    "film": "an ink with carbon black (a pigment ink), or print once more over it",
    "tpu": "a filament that is coloured with carbon black, or more layers",
    "cut": "a film that is coloured with carbon black",
}
_CREASE = """\
2. Bring that line alone to {soften_c:g} °C, with a narrow nozzle of hot air or an iron with its
   temperature set, until it goes limp.
3. Press the flap down over the edge and hold it until it is cold. Go on to the next fold, in the
   order of the flaps' numbers.
"""
_FOLD = """\
2. Fold each flap over the edge and flat onto the back, in the order of its number. The tip is 1,
   the gripper end 2 and 3, then opposite sides in turn from wide to narrow, 4 to {last}: the {what}
   is first taut lengthwise, then across, and the narrow flaps of the corners lap over their
   neighbours."""
_TABLE = """
| fold | width of fold (mm) | length of flap (mm) | onto the back (mm) |
|---:|---:|---:|---:|
{table}

Folded and drawn tight, no flap comes nearer than {foot_mm:g} mm to the block and ramp of the
coupling, and none lies over the wire notch or, where there is room, over a window behind a part.
{shorter}
"""


def wrapping_note(artwork: Artwork, design: Design) -> bytes:
    """The bytes of the note, in Markdown, for the mask's route.

    Args:
        artwork: of this finger, for its flaps.
        design: for the mask, what it and the finger bear, and their heights.
    """
    mask, stack, title = design.mask, design.stack, design.title
    flaps = sorted(artwork.flaps, key=lambda flap: flap.number)
    shortened = [str(f.number) for f in flaps if f.length_mm < mask.flap_mm]
    shorter = (
        f"Flaps {', '.join(shortened)} are shorter than {mask.flap_mm:g} mm for that, or because\n"
        "neighbours would overlap where the outline bends inward."
        if shortened
        else f"All flaps are {mask.flap_mm:g} mm long."
    )
    across, up = mask.measured_ruler_mm
    ends = [y for _, y in artwork.cut.corners]
    what = "sheet" if mask.route == "tpu" else "film"
    text = (_TEXTS[mask.route] + _TABLE).format(
        title=as_written(f"{title.name} {title.revision}"),
        name=artwork.name.lower(),
        NAME=artwork.name,
        material=mask.material,
        film_mm=stack.film_mm,
        across=across,
        up=up,
        count=len(artwork.apertures),
        hole_mm=mask.hole_mm,
        wide_mm=2 * max(abs(x) for x, _ in artwork.cut.corners),
        long_mm=max(ends) - min(ends),
        side_mm=stack.plate_mm + stack.cover_mm,
        band_mm=BAND_MM,
        infrared=_infrared(design),
        fold=_FOLD.format(last=len(flaps), what=what),
        table="\n".join(map(_row, flaps)),
        foot_mm=FOOT_MM,
        shorter=shorter,
        **(_printed(design) if mask.route == "tpu" else _creased(design)),
    )
    return text.encode()


def _infrared(design: Design) -> str:
    """How the mask's material is tested."""
    coupon, route = design.mask.coupon, design.mask.route
    size = f"{coupon.width_mm:.0f} x {coupon.length_mm:.0f} mm"
    pieces = {
        "film": f"`coupon_a4.pdf` on the same film, printed as often over it ({size})",
        "tpu": f"`coupon.3mf` ({size})",
        "cut": f"{size} of the same film",
    }
    return _INFRARED.format(coupon=pieces[route], other=_OTHERS[route])


def _creased(design: Design) -> dict[str, object]:
    """Figures of a film that is creased with heat."""
    weakest = min(design.heat_steps["cure"].parts, key=lambda part: part.limit_c)
    return {
        "crease": _CREASE.format(soften_c=design.heat_steps["crease"].temperature_c),
        "weakest": f"{weakest.name} of {weakest.material}",
        "finger_c": weakest.limit_c,
    }


def _printed(design: Design) -> dict[str, object]:
    """Figures of a sheet from a 3D printer."""
    sheet = design.mask.sheet
    letter = ", and the first letter of the finger's name on the tip flap," * sheet.letter
    return {
        "layers": "one layer" if sheet.layers == 1 else f"{sheet.layers} layers",
        "layer_mm": sheet.layer_mm,
        "line_mm": sheet.line_mm,
        "settings": design.slicing.sheet.file,
        "known": (
            f"Grooves along the folds{letter}\n   are on the inside. Where a flap turns onto the "
            "back there is none:\n   bend it there over a steel ruler."
            if sheet.layers > 1
            else "A fold runs from one foot of its flap to the other. Bend it over a steel ruler."
        ),
    }


def _row(flap: Flap) -> str:
    return f"| {flap.number} | {flap.width_mm:.1f} | {flap.length_mm:.1f} | {flap.reach_mm:.1f} |"
