"""The boards: outlines, parts, devices and their circuits."""
