"""The manual's steps of the boards: polarity and order; soldering and measuring."""

import math
from collections import Counter
from collections.abc import Iterable, Iterator

from lumitip_fab.design import AuxiliaryBoard, Design, Finger, Packages
from lumitip_fab.design.boards import GLUE_FILM_MM, thickness_off_mm
from lumitip_fab.design.least_size import too_small
from lumitip_fab.docs.bill import TESTED
from lumitip_fab.docs.protection import boards_of_later, protection_note
from lumitip_fab.pipeline.artefact import Files
from lumitip_fab.text import as_written, listed, passage

MINUTES_A_PART = 1.5  # of soldering by hand, assumed
PROUD_MM = 0.05
"""So much thicker than its pocket is deep a board may be."""
_PROBE_V = 0.15  # less than at the working current: a diode test drives about 1 mA
LIT_V = 0.3  # at most, of a phototransistor in strong light at that current


def ordering(design: Design, files: Files) -> str:
    """The step up to the order: polarity of the parts, panels, what the zips hold."""
    names = ("emitter", "receiver", *(board.name for board in design.auxiliary_boards))
    polarity = polarity_test(design.packages, design.fingers)
    return _text(
        "boards_ordered",
        tester="multimeter, sunlight or a halogen lamp, " * bool(polarity),
        names=listed(list(names)),
        panels=_panels(design),
        polarity=polarity,
        unplaced=_unplaced(files),
        stopped=_text("stopped") * bool(polarity),
    )


def soldering(design: Design, files: Files) -> str:
    """The step that solders and measures the boards."""
    later = boards_of_later(design)
    auxiliary = [board for board in design.auxiliary_boards if board not in later]
    sunk = design.stack.sunk
    tried = set(faces_when_tried(design))
    shown = [*_finger_faces(design)]
    shown += [face for board in auxiliary for face in faces(board) if face not in tried]
    behind = any(part.side == "back" for part in design.emitter.parts)
    reflowed = _reflowed(design)
    count = sum(int(row["quantity"]) for row in _rows(files))
    return _text(
        "boards_soldered",
        count=count,
        hours=math.ceil(count * MINUTES_A_PART / 60),
        broken=_text("broken", board=design.board) + "\n" if design.panels else "",
        solder=design.heat_steps["solder"],
        reflowed=reflowed,
        hot_air=", hot air, flux pen" * bool(reflowed),
        calipers=", calipers" * sunk,
        thick=_thick(design.stack.pcb_mm) if sunk else "",
        short=3 if sunk else 2,
        protection="".join(protection_note(board, design) for board in auxiliary),
        breaking=", pliers, small files, safety glasses" * bool(design.panels),
        led=design.packages.led,
        detector=design.packages.photodetector,
        last=", then the string resistors on the back of the emitter" if behind else "",
        pictures=pictures(shown, files),
    )


def _finger_faces(design: Design) -> Iterator[tuple[str, str]]:
    """Name and side of each face of the fingers' boards that has parts."""
    for finger in design.fingers:
        yield finger.name, "front"
        if any(part.side == "back" for part in finger.parts):
            yield finger.name, "back"


def faces(board: AuxiliaryBoard) -> Iterator[tuple[str, str]]:
    """Name and side of each face of a board that has parts, and of its front."""
    yield board.name, "front"
    if any(part.side == "back" for part in board.components):
        yield board.name, "back"


def faces_when_tried(design: Design) -> Iterator[tuple[str, str]]:
    """Faces that are shown where the flange's board is tried: of one that is soldered earlier the
    back, onto which its contacts come."""
    later = boards_of_later(design)
    for board in design.auxiliary_boards:
        if board in later:
            yield from faces(board)
        elif board.name in {flange.auxiliary for flange in design.flanges}:
            yield board.name, "back"


def pictures(shown: Iterable[tuple[str, str]], files: Files) -> str:
    """Pictures of faces, by the board's name and the side, fronts first."""
    return "\n".join(
        f"![The {name} board, {side}](boards/{name}/{name}_{side}.png)"
        for name, side in sorted(shown, key=lambda face: face[1] == "back")
        if files.like(f"boards/{name}/{name}_{side}.png")
    )


def _thick(pcb_mm: float) -> str:
    """How boards are measured that must not stand out of their pockets."""
    off_mm = thickness_off_mm(pcb_mm)
    text = _text(
        "thick",
        pcb_mm=pcb_mm,
        low_mm=pcb_mm - off_mm,
        high_mm=pcb_mm + off_mm,
        most_mm=pcb_mm + PROUD_MM,
        film_mm=GLUE_FILM_MM,
    )
    return f"{text}\n"


def _rows(files: Files) -> Iterator[dict[str, str]]:
    """The rows of all boards' bills of materials."""
    for path in files.like("boards/*/*.kicad_pcb"):
        yield from files.facts(path).get("parts", ())


def _unplaced(files: Files) -> str:
    """Parts that the PCB fab which mounts parts does not know by a number; empty without any."""
    rows = [row for row in _rows(files) if not row["lcsc"]]
    parts = dict.fromkeys(
        f"{row['manufacturer']} {row['part']}"
        + f" ({row['value']})" * (row["value"] != row["part"])
        for row in rows
    )
    return _text("unplaced", parts=as_written(listed(list(parts)))) if parts else ""


def _panels(design: Design) -> str:
    """Panels to order instead of boards, for a fab that assembles them; without panels, the boards
    that are too small for it."""
    if design.panels:
        lines = [
            f"- `boards/{panel.name}/order/`: {len(panel.copies)} times {panel.board}"
            for panel in design.panels
        ]
        return _text("panels", listed="\n".join(lines))
    every = len(design.fingers) + len(design.auxiliary_boards)
    small = [
        f"{'all boards' if len(found.boards) == every else listed([*found.boards])} at "
        f"{listed([*found.fabs])} (at least {found.least_mm[0]:g} x {found.least_mm[1]:g} mm)"
        for found in too_small(design)
    ]
    return _text("small", listed="; ".join(small)) if small else ""


def _reflowed(design: Design) -> str:
    """How a part is soldered whose pads an iron does not reach: a module's."""
    modules = [board.module for board in design.auxiliary_boards if board.module]
    return "".join(_text("reflowed", part=module) for module in modules)


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
        tests.append(_text("photodetector", part=detector, name=name, lit_v=LIT_V))
    parts = Counter(part.kind for finger in fingers for part in finger.parts)
    counted = f"{parts['led']} LEDs, {parts['photodetector']} photodetectors"
    tests_text = "".join(tests)
    return _text("polarity", tests=tests_text, counted=counted, tested=TESTED) if tests else ""


def _text(name: str, /, **values: object) -> str:
    """A passage of the manual with its values."""
    return passage("docs/chapters.md", name).format(**values)
