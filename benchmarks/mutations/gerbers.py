"""Gerber and drill files, and the zips of an order that they are in."""

import io
import re
import zipfile
from collections.abc import Callable
from functools import lru_cache
from pathlib import PurePath

from numpy.random import Generator
from shapely.geometry.base import BaseGeometry

from lumitip_fab.checks.readers.gerber import gerber_area
from mutations.amounts import changed, cut_short, distance_mm, factor, put, replaced
from mutations.damage import Mutator, Mutators, NotApplicableError
from mutations.records import CSV, PLAIN
from mutations.solids import in_zip

_DRAW = re.compile(r"^(?:X(-?\d+))?(?:Y(-?\d+))?(?:I-?\d+)?(?:J-?\d+)?D0[123]\*$", re.MULTILINE)
_APERTURE = re.compile(r"^%ADD\d+[CRO],(.*)\*%$", re.MULTILINE)
_UNITS_PER_MM = 1e6  # %FSLAX46Y46*%
_LEAST_MM2 = 0.02
"""A fab etches nothing smaller. A corner of a pour's rounded edge changes less."""
_HOLE = re.compile(r"^X(-?[\d.]+)Y(-?[\d.]+)\n", re.MULTILINE)
_TOOL = re.compile(r"^T\d+C([\d.]+)$", re.MULTILINE)


@lru_cache(maxsize=16)
def _area(text: str) -> BaseGeometry | None:
    """Painted area of a file; none where it cannot be read."""
    try:
        return gerber_area(text)
    except (ArithmeticError, LookupError, ValueError, SyntaxError, AttributeError, TypeError):
        return None


def painting(damage: Mutator) -> Mutator:
    """A mutator that counts only where it paints another area."""

    def mutate(data: bytes, rng: Generator) -> tuple[bytes, str]:
        for _ in range(10):
            new, done = damage(data, rng)
            before, after = _area(data.decode()), _area(new.decode())
            if before is None or after is None:
                return new, done
            if before.symmetric_difference(after).area > _LEAST_MM2:
                return new, done
        raise NotApplicableError

    return mutate


def _draws(text: str) -> list[re.Match[str]]:
    found = list(_DRAW.finditer(text))
    if not found:
        raise NotApplicableError
    return found


def _coordinate(data: bytes, rng: Generator) -> tuple[bytes, str]:
    text = data.decode()
    draws = _draws(text)
    draw = draws[int(rng.integers(len(draws)))]
    axis = 1 if draw[1] else 2
    if draw[1] and draw[2]:
        axis = int(rng.integers(1, 3))
    if draw[axis] is None:
        raise NotApplicableError
    new = int(draw[axis]) + round(distance_mm(rng) * _UNITS_PER_MM)
    return put(text, draw.span(axis), f"{'-' if new < 0 else ''}{abs(new):010d}")


def _line_removed(data: bytes, rng: Generator) -> tuple[bytes, str]:
    text = data.decode()
    draws = _draws(text)
    draw = draws[int(rng.integers(len(draws)))]
    return put(text, draw.span(), "")


def _aperture(data: bytes, rng: Generator) -> tuple[bytes, str]:
    text = data.decode()
    found = list(_APERTURE.finditer(text))
    if not found:
        raise NotApplicableError
    aperture = found[int(rng.integers(len(found)))]
    sizes = aperture[1].split("X")
    at = int(rng.integers(len(sizes)))
    old = float(sizes[at])
    sizes[at] = f"{max(old + abs(distance_mm(rng)) * rng.choice([-1, 1]), old * 0.3):.3f}"
    return put(text, aperture.span(1), "X".join(sizes))


def _whole(data: bytes, rng: Generator) -> tuple[bytes, str]:
    """Every coordinate of one axis moved, scaled or negated."""
    text, axis, how = data.decode(), "XY"[int(rng.integers(2))], int(rng.integers(3))
    by, move = factor(rng), distance_mm(rng)
    _draws(text)

    def change(match: re.Match[str]) -> str:
        old = int(match[1])
        new = (old + round(move * _UNITS_PER_MM), round(old * by), -old)[how]
        return f"{axis}{'-' if new < 0 else ''}{abs(new):010d}"

    # Not in %ADD…, and not the I and J of arcs, which are distances.
    lines = (
        line if line.startswith(("%", "G04")) else re.sub(rf"{axis}(-?\d+)", change, line)
        for line in text.splitlines(keepends=True)
    )
    new = "".join(lines)
    return new.encode(), f"all {axis} {(f'moved by {move:g} mm', f'times {by:g}', 'negated')[how]}"


