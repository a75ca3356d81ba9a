"""`lumitip tare`: measure what each cell reads with an empty grasp, or in the dark, and keep it."""

import argparse

from lumitip.commands.common import Subparsers, add_fingertip, open_fingertip


def add(subparsers: Subparsers) -> None:
    """Say what the command takes."""
    told = "Measure the empty grasp (or darkness) of every cell and keep it for this device."
    parser = subparsers.add_parser("tare", help=told, description=told)
    add_fingertip(parser)
    what = parser.add_mutually_exclusive_group()
    what.add_argument("--dark", action="store_true", help="all light is shut off")
    what.add_argument("--forget", action="store_true", help="delete what is kept")


def run(options: argparse.Namespace) -> int:
    """Carry it out."""
    from lumitip.session.drift import WARM_UP_S

    with open_fingertip(options, calibrated=not options.forget) as tip:
        if options.forget:
            tip.forget()
            print(f"{tip.device_id}: nothing is kept any more")
            return 0
        state = "with all light shut off" if options.dark else "with nothing between the fingers"
        print(f"{tip.device_id}: hold still {state}, waiting for 50 frames", flush=True)
        made = tip.tare("dark" if options.dark else "empty")
        reference = made.dark if options.dark else made.empty
        assert reference is not None
        print(
            f"{tip.device_id}: cells read {reference.min():.1f} to {reference.max():.1f} of 255 "
            f"{'in the dark' if options.dark else 'with an empty grasp'}; kept"
        )
        last = tip.latest()
        if last and (last.t_device or WARM_UP_S) < WARM_UP_S:
            print("still warming up: tare again five minutes after switching on")
    return 0
