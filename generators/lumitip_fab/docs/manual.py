"""`manual/manual.html` and `manual.pdf`, which say the same."""

from lumitip_fab.design import (
    Cabling,
    Carrier,
    Electrical,
    Finger,
    Flange,
    HeatStep,
    Holder,
    Interface,
    Mask,
    Mould,
    Mount,
    Printing,
    Title,
    Wiring,
)
from lumitip_fab.docs.chapters import Facts, manual_text
from lumitip_fab.docs.page import html_page
from lumitip_fab.docs.sheet import pdf_sheets
from lumitip_fab.pipeline.artefact import Artefact, Made


def manual_files(
    made: Made,
    title: Title,
    printing: Printing,
    mould: Mould,
    mask: Mask,
    heat: tuple[HeatStep, ...],
    mount: Mount,
    wiring: Wiring,
    cabling: Cabling,
    electrical: Electrical,
    carriers: tuple[Carrier, ...],
    holders: tuple[Holder, ...],
    interfaces: tuple[Interface, ...],
    flanges: tuple[Flange, ...],
    emitter: Finger,
) -> tuple[Artefact, ...]:
    """The manual twice: to read on a screen, and to print.

    Args:
        made: drawings, notes, the list of parts.
        title: of the design.
        printing: layers.
        mould: silicone.
        mask: film.
        heat: the steps that heat something.
        mount: bolts and gripper.
        wiring: supply of the LEDs.
        cabling: cables.
        electrical: currents.
        carriers: boards outside the fingers.
        holders: what holds the controller's board.
        interfaces: what holds backings that bend.
        flanges: what holds the flange's board.
        emitter: for parts on the back of its board.
    """
    facts = Facts(
        title,
        printing,
        mould,
        mask,
        heat,
        mount,
        wiring,
        cabling,
        electrical,
        carriers,
        holders,
        interfaces,
        flanges,
        emitter,
    )
    text = manual_text(facts, made)
    name = f"{title.name} {title.revision}: build manual"
    return (
        Artefact("manual/manual.html", html_page(name, text, made).encode(), frame=""),
        Artefact("manual/manual.pdf", pdf_sheets(name, text, made), frame=""),
    )