GERBER: Mutators = {
    "number": painting(_coordinate),
    "remove": painting(_line_removed),
    "aperture": painting(_aperture),
    "transform": painting(_whole),
    "polarity": painting(replaced(("%LPD*%", "%LPC*%"), ("%LPC*%", "%LPD*%"))),
    "unit": painting(replaced(("%MOMM*%", "%MOIN*%"), ("%FSLAX46Y46*%", "%FSLAX45Y45*%"))),
    "function": replaced(
        ("FileFunction,Copper,L1,Top", "FileFunction,Copper,L2,Bot"),
        ("FileFunction,Copper,L2,Bot", "FileFunction,Copper,L1,Top"),
        ("FilePolarity,Positive", "FilePolarity,Negative"),
        ("FilePolarity,Negative", "FilePolarity,Positive"),
        (",Top*%", ",Bot*%"),
        (",Bot*%", ",Top*%"),
    ),
    "truncate": cut_short,
}


def _hole_moved(data: bytes, rng: Generator) -> tuple[bytes, str]:
    text = data.decode()
    hole = _hole(text, rng)
    axis = int(rng.integers(1, 3))
    new = float(hole[axis]) + distance_mm(rng)
    return put(text, hole.span(axis), f"{'-' if new < 0 else ''}{abs(new):07.4f}")


def _hole(text: str, rng: Generator) -> re.Match[str]:
    holes = list(_HOLE.finditer(text))
    if not holes:
        raise NotApplicableError
    return holes[int(rng.integers(len(holes)))]


def _hole_removed(data: bytes, rng: Generator) -> tuple[bytes, str]:
    text = data.decode()
    return put(text, _hole(text, rng).span(), "")


def _hole_added(data: bytes, rng: Generator) -> tuple[bytes, str]:
    text = data.decode()
    hole = _hole(text, rng)
    x, y = (float(hole[i]) + abs(distance_mm(rng)) for i in (1, 2))
    new = f"{hole[0]}X{x:.4f}Y{y:.4f}\n"
    return put(text, hole.span(), new)


def _tool(data: bytes, rng: Generator) -> tuple[bytes, str]:
    text = data.decode()
    tools = list(_TOOL.finditer(text))
    if not tools:
        raise NotApplicableError
    tool = tools[int(rng.integers(len(tools)))]
    return put(text, tool.span(1), changed(tool[1], rng, 0.1))


DRILL: Mutators = {
    "number": _hole_moved,
    "remove": _hole_removed,
    "duplicate": _hole_added,
    "tool": _tool,
    "unit": replaced(("METRIC", "INCH")),
    "function": replaced(
        ("Plated,1,2,PTH", "NonPlated,1,2,NPTH"), ("NonPlated,1,2,NPTH", "Plated,1,2,PTH")
    ),
    "truncate": cut_short,
}
_MEMBERS: dict[str, Mutators] = {".drl": DRILL, ".csv": CSV, ".txt": PLAIN}


def _of_member(name: str) -> Mutators:
    return _MEMBERS.get(PurePath(name).suffix.lower(), GERBER)


def _in_a_member(data: bytes, rng: Generator) -> tuple[bytes, str]:
    """A file in the zip damaged by one of the mutators of its format."""
    with zipfile.ZipFile(io.BytesIO(data)) as order:
        name = order.namelist()[int(rng.integers(len(order.namelist())))]
    kinds = sorted(_of_member(name))
    kind = kinds[int(rng.integers(len(kinds)))]
    new, done = in_zip(name, lambda body: _of_member(name)[kind](body, rng), data)
    return new, f"{name}, {kind}: {done}"


def _rezipped(change: Callable[[dict[str, bytes], Generator], str]) -> Mutator:
    def mutate(data: bytes, rng: Generator) -> tuple[bytes, str]:
        target = io.BytesIO()
        with zipfile.ZipFile(io.BytesIO(data)) as old:
            members = {name: old.read(name) for name in old.namelist()}
            done = change(members, rng)
            with zipfile.ZipFile(target, "w") as new:
                for name, body in members.items():
                    new.writestr(zipfile.ZipInfo(name), body, zipfile.ZIP_DEFLATED)
        return target.getvalue(), done

    return mutate


def _member_removed(members: dict[str, bytes], rng: Generator) -> str:
    name = sorted(members)[int(rng.integers(len(members)))]
    del members[name]
    return f"{name} is gone"


def _members_swapped(members: dict[str, bytes], rng: Generator) -> str:
    """Two files of one format in each other's place."""
    one = sorted(members)[int(rng.integers(len(members)))]
    others = [
        n
        for n in sorted(members)
        if _of_member(n) is _of_member(one) and members[n] != members[one]
    ]
    if not others:
        raise NotApplicableError
    other = others[int(rng.integers(len(others)))]
    members[one], members[other] = members[other], members[one]
    return f"{one} and {other} are swapped"


def _member_added(members: dict[str, bytes], rng: Generator) -> str:
    """A second copy of a layer under another name."""
    name = sorted(members)[int(rng.integers(len(members)))]
    path = PurePath(name)
    members[f"{path.stem}_old{path.suffix}"] = members[name]
    return f"{name} is there once more, as {path.stem}_old{path.suffix}"


ORDER: Mutators = {
    "file": _in_a_member,
    "remove": _rezipped(_member_removed),
    "swap files": _rezipped(_members_swapped),
    "duplicate": _rezipped(_member_added),
    "truncate": cut_short,
}
