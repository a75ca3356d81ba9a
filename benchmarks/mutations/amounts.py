"""Numbers changed by an amount that matters, and words by other words."""

import math
import re
from collections.abc import Callable, Iterator, Sequence

from numpy.random import Generator

from mutations.damage import Mutator, NotApplicableError

LEAST_SHARE, MOST_SHARE = 0.03, 0.6
LEAST_MM, MOST_MM = 0.25, 3.0
NUMBER = re.compile(r"(?<![\w.\-+#])[-+]?(?:\d+(?:\.\d+)?|\.\d+)(?:[eE][-+]?\d+)?(?!\w|\.\d|-\d)")
WORD = re.compile(r"(?<![\w-])[^\W\d_]{4,}(?![\w-])")
Span = tuple[int, int]
Skip = re.Pattern[str] | None


def changed(text: str, rng: Generator, least: float = 0.0) -> str:
    """Another number with as many decimals, or as many more as the change needs.

    Args:
        text: a number, as it is in the file.
        rng: draws amount and sign.
        least: the least change; where it is 0, the change is a share of the number, or 1 of 0.
    """
    value = float(text)
    share = math.exp(rng.uniform(math.log(LEAST_SHARE), math.log(MOST_SHARE)))
    by = max(share * abs(value), least * rng.uniform(1, 4)) or 1.0
    if not re.search(r"[.eE]", text):
        by = max(round(by), 1, math.ceil(least))
        return str(int(value) + (by if value <= 0 or rng.random() < 0.5 else -by))
    moved = value + (by if rng.random() < 0.5 else -by)
    if "e" in text.lower():
        return f"{moved:.9e}"
    decimals = max(len(text.partition(".")[2]), 0)
    while abs(round(moved, decimals) - value) < 0.5 * by:
        decimals += 1
    return f"{moved:.{decimals}f}"


def distance_mm(rng: Generator) -> float:
    """A length that matters, with a sign."""
    size = math.exp(rng.uniform(math.log(LEAST_MM), math.log(MOST_MM)))
    return round(float(size * rng.choice([-1, 1])), 3)


def factor(rng: Generator) -> float:
    """A scale that differs from 1 by 2 to 20 %, up or down."""
    return round(float(1 + rng.uniform(0.02, 0.2) * rng.choice([-1, 1])), 3)


def one_of(items: Sequence[Span], rng: Generator) -> Span:
    """One of some spans."""
    if not items:
        raise NotApplicableError
    return items[int(rng.integers(len(items)))]


def spans(text: str, pattern: re.Pattern[str], skip: Skip = None) -> Iterator[Span]:
    """Where a pattern (its group 1, if it has one) is, outside what is skipped."""
    skipped = [m.span() for m in skip.finditer(text)] if skip else []
    at = 0
    for match in pattern.finditer(text):
        start, end = match.span(1 if pattern.groups else 0)
        while at < len(skipped) and skipped[at][1] <= start:
            at += 1
        if at == len(skipped) or skipped[at][0] >= end:
            yield start, end


def around(text: str, start: int, end: int) -> str:
    """The line of a place, for a description."""
    low, high = text.rfind("\n", 0, start) + 1, text.find("\n", end)
    line = text[max(low, start - 50) : min(high if high >= 0 else len(text), end + 30)]
    return f"line {text.count(chr(10), 0, start) + 1}: …{line.strip()}…"


def put(text: str, span: Span, new: str) -> tuple[bytes, str]:
    """The text with a span replaced, and what was done."""
    start, end = span
    done = f"{text[start:end]!r} becomes {new!r} in {around(text, start, end)}"
    return (text[:start] + new + text[end:]).encode(), done


