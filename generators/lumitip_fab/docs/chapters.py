"""The manual: its own chapters and the notes of the parts, as Markdown, HTML and PDF."""

import re
from collections.abc import Iterable, Iterator
from dataclasses import replace
from itertools import count
from typing import Any

from lumitip_fab.design import Design
from lumitip_fab.docs.boards import faces_when_tried, ordering, pictures, soldering
from lumitip_fab.docs.bring_up import bring_up_steps
from lumitip_fab.docs.casting import (
    amounts_of_both,
    casting_steps,
    heights,
    silicone_mix,
    volume_ml,
)
from lumitip_fab.docs.flange import coupling_step, flange_board_step, flange_step
from lumitip_fab.docs.front import WARM_UP_MIN, front
from lumitip_fab.docs.gripper_cable import in_the_list
from lumitip_fab.docs.measuring import measuring
from lumitip_fab.docs.mounting import mounting_steps
from lumitip_fab.docs.orders import amount, money
from lumitip_fab.docs.page import html_page
from lumitip_fab.docs.placed import where_parts_go
from lumitip_fab.docs.protection import boards_of_later
from lumitip_fab.docs.sheet import pdf_sheets
from lumitip_fab.docs.wiring import ends_of_fingers, wiring_steps
from lumitip_fab.docs.wrapping import mask_facts, wrapping_steps
from lumitip_fab.pipeline.artefact import Artefact, Files
from lumitip_fab.text import as_written, listed, passage

RUN_MIN, ACCEPT_MIN = 15, 10
"""How long calibration takes, and the test with the gauge card (assumed)."""
WEAR_GRASPS = 100
"""After about so many grasps the published sensor's silicone had worn above the LEDs."""
_STEP = re.compile(r"^## #\. ", re.MULTILINE)
_HEADING = re.compile(r"^(#+) ", re.MULTILINE)


def manual_text(design: Design, files: Files) -> str:
    """The whole manual. An image stands alone in its paragraph; its path is below the outputs."""
    chapters = (
        front(design),
        _bought(design, files),
        measuring(design),
        *(coupling_step(design, flange) for flange in design.flanges),
        ordering(design, files),
        soldering(design, files),
        *_flange_board(design, files, later=False),
        _printed(design, files),
        *(step.section() for step in wiring_steps(design)),
        *bring_up_steps(design, _controllers_board(design, files)),
        *(
            step.section()
            for step in casting_steps(design, design.fingers, _amounts(design, files))
        ),
        *_masked(design, files),
        *_flange_board(design, files, later=True),
        *(flange_step(design, flange) for flange in design.flanges),
        *mounting_steps(design),
        _run(design),
        _kept(design),
        *where_parts_go(design, files),
    )
    numbers = count(1)
    joined = _joined(chapter.strip() for chapter in chapters) + "\n"
    return _STEP.sub(lambda _: f"## {next(numbers)}. ", joined)


def _bought(design: Design, files: Files) -> str:
    bill = files.facts("bom.csv")
    lines = "\n".join(
        f"| {as_written(line['item'])} | {as_written(line['where'])} | {_how_much(line)} "
        f"| {money(line['price'])} |"
        for line in bill["lines"]
    )
    order = files.facts("order.csv")
    packs = "\n".join(map(_pack, order["lines"]))
    return _text(
        "bought",
        prices=as_written(bill["prices"]),
        measured=_text("measured", cable=in_the_list(design)) if design.flanges else "",
        lines=lines,
        total=money(bill["total"]),
        packs=packs,
        single=money(order["single"]),
        to_buy=money(order["total"]),
    )


def _pack(line: dict[str, Any]) -> str:
    """A line of the packs to buy."""
    product = " ".join(filter(None, (line["manufacturer"], line["part"])))
    return (
        f"| {as_written(line['item'])} | {as_written(product)} | {as_written(line['pack'])} "
        f"| {line['packs']} | {money(line['price'])} |"
    )


def _how_much(line: dict[str, Any]) -> str:
    """Pieces are counted; anything else has its unit."""
    unit = {"piece": "", "sheet": " sheets"}.get(line["unit"], f" {line['unit']}")
    return amount(line["quantity"]) + unit


def _amounts(design: Design, files: Files) -> str:
    """Amounts to weigh for each finger."""
    mixes = {f.name: silicone_mix(volume_ml(f, files), design.mould) for f in design.fingers}
    return amounts_of_both(design.mould, mixes)


