"""The files that describe the design: `layout.json`, `design.json` and `resolved.toml`, and what of
the catalogue is the user's own."""

from collections.abc import Iterator
from pathlib import Path

from lumitip_fab.catalogue import Catalogue
from lumitip_fab.config.load import Input
from lumitip_fab.derive.resolved import resolved_text
from lumitip_fab.design import Design
from lumitip_fab.design.encoding import design_text
from lumitip_fab.paths import design_folder, packaged_design, parts_file
from lumitip_fab.pipeline.artefact import Artefact


def documents(config: Input, design: Design, out: Path) -> tuple[Artefact, ...]:
    """The documents of a design, for an output folder."""
    return (
        Artefact("layout.json", design.layout.to_json().encode()),
        Artefact("design.json", design_text(design).encode()),
        Artefact("resolved.toml", resolved_text(config).encode(), frame=""),
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
