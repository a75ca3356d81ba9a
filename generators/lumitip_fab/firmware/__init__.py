"""The sketch folder: what every design shares, and two headers written for this one."""
