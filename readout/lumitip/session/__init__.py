"""One open fingertip: what arrives, in order and on time, to all who read it."""
