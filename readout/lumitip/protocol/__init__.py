"""What travels between a fingertip and a computer: packets, their frame on a serial line, status.

Numpy and the standard library alone. Bytes from outside raise `PacketError` or `CobsError` and
nothing else.
"""
