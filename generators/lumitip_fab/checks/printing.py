"""Settings for the slicer against the printer, the filaments and the parts in the folder."""

import math
import re
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

from lumitip_fab.checks.places import files_in
from lumitip_fab.checks.result import Measurement, count, unreadable
from lumitip_fab.design import Design
from lumitip_fab.design.making import Filament
from lumitip_fab.design.mould import printed_times
from lumitip_fab.design.print_time import BRIM_MM, FIRST_LAYER_MM_S, OUTER_SHARE, PERIMETERS

READS = ("print/*",)
_NOTE = "print/printing.md"
_LEAST_LAYER_MM = 0.01
_ROUNDING_MM = 1e-4
_STANDING = "on the mount face, tip up"
_LIES = {
    "backing": _STANDING,
    "interface": _STANDING,
    "mould": "open side up",
    "clamp": "on its flat back, feet up",
    "prop": "stop up",
    "card": "rails up; black, opaque",
    "sheet": 'on its outer face, for `mask.route = "tpu"`',
    "coupon": 'on its outer face, for `mask.route = "tpu"`',
}
"""How a part lies on the bed, by the last word of its file's name."""
_BENDING = "on its front, groove up"
"""How a backing lies that has an interface."""
_WIDTHS = (
    "extrusion_width",
    "first_layer_extrusion_width",
    "perimeter_extrusion_width",
    "external_perimeter_extrusion_width",
    "infill_extrusion_width",
    "solid_infill_extrusion_width",
    "top_infill_extrusion_width",
)
_FULL_SPEEDS = ("perimeter_speed", "infill_speed", "solid_infill_speed")
_OUTER_SPEEDS = ("external_perimeter_speed", "top_solid_infill_speed", "bridge_speed")
_ALWAYS = {
    "avoid_crossing_perimeters": "1",
    "bottom_solid_layers": "5",
    "brim_type": "outer_only",
    "elefant_foot_compensation": "0.1",
    "filament_diameter": "1.75",
    "fill_density": "100%",
    "fill_pattern": "rectilinear",
    "gcode_flavor": "marlin",
    "perimeter_generator": "arachne",  # walls and wedges are as thin as one or two lines
    "printer_technology": "FFF",
    "seam_position": "rear",
    "skirts": "0",
    "support_material": "0",
    "top_solid_layers": "5",
}
"""Settings of every design."""


def measure(outputs: Path, design: Design) -> Iterator[Measurement]:
    """Read the settings as the slicer would."""
    for filament in design.slicing.filaments:
        yield _settings(outputs, design, filament)
    yield _mould_layers(outputs, design)
    yield _parts(outputs, design)
    wanted = {_NOTE, *(filament.file for filament in design.slicing.filaments)}
    others = sorted({f"print/{name}" for name in files_in(outputs / "print")} - wanted)
    yield count("printing.files", "print", others, "files that no filament of the design has")


def _mould_layers(outputs: Path, design: Design) -> Measurement:
    """Floor, recess and stops of the moulds are whole layers of the slicer's `layer_height`:
    rounding there makes the silicone thinner or thicker."""
    file = design.slicing.mould.file
    try:
        layer_mm = float(dict(_read(outputs / file))["layer_height"])
        if not _LEAST_LAYER_MM <= layer_mm < math.inf:
            raise ValueError(f"layer_height = {layer_mm:g}")
    except (OSError, KeyError, ValueError) as problem:
        return unreadable("printing.mould_layers", file, str(problem))
    mould = design.mould
    heights_mm = (mould.wall_mm, mould.floor_mm, mould.stops_mm(design.stack.cover_mm))
    off_mm = max(abs(h - round(h / layer_mm) * layer_mm) for h in heights_mm)
    most_mm = mould.off_layer_mm + _ROUNDING_MM
    note = f"of floor and stops to a whole layer of {layer_mm:g} mm"
    return Measurement("printing.mould_layers", file, off_mm, 0, most_mm, "mm", note)


def _read(path: Path) -> list[tuple[str, str]]:
    """Key and value of each line."""
    lines = path.read_text(encoding="utf-8").splitlines()
    return [(key.strip(), value.strip()) for key, _, value in (n.partition("=") for n in lines)]


