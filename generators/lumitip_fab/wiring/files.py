"""`wiring/*`: the list of cables, the same to read, and the diagram."""

from lumitip_fab.artefact import Artefact
from lumitip_fab.design import Cabling, Title
from lumitip_fab.wiring.diagram import diagram
from lumitip_fab.wiring.lists import cable_list, wiring_note


def wiring_files(title: Title, cabling: Cabling) -> tuple[Artefact, ...]:
    """Everything that tells how to wire the fingers.

    Args:
        title: of the design.
        cabling: every wire.
    """
    return (
        Artefact("wiring/cables.csv", cable_list(cabling).encode(), frame=""),
        Artefact("wiring/cables.md", wiring_note(title, cabling).encode(), frame=""),
        Artefact("wiring/wiring.svg", diagram(title, cabling).encode(), frame=""),
    )
