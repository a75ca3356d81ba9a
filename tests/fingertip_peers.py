"""Bluetooth fingertips that a test scripts, and sending from them."""

from bluetooth_peers import ScriptedPeer
from fake_bluez import FakeBluez
from lumitip.protocol.bluetooth import FRAMES, SERVICE, STATUS

HERE, THERE = "C0:FF:EE:00:00:01", "C0:FF:EE:00:00:02"
V2 = {SERVICE: {FRAMES: ["notify"], STATUS: ["read", "notify"]}}


def add_fingertip(
    bluez: FakeBluez, device, address: str = HERE, name: str = "Lumitip"
) -> ScriptedPeer:
    """Switch on a fingertip that a test scripts."""
    peer = ScriptedPeer(name, address, V2)
    peer.values[STATUS] = device.status()
    bluez.add(peer)
    return peer


def send(bluez: FakeBluez, peer: ScriptedPeer, *packets: bytes, uuid: str = FRAMES) -> None:
    """Send notifications, one for each packet."""
    for packet in packets:
        bluez.call(peer.notify, uuid, packet)
