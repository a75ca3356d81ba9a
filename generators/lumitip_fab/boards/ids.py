"""Identifiers that stay the same from build to build."""

import uuid

_NAMESPACE = uuid.UUID("408b861d-d571-5373-9831-97c1aafb6016")


def stable_uuid(*parts: str) -> str:
    """The UUID of a thing by its name, such as `stable_uuid("receiver", "symbol", "U1")`."""
    return str(uuid.uuid5(_NAMESPACE, "/".join(parts)))
