"""A picture of each of many materials, as files in one folder that a later run may finish: a `halfway.batch.Batch`."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ..batch import Batch, Checksum, Written
from ..errors import RenderError
from ..tasks import HERE, Work
from . import pictures
from .renderer import Renderer


class Frame(NamedTuple):
    """One picture of several."""

    name: str
    """Of its file in a folder; the suffix says how it is written."""
    of: Any
    """What it shows, as JSON."""
    picture: Callable[[], np.ndarray]
    """Linear RGB radiance, shape (height, width, 3)."""
    label: str = ""
    """What stands under it beside others."""


def write_frames(
    folder: Path,
    renderer: Renderer,
    frames: Sequence[Frame],
    *,
    exposure: float = 0.0,
    work: Work = HERE,
) -> Written:
    """Write a file for each frame; a picture that an earlier run made of the same is kept.

    Raises
    ------
    RenderError
        When two frames have the same name.
    OutputError
        When the folder cannot be written or has no room, another run works in it, or a file in it is in the way.
    """
    by_name = {frame.name: frame for frame in frames}
    if len(by_name) < len(frames):
        raise RenderError(
            f"{len(frames)} pictures have {len(by_name)} names: expected a name for each."
        )
    made = {
        "by": "render",
        "scene": renderer.scene.name,
        "size": list(renderer.size),
        "samples": renderer.spp,
        "exposure": exposure,
        "fingerprint": renderer.fingerprint(),
    }
    width, height = renderer.size
    outputs = {frame.name: frame.of for frame in frames}
    opened = Batch.open(folder, outputs, made=made, n_bytes=12 * width * height, work=work)
    with opened as batch:
        for name in work.track(batch.missing, "Pictures", len(batch.missing)):
            pictures.write(folder / name, by_name[name].picture(), exposure=exposure)
            batch.add(name, Checksum.of(folder / name))
        return Written(len(batch.missing), batch.n_kept)
