"""Settings for PrusaSlicer, one file for each filament and layer, and which part takes which."""

from lumitip_fab.design import Design, Printing
from lumitip_fab.design.making import Filament, Slicing
from lumitip_fab.pipeline.artefact import Artefact
from lumitip_fab.text import as_written, passage

_BRIM_MM = 3.0  # a backing is tall and stands on little; a flat sheet has none to trim off
_OUTER_SHARE = 0.6  # of the speed: outer walls are what board, gripper and silicone meet
_FIRST_LAYER_MM_S = 20.0
_FIRST_LAYER_C = 5
_WIDTHS = (
    "extrusion_width",
    "first_layer_extrusion_width",
    "perimeter_extrusion_width",
    "external_perimeter_extrusion_width",
    "infill_extrusion_width",
    "solid_infill_extrusion_width",
    "top_infill_extrusion_width",
)


def print_settings(design: Design) -> tuple[Artefact, ...]:
    """`print/*.ini` and `print/printing.md`."""
    printing, slicing = design.printing, design.slicing
    texts = {f.file: _settings(f, printing, slicing) for f in slicing.filaments}
    texts["print/printing.md"] = _note(design, bool(design.interfaces))
    return tuple(Artefact(path, texts[path].encode(), frame="") for path in sorted(texts))


def _settings(filament: Filament, printing: Printing, slicing: Slicing) -> str:
    x, y, z = printing.bed_mm
    values: dict[str, object] = {
        "printer_technology": "FFF",
        "gcode_flavor": "marlin",
        "bed_shape": f"0x0,{x:g}x0,{x:g}x{y:g},0x{y:g}",
        "max_print_height": f"{z:g}",
        "nozzle_diameter": f"{slicing.nozzle_mm:g}",
        "layer_height": f"{filament.layer_mm:g}",
        "first_layer_height": f"{filament.layer_mm:g}",
        **dict.fromkeys(_WIDTHS, f"{printing.line_mm:g}"),
        # Walls of two lines, wedges of one: widths that follow the wall.
        "perimeter_generator": "arachne",
        "perimeters": 3,
        "top_solid_layers": 5,
        "bottom_solid_layers": 5,
        "fill_density": "100%",
        "fill_pattern": "rectilinear",
        "support_material": 0,
        "brim_type": "outer_only",
        "brim_width": "0" if filament == slicing.sheet else f"{_BRIM_MM:g}",
        "skirts": 0,
        "seam_position": "rear",
        "elefant_foot_compensation": "0.1",
        "avoid_crossing_perimeters": 1,
        **_of_filament(filament),
    }
    return "".join(f"{key} = {values[key]}\n" for key in sorted(values))


def _of_filament(filament: Filament) -> dict[str, object]:
    speed = filament.speed_mm_s
    least, most = filament.fan_percent
    return {
        "filament_settings_id": filament.name,
        "filament_type": filament.kind,
        "filament_diameter": "1.75",
        "filament_density": f"{filament.density_g_ml:g}",
        "filament_max_volumetric_speed": f"{filament.max_flow_mm3_s:g}",
        "temperature": filament.nozzle_c,
        "first_layer_temperature": filament.nozzle_c + _FIRST_LAYER_C,
        "bed_temperature": filament.bed_c,
        "first_layer_bed_temperature": filament.bed_c,
        "min_fan_speed": least,
        "max_fan_speed": most,
        "bridge_fan_speed": most,
        "fan_always_on": int(least > 0),
        "retract_length": f"{filament.retract_mm:g}",
        "perimeter_speed": f"{speed:g}",
        "external_perimeter_speed": f"{_OUTER_SHARE * speed:g}",
        "infill_speed": f"{speed:g}",
        "solid_infill_speed": f"{speed:g}",
        "top_solid_infill_speed": f"{_OUTER_SHARE * speed:g}",
        "bridge_speed": f"{_OUTER_SHARE * speed:g}",
        "first_layer_speed": f"{min(_FIRST_LAYER_MM_S, speed):g}",
    }


def _note(design: Design, bends: bool) -> str:
    printing, slicing = design.printing, design.slicing
    standing = "on the mount face, tip up"
    lies = "on its front, groove up" if bends else standing
    rows = [(f"backing/{finger}_backing.3mf", lies) for finger in _FINGERS]
    if bends:
        rows += [(f"interface/{finger}_interface.3mf", standing) for finger in _FINGERS]
    rows += [(f"mould/{finger}_mould.3mf", "open side up") for finger in _FINGERS]
    flat = 'on its outer face, for `mask.route = "tpu"`'
    rows += [(f"mask/{name}.3mf", flat) for name in (*(f"{f}_sheet" for f in _FINGERS), "coupon")]
    listed = "\n".join(
        f"| `{path}` | {_temperatures(slicing.of(path))} | {lies} |" for path, lies in rows
    )
    return passage("parts/settings.md", "note").format(
        title=f"{as_written(design.title.name)} {design.title.revision}",
        listed=listed,
        rigid=_temperatures(slicing.rigid),
        printing=printing,
        brim_mm=_BRIM_MM,
        slicing=slicing,
    )


def _temperatures(filament: Filament) -> str:
    return f"`{filament.file}` | {filament.name} | {filament.layer_mm:g} mm"


_FINGERS = ("emitter", "receiver")
