"""`lumitip-fab page`: one page about an output folder."""

import argparse

from lumitip_fab.cli.screen import OUT
from lumitip_fab.errors import OutputError
from lumitip_fab.pipeline.manifest import PAGE, write_file
from lumitip_fab.site.folder import Folder
from lumitip_fab.site.page import page


def run(options: argparse.Namespace) -> int:
    """Write the page into the output folder."""
    from lumitip_fab.cli.built import built_rows
    from lumitip_fab.docs import spec

    folder = Folder.of(options.out)
    rows = (*spec.rows(folder.design), *built_rows(options.out, folder.design))
    text = page(folder, [(r.quantity, r.published, r.computed, r.reason) for r in rows])
    path = options.out / PAGE
    try:
        write_file(path, text.encode())
    except OSError as error:
        raise OutputError(
            f"--out: is {options.out}, which cannot be written ({error.strerror}); a folder that "
            "can be written is needed. Choose another folder."
        ) from error
    if not options.quiet:
        OUT.print(f"open {path} in a browser", soft_wrap=True)
    return 0
