"""Files of a panel: a KiCad board, pictures and orders."""

from lumitip_fab.boards.fab.notes import assembly_note, fabrication_note, stop_note
from lumitip_fab.boards.fab.order import layers_of, order_files
from lumitip_fab.boards.fab.picture import picture_files
from lumitip_fab.boards.kicad.project import project_files
from lumitip_fab.boards.model import BoardModel
from lumitip_fab.boards.panel.model import panel_model
from lumitip_fab.boards.verify import require_clean_drc
from lumitip_fab.design import Design, Panel
from lumitip_fab.pipeline.artefact import Artefact


def panel_files(design: Design, panel: Panel, board: BoardModel) -> tuple[Artefact, ...]:
    """Every file of the panel of a finished board.

    Raises:
        BuildError: if a tab has no room, or the panel's copper breaks its rules.
    """
    model = require_clean_drc(panel_model(panel, board, design.rules))
    placement, layers = model.placement, layers_of(model)
    notes = {
        **stop_note(placement),
        f"{panel.name}_fabrication.txt": fabrication_note(model) + panel_note(panel).encode(),
    }
    files = {
        **project_files(model, placement.thickness_mm),
        **picture_files(model, placement.finish.mask),
    }
    for fab in design.fabs:
        texts = {**notes, f"{panel.name}_assembly.txt": assembly_note(placement, fab)}
        orders = order_files(model, layers, texts, fab, panel.name)
        files |= {f"order/{path}": data for path, data in orders.items()}
    return tuple(
        Artefact(f"boards/{panel.name}/{path}", data, frame="") for path, data in files.items()
    )


def panel_note(panel: Panel) -> str:
    """Lines of the fabrication note on copies, gaps, tabs, rails and marks."""
    rules, copies = panel.rules, len(panel.copies)
    return (
        f"\nPanel: {copies} boards, {panel.columns} x {panel.rows}, as the customer has drawn it; "
        "deliver it whole\n"
        f"Rails: {panel.rail_mm:g} mm, left and right; bars as wide join them\n"
        f"Gaps: routed, {rules.gap_mm:g} mm and more, corners with a radius of "
        f"{rules.gap_mm / 2:g} mm\n"
        f"Mouse bites: {rules.bites} unplated holes of {rules.bite_mm:g} mm at each tab, a third "
        "of each within the board\n"
        f"Tooling holes: 4 of {rules.tooling_mm:g} mm, unplated\n"
        f"Fiducials: {rules.fiducial_mm:g} mm on the rails, the mask open for "
        f"{rules.fiducial_opening_mm:g} mm\n"
        "The last number of a part is that of its board: D1_2 is D1 of board 2, counted row by row "
        "from the lower left.\n"
        "Keep the rails. After breaking the boards out, file what is left of the tabs flush with "
        "the edge.\n"
    )
