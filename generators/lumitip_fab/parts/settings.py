"""Settings for PrusaSlicer, one file for each filament and layer, and which part takes which."""

from lumitip_fab.design import Design, Printing
from lumitip_fab.design.making import Filament, Slicing
from lumitip_fab.design.mould import MOULDS
from lumitip_fab.design.print_time import BRIM_MM, FIRST_LAYER_MM_S, OUTER_SHARE, PERIMETERS
from lumitip_fab.pipeline.artefact import Artefact
from lumitip_fab.text import as_written, data_file, passage


def print_settings(design: Design) -> tuple[Artefact, ...]:
    """`print/*.ini` and `print/printing.md`."""
    printing, slicing = design.printing, design.slicing
    texts = {f.file: _settings(f, printing, slicing) for f in slicing.filaments}
    texts["print/printing.md"] = _note(design, bool(design.interfaces))
    return tuple(Artefact(path, texts[path].encode(), frame="") for path in sorted(texts))


def _settings(filament: Filament, printing: Printing, slicing: Slicing) -> str:
    speed = filament.speed_mm_s
    return data_file("parts/slicer.txt").format(
        bed_mm=printing.bed_mm,
        line_mm=printing.line_mm,
        nozzle_mm=slicing.nozzle_mm,
        perimeters=PERIMETERS,
        brim_mm=0.0 if filament == slicing.sheet else BRIM_MM,
        filament=filament,
        fan=filament.fan_percent,
        fan_always=int(filament.fan_percent[0] > 0),
        outer_mm_s=OUTER_SHARE * speed,
        first_mm_s=min(FIRST_LAYER_MM_S, speed),
    )


def _note(design: Design, bends: bool) -> str:
    printing, slicing = design.printing, design.slicing
    standing = "on the mount face, tip up"
    lies = "on its front, groove up" if bends else standing
    rows = [(f"backing/{finger}_backing.3mf", lies) for finger in _FINGERS]
    if bends:
        rows += [(f"interface/{finger}_interface.3mf", standing) for finger in _FINGERS]
    rows += [(f"mould/{finger}_mould.3mf", "open side up") for finger in _FINGERS]
    for each, how in ((design.clamps, "on its flat back, feet up"), (design.props, "stop up")):
        rows += [(part.file.replace(".stl", ".3mf"), f"{how}; print {MOULDS}") for part in each]
    rows += [
        (c.file.replace(".stl", ".3mf"), "rails up; black, opaque") for c in design.gauge_cards
    ]
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
        brim_mm=BRIM_MM,
        slicing=slicing,
    )


def _temperatures(filament: Filament) -> str:
    return f"`{filament.file}` | {filament.name} | {filament.layer_mm:g} mm"


_FINGERS = ("emitter", "receiver")
