"""`lumitip-fab page`: one page about an output folder."""

import argparse
from functools import cache
from pathlib import Path

from lumitip.layout import Layout
from lumitip_fab.cli.screen import OUT
from lumitip_fab.errors import OutputError
from lumitip_fab.pipeline.manifest import PAGE, STAMP, content_hash, write_file
from lumitip_fab.site.folder import Folder
from lumitip_fab.site.page import page


def run(options: argparse.Namespace) -> int:
    """Write the page into the output folder."""
    path = write_page(options.out)
    if not options.quiet:
        OUT.print(f"open {path} in a browser", soft_wrap=True)
    return 0


def write_page(out: Path, watched: bool = False) -> Path:
    """Write the page of an output folder.

    Args:
        out: the folder.
        watched: whether an open page is loaded again when it is written anew.

    Raises:
        OutputError: if the folder has no outputs, a file of it is damaged, or it cannot be written.
    """
    from lumitip_fab.cli.built import built_rows
    from lumitip_fab.docs import spec

    folder = Folder.of(out)
    rows = (*spec.rows(folder.design), *built_rows(out, folder.design))
    figures = [(r.quantity, r.published, r.computed, r.reason) for r in rows]
    stamp = content_hash(out) if watched else ""
    text = page(folder, figures, _errors(folder.design.layout.to_json()), stamp)
    path = out / PAGE
    try:
        write_file(path, text.encode())
        if watched:
            write_file(out / STAMP, f'written("{stamp}");\n'.encode())
        else:
            (out / STAMP).unlink(missing_ok=True)
    except OSError as error:
        raise OutputError(
            f"--out: is {out}, which cannot be written ({error.strerror}); a folder that "
            "can be written is needed. Choose another folder."
        ) from error
    return path


@cache
def _errors(layout: str) -> dict[str, float]:
    """Rms errors that the twin lets expect, by figure; kept for a page that is watched."""
    from lumitip_fab.solve.information import USUAL, expected

    return expected(Layout.from_json(layout), USUAL).rms()
