"""The build manual against the design, the notes and the drawings beside it; PDF against HTML."""

import math
import re
from collections.abc import Iterator
from pathlib import Path

from lumitip_fab.checks.readers.tables import table
from lumitip_fab.checks.result import Measurement, unreadable
from lumitip_fab.design import Design
from lumitip_fab.docs.boards import LIT_V
from lumitip_fab.errors import OutputError
from lumitip_fab.text import page_letters
from manual_reader import Chapter, Manual, read_html, read_pdf

_HTML, _PDF = "manual/manual.html", "manual/manual.pdf"
_GLANCE = "At a glance"
_WARM_UP_MIN = 5.0  # Table I of the published sensor
_AMOUNT = re.compile(r"^\| (.*?) \| \**([\d.]+ (?:mL|g))\** \|$", re.MULTILINE)
_WIRE = re.compile(
    r"^\| (W\d+\.\d+) \| (.*?) \| (.*?) \| (.*?) \| (.*?) \| (.*?) \|$", re.MULTILINE
)
_FILE = re.compile(r"[\w*]+(?:/[\w*]+)+\.\w+")


def measure(outputs: Path, design: Design) -> Iterator[Measurement]:
    """Read both manuals as their readers do."""
    try:
        manual = read_html(outputs / _HTML)
    except OutputError as error:
        yield unreadable("manual.readable", _HTML, str(error))
        return
    yield _count("drawings", _HTML, _wrong_drawings(outputs, manual, design), "wrong drawings")
    yield _count("files", _HTML, _lost_files(outputs, manual), "named files that are lost")
    yield _count("figures", _HTML, _wrong_figures(manual, design), "wrong figures")
    yield _count("units", _HTML, _wrong_units(manual, design), "wrong figures with a unit")
    for check, wanted in (
        ("amounts", _weighed(_noted(outputs, "mould/{}_casting.md", _AMOUNT, design))),
        ("wires", _noted(outputs, "wiring/cables.md", _WIRE, design)),
        ("parts", _billed(outputs)),
    ):
        yield _count(check, _HTML, _differing(manual, wanted), "wrong rows")
    yield from _pdf(outputs, manual)


def _wrong_drawings(outputs: Path, manual: Manual, design: Design) -> list[str]:
    """Pictures other than the file of their name, and those that are missing."""
    names = [finger.name for finger in design.fingers]
    boards = [*names, *(auxiliary.name for auxiliary in design.auxiliary_boards)]
    wanted = {"assembly/receiver_exploded.svg", "wiring/wiring.svg"}
    wanted.add("manual/mounted.svg" if design.system.holders else "assembly/system.svg")
    wanted |= {f"manual/{name}_mask.svg" for name in names}
    bench = ("measured", "lengths", "plate", "facing", "board", "mould", "drop")
    work = (*bench, "cable", "filled", "lowered", "clamped", "lifted", "card", "skin")
    if design.packages.unmarked:
        wanted.add("manual/marks.svg")
    if design.holders:
        wanted.add("manual/holder.svg")
    if design.gauge_cards:
        wanted.add("manual/gauge.svg")
    wanted |= {f"manual/{name}.svg" for name in work}
    wanted |= {f"manual/{name}_folded.svg" for name in names}
    for flange in design.flanges:
        wanted |= {f"manual/{flange.name}.svg", "manual/contacts.svg"}
    if design.mask.route != "tpu":
        wanted.add("mask/creasing.svg")
    wanted |= {f"boards/{name}/{name}_front.png" for name in boards}
    behind = {f.name for f in design.fingers if any(p.side == "back" for p in f.parts)}
    behind |= {
        c.name for c in design.auxiliary_boards if any(d.side == "back" for d in c.components)
    }
    wanted |= {f"boards/{name}/{name}_back.png" for name in behind}
    wanted |= {f"boards/{name}/{name}_assembly_front.svg" for name in boards}
    bare = {
        board.name
        for board in design.auxiliary_boards
        if not any(part.part and part.side == "back" for part in board.components)
    }
    wanted |= {f"boards/{name}/{name}_assembly_back.svg" for name in behind - bare}
    shown = dict(manual.pictures)
    wrong = sorted(wanted ^ shown.keys())
    for name in sorted(wanted & shown.keys()):
        path = outputs / name
        if not path.is_file() or path.read_bytes() != shown[name]:
            wrong.append(f"{name} is another")
    return wrong


def _lost_files(outputs: Path, manual: Manual) -> list[str]:
    """Named files that are not there; `NAME` stands for each finger."""
    named = {code for code in manual.codes if _FILE.fullmatch(code)}
    meant = {name.replace("NAME", finger) for name in named for finger in ("emitter", "receiver")}
    return sorted(name for name in meant if not any(outputs.glob(name)))


def _wrong_figures(manual: Manual, design: Design) -> list[str]:
    """The table at a glance, and chapters that must be there."""
    wanted = {
        "layers of the backings": f"{design.printing.layer_mm:g} mm",
        "filament of the backings": design.printing.material,
        "silicone": design.mould.silicone,
        f"curing at {design.mould.cure_c:g} °C": f"{design.mould.cure_h:g} h",
        "film": design.mask.film,
        "creasing the film, off the finger": f"{design.mask.soften_c:g} °C",
        "supply of the LEDs": f"{design.wiring.supply_v:g} V",
        "current of the LEDs, nominal": f"{sum(design.wiring.current_ma):.1f} mA",
        "wires": str(sum(len(cable.wires) for cable in design.cabling.cables)),
        "gripper": design.mount.title,
        "its force, at most": f"{design.strength.rated_force_n:g} N",
        "finger bolts, for each finger": f"{len(design.mount.bolt_u_mm)} x {design.mount.bolt} x "
        f"{design.mount.bolt_length_mm:g}",
        "warm-up": f"{_WARM_UP_MIN:g} min",
    }
    chapter = next((c for c in manual.chapters if c.heading == _GLANCE), Chapter(""))
    rows = {row[0]: row[-1] for table in chapter.tables for row in table[1:]}
    return sorted(k for k in {*wanted, *rows} if wanted.get(k) != rows.get(k))


