"""Settings for the slicer against the printer, the filaments and the parts in the folder."""

import math
import re
from collections.abc import Iterator
from pathlib import Path

from lumitip_fab.checks.result import Measurement, unreadable
from lumitip_fab.design import Design
from lumitip_fab.design.making import Filament
from lumitip_fab.design.mould import printed_times

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


def measure(outputs: Path, design: Design) -> Iterator[Measurement]:
    """Read the settings as the slicer would."""
    for filament in design.slicing.filaments:
        yield _settings(outputs, design, filament)
    yield _mould_layers(outputs, design)
    yield _parts(outputs, design)


def _mould_layers(outputs: Path, design: Design) -> Measurement:
    """Floor, recess and stops of the moulds are whole layers of the slicer's `layer_height`:
    rounding there makes the silicone thinner or thicker."""
    file = design.slicing.mould.file
    try:
        layer_mm = float(_read(outputs / file)["layer_height"])
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


def _read(path: Path) -> dict[str, str]:
    lines = path.read_text(encoding="utf-8").splitlines()
    return {key.strip(): value.strip() for key, _, value in (n.partition("=") for n in lines)}


def _settings(outputs: Path, design: Design, filament: Filament) -> Measurement:
    try:
        settings = _read(outputs / filament.file)
    except (OSError, UnicodeDecodeError) as problem:
        return unreadable("printing.settings", filament.file, str(problem))
    wrong = [key for key, value in _wanted(design, filament).items() if settings.get(key) != value]
    note = f"other than printer and filament say: {', '.join(wrong) or 'none'}"
    return Measurement(
        "printing.settings", filament.file, float(len(wrong)), 0, 0, "settings", note
    )


def _wanted(design: Design, filament: Filament) -> dict[str, str]:
    printing = design.printing
    x, y, z = (f"{value:g}" for value in printing.bed_mm)
    least, most = filament.fan_percent
    return {
        "layer_height": f"{filament.layer_mm:g}",
        "first_layer_height": f"{filament.layer_mm:g}",
        **dict.fromkeys(_WIDTHS, f"{printing.line_mm:g}"),
        "perimeter_generator": "arachne",  # walls and wedges are as thin as one or two lines
        "nozzle_diameter": f"{design.slicing.nozzle_mm:g}",
        "bed_shape": f"0x0,{x}x0,{x}x{y},0x{y}",
        "max_print_height": z,
        "support_material": "0",
        "fill_density": "100%",
        "filament_density": f"{filament.density_g_ml:g}",
        "filament_max_volumetric_speed": f"{filament.max_flow_mm3_s:g}",
        "filament_type": filament.kind,
        "filament_diameter": "1.75",
        "temperature": str(filament.nozzle_c),
        "bed_temperature": str(filament.bed_c),
        "first_layer_bed_temperature": str(filament.bed_c),
        "perimeter_speed": f"{filament.speed_mm_s:g}",
        "min_fan_speed": str(least),
        "max_fan_speed": str(most),
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
