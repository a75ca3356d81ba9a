"""A random user file: `design(seed, index)` is the same wherever and whenever it is called."""

import json
from dataclasses import dataclass
from random import Random

from acceptance.kinds import KINDS, WITH_A_PRESET, Kind
from acceptance.limits import Values, crossed
from acceptance.parts import BASE, Table, preset, preset_file, presets

COUNTS, COUNT_WEIGHTS = (1, 2, 3, 4, 5), (30, 30, 20, 12, 8)
PRESET_SHARE = 0.04
EDITS = {kind.name: kind for kind in KINDS}


@dataclass(frozen=True)
class Design:
    """A user file."""

    name: str
    """Seed and index, for file names."""
    base: str
    """The preset that it extends."""
    kinds: tuple[str, ...]
    """Its kinds of edit."""
    edits: Table
    """The fields that it writes, by name."""

    @property
    def text(self) -> str:
        """The file as TOML."""
        sections: dict[str, list[str]] = {"": [f'extends = "{preset_file(self.base)}"']}
        for field, value in self.edits.items():
            section, _, key = field.rpartition(".")
            # Texts, numbers and arrays of numbers are written in TOML as in JSON.
            line = f"{key} = {json.dumps(value, ensure_ascii=False)}"
            sections.setdefault(section, []).append(line)
        about = f"#:schema ./schema.json\n# Design {self.name}: {', '.join(self.kinds)}.\n\n"
        tables = (
            "\n".join([f"[{section}]", *lines] if section else lines)
            for section, lines in sections.items()
        )
        return about + "\n\n".join(tables) + "\n"


def design(seed: int, index: int, usual: str = BASE) -> Design:
    """One of the random designs of a seed, none of which crosses a physical limit.

    Args:
        seed: of all of them.
        index: of this one.
        usual: the preset that most of them extend.
    """
    random = Random(f"{seed} {index}")
    while True:
        drawn = _draw(random, f"{seed}_{index}", usual)
        if drawn and not crossed(Values(drawn.edits, drawn.base)):
            return drawn


def _draw(random: Random, name: str, usual: str) -> Design | None:
    """A design; none where one of its edits changes nothing."""
    base, kinds = usual, tuple(KINDS)
    if random.random() < PRESET_SHARE:
        base = random.choice([preset for preset in presets() if preset != usual])
        kinds = tuple(kind for kind in KINDS if kind.name in WITH_A_PRESET)
    count = random.choices(COUNTS, COUNT_WEIGHTS)[0]
    chosen = _different(random, kinds, count - (base != usual))
    edits: Table = {}
    # In the order of `KINDS`: an aperture follows the pitch.
    for kind in (k for k in KINDS if k in chosen):
        drawn = kind.draw(random, edits, base)
        changes = {f: v for f, v in drawn.items() if f not in edits and v != preset(base)[f]}
        if not changes:
            return None
        edits |= changes
    names = tuple(k.name for k in KINDS if k in chosen)
    return Design(name, base, ("preset", *names) if base != usual else names, edits)


def _different(random: Random, kinds: tuple[Kind, ...], count: int) -> list[Kind]:
    """Some kinds by weight, none twice."""
    left, chosen = list(kinds), []
    for _ in range(count):
        chosen.append(random.choices(left, [kind.weight for kind in left])[0])
        left.remove(chosen[-1])
    return chosen