def number_changed(
    pattern: re.Pattern[str] = NUMBER, least: float = 0.0, skip: Skip = None
) -> Mutator:
    """A mutator that changes one number.

    Args:
        pattern: finds numbers; its group 1, if it has one, is the number.
        least: the least change.
        skip: text in which no number matters.
    """

    def mutate(data: bytes, rng: Generator) -> tuple[bytes, str]:
        text = data.decode()
        span = one_of(list(spans(text, pattern, skip)), rng)
        in_mm = LEAST_MM if _is_length(text, *span) else 0.0
        return put(text, span, changed(text[slice(*span)], rng, max(least, in_mm)))

    return mutate


def _is_length(text: str, start: int, end: int) -> bool:
    """Whether a unit of mm stands behind a number, or in the name before it."""
    before = text[text.rfind("\n", 0, start) + 1 : start]
    return bool(re.match(r"\s?mm\b", text[end : end + 4]) or re.search(r"_mm\b", before))


def word_changed(pattern: re.Pattern[str] = WORD, skip: Skip = None) -> Mutator:
    """A mutator that puts another word of the same file in a word's place."""

    def mutate(data: bytes, rng: Generator) -> tuple[bytes, str]:
        text = data.decode()
        found = list(spans(text, pattern, skip))
        span = one_of(found, rng)
        old = text[slice(*span)]
        others = sorted({text[slice(*s)] for s in found if text[slice(*s)].lower() != old.lower()})
        if not others:
            raise NotApplicableError
        return put(text, span, others[int(rng.integers(len(others)))])

    return mutate


def removed(pattern: re.Pattern[str], skip: Skip = None) -> Mutator:
    """A mutator that removes one match."""

    def mutate(data: bytes, rng: Generator) -> tuple[bytes, str]:
        text = data.decode()
        return put(text, one_of(list(spans(text, pattern, skip)), rng), "")

    return mutate


def doubled(pattern: re.Pattern[str], skip: Skip = None) -> Mutator:
    """A mutator that repeats one match."""

    def mutate(data: bytes, rng: Generator) -> tuple[bytes, str]:
        text = data.decode()
        span = one_of(list(spans(text, pattern, skip)), rng)
        return put(text, span, text[slice(*span)] * 2)

    return mutate


def swapped(pattern: re.Pattern[str], skip: Skip = None) -> Mutator:
    """A mutator that swaps two matches that differ."""

    def mutate(data: bytes, rng: Generator) -> tuple[bytes, str]:
        text = data.decode()
        found = list(spans(text, pattern, skip))
        one = one_of(found, rng)
        old = text[slice(*one)]
        other = one_of([s for s in found if text[slice(*s)] != old], rng)
        (a, b), (c, d) = sorted([one, other])
        swapped_text = text[:a] + text[c:d] + text[b:c] + text[a:b] + text[d:]
        return swapped_text.encode(), f"{text[a:b]!r} and {text[c:d]!r} are swapped"

    return mutate


def replaced(*pairs: tuple[str, str]) -> Mutator:
    """A mutator that replaces a text by another everywhere, like a unit."""

    def mutate(data: bytes, rng: Generator) -> tuple[bytes, str]:
        text = data.decode()
        fitting = [(old, new) for old, new in pairs if old in text]
        if not fitting:
            raise NotApplicableError
        old, new = fitting[int(rng.integers(len(fitting)))]
        return text.replace(old, new).encode(), f"every {old!r} becomes {new!r}"

    return mutate


def first_of(*mutators: Mutator) -> Mutator:
    """A mutator that is one of some, each as often."""

    def mutate(data: bytes, rng: Generator) -> tuple[bytes, str]:
        order: Sequence[Callable[..., tuple[bytes, str]]] = mutators
        return order[int(rng.integers(len(order)))](data, rng)

    return mutate


def cut_short(data: bytes, rng: Generator) -> tuple[bytes, str]:
    """Keep only the beginning: as when a disk is full."""
    kept = int(len(data) * rng.uniform(0.1, 0.9))
    if data[kept:].strip() == b"":
        raise NotApplicableError
    return data[:kept], f"only the first {kept} of {len(data)} bytes are left"
