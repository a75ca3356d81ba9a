"""`records`: what an MCAP file holds, in order, also of a damaged one."""

import io
import struct
from collections.abc import Callable, Iterator
from typing import BinaryIO, NamedTuple

import zstandard
from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Channel, Chunk, McapRecord, Message, Metadata, Schema
from mcap.stream_reader import breakup_chunk

_MAGIC = b"\x89MCAP0\r\n"
_HEAD = struct.Struct("<BQ")
"""Of each record: opcode and length of its content."""
_MOST_BYTES = 64 * 2**20  # of one record: far above those of `Writer`
_PRIVATE = 0x80
"""Opcodes from here on are free for anyone."""
_ZSTD = b"\x04\x00\x00\x00zstd"
"""Name of the compression in a chunk, with its length."""
_BEFORE_ZSTD = _HEAD.size + 3 * 8 + 4
"""Bytes of a chunk before it."""
_BLOCK_BYTES = 2**20
# Exceptions of the libraries for damaged bytes (MemoryError for a wrong length), and OSError of a
# failed or removed disk.
_FAULTS = (
    McapError,
    ValueError,
    struct.error,
    zstandard.ZstdError,
    RuntimeError,
    EOFError,
    OverflowError,
    MemoryError,
    KeyError,
    IndexError,
    TypeError,
    OSError,
)


class Fault(NamedTuple):
    """Damage of a file."""

    why: str
    ends: bool
    """Whether nothing after it can be read."""


def records(stream: BinaryIO) -> Iterator[McapRecord | Fault]:
    """Metadata, schemas, channels and messages of a file, those within chunks included. Never
    raises for damage: reading goes on at the next chunk."""
    at = len(_MAGIC)
    try:
        size = stream.seek(0, io.SEEK_END)
        stream.seek(0)
        if stream.read(len(_MAGIC)) != _MAGIC:
            yield Fault("not the bytes that begin an MCAP file", ends=True)
            return
    except OSError as error:
        yield Fault(f"it cannot be read ({_text(error)})", ends=True)
        return
    while True:
        try:
            opcode, end, content = _record(stream, at, size)
            yield from _parsed(opcode, content)
        except _FAULTS as error:
            following = _next_chunk(stream, at + 1, size)
            if following is None:
                yield Fault(f"it ends near byte {at} ({_text(error)})", ends=True)
                return
            why = f"bytes {at} to {following} cannot be read ({_text(error)})"
            yield Fault(why, ends=False)
            at = following
            continue
        if opcode == Opcode.FOOTER:
            return
        at = end


def _record(stream: BinaryIO, at: int, size: int) -> tuple[int, int, bytes]:
    """Opcode, end and content of the record that begins at a byte; the content of those that
    nobody needs is skipped."""
    stream.seek(at)
    opcode, length = _HEAD.unpack(stream.read(_HEAD.size))
    if opcode not in set(Opcode) and opcode < _PRIVATE:
        raise ValueError(f"no record has the number {opcode}")
    end = at + _HEAD.size + length
    if end > size:
        raise EOFError
    if opcode not in _READ:
        return opcode, end, b""
    if length > _MOST_BYTES:
        raise ValueError(f"{length} bytes")
    return opcode, end, stream.read(length)


_READ: dict[int, Callable[[ReadDataStream, int], McapRecord]] = {
    Opcode.METADATA: lambda source, _: Metadata.read(source),
    Opcode.SCHEMA: lambda source, _: Schema.read(source),
    Opcode.CHANNEL: lambda source, _: Channel.read(source),
    Opcode.MESSAGE: Message.read,
    Opcode.CHUNK: lambda source, _: Chunk.read(source),
}


def _parsed(opcode: int, content: bytes) -> list[McapRecord]:
    """A record, or those in a chunk."""
    if opcode not in _READ:
        return []
    source = ReadDataStream(io.BytesIO(content))
    record = _READ[opcode](source, len(content))
    if not isinstance(record, Chunk):
        return [record]
    if source.count != len(content):  # its length is wrong, and others may lie in what follows
        raise ValueError(f"a chunk of {source.count} bytes claims {len(content)}")
    return _opened(record)


def _opened(chunk: Chunk) -> list[McapRecord]:
    size = chunk.uncompressed_size
    if chunk.compression == "zstd":
        size = max(size, zstandard.frame_content_size(chunk.data))
    if size > _MOST_BYTES:
        raise ValueError(f"{size} bytes")
    return breakup_chunk(chunk, validate_crc=True)


def _next_chunk(stream: BinaryIO, start: int, size: int) -> int | None:
    """Where the next chunk begins, by the name of its compression and its length; `None` without
    one. An accidental find is only more damage, since a chunk has a check sum."""
    overlap = _BEFORE_ZSTD + len(_ZSTD)
    try:
        for block_at in range(start, size, _BLOCK_BYTES):
            stream.seek(block_at)
            block = stream.read(_BLOCK_BYTES + overlap)
            found = -1
            while (found := block.find(_ZSTD, found + 1)) >= 0:
                head = found - _BEFORE_ZSTD
                if 0 <= head < _BLOCK_BYTES and block[head] == Opcode.CHUNK:
                    _, length = _HEAD.unpack_from(block, head)
                    if block_at + head + _HEAD.size + length <= size:
                        return block_at + head
    except OSError:
        return None
    return None


def _text(error: BaseException) -> str:
    if isinstance(error, struct.error | EOFError):
        return "the bytes of a record are missing"
    return f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
