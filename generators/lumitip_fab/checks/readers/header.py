"""A C++ header of settings and constants: what a compiler would reject or read otherwise."""

import re
from collections import Counter
from collections.abc import Collection, Iterator, Mapping

_COMMENT = re.compile(r'("(?:[^"\\\n]|\\.)*")|//(?:\\\n|.)*')
_NUMBER = r"(?:0x[0-9a-f]+|0|[1-9][0-9]*)"
_VALUE = rf'(?:{_NUMBER}|"[^"\\\n]*"|\{{\s*{_NUMBER}(?:,\s*{_NUMBER})*,?\s*\}})'
_HEADER = re.compile(
    r"\s*#pragma once\s*\n#include <stdint\.h>[ \t]*\n"
    r"(?P<settings>(?:[ \t]*\n|#define \w+ .*(?<!\\)\n"
    r"|#ifndef (?P<name>\w+)\n#define (?P=name) \w+[ \t]*\n#endif[ \t]*\n)*)"
    r"namespace lumitip \{"
    rf"(?P<constants>(?:\s*constexpr \w+ \w+(?:\[\w*\])? = {_VALUE};)*)\s*\}}\s*",
    re.ASCII,
)
_SETTING = re.compile(r"^#define (\w+)", re.MULTILINE)
_CONSTANT = re.compile(rf"constexpr (\w+) (\w+)((?:\[\w*\])?) = ({_VALUE});", re.ASCII)


def uncommented(text: str) -> str:
    """The header without its comments, each of which goes on after a backslash at its end."""
    return _COMMENT.sub(r"\1", text)


def faults(text: str, settings: Collection[str], types: Mapping[str, str]) -> list[str]:
    """Places where a header, without its comments, is not what a compiler needs.

    Args:
        text: the header.
        settings: names that it may define, each once.
        types: type of every constant, all of which it must have, like `"uint8_t[8]"`.
    """
    whole = _HEADER.fullmatch(text)
    if whole is None:
        return ["not a guard, <stdint.h>, settings and a namespace of constants"]
    constants = _CONSTANT.findall(whole["constants"])
    names = Counter([*_SETTING.findall(whole["settings"]), *(name for _, name, *_ in constants)])
    wrong = [f"{name} twice" for name, times in names.items() if times > 1]
    wrong += [f"{name} unknown" for name in names if name not in types and name not in settings]
    wrong += [f"no {name}" for name in types if name not in names]
    return [*wrong, *_misfits(constants, types)]


def _misfits(constants: list[tuple[str, str, str, str]], types: Mapping[str, str]) -> Iterator[str]:
    """Constants of another type, or of a value that does not fit into it."""
    known: dict[str, int] = {}
    for kind, name, size, value in constants:
        numbers = [int(number, 0) for number in re.findall(_NUMBER, value)]
        if types.get(name) != kind + size:
            yield f"{name} is {kind}{size}"
        elif kind == "char":
            if not value.startswith('"'):
                yield f"{name} is no text"
        elif not _fits(int(kind.strip("uint_")), size[1:-1], value, numbers, known):
            yield f"{name} does not fit into {kind}{size}"
        known[name] = numbers[0] if numbers else 0


def _fits(bits: int, size: str, value: str, numbers: list[int], known: Mapping[str, int]) -> bool:
    """Whether each number has no more bits, and there are no more numbers than the array has
    places: a number, or a constant that is known by then."""
    most = int(size) if size.isdigit() else known.get(size, 0) if size else 1
    in_braces = value.startswith("{")
    return in_braces == bool(size) and 0 < len(numbers) <= most and max(numbers) < 2**bits
