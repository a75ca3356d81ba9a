"""`lumitip view`: fingertips in a browser."""

import argparse
import os
from pathlib import Path

from lumitip.commands.common import layout_path


def run(options: argparse.Namespace) -> int:
    """Serve until Ctrl-C."""
    import webbrowser
    from contextlib import ExitStack

    from lumitip.errors import MissingExtra

    try:
        from lumitip.view.server import ViewServer
    except ModuleNotFoundError as error:
        raise MissingExtra("view", "the live view") from error
    from lumitip.view.estimating import Expected
    from lumitip.view.finger import Finger
    from lumitip.view.registry import FingerRegistry
    from lumitip.view.rerun_sink import RerunSink

    if options.folder:  # the default may stay unused
        _require_writable(options.folder)
    with ExitStack() as stack:
        sinks: tuple[RerunSink, ...] = ()
        if options.rerun is not None:
            sinks = (RerunSink(Path(options.rerun) if options.rerun else None),)
            stack.callback(sinks[0].close)
        expected = Expected.of("", options.gap, options.diameter)
        registry = FingerRegistry((), options.folder or Path("recordings"), expected)
        stack.callback(registry.close)
        for url in options.urls:
            layout = layout_path(options, url)
            registry.add(
                Finger.open(
                    url,
                    layout,
                    sinks,
                    timeout=options.timeout,
                    any_design=options.any_design,
                    gap_mm=options.gap,
                    diameter_mm=options.diameter,
                )
            )
        server = ViewServer(registry, options.host, options.port, options.token)
        print(f"live view at {server.url} (Ctrl-C ends it)", flush=True)
        if options.open:
            webbrowser.open(server.url)
        server.run()
    return 0


def _require_writable(folder: Path) -> None:
    """Refuse a folder in which no recording could be written: it is made with the first one."""
    from lumitip.errors import ViewError

    there = folder.absolute()
    try:
        while not there.exists():
            there = there.parent
        if not there.is_dir():
            raise ViewError(f"--folder {folder}: {there} is not a folder. Choose another one")
        writable = os.access(there, os.W_OK | os.X_OK)
    except OSError:
        writable = False
    if not writable:
        raise ViewError(f"--folder {folder}: {there} cannot be written. Choose another one")
