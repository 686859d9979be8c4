"""Gram matrices in the cache folder: found whole, or found in part and completed.

A kept matrix knows its materials by their checksums. So when a library has grown, by whatever way, the largest kept matrix
all of whose materials are in it is completed by the new ones.
"""

from dataclasses import fields
from pathlib import Path

import numpy as np

from ..library import Streamed
from ..tasks import HERE, Work
from .gram import Gram

_KEY = "gram-2-"


def kept_gram(library: Streamed, *, work: Work = HERE) -> Gram:
    """The Gram matrices of ``library``, from the cache folder as far as it has them; kept there."""

    def compute() -> dict[str, np.ndarray]:
        start = _largest_part(library, work.cache) if work.cache is not None else None
        gram = start.extended(library, work=work) if start else Gram.of(library, work=work)
        return {field.name: np.asarray(getattr(gram, field.name)) for field in fields(Gram)}

    return _to_gram(work.cached(f"{_KEY}{library.checksum}", compute))


def _largest_part(library: Streamed, cache: Path) -> Gram | None:
    ours = set(library.material_checksums)
    n_most, largest = 0, None
    for path in cache.glob(f"{_KEY}*.npz"):
        theirs = _materials(path)
        if len(theirs) > n_most and ours.issuperset(theirs):
            n_most, largest = len(theirs), path
    if largest is None:
        return None
    try:
        with largest.open("rb") as file, np.load(file, allow_pickle=False) as archive:
            return _to_gram(dict(archive))
    except Exception:  # its products are damaged, or it was just forgotten
        return None


def _materials(path: Path) -> list[str]:
    """Of a kept matrix; a file that is damaged, or just gone, has none."""
    try:
        with path.open("rb") as file, np.load(file, allow_pickle=False) as archive:
            return archive["materials"].tolist()
    except Exception:
        return []


def _to_gram(arrays: dict[str, np.ndarray]) -> Gram:
    materials, origin = tuple(arrays["materials"].tolist()), int(arrays["origin"])
    return Gram(materials, origin, *(arrays[f] for f in ("products", "squared_norms", "n_cells")))
