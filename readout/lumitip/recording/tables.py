"""A recording as a table: Parquet or CSV, one row per frame.

Columns: `seq`, `t_wall`, `t_host`, `t_device` (s), `dropped_before`, `bits`, then for every cell
`raw_0`… (ADC codes, high is dark) and `value_0`… (calibrated light, 255 is full light). Unknown
values are empty.
"""

import csv
import json
from collections.abc import Callable, Iterator
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np

from lumitip import arguments
from lumitip.errors import MissingExtra
from lumitip.frame import RecordedFrame
from lumitip.recording.message import RecordingError
from lumitip.recording.reader import Reader

_BLOCK = 4096
_TIMES = ("seq", "t_wall", "t_host", "t_device", "dropped_before", "bits")


def export(source: str | Path, target: str | Path, finger: str | None = None) -> int:
    """Write a recording as a table; returns the number of rows.

    Args:
        source: of the recording.
        target: of the table, ending in `.parquet` or `.csv`; must not exist yet.
        finger: see `Reader`.

    Raises:
        RecordingError: if either file cannot be used; no partial table is left.
        MissingExtra: for Parquet without pyarrow.
    """
    path = arguments.path(target, RecordingError)
    writers: dict[str, Callable[[Reader, Path], int]] = {".csv": _csv, ".parquet": _parquet}
    if path.suffix not in writers:
        raise RecordingError(f"the table is {target}; its name must end in {' or '.join(writers)}")
    reader = Reader(source, finger=finger)
    if path.exists():
        raise RecordingError(f"{target} exists. Choose another name")
    try:
        return writers[path.suffix](reader, path)
    except BaseException as error:
        path.unlink(missing_ok=True)
        if isinstance(error, OSError):
            raise RecordingError(arguments.unwritable(path, error)) from error
        raise


def _blocks(reader: Reader) -> Iterator[list[RecordedFrame]]:
    frames = iter(reader)
    while block := list(islice(frames, _BLOCK)):
        yield block


def _csv(reader: Reader, path: Path) -> int:
    cells = len(reader.layout)
    rows = 0
    with path.open("x", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow([*_TIMES, *_names("raw", cells), *_names("value", cells)])
        for frame in reader:
            values = [f"{v:.3f}" for v in reader.metadata.values(frame).tolist()]
            times = [getattr(frame, name) for name in _TIMES]
            table.writerow([*times, *frame.raw.tolist(), *values])
            rows += 1
    return rows


def _parquet(reader: Reader, path: Path) -> int:
    try:
        import pyarrow
        from pyarrow import parquet
    except ModuleNotFoundError as error:
        raise MissingExtra("export", "Parquet") from error
    cells = len(reader.layout)
    kinds = (pyarrow.int64(), *[pyarrow.float64()] * 3, pyarrow.int32(), pyarrow.uint8())
    fields = [pyarrow.field(n, k) for n, k in zip(_TIMES, kinds, strict=True)]
    fields += [pyarrow.field(n, pyarrow.uint16()) for n in _names("raw", cells)]
    fields += [pyarrow.field(n, pyarrow.float32()) for n in _names("value", cells)]
    metadata = {b"lumitip": json.dumps(reader.metadata.to_texts()).encode()}
    schema = pyarrow.schema(fields, metadata=metadata)
    rows = 0
    with parquet.ParquetWriter(path, schema) as table:
        for block in _blocks(reader):
            table.write_table(pyarrow.table(_columns(reader, block), schema=schema))
            rows += len(block)
    return rows


def _columns(reader: Reader, block: list[RecordedFrame]) -> list[Any]:
    raw = np.array([frame.raw for frame in block], dtype=np.uint16)
    values = np.array([reader.metadata.values(frame) for frame in block], dtype=np.float32)
    return [[getattr(f, name) for f in block] for name in _TIMES] + [*raw.T, *values.T]


def _names(what: str, cells: int) -> list[str]:
    return [f"{what}_{i}" for i in range(cells)]
