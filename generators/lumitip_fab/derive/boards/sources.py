"""Places of the current sources on the emitter's front, each with its two resistors.

```
     towards the cells
 ┌─────┐
 │R out│ ┌───────────┐
 └─────┘ │ O O O ·   │   O: OUT, S: SET, I: IN, · open
 ┌─────┐ │  source   │
 │R set│ │ S · I I   │
 └─────┘ └───────────┘
   towards the connector
```
"""

import math

import numpy as np

from lumitip_fab.config.load import Input
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.design import Box, Part

BETWEEN_MM = 0.5  # parts of a group: a track and its gaps
GROUPS_APART_MM = 0.8
ROWS_APART_MM = (1.0, 3.0)  # at least, and where there is room
LABELS_MM = 1.4
"""Above the sources, for their references, where there is room."""


def source_parts(config: Input, strings: int, zone: Box, faults: Diagnostics) -> tuple[Part, ...]:
    """Sources U1 … with R1 … at their OUT, and the resistors at their SET, which count on.

    U1 is rightmost, because the strings begin with column 0, which is on the emitter's right.
    """
    wide, tall = group_mm(config)
    per_row = int((zone.width_mm + GROUPS_APART_MM) / (wide + GROUPS_APART_MM) + 1e-9)
    rows = math.ceil(strings / max(per_row, 1))
    least_mm, most_mm = ROWS_APART_MM
    deep = rows * (tall + least_mm) - least_mm
    if per_row < 1 or deep > zone.length_mm + 1e-9:
        faults.add("sources_no_room", strings=strings, wide=wide, tall=tall, zone=zone)
        return ()
    spare = zone.length_mm - deep
    top = zone.y_max_mm - min(LABELS_MM, spare)
    apart = min(least_mm + max(spare - LABELS_MM, 0.0) / rows, most_mm)
    parts: list[Part] = []
    for r, row in enumerate(np.array_split(np.arange(strings), rows)):
        y = top - tall / 2 - r * (tall + apart)
        slot = zone.width_mm / row.size
        for k, number in enumerate(row.tolist()):
            x = zone.x_max_mm - slot * (k + 0.5)
            parts += _group(config, number, strings, (x, y))
    return tuple(sorted(parts, key=lambda part: (part.kind, int(part.name[1:]))))


def group_mm(config: Input) -> tuple[float, float]:
    """Width and depth of a source with its resistors."""
    source, resistor = config.parts.emitter.source, config.parts.emitter.resistor
    along, across = resistor.over_pads_mm
    gap = config.parameters.board.clearance_mm
    wide = source.body_mm[0] + max(BETWEEN_MM, gap) + across
    return wide, max(source.lead_span_mm, 2 * along + gap)


def _group(
    config: Input, number: int, strings: int, middle: tuple[float, float]
) -> tuple[Part, Part, Part]:
    source, resistor = config.parts.emitter.source, config.parts.emitter.resistor
    along, across = resistor.over_pads_mm
    wide, _ = group_mm(config)
    left, y = middle[0] - wide / 2, middle[1]
    off = (along + config.parameters.board.clearance_mm) / 2

    def upright(count: int, up: int) -> Part:
        place = left + across / 2, y + up * off
        return Part(f"R{count}", "resistor", *place, across, along, resistor.body_mm[2], "front")

    length, _, height = source.body_mm
    place = left + wide - length / 2, y
    size = length, source.lead_span_mm, height
    chip = Part(f"U{number + 1}", "current source", *place, *size, "front")
    return chip, upright(number + 1, 1), upright(strings + number + 1, -1)
