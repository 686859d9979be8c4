"""OpenEXR files of uncompressed rows, made by hand: https://openexr.com/en/latest/OpenEXRFileLayout.html."""

import struct
from collections.abc import Sequence

import numpy as np

_TYPES = {0: "<u4", 1: "<f2", 2: "<f4"}
"""What a channel's samples are, by the format's number."""


def exr(
    channels: Sequence[tuple[str, int, np.ndarray]], *, corner: tuple[int, int] = (0, 0)
) -> bytes:
    """Of (name, type, samples): rows of channels in the order of their names."""
    channels = sorted(channels, key=lambda channel: channel[0])
    height, width = channels[0][2].shape
    listed = b"".join(
        f"{name}\0".encode() + struct.pack("<4i", kind, 0, 1, 1) for name, kind, _ in channels
    )
    window = struct.pack("<4i", *corner, corner[0] + width - 1, corner[1] + height - 1)
    head = struct.pack("<2i", 20000630, 2) + b"".join(
        _attribute(*parts)
        for parts in (
            ("channels", "chlist", listed + b"\0"),
            ("compression", "compression", b"\0"),
            ("dataWindow", "box2i", window),
            ("displayWindow", "box2i", struct.pack("<4i", 0, 0, width + 7, height + 7)),
            ("lineOrder", "lineOrder", b"\0"),
            ("pixelAspectRatio", "float", struct.pack("<f", 1)),
            ("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0)),
            ("screenWindowWidth", "float", struct.pack("<f", 1)),
        )
    )  # fmt: skip
    rows = [
        b"".join(a[y].astype(_TYPES[kind]).tobytes() for _, kind, a in channels)
        for y in range(height)
    ]
    start = len(head) + 1 + 8 * height
    offsets = [start + y * (8 + len(rows[0])) for y in range(height)]
    blocks = [struct.pack("<2i", corner[1] + y, len(row)) + row for y, row in enumerate(rows)]
    return head + b"\0" + struct.pack(f"<{height}Q", *offsets) + b"".join(blocks)


def _attribute(name: str, kind: str, value: bytes) -> bytes:
    return f"{name}\0{kind}\0".encode() + struct.pack("<i", len(value)) + value