def _settings(outputs: Path, design: Design, filament: Filament) -> Measurement:
    """Every line of a file: the slicer takes its own value for what is missing."""
    try:
        settings = _read(outputs / filament.file)
    except (OSError, UnicodeDecodeError) as problem:
        return unreadable("printing.settings", filament.file, str(problem))
    wrong = set(settings) ^ set(_wanted(design, filament).items())
    twice = {key for key, lines in Counter(key for key, _ in settings).items() if lines > 1}
    names = sorted(twice | {key for key, _ in wrong})
    return count("printing.settings", filament.file, names, "settings other than the design's")


def _wanted(design: Design, filament: Filament) -> dict[str, str]:
    printing, speed = design.printing, filament.speed_mm_s
    x, y, z = (f"{value:g}" for value in printing.bed_mm)
    least, most = filament.fan_percent
    return {
        **_ALWAYS,
        "layer_height": f"{filament.layer_mm:g}",
        "first_layer_height": f"{filament.layer_mm:g}",
        **dict.fromkeys(_WIDTHS, f"{printing.line_mm:g}"),
        "perimeters": f"{PERIMETERS}",
        "brim_width": "0" if filament == design.slicing.sheet else f"{BRIM_MM:g}",
        "nozzle_diameter": f"{design.slicing.nozzle_mm:g}",
        "bed_shape": f"0x0,{x}x0,{x}x{y},0x{y}",
        "max_print_height": z,
        "filament_settings_id": filament.name,
        "filament_density": f"{filament.density_g_ml:g}",
        "filament_max_volumetric_speed": f"{filament.max_flow_mm3_s:g}",
        "filament_type": filament.kind,
        "temperature": str(filament.nozzle_c),
        "first_layer_temperature": str(filament.first_nozzle_c),
        "bed_temperature": str(filament.bed_c),
        "first_layer_bed_temperature": str(filament.bed_c),
        **dict.fromkeys(_FULL_SPEEDS, f"{speed:g}"),
        **dict.fromkeys(_OUTER_SPEEDS, f"{OUTER_SHARE * speed:g}"),
        "first_layer_speed": f"{min(FIRST_LAYER_MM_S, speed):g}",
        "fan_always_on": str(int(least > 0)),
        "min_fan_speed": str(least),
        "max_fan_speed": str(most),
        "bridge_fan_speed": str(most),
        "retract_length": f"{filament.retract_mm:g}",
    }


def _parts(outputs: Path, design: Design) -> Measurement:
    """Every printed part of a finger and the gauge card are listed with settings, filament,
    layers, the side that is up and how often each is printed, none else."""
    try:
        text = (outputs / _NOTE).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as problem:
        return unreadable("printing.parts", _NOTE, str(problem))
    row = r"^\| `(\S+\.3mf)` \| `(\S+)` \| (.+?) \| (\S+) mm \| (.+?) \|$"
    listed = set(re.findall(row, text, re.MULTILINE))
    kinds = ("backing", *(["interface"] if design.interfaces else []), "mould")
    fingers = design.fingers
    paths = [f"{kind}/{finger.name}_{kind}.3mf" for kind in kinds for finger in fingers]
    others = (*design.mould_accessories, *design.gauge_cards)
    paths += [part.file.replace(".stl", ".3mf") for part in others]
    paths += [*(f"mask/{finger.name}_sheet.3mf" for finger in fingers), "mask/coupon.3mf"]
    wanted = {
        (path, of.file, of.name, f"{of.layer_mm:g}", _lies(path, design))
        for path in paths
        for of in [design.slicing.of(path)]
    }
    wrong = listed ^ wanted
    note = f"listed wrongly or not at all, of {len(paths)}"
    return Measurement("printing.parts", _NOTE, float(len(wrong)), 0, 0, "parts", note)


def _lies(path: str, design: Design) -> str:
    """How a part lies on the bed, and how often it is printed."""
    kind = Path(path).stem.rpartition("_")[2]
    how = _BENDING if kind == "backing" and design.interfaces else _LIES[kind]
    times = printed_times(design.mould_accessories, path.replace(".3mf", ".stl"))
    return f"{how}; print {times}" if times > 1 else how