def _wrong_units(manual: Manual, design: Design) -> list[str]:
    """Hours, degrees and volts anywhere in the text that are not the design's."""
    volts = {design.wiring.supply_v, 5.0, 0.0}  # the controller's supply, and ground
    volts |= {lit.output_v for lit in design.electrical.indicators}
    for contact in (c for f in design.flanges for c in f.contacts if c.kind == "supply"):
        volts.add(float(contact.carries.removesuffix("V")))
    rated = [part.rating for board in design.auxiliary_boards for part in board.components]
    volts |= {float(rating.removesuffix(" V")) for rating in rated if rating}
    capacitors = (design.packages.capacitor, design.packages.bulk)
    volts |= {capacitor.rated_v for capacitor in capacitors if capacitor is not None}
    led = design.packages.led
    if not led.mark_is_known:  # 0.15 V less at the 1 mA of a multimeter
        volts.add(round(led.forward_voltage_v - 0.15, 1))
    if not design.packages.photodetector.mark_is_known:
        volts.add(LIT_V)
    heat = {figure for s in design.heat for figure in (s.temperature_c, s.limit_c)}
    heat.add(25.0)  # of the room that the heat in use is estimated for
    hours = {design.mould.cure_h, design.mould.glue_hard_h, *_soldering_h(manual)}
    allowed = {"h": hours, "°C": heat, "V": volts}
    matches = re.findall(r"(?<![\w.])(\d+(?:\.\d+)?) (h|°C|V)\b", " ".join(manual.blocks))
    found = {(float(value), unit) for value, unit in matches}
    wrong = [f"{value:g} {unit}" for value, unit in sorted(found) if value not in allowed[unit]]
    lost = [f"no {unit}" for unit in allowed if unit not in {u for _, u in found}]
    return wrong + lost


def _soldering_h(manual: Manual) -> set[float]:
    """Hours to solder all parts by hand: a minute and a half for each, rounded up."""
    counted = re.search(r"for all (\d+) parts of all boards by hand", " ".join(manual.blocks))
    return {math.ceil(int(counted[1]) * 1.5 / 60)} if counted else set()


def _noted(outputs: Path, name: str, row: re.Pattern[str], design: Design) -> list[tuple[str, ...]]:
    """Rows of the notes, of both fingers where each has its own, in their order."""
    files = dict.fromkeys(name.format(finger.name) for finger in design.fingers)
    found: list[tuple[str, ...]] = []
    for file in files:
        try:
            found += row.findall((outputs / file).read_text(encoding="utf-8"))
        except (OSError, UnicodeDecodeError):
            found.append((f"{file} cannot be read",))
    return found


def _weighed(rows: list[tuple[str, ...]]) -> list[tuple[str, ...]]:
    """Rows of both casting notes beside each other."""
    both: dict[str, tuple[str, ...]] = {}
    for what, *amounts in rows:
        both[what] = (*both.get(what, ()), *amounts)
    return [(what, *amounts) for what, amounts in both.items()]


def _billed(outputs: Path) -> list[tuple[str, ...]]:
    try:
        rows = table((outputs / "bom.csv").read_text(encoding="utf-8"))
        units = {"piece": "", "sheet": " sheets", "g": " g", "m": " m", "mL": " mL"}
        lines = [
            (r["item"], r["for"], r["quantity"] + units[r["unit"]], r["price"]) for r in rows[:-1]
        ]
        return [*lines, ("used by one pair of fingers", "", "", rows[-1]["price"])]
    except (OSError, ValueError, LookupError) as error:
        return [(f"bom.csv cannot be read: {error!r:.80}",)]


def _differing(manual: Manual, wanted: list[tuple[str, ...]]) -> list[str]:
    """Rows that are missing from the manual's tables, or stand there in another order."""
    chapters = (chapter for chapter in manual.chapters if chapter.heading != _GLANCE)
    rows = [tuple(row) for c in chapters for table in c.tables for row in table]
    known = set(wanted)
    keys = {row[0] for row in wanted}
    width = {len(row) for row in wanted}
    shown = [row for row in rows if row in known or (row[0] in keys and len(row) in width)]
    if shown == wanted and wanted:
        return []
    wrong = [" ".join(row) for row in wanted if row not in shown]
    return wrong or ["another order, or more of them"]


def _pdf(outputs: Path, manual: Manual) -> Iterator[Measurement]:
    """Words of the HTML that are not in the PDF, and fonts that it does not bring."""
    try:
        printed, without = read_pdf(outputs / _PDF)
    except OutputError as error:
        yield unreadable("manual.pdf", _PDF, str(error))
        yield unreadable("manual.fonts", _PDF, str(error))
        return
    whole = "".join(printed)
    wrong = [text for text in manual.blocks if re.sub(r"\s", "", page_letters(text)) not in whole]
    yield _count("pdf", _PDF, wrong, "lost paragraphs of the HTML")
    yield _count("fonts", _PDF, without, "fonts that are not embedded")


def _count(check: str, subject: str, wrong: list[str], unit: str) -> Measurement:
    note = "; ".join(text[:60] for text in wrong[:4]) + (" …" if len(wrong) > 4 else "")
    return Measurement(f"manual.{check}", subject, float(len(wrong)), 0, 0, unit, note)
