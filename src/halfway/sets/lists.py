"""Sets that others published as lists of pairs.

    specular-red-phenolic violet-acrylic 0.421037

is .421037 of the first and the rest of the second, mixed as tables. So M3ashy's data are listed (Hu et al., "M3ashy: Multi-Modal
Material Synthesis via Hyperdiffusion", AAAI 2026): lists of a hundred pairs of the MERL database, each in all orders of its channels.
"""

from collections.abc import Iterable
from pathlib import Path

import numpy as np
from jaxtyping import Float64

from ..errors import FormatError
from ..library import Library, Permuted
from ..look import Looks
from ..recipes import Blend
from ..tasks import HERE, Work
from .candidates import THINNING, Weighed, candidates, materials
from .diversity import Diversity
from .sets import SampleSet

ALL = "all"
"""The one split: pairs share their parents."""


def listed(
    library: Library, path: Path, *, permute_channels: bool = False, work: Work = HERE
) -> SampleSet:
    """The set that a list of pairs stands for; with its channels permuted, each pair in all six orders.

    Raises
    ------
    FormatError
        When a line is no pair with a weight.
    LibraryError
        When the library has no material of a name.
    """
    orders = Permuted.ORDERS if permute_channels else Permuted.ORDERS[:1]
    pairs = list(_pairs(library, path, _lines(path)))
    weighed = [Weighed(weights, order) for weights in pairs for order in orders]
    looks = Looks.fit(library, work=work).thinned(THINNING)
    alone = materials(looks, work=work)
    chosen = list(candidates(looks, Blend.LINEAR, weighed, work=work))
    return SampleSet.of(
        library,
        Blend.LINEAR,
        {ALL: chosen},
        {ALL: [name for i, name in enumerate(library.names) if any(w[0, i] for w in pairs)]},
        how={"by": "halfway sample", "list": path.name, "permute_channels": permute_channels},
        diversity=Diversity.of(chosen, alone, work=work),
    )


def _lines(path: Path) -> list[str]:
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except UnicodeDecodeError:
        lines = []
    if not any(line.strip() for line in lines):
        raise FormatError(f"{path} is no list: expected lines such as `teflon chrome 0.42`.")
    return lines


def _pairs(
    library: Library, path: Path, lines: Iterable[str]
) -> Iterable[Float64[np.ndarray, "3 N"]]:
    for number, line in enumerate(lines, 1):
        if not line.strip():
            continue
        try:
            first, second, share = line.split()
            weight = float(share)
        except ValueError:
            weight, first, second = np.nan, "", ""
        if not 0 <= weight <= 1:
            raise FormatError(
                f"line {number} of {path}, {line!r}, is no pair of materials with the first one's weight: "
                "expected such as `teflon chrome 0.42`."
            )
        weights = np.zeros(len(library))
        weights[library.index(first)] += weight
        weights[library.index(second)] += 1 - weight
        yield np.broadcast_to(weights, (3, len(library)))
