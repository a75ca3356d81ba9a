"""`lumitip view`: fingertips in a browser."""

import argparse
from pathlib import Path

from lumitip.commands.common import Subparsers, add_fingertip, layout_path


def add(subparsers: Subparsers) -> None:
    """Say what the command takes."""
    told = "Show one or more fingertips live in a browser, served from this computer."
    parser = subparsers.add_parser("view", help=told, description=told)
    add_fingertip(parser, several=True)
    parser.add_argument(
        "--host",
        default="127.0.0.1",
        metavar="ADDRESS",
        help="address to listen at (127.0.0.1); any other computer then needs the token",
    )
    parser.add_argument(
        "--port", type=int, default=8642, metavar="N", help="port (8642); 0 takes a free one"
    )
    parser.add_argument(
        "--token", metavar="TEXT", help="what browsers must show; made up where one is needed"
    )
    parser.add_argument(
        "--folder",
        type=Path,
        default=Path("recordings"),
        metavar="DIR",
        help="where recordings are written and replayed from (recordings)",
    )
    parser.add_argument(
        "--rerun",
        nargs="?",
        const="",
        metavar="FILE.rrd",
        help="show everything in the Rerun viewer too, or write it to a file for it",
    )
    parser.add_argument("--open", action="store_true", help="open the browser too")


def run(options: argparse.Namespace) -> int:
    """Carry it out."""
    import webbrowser
    from contextlib import ExitStack

    from lumitip.errors import MissingExtra

    try:
        from lumitip.view.server import ViewServer
    except ModuleNotFoundError as error:
        raise MissingExtra("view", "the live view") from error
    from lumitip.view.finger import Finger
    from lumitip.view.rerun_sink import RerunSink
    from lumitip.view.room import Room

    with ExitStack() as stack:
        sinks: tuple[RerunSink, ...] = ()
        if options.rerun is not None:
            sinks = (RerunSink(Path(options.rerun) if options.rerun else None),)
            stack.callback(sinks[0].close)
        room = Room((), options.folder)
        stack.callback(room.close)
        for url in options.urls:
            layout = layout_path(options, url)
            how = {"timeout": options.timeout, "any_design": options.any_design}
            room.add(Finger.open(url, layout, sinks, **how))
        server = ViewServer(room, options.host, options.port, options.token)
        print(f"live view at {server.url} (Ctrl-C ends it)", flush=True)
        if options.open:
            webbrowser.open(server.url)
        server.run()
    return 0
