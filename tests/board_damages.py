"""Ways to hurt a written board file, shared by the tests of its checks."""

import re
from collections.abc import Callable


def in_part(text: str, ref: str, pattern: str, put: str | Callable[[re.Match[str]], str]) -> str:
    """Replace the first match within a part's footprint."""
    at = text.index(f'(fp_text reference "{ref}"')
    start = text.rindex("\n  (footprint", 0, at)
    end = text.index("\n  (", at)
    return text[:start] + once(text[start:end], pattern, put) + text[end:]


def once(text: str, pattern: str, put: str | Callable[[re.Match[str]], str]) -> str:
    """Replace the first match, of which there must be one."""
    hurt, count = re.subn(pattern, put, text, count=1)
    assert count == 1, f"nothing matches {pattern}"
    return hurt


def shifted(dx_mm: float, dy_mm: float) -> Callable[[re.Match[str]], str]:
    """For a pattern whose groups 1 and 2 are x and y, and 3 what follows."""
    return lambda m: f"(at {float(m[1]) + dx_mm:g} {float(m[2]) + dy_mm:g}{m[3]}"


def moved_part(text: str, ref: str, dx_mm: float, dy_mm: float) -> str:
    """A footprint moved on the page."""
    return in_part(text, ref, r"\(at (\S+) (\S+?)( \S+\)|\))", shifted(dx_mm, dy_mm))


def swapped_pads(text: str, ref: str, one: str, other: str) -> str:
    """Two pads of a part with each other's number: the copper stays where it is."""
    text = in_part(text, ref, rf'\(pad "{one}" ', '(pad "?" ')
    text = in_part(text, ref, rf'\(pad "{other}" ', f'(pad "{one}" ')
    return in_part(text, ref, r'\(pad "\?" ', f'(pad "{other}" ')


def resistor_smaller(text: str) -> str:
    """Another value of a string's resistor."""
    return in_part(text, "R1", r'value "\d+R"', 'value "100R"')


def unrated(text: str) -> str:
    """A string's resistor in a package without a known rating."""
    return in_part(text, "R1", r"RESC\d{4}X", "RESC9999X")
