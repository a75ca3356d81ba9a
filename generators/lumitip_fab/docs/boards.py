"""The manual's chapter on boards: ordering, panels, soldering, measuring."""

from lumitip_fab.design import Design
from lumitip_fab.docs.polarity import polarity_test
from lumitip_fab.pipeline.artefact import Files


def boards_chapter(design: Design, files: Files) -> str:
    """Markdown; an image stands alone in its paragraph."""
    names = ("emitter", "receiver", *(auxiliary.name for auxiliary in design.auxiliary_boards))
    behind = any(part.side == "back" for part in design.emitter.parts)
    backs = ["emitter"] if behind else []
    backs += [
        c.name for c in design.auxiliary_boards if any(d.side == "back" for d in c.components)
    ]
    sides = [*((name, "front") for name in names), *((name, "back") for name in backs)]
    pictures = "\n".join(
        f"![The {name} board, {side}](boards/{name}/{name}_{side}.png)"
        for name, side in sides
        if files.like(f"boards/{name}/{name}_{side}.png")
    )
    last = ", then the string resistors on the back of the emitter" if behind else ""
    zips = "\n".join(f"- `boards/{name}/order/`: {name}" for name in names)
    return f"""## 3. Boards

Each board has a zip for each PCB fab, with Gerber and drill files, parts and places:

{zips}
{_panels(design)}
{polarity_test(design.packages)}1. Order the boards, or have them placed as well.
   `..._fabrication.txt` in each zip has thickness, copper and colour. Finger boards are matte
   black, because they must not reflect infrared light.
2. Solder what is left: parts on the front{last}.
3. Before the wires go in, measure between ground and supply of each board: no short.

{pictures}"""


def _panels(design: Design) -> str:
    """Panels to order instead of boards, for a fab that assembles them."""
    if not design.panels:
        return ""
    listed = "\n".join(
        f"- `boards/{panel.name}/order/`: {len(panel.copies)} times {panel.board}"
        for panel in design.panels
    )
    return f"""
If the PCB fab also mounts the parts, order these zips instead, and choose "panel by customer":

{listed}

Break the boards out along the mouse bites, with pliers close to the tab, and file the edges flush:
a finger's board fits its pocket with {design.board.pocket_clearance_mm:g} mm on each side.
"""
