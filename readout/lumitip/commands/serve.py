"""`lumitip serve`: one fingertip for several programs."""

import argparse

from lumitip.commands.common import layout_path


def run(options: argparse.Namespace) -> int:
    """Serve until Ctrl-C, or until the device fails."""
    from lumitip.sharing import FingertipServer

    with FingertipServer(
        options.url,
        layout_path(options, options.url),
        host=options.host,
        port=options.port,
        token=options.token,
        timeout=options.timeout,
        any_design=options.any_design,
    ) as server:
        print(
            f"{server.device_id}: {len(server.layout)} cells, shared at {server.address} "
            "(Ctrl-C ends it)",
            flush=True,
        )
        server.wait()
    return 0
