"""One design of a study, in any process: accuracy, price, or why it cannot be; and the journal."""

import hashlib
import json
import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Any

import numpy as np

from lumitip.estimation import EstimationError
from lumitip_fab.catalogue import Catalogue
from lumitip_fab.catalogue.ordering import Prices
from lumitip_fab.config.load import Input
from lumitip_fab.config.messages import shown_path
from lumitip_fab.derive import resolve
from lumitip_fab.design import Design
from lumitip_fab.design.encoding import canonical
from lumitip_fab.design.pull_ups import used_slots
from lumitip_fab.errors import InputError, OutputError, Problem
from lumitip_fab.explore.accuracy import Sample, accuracy
from lumitip_fab.explore.vary import Changes
from lumitip_fab.paths import design_folder, parts_file
from lumitip_fab.pipeline.fingerprint import code_hash, tool_version


def unpriced(config: Input, prices: Prices, names: set[str]) -> list[Problem]:
    """A fault for each part that has no price."""
    path = parts_file(design_folder(config.sources[0].path), "prices")
    return [
        Problem(shown_path(path), 0, "each", f"has no price of {name!r}: add a line for it")
        for name in sorted(names - set(prices.each))
    ]


def bill(config: Input, design: Design) -> dict[str, int]:
    """How many of each part the two boards and the controller need."""
    p, wiring = config.parameters, design.wiring
    mux, array = design.packages.multiplexer, design.packages.array
    pull_ups = (p.receiver.resistor, wiring.muxes)
    if wiring.own_pull_ups:
        pull_ups = p.receiver.array, len(used_slots(design.reading.cells, mux, array))
    counts = (
        (p.emitter.led, len(design.layout)),
        (p.emitter.source, len(wiring.set_ohm)),
        (p.emitter.resistor, len(wiring.resistor_ohm) + len(wiring.set_ohm)),
        *(((p.emitter.switch, 1), (p.receiver.resistor, 1)) if wiring.emitter_pin else ()),
        (p.receiver.photodetector, len(design.layout)),
        (p.receiver.multiplexer, wiring.muxes),
        pull_ups,
        (p.receiver.capacitor, wiring.muxes),
        (p.controller.board, 1),
    )
    needed: dict[str, int] = {}
    for name, count in counts:
        if not count:
            continue
        needed[name] = needed.get(name, 0) + count
    return needed


def cost(config: Input, design: Design, prices: Prices) -> float:
    """Parts of both boards, the boards, placing, and the controller.

    Prints, silicone, film and work are not counted.
    """
    needed = bill(config, design)
    placed = sum(needed.values()) - 1  # the controller lies beside the robot
    board_cm2 = design.board.box.width_mm * design.board.box.length_mm / 100.0
    return (
        sum(count * prices.each[name] for name, count in needed.items())
        + 2 * (prices.board.each + board_cm2 * prices.board.per_cm2)
        + placed * prices.placing.each
    )


_DIGITS = 5

FIGURES = (
    "error_mm",
    "error_deg",
    "edge_mm",
    "cable_mm",
    "gross_percent",
    "bound_mm",
    "cells",
    "grid_cm2",
    "cost",
    "current_ma",
)
"""Figures of a design, in this order."""

Record = dict[str, Any]
"""Plain JSON: `key`, and `figures` (by name) or `refused` (what derive says)."""


@dataclass(frozen=True)
class Job:
    """All that one evaluation needs, on whatever machine."""

    config: Input
    """The parameter file with its changes."""
    changes: Changes
    prices: Prices
    sample: Sample
    key: str
    """SHA-256 of everything that the result depends on."""

    @classmethod
    def of(cls, config: Input, changes: Changes, prices: Prices, sample: Sample) -> "Job":
        """A job with its key."""
        key = key_of(config, prices, sample, code_hash("explore"))
        return cls(config, changes, prices, sample, key)


_WITHOUT_EFFECT = {"prices", "tolerances", "mask_shifts"}
"""Tables of the catalogue that no figure follows from; prices come by themselves."""


def key_of(config: Input, prices: Prices, *others: Any) -> str:
    """SHA-256 of a design, of prices, and of all else that a result depends on.

    Args:
        config: the design's parameters, and the catalogue: rules and automatic values read more
            of it than the parts that the parameters name.
        prices: of its parts.
        others: plain values, records, and the hash of the code.
    """
    inputs = [
        config.parameters.model_dump(),
        sorted(config.automatic),
        _catalogue_hash(config.catalogue),
        prices.model_dump(),
        *others,
        *map(tool_version, ("numpy", "scipy", "shapely")),
    ]
    return hashlib.sha256(canonical(inputs).encode()).hexdigest()


_hashed: list[tuple[Catalogue, str]] = []


def _catalogue_hash(catalogue: Catalogue) -> str:
    """SHA-256 of what moves figures, kept for one catalogue: a study asks for that of the same one
    for each of its designs, and it takes 12 ms."""
    if not _hashed or _hashed[0][0] is not catalogue:
        text = canonical(catalogue.model_dump(exclude=_WITHOUT_EFFECT))
        _hashed[:] = [(catalogue, hashlib.sha256(text.encode()).hexdigest())]
    return _hashed[0][1]


def evaluate(job: Job) -> Record:
    """Judge a design; nothing is built."""
    try:
        resolved = resolve(job.config)
    except InputError as error:
        return {"key": job.key, "refused": [p.text for p in error.problems]}
    design, layout = resolved.design, resolved.design.layout
    try:
        accurate = accuracy(layout, job.sample)
    except EstimationError as error:
        return {"key": job.key, "refused": [f"grid.columns: {error}"]}
    figures = {
        **accurate,
        "cells": float(len(layout)),
        "grid_cm2": float(np.ptp(layout.x_mm) * np.ptp(layout.y_mm)) / 100.0,
        "cost": cost(resolved.config, design, job.prices),
        "current_ma": float(sum(design.wiring.current_ma)),
    }
    return {"key": job.key, "figures": {n: rounded(figures[n]) for n in FIGURES}}


def rounded(value: float) -> float:
    """A figure with as many digits as are the same on any machine."""
    return float(f"{value:.{_DIGITS}g}")


NAME = "evaluated.jsonl"


class Journal:
    """The journal of a folder, a context manager; `known` is what is in it, by key."""

    def __init__(self, folder: Path) -> None:
        """Read what there is, and be ready to add to it.

        Raises:
            OutputError: if it cannot be read or written.
        """
        self._path = folder / NAME
        try:
            self._file = self._path.open("a+b")
            self._file.seek(0)
            whole = self._file.read()
            self._file.truncate(whole.rfind(b"\n") + 1)
        except OSError as error:
            raise OutputError(f"{self._path}: cannot be used: {error.strerror}") from error
        self.known: Mapping[str, Record] = {
            record["key"]: record for record in map(_record, whole.split(b"\n")[:-1]) if record
        }

    def add(self, record: Record) -> None:
        """Keep a record, on the disk before this returns."""
        line = json.dumps(record, sort_keys=True, ensure_ascii=False) + "\n"
        self._file.write(line.encode())
        self._file.flush()
        os.fsync(self._file.fileno())

    def __enter__(self) -> "Journal":
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._file.close()


def _record(line: bytes) -> Record | None:
    """A record, `None` of a line that is none: then its design is evaluated again."""
    try:
        record = json.loads(line)
    except ValueError:
        return None
    usable = isinstance(record, dict) and isinstance(record.get("key"), str)
    return record if usable and ("figures" in record or "refused" in record) else None