def _printed(design: Design, files: Files) -> str:
    lines = files.text("print/printing.md").splitlines()
    made = [line for line in lines if design.mask.route == "tpu" or "| `mask/" not in line]
    note = _included("\n".join(made))
    corners = design.fit_plate.corners
    signs = _text("signs_corner" if corners else "signs_slice", off=_text("signs_off"))
    holds = "pins and seat" if design.mount.pin_u_mm else "seat"
    return _text(
        "printed",
        note=note,
        moulds=heights(design),
        filaments=_filaments(design),
        tried=_text("tried_corner") * bool(corners) + _text("tried_slice", holds=holds),
        tried_with="the gripper, a finger bolt" + ", a board without wires" * bool(corners),
        signs=signs,
    )


def _filaments(design: Design) -> str:
    """Those that are printed by this manual: of a mask only where it is printed."""
    of = design.slicing
    used = [of.backing, of.rigid, of.mould] + [of.sheet] * (design.mask.route == "tpu")
    return f"filament of {listed(list(dict.fromkeys(as_written(f.name) for f in used)))}"


def _masked(design: Design, files: Files) -> Iterator[str]:
    """The steps of the mask; the first shows both masks."""
    printed = "as it is printed, but without words"
    shown = printed if design.mask.route == "film" else "outline, holes and folds"
    pictures = "\n".join(
        f"![The {f.name} mask, {shown}](manual/{f.name}_mask.svg)" for f in design.fingers
    )
    first, *others = wrapping_steps(design, mask_facts(files, design.emitter), "NAME")
    both = _text("masks", pictures=pictures)
    yield replace(first, text=f"{both}\n\n{first.text}").section()
    yield from (step.section() for step in others)


def _controllers_board(design: Design, files: Files) -> str:
    """A picture of the board that the controller is on."""
    near = ends_of_fingers(design)
    return pictures([(b.name, "front") for b in design.auxiliary_boards if b.name in near], files)


def _flange_board(design: Design, files: Files, later: bool) -> Iterator[str]:
    """The test of the flange's board, where it is tried after the first test or before."""
    if bool(boards_of_later(design)) == later:
        shown = pictures(faces_when_tried(design), files)
        yield from (flange_board_step(design, flange, shown) for flange in design.flanges)


def _run(design: Design) -> str:
    """Warm-up, tare, and the test with the gauge card where there is one."""
    cards = len(design.gauge_cards)
    return _text(
        "run",
        warm_up_min=WARM_UP_MIN,
        minutes=RUN_MIN + ACCEPT_MIN * cards,
        gauge=_text("gauge_shown") * cards,
        gauged=", the gauge card, thin sheet metal" * cards,
        supply="the robot's tool output" if design.flanges else "the LEDs' supply",
        accepted="\n" + _text("accepted", accept_min=ACCEPT_MIN).strip() if cards else "",
    )


def _kept(design: Design) -> str:
    """Parts that wear, and how a worn skin comes off."""
    film = design.mask.route == "film"
    keys = len(design.keys)
    return _text(
        "kept",
        grasps=WEAR_GRASPS,
        worn="its black is rubbed off" if film else "it is torn or has come loose",
        lip=", and along the lip on the back of the tip" if design.props else "",
        plugs=_text("skin_plugs", keys=keys) + " " if keys else "",
    )


def _included(note: str) -> str:
    """A note as a part of a chapter, without its title: its headings a level lower."""
    _, _, text = note.partition("\n")
    return _HEADING.sub(lambda found: f"{found[1]}# ", text).strip()


def _joined(texts: Iterable[str]) -> str:
    return "\n\n".join(texts)


def _text(name: str, /, **values: object) -> str:
    """A passage of the manual with its values."""
    return passage("docs/chapters.md", name).format(**values)


def manual_files(design: Design, files: Files) -> tuple[Artefact, ...]:
    """The manual twice: to read on a screen, and to print."""
    text = manual_text(design, files)
    name = f"{design.title.name} {design.title.revision}: build manual"
    return (
        Artefact("manual/manual.html", html_page(name, text, files).encode(), frame=""),
        Artefact("manual/manual.pdf", pdf_sheets(name, text, files), frame=""),
    )
