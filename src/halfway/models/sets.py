"""Sets of models that need no file: published fits, and synthetic materials of any number.

merl-abc, merl-sgd         the 100 MERL materials, as published fits
anisotropic                some forty brushed metals, plastics and cloths, as models
synthetic-N, synthetic-N-S N synthetic materials, of seed 0 or S
"""

import re
from functools import cache

from ..errors import LibraryError
from ..origin import Origin
from .brushed import anisotropic
from .published import PUBLISHED, ModelSet, published
from .synthetic import synthetic

BUILTIN = (*PUBLISHED, "anisotropic", "synthetic-N")
"""What there is; N is a number of materials."""
MOST_SYNTHETIC = 100_000


@cache  # 100 small models a published set; a synthetic one is 1 KB a material, and a process asks for few
def builtin(name: str) -> ModelSet:
    """The set of models of this name, one of `BUILTIN`.

    Raises
    ------
    LibraryError
        When there is no such set.
    """
    if name in PUBLISHED:
        return published(name)
    if name == "anisotropic":
        return anisotropic()
    numbers = re.fullmatch(r"synthetic-(\d{1,9})(?:-(\d{1,9}))?", name)
    if numbers is None:
        raise LibraryError(
            f"builtin:{name} is not in this package: choose one of {', '.join(BUILTIN)} "
            "(such as synthetic-2000, or synthetic-2000-7 for seed 7)."
        )
    n, seed = int(numbers[1]), int(numbers[2] or 0)
    if not 1 <= n <= MOST_SYNTHETIC:
        raise LibraryError(f"builtin:{name} has {n:,} materials: expected 1 to {MOST_SYNTHETIC:,}.")
    return ModelSet(
        name,
        Origin(
            f"{n:,} synthetic materials (parametric families, seed {seed}), not measurements",
            "made by halfway; the formula is in its module models/synthetic.py",
            "CC0-1.0",
        ),
        synthetic(n, seed),
    )
