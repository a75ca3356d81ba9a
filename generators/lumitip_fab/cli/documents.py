"""The files that describe the design: `layout.json`, `design.json` and `resolved.toml`, and what of
the catalogue is the user's own."""

from collections.abc import Iterator
from pathlib import Path

import tomli_w

from lumitip_fab.catalogue import Catalogue
from lumitip_fab.config.load import Input
from lumitip_fab.config.parts import NAMED
from lumitip_fab.design import Design
from lumitip_fab.design.encoding import design_text, encoded
from lumitip_fab.paths import design_folder, packaged_design, parts_file
from lumitip_fab.pipeline.artefact import Artefact

_HEAD = """\
# Every value in force: the parameter file with its bases. Can itself be built.
"""
_PARTS = """
# The parts that are named above, as they stand in the catalogue.
"""


def documents(config: Input, design: Design, out: Path) -> tuple[Artefact, ...]:
    """The documents of a design, for an output folder."""
    return (
        Artefact("layout.json", design.layout.to_json().encode()),
        Artefact("design.json", design_text(design).encode()),
        Artefact("resolved.toml", _resolved(config).encode(), frame=""),
        *_own_parts(config, out / "parts"),
    )


def _own_parts(config: Input, target: Path) -> Iterator[Artefact]:
    """Catalogue files that differ from the packaged ones: beside `resolved.toml`, which needs them
    where it is built. The user's own, where they lie there already, are no output."""
    folder = design_folder(config.sources[0].path)
    for kind in Catalogue.model_fields:
        packaged, used = packaged_design() / "parts" / f"{kind}.toml", parts_file(folder, kind)
        if used.resolve().parent == target.resolve():
            continue
        data = used.read_bytes()
        if data != packaged.read_bytes():
            yield Artefact(f"parts/{kind}.toml", data, frame="")


def _resolved(config: Input) -> str:
    parts = {field: encoded(e.model_dump()) for field, e in config.parts_by_field().items()}
    tables = {f"{NAMED[field]} for {field}": _without_none(entry) for field, entry in parts.items()}
    listed = "".join(f"# {line}".rstrip() + "\n" for line in tomli_w.dumps(tables).splitlines())
    return _HEAD + tomli_w.dumps(encoded(config.parameters.model_dump())) + _PARTS + listed


def _without_none(table: dict[str, object]) -> dict[str, object]:
    return {key: value for key, value in table.items() if value is not None}
