"""Judgement of a fingertip from its frames: cells without signal, noise, swapped wires."""
