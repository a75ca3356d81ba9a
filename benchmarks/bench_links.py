"""Links: frames lost and processor time at 500 frames a second over Bluetooth, 20 s at a time.

bleak is the installed one. A separate process fakes `org.bluez` on a private D-Bus, so that the
processor time is that of the reader alone. Run by `make bench`; exits 1 if a goal is missed.
"""

import asyncio
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "tests"))

from bluetooth_peers import ScriptedPeer  # noqa: E402
from common import Goals  # noqa: E402
from fake_bluez import FakeBluez  # noqa: E402
from lumitip.fingertip import Fingertip  # noqa: E402
from lumitip.links.twin import Scene, packet_at, published_layout  # noqa: E402
from lumitip.protocol.bluetooth import FRAMES, SERVICE, STATUS, Fault, Status  # noqa: E402
from lumitip.protocol.packet import encode, needed_mtu  # noqa: E402
from private_bus import private_bus  # noqa: E402

RATE_HZ, SECONDS = 500, 20
LIMIT_SHARE, LIMIT_IMPORT_S = 0.5, 0.25
BATCHES = (1, 4)  # frames in a notification: the hardest case, and that of 7.5 ms intervals


def serve(address: str, batch: int) -> None:
    """Simulate a device that sends `RATE_HZ * SECONDS` frames after a subscription."""
    layout = published_layout()
    scene = Scene("disc", 12.0, 1.5, RATE_HZ, 8, 0)
    numbers = range(0, RATE_HZ * SECONDS, batch)
    packets = [encode(packet_at(layout, scene, n, batch)) for n in numbers]
    peer = ScriptedPeer(
        "Bench", "C0:FF:EE:00:00:01", {SERVICE: {FRAMES: ["notify"], STATUS: ["read", "notify"]}}
    )
    peer.values[STATUS] = Status(
        (1, 0, 0), layout.design_hash[:16], len(layout), 247, needed_mtu(len(layout), 8), Fault(0)
    ).encode()
    bluez = FakeBluez(address)
    bluez.add(peer)
    print("ready", flush=True)

    async def send() -> None:
        while FRAMES not in peer.subscribed:
            await asyncio.sleep(0.01)
        await asyncio.sleep(0.5)
        began = time.monotonic()
        for n, packet in zip(numbers, packets, strict=True):
            await asyncio.sleep(began + n / RATE_HZ - time.monotonic())
            peer.notify(FRAMES, packet)
        await asyncio.sleep(1.0)

    task = asyncio.run_coroutine_threadsafe(send(), bluez._loop)
    task.result()
    sys.stdin.read()
    bluez.stop()


def measure(batch: int) -> int:
    """Read all frames; the exit code."""
    with tempfile.TemporaryDirectory() as folder, private_bus(Path(folder)) as address:
        os.environ["DBUS_SYSTEM_BUS_ADDRESS"] = address
        command = [sys.executable, __file__, "serve", address, str(batch)]
        with subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        ) as device:
            assert device.stdin
            assert device.stdout
            assert device.stdout.readline() == "ready\n"
            wanted = RATE_HZ * SECONDS
            with Fingertip.open("ble://Bench", published_layout(), calibrated=False) as tip:
                first = tip.read(10.0)
                cpu_s, wall_s = time.process_time(), time.monotonic()
                last = first
                while last.seq < wanted - 1:
                    last = tip.read(5.0)
                cpu_s, wall_s = time.process_time() - cpu_s, time.monotonic() - wall_s
                stats = tip.stats
            device.stdin.close()
    lost, share = wanted - stats.received, cpu_s / wall_s
    print(
        f"{batch:>12}{stats.received:>11}{lost:>7}{wanted / wall_s:>10.0f}"
        f"{share:>12.2f}{stats.jitter_ms or 0:>12.2f}"
    )
    goals = Goals()
    counted = sum((stats.dropped or {}).values())
    goals.at_most(f"lost, {batch} in a notification", max(lost, counted), 0, "frames")
    goals.at_most(
        f"reading {RATE_HZ} frames/s, {batch} in a notification", share, LIMIT_SHARE, "of a core"
    )
    return goals.exit_code()


def imported() -> int:
    """Print what `import lumitip` takes, numpy and the interpreter's start apart, in processor
    time of the quickest of five starts; the exit code."""
    code = (
        "from time import process_time as now; a = now(); import numpy; b = now(); "
        "import lumitip; c = now(); import lumitip.fingertip; "
        "print(b - a, c - b, now() - c)"
    )
    timings = [
        [
            float(t)
            for t in subprocess.run(
                [sys.executable, "-I", "-c", code], capture_output=True, text=True, check=True
            ).stdout.split()
        ]
        for _ in range(5)
    ]
    numpy_s, lumitip_s, fingertip_s = min(timings, key=sum)
    print(
        f"import: numpy {numpy_s:.3f} s, lumitip {lumitip_s:.3f} s more, "
        f"Fingertip {fingertip_s:.3f} s more"
    )
    goals = Goals()
    goals.at_most("import of lumitip with numpy", numpy_s + lumitip_s, LIMIT_IMPORT_S, "s")
    return goals.exit_code()


def main() -> int:
    """Print the table."""
    if sys.argv[1:2] == ["serve"]:
        serve(sys.argv[2], int(sys.argv[3]))
        return 0
    if sys.argv[1:]:
        return measure(int(sys.argv[1]))
    codes = [imported()]
    print(f"\nlinks: {SECONDS} s at {RATE_HZ} frames/s over fake BlueZ")
    print(
        f"{'frames/value':>12}{'received':>11}{'lost':>7}{'rate/Hz':>10}{'core share':>12}"
        f"{'jitter/ms':>12}",
        flush=True,
    )
    # A process for each, since bleak keeps the first bus.
    codes += [subprocess.call([sys.executable, __file__, str(batch)]) for batch in BATCHES]
    return max(codes)


if __name__ == "__main__":
    sys.exit(main())
