"""The manual's step of the boards: ordering, polarity, panels, soldering, measuring."""

from collections import Counter

from lumitip_fab.design import Design, Finger, Packages
from lumitip_fab.design.boards import GLUE_FILM_MM, thickness_off_mm
from lumitip_fab.docs.bill import TESTED
from lumitip_fab.docs.protection import protection_note
from lumitip_fab.docs.wiring import listed
from lumitip_fab.pipeline.artefact import Files
from lumitip_fab.text import as_written, passage

PROUD_MM = 0.05
"""So much thicker than its pocket is deep a board may be."""
_PROBE_V = 0.15  # less than at the working current: a diode test drives about 1 mA


def boards(design: Design, files: Files) -> str:
    """Ordering, panels, soldering, measuring."""
    auxiliary = design.auxiliary_boards
    names = ("emitter", "receiver", *(board.name for board in auxiliary))
    behind = any(part.side == "back" for part in design.emitter.parts)
    backs = ["emitter"] if behind else []
    backs += [board.name for board in auxiliary if any(d.side == "back" for d in board.components)]
    pictures = [
        f"![The {name} board, {side}](boards/{name}/{name}_{side}.png)"
        for side, shown in (("front", names), ("back", backs))
        for name in shown
        if files.like(f"boards/{name}/{name}_{side}.png")
    ]
    reflowed = _reflowed(design)
    return _text(
        "boards",
        names=listed(list(names)),
        panels=_panels(design),
        solder=design.heat_steps["solder"],
        reflowed=reflowed,
        hot_air=", hot air, flux" * bool(reflowed),
        calipers=", calipers" * design.stack.sunk,
        thick=_thick(design.stack.pcb_mm) if design.stack.sunk else "",
        short=4 if design.stack.sunk else 3,
        breaking=", pliers, small files, safety glasses" * bool(design.panels),
        polarity=polarity_test(design.packages, design.fingers),
        protection=protection_note(design),
        led=design.packages.led,
        detector=design.packages.photodetector,
        unplaced=_unplaced(files),
        last=", then the string resistors on the back of the emitter" if behind else "",
        pictures="\n".join(pictures),
    )


def _thick(pcb_mm: float) -> str:
    """How boards are measured that must not stand out of their pockets."""
    off_mm = thickness_off_mm(pcb_mm)
    return (
        _text(
            "thick",
            pcb_mm=pcb_mm,
            low_mm=pcb_mm - off_mm,
            high_mm=pcb_mm + off_mm,
            most_mm=pcb_mm + PROUD_MM,
            film_mm=GLUE_FILM_MM,
        )
        + "\n"
    )


def _unplaced(files: Files) -> str:
    """Parts that the PCB fab which mounts parts does not know by a number; empty without any."""
    rows = [
        row
        for path in files.like("boards/*/*.kicad_pcb")
        for row in files.facts(path).get("parts", ())
        if not row["lcsc"]
    ]
    parts = dict.fromkeys(
        f"{row['manufacturer']} {row['part']}"
        + f" ({row['value']})" * (row["value"] != row["part"])
        for row in rows
    )
    return _text("unplaced", parts=as_written(listed(list(parts)))) + "\n" if parts else ""


def _panels(design: Design) -> str:
    """Panels to order instead of boards, for a fab that assembles them."""
    if not design.panels:
        return ""
    listed = "\n".join(
        f"- `boards/{panel.name}/order/`: {len(panel.copies)} times {panel.board}"
        for panel in design.panels
    )
    return _text("panels", listed=listed, board=design.board)


def _reflowed(design: Design) -> str:
    """How a part is soldered whose pads an iron does not reach: a module's."""
    components = (part for board in design.auxiliary_boards for part in board.components)
    return "".join(_text("reflowed", part=part) for part in components if part.kind == "module")


def polarity_test(packages: Packages, fingers: tuple[Finger, ...]) -> str:
    """The test with a multimeter of parts whose marked terminal is not known; empty where the
    polarity of both kinds of part is known."""
    led, detector = packages.led, packages.photodetector
    tests = []
    if not led.mark_is_known:
        probed_v = led.forward_voltage_v - _PROBE_V
        name = as_written(packages.led_name)
        tests.append(_text("led", part=led, name=name, probed_v=probed_v))
    if not detector.mark_is_known:
        name = as_written(packages.photodetector_name)
        tests.append(_text("photodetector", part=detector, name=name))
    parts = Counter(part.kind for finger in fingers for part in finger.parts)
    counted = f"{parts['led']} LEDs, {parts['photodetector']} photodetectors"
    tests_text = "".join(tests)
    return _text("polarity", tests=tests_text, counted=counted, tested=TESTED) if tests else ""


def _text(name: str, /, **values: object) -> str:
    """A passage of the manual with its values."""
    return passage("docs/chapters.md", name).format(**values)
