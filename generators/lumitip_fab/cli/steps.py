"""The steps of a build: every generator, what it is made with, and what it reads."""

from lumitip_fab.pipeline.graph import Step

_CAD = (
    "build123d",
    "cadquery-ocp",
    "cadquery-ocp-novtk",
    "lib3mf",
    "numpy",
    "shapely",
    "trimesh",
)
_INK = ("matplotlib", "reportlab", "ezdxf", "numpy", "shapely")
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
_STACKED = ("assembly/assembly.glb", "flange/*.stl", "holder/*.stl")
_LISTED = (
    "backing/*.stl",
    "interface/*.stl",
    "mould/*.stl",
    "holder/*.stl",
    "flange/*.stl",
    "fit/*.stl",
    "mould/*_casting.md",
    "boards/*/order/generic_*_bom.csv",
)
_SHOWN = (
    "assembly/*.svg",
    "bom.csv",
    "boards/*/*_front.png",
    "boards/*/*_back.png",
    "mask/*_mask.svg",
    "mask/*_wrapping.md",
    "mould/*_casting.md",
    "print/printing.md",
    "wiring/*",
)
_SET = ("lxml", "markdown-it-py", "matplotlib", "pillow", "reportlab", "svglib")
STEPS = (
    Step("mask", "files", "mask_files", False, _INK),
    Step("parts", "settings", "print_settings", False, ()),
    Step("docs", "wiring", "wiring_files", False, ()),
    Step("firmware", "files", "firmware_files", False, ("numpy",)),
    Step("boards", "files", "board_files", True, _COPPER),
    Step("boards", "carrier", "carrier_files", True, _COPPER),
    Step("boards", "spice", "simulation", False, ()),
    Step("boards", "spice", "supply_simulation", False, ()),
    Step("scenes", "assembly", "assembly", True, _CAD),
    Step("scenes", "robot", "robot_files", True, _CAD),
    Step("parts", "mould", "mould_files", True, _CAD),
    Step("parts", "backing", "backing", True, _CAD),
    Step("parts", "holder", "holder_files", True, _CAD),
    Step("parts", "flange", "flange_files", True, _CAD),
    Step("parts", "fit_plate", "fit_plate_files", True, _CAD),
    Step("scenes", "system", "system_files", False, _DRAWN, _STACKED),
    Step("docs", "bill", "bill_of_materials", False, ("numpy",), _LISTED),
    Step("docs", "manual", "manual_files", False, _SET, _SHOWN),
)
