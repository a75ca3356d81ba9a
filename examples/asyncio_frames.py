"""Read a fingertip in an asyncio program.

python examples/asyncio_frames.py twin://disc
"""

import asyncio
import sys

from lumitip import AsyncFingertip

if len(sys.argv) == 1:
    sys.exit(__doc__)


async def main(url: str, *layout: str) -> None:
    """Print twenty frames."""
    async with AsyncFingertip.open(url, *layout) as tip:
        number = 0
        async for frame in tip:
            print(f"{frame.seq:6}  {frame.values.mean():6.1f} of 255 on the mean")
            number += 1
            if number == 20:
                break


asyncio.run(main(*sys.argv[1:]))
