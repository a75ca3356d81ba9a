"""One fingertip for several programs: `FingertipServer`, the server of `tcp://` links.

Clients count the frames that a server drops for them as lost on the link. Nothing is encrypted.

with FingertipServer("serial:///dev/ttyACM0", layout) as server:
    print(server.address)
    server.wait()
"""

from lumitip.sharing.client import ClientCounts
from lumitip.sharing.server import FingertipServer

__all__ = ["ClientCounts", "FingertipServer"]
