"""The steps of a build: every generator, and the tools that it is made with."""

from lumitip_fab.pipeline.workers import Step

_CAD = ("build123d", "cadquery-ocp", "cadquery-ocp-novtk", "lib3mf", "numpy", "shapely", "trimesh")
_COPPER = (
    "gerbonara",
    "kicad-skip",
    "matplotlib",
    "networkx",
    "numba",
    "numpy",
    "scipy",
    "sexpdata",
    "shapely",
)
_DRAWN = ("numpy", "shapely", "trimesh")
_INK = ("matplotlib", "reportlab", "ezdxf", "numpy", "shapely")
_MANIFOLD = ("manifold3d",)
_NUMBERS = ("numpy",)
_SET = ("lxml", "markdown-it-py", "matplotlib", "pillow", "reportlab", "svglib")
_SHEET = ("reportlab", "lib3mf", "numpy", "trimesh")
STEPS = (
    Step("mask", "mask.files.mask_files", "fingers", tools=_INK),
    Step("creasing", "mask.files.creasing_files", tools=_INK),
    Step("slicer", "parts.settings.print_settings"),
    Step("wiring", "docs.wiring.wiring_files"),
    Step("firmware", "firmware.files.firmware_files", tools=_NUMBERS),
    Step(
        "finger_board", "boards.files.board_files", "fingers", heavy=True, tools=_COPPER, takes_s=10
    ),
    Step(
        "other_board",
        "boards.files.board_files",
        "auxiliary_boards",
        heavy=True,
        tools=_COPPER,
        takes_s=3,
    ),
    Step("models", "models.files.model_files", heavy=True, tools=_CAD, takes_s=3),
    Step("finger_spice", "boards.spice.simulation", "fingers"),
    Step("supply_spice", "boards.spice.supply_simulation", "regulated"),
    Step("plug_in_spice", "boards.spice.plug_in_simulation", "entered"),
    Step("discharge_spice", "boards.spice_discharge.discharge_simulation", "protecting"),
    Step("assembly", "scenes.assembly.assembly", heavy=True, tools=_CAD, takes_s=6),
    Step("robot", "scenes.robot.robot_files", heavy=True, tools=_CAD, takes_s=4),
    Step("mould", "parts.mould.mould_files", "fingers", heavy=True, tools=_CAD, takes_s=3),
    Step("insert", "parts.insert.insert_files", "inserts", tools=_INK),
    Step("prop", "parts.prop.prop_files", "props", heavy=True, tools=_CAD),
    Step("clamp", "parts.clamp.clamp_files", "clamps", heavy=True, tools=_CAD),
    Step("backing", "parts.backing.backing", "fingers", heavy=True, tools=_CAD),
    Step("holder", "parts.holder.holder_files", "holders", heavy=True, tools=_CAD),
    Step("flange", "parts.flange.flange_files", "flanges", heavy=True, tools=_CAD),
    Step("mask_sheet", "parts.sheet.sheet_files", "fingers", heavy=True, tools=(*_CAD, *_MANIFOLD)),
    Step("coupon", "parts.coupon.coupon_files", tools=_SHEET, takes_s=3),
    Step("fit_plate", "parts.fit_plate.fit_plate_files", heavy=True, tools=_CAD, takes_s=2),
    Step("gauge_card", "parts.gauge_card.gauge_card_files", "gauge_cards", heavy=True, tools=_CAD),
    Step("system", "scenes.system.system_files", late=True, tools=_DRAWN, takes_s=2),
    Step("work", "scenes.work.work_views", late=True, tools=_DRAWN, takes_s=4),
    Step("casting", "docs.casting.casting_files", late=True),
    Step("wrapping", "docs.wrapping.wrapping_files", late=True),
    Step("bom", "docs.bill.bill_of_materials", late=True, tools=_NUMBERS),
    Step("manual", "docs.chapters.manual_files", late=True, tools=_SET, takes_s=2),
)
"""In this order. `tools`: distributions whose version may change the step's bytes."""
