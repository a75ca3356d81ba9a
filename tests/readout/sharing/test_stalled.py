"""A client that reads nothing while the server goes on."""

import socket
import time

from lumitip import LinkEvent
from lumitip.links.base import Arrival, Fault
from lumitip.protocol.messages import Kind, MessageDecoder, encode_request

BUFFER = 8
FAULTS = 400
WHY = "the checksum is wrong; " * 100  # so that sockets hold few of them


def test_faults_that_wait_for_a_stalled_client_are_bounded(serve, until, link) -> None:
    server = serve("ble://Published", buffer=BUFFER)
    host, port = server.address.removeprefix("tcp://").split(":")
    with socket.socket() as client:
        client.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        client.settimeout(30.0)
        client.connect((host, int(port)))
        client.sendall(encode_request(None))
        until(lambda: len(server.clients) == 1)
        for _ in range(FAULTS):
            link.deliver(Arrival(time.monotonic(), Fault("crc", 1, WHY)))
        link.report(LinkEvent("lost", "gone"))
        dropped = server.clients[0].dropped
        assert dropped > FAULTS / 2
        decoder, kinds = MessageDecoder(), []
        while Kind.EVENT not in kinds:
            kinds += [kind for kind, _ in decoder.feed(client.recv(1 << 16))]
        assert kinds.count(Kind.FAULT) == FAULTS - dropped
        until(lambda: server.clients[0].sent == FAULTS - dropped)
