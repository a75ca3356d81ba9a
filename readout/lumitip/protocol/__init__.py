"""Packets and status of a fingertip, and packets on a serial line.

Needs only numpy. Received bytes raise `PacketError` or `CobsError`, and nothing else.
"""
