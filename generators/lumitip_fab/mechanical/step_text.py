"""STEP text without what the kernel takes from the process: the same shape, the same bytes.

Two things differ from run to run. Uses of a shape in an assembly are numbered over the life of
the process; and colours are written in the order of addresses in memory, after all geometry.
"""

import re
from functools import partial
from itertools import count

_USAGE = re.compile(r"NEXT_ASSEMBLY_USAGE_OCCURRENCE\('[^']*'([^;]*);")
_BREAK = re.compile(r"\n\s*")
_ENTITY = re.compile(r"#(\d+) = (.*?);\n", re.DOTALL)
_REFERENCE = re.compile(r"#(\d+)")
_COLOURED = "MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION("
_END = "ENDSEC;\nEND-ISO-10303-21;"


def canonical(text: str) -> str:
    """The same file with uses numbered from 1 and colours in the order of their text."""
    text = _USAGE.sub(partial(_numbered, count(1)), text)
    start, end = _colours(text)
    if start < 0:
        return text
    entities = {int(n): _BREAK.sub("", told) for n, told in _ENTITY.findall(text[start:end])}
    return text[:start] + _ordered(entities) + text[end:]


def _numbered(numbers: "count[int]", use: re.Match[str]) -> str:
    # The number's length decides where the kernel breaks the line.
    rest = _BREAK.sub("", use[1])
    return f"NEXT_ASSEMBLY_USAGE_OCCURRENCE('{next(numbers)}'{rest};"


def _colours(text: str) -> tuple[int, int]:
    """Where the entities of colours begin and end; below zero where there are none."""
    first = text.find(_COLOURED)
    return (text.rfind("#", 0, first) if first >= 0 else -1), text.rfind(_END)


def _ordered(entities: dict[int, str]) -> str:
    """Entities sorted by what they say, equal ones once, numbered anew from their first."""
    told: dict[int, str] = {}

    def full(number: int) -> str:
        if number not in told:
            told[number] = _REFERENCE.sub(
                lambda m: f"<{full(int(m[1]))}>" if int(m[1]) in entities else m[0],
                _sorted_items(entities[number]),
            )
        return told[number]

    def _sorted_items(entity: str) -> str:
        if not entity.startswith(_COLOURED):
            return entity
        head, items, tail = re.split(r"\((?=#)|\)(?=,#)", entity, maxsplit=2)
        ordered = sorted(items.split(","), key=lambda item: full(int(item[1:])))
        return f"{head}({','.join(ordered)}){tail}"

    numbers: dict[str, int] = {}
    lines: list[tuple[int, str]] = []

    def emit(number: int) -> int:
        key = full(number)
        if key not in numbers:
            numbers[key] = min(entities) + len(numbers)
            mine = numbers[key]
            line = _REFERENCE.sub(
                lambda m: f"#{emit(int(m[1]))}" if int(m[1]) in entities else m[0],
                _sorted_items(entities[number]),
            )
            lines.append((mine, line))
        return numbers[key]

    roots = [n for n, entity in entities.items() if entity.startswith(_COLOURED)]
    for root in sorted(roots, key=full):
        emit(root)
    return "".join(f"#{number} = {line};\n" for number, line in sorted(lines))
