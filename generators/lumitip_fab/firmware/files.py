"""Every file of the sketch folder."""

from lumitip.layout import Layout
from lumitip_fab.artefact import Artefact
from lumitip_fab.design import Controller, Title, Wiring
from lumitip_fab.design.electrical import Electrical
from lumitip_fab.firmware.headers import layout_header, protocol_header
from lumitip_fab.locate import firmware_sources


def firmware_files(
    layout: Layout, wiring: Wiring, controller: Controller, electrical: Electrical, title: Title
) -> tuple[Artefact, ...]:
    """The sketch folder, whose name and that of the sketch are the same, as Arduino asks.

    Args:
        layout: which cell hangs on which multiplexer and input.
        wiring: pins of the controller.
        controller: its name on the air, and its converter.
        electrical: capacitance of the lines, which sets how long each input settles.
        title: of the design.
    """
    made = {
        "layout.h": layout_header(layout, wiring, controller, electrical, title).encode("ascii"),
        "protocol.h": protocol_header(layout, controller, title).encode("ascii"),
    }
    made |= {source.name: source.read_bytes() for source in firmware_sources()}
    return tuple(Artefact(f"firmware/{name}", made[name], frame="") for name in sorted(made))
