"""Figures of matplotlib as SVG and PNG, the same bytes for the same figure."""

import io
from typing import Any

_DOTS_PER_INCH = 150
KINDS = ("svg", "png")


def pictures(figure: Any, name: str) -> dict[str, bytes]:
    """`NAME.svg` and `NAME.png` of a figure."""
    from matplotlib import rc_context

    files = {}
    metadata = {"svg": {"Date": None}, "png": {"Software": None}}
    with rc_context({"svg.hashsalt": name, "svg.fonttype": "none"}):
        for kind in KINDS:
            data = io.BytesIO()
            figure.savefig(data, format=kind, metadata=metadata[kind], dpi=_DOTS_PER_INCH)
            files[f"{name}.{kind}"] = data.getvalue()
    return files
