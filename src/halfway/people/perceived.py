"""How people perceive a material: the fourteen attributes of Serrano et al. 2016, by their published networks.

They had 400 materials rated, MERL's 100 and edits of them, and trained a network of radial basis functions for each attribute:

    m  = ln((f c + .001) / (median c f + .001))     c = cos_i cos_o in [.01, 1], the mapping of Nielsen et al. 2015
    u  = coordinates of m on the first five principal components of the colour channels of MERL's materials, of which each
         channel is a sample; U of the singular value decomposition, whose columns have norm 1
    x  = L*/100 of each component's three channels, as CIELAB has it of linear sRGB, with its straight foot below 0

and the networks read x. Components need MERL's materials, or stand-ins of them: those of a library that has them all, else the published fits that
come with the package. The sign of each is that of the projection of gold-metallic-paint which was published with the networks.

A. Serrano, D. Gutierrez, K. Myszkowski, H.-P. Seidel, B. Masia, "An intuitive control space for material appearance", ACM
Transactions on Graphics 35(6), 2016. The numbers are under the licence beside them.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache, lru_cache, partial
from typing import NamedTuple

import numpy as np
from jaxtyping import Float64

from .._types import Directions
from ..brdf import Brdf, TabularBrdf, quadrature
from ..colour import LUMINANCE, response
from ..halfdiff import Corners, Grid, from_half_diff
from ..library import Library
from ..models import builtin
from ..tasks import HERE, Work
from .networks import networks
from .quality import Read, Reading, with_qualities

N_PAIRS = 8192
"""Of directions, spread evenly over the cells of a MERL table; those above the horizon count."""
N_COMPONENTS = 5
EPSILON = 1e-3
LEAST_COSINES = 0.01
ANCHOR = "gold-metallic-paint"
ANCHOR_SCORES = np.array(
    [
        [0.02397078, -0.05367952, -0.11060172, 0.13308536, -0.07299291],
        [0.02499191, -0.0268448, -0.10956725, 0.12815318, -0.07793653],
        [0.03239528, 0.03495008, -0.09181931, 0.07772902, -0.06962217],
    ]
)
"""The published projection of gold-metallic-paint, by channel and component."""
STAND_INS = "merl-abc"
FULL_SET = 100
"""Materials of MERL; a library of fewer has no components of its own to read by."""

EXPLAINED: Mapping[str, float] = {
    "plastic": 0.61,
    "rubber": 0.98,
    "metallic": 0.97,
    "fabric": 0.90,
    "ceramic": 0.71,
    "soft": 0.96,
    "hard": 0.99,
    "matte": 0.98,
    "glossy": 0.99,
    "bright": 0.96,
    "rough": 0.99,
    "reflection_strength": 0.99,
    "reflection_sharpness": 0.99,
    "reflection_tint": 0.85,
}
"""R^2 of the linear fit of each network to the five numbers of MERL's materials (neural fits): a network that bends more
than they tell rests on its few centres. Measured by ``docs/control.py``."""
HIGH, FAIR = 0.95, 0.88
MARGIN = 0.1
"""Of the range of MERL's materials, as far as which others are taken for rated ones: the edits went beyond them."""
Scores = Float64[np.ndarray, "*k 3 n_components"]
Values = Float64[np.ndarray, "*k 3 n_pairs"]


class Perceived(NamedTuple):
    """How a material is perceived in one respect."""

    value: float
    """About 0, not at all, to 1, very."""
    trust: str
    """How far to trust it, "high", "fair" or "low", by how well a straight line through the five numbers explains the attribute on MERL's materials
    (`EXPLAINED`), and low for what lies beyond those, which people rated, in any of the numbers."""


@dataclass(frozen=True, eq=False)
class Perception:
    """What takes a BRDF to the numbers that the networks read."""

    median: Float64[np.ndarray, " n_pairs"]
    """Of f c over the materials and channels, at each pair of directions."""
    mean: Float64[np.ndarray, " n_pairs"]
    """Of m."""
    axes: Float64[np.ndarray, "n_pairs n_components"]
    """What m - mean is multiplied by to give the scores."""
    rated: Float64[np.ndarray, "2 n_components"]
    """Least and most of the five numbers of MERL's materials."""

    @classmethod
    def of(cls, library: Library | None = None, *, work: Work = HERE) -> "Perception":
        """By the materials of a library that has MERL's, or by the package's stand-ins of them; kept in the cache."""
        own = library if library and _has_merl(library) else None
        key = own.checksum if own else STAND_INS
        compute = partial(_components, own, work) if own else _of_stand_ins
        arrays = work.cached(f"perception-1-{key}", compute)
        return cls(**arrays)

    def scores(self, values: Values) -> Scores:
        """The coordinates of materials whose `samples` are given; what is not measured counts as the mean does."""
        mapped = np.log((values + EPSILON) / (self.median + EPSILON)) - self.mean
        return np.nan_to_num(mapped) @ self.axes

    def read(self, readings: Read, brdf: Brdf) -> Reading:
        """The readings of instruments of a material, and after them those of `halfway.people.QUALITIES`."""
        return with_qualities(readings, _values(lightness(self.scores(samples(brdf)))))

    def perceived(self, brdf: Brdf) -> dict[str, Perceived]:
        """How people would perceive a material, by the name of the attribute."""
        x = lightness(self.scores(samples(brdf)))
        margin = MARGIN * np.ptp(self.rated, axis=0)
        was_rated = bool(((x >= self.rated[0] - margin) & (x <= self.rated[1] + margin)).all())
        return {
            name: Perceived(value, _trust(name, was_rated))
            for name, value in zip(networks(), _values(x).tolist(), strict=True)
        }


def read_library(readings: Read, library: Library, *, work: Work = HERE) -> Reading:
    """The readings of instruments of all materials of a library, and after them those of `halfway.people.QUALITIES`."""
    return with_qualities(readings, _values(lightness(library_scores(library, work=work))))


def library_scores(
    library: Library, *, work: Work = HERE
) -> Float64[np.ndarray, "N 3 n_components"]:
    """The coordinates of all materials of a library, by `Perception.of` it; kept in the cache."""
    perception = Perception.of(library, work=work)

    def compute() -> dict[str, np.ndarray]:
        rows = work.run(partial(_row, library.material), library.names, label="Perception")
        return {"scores": perception.scores(np.stack(list(rows)))}

    return work.cached(f"perceived-1-{library.checksum}", compute)["scores"]


def samples(brdf: Brdf) -> Values:
    """Values f c of a material, or of its mean over turns, at the pairs of directions that perception looks at."""
    wi, wo = _pairs()
    cosines = np.maximum(wi[:, 2] * wo[:, 2], LEAST_COSINES)
    mean = brdf.turned_mean()
    if isinstance(mean, TabularBrdf):
        return _corners(mean.grid).blend(mean.values) * cosines
    return mean.eval(wi, wo).T * cosines


def lightness(scores: Scores) -> Float64[np.ndarray, "*k n_components"]:
    """L*/100 of each component, of which the three channels are a colour."""
    luminance = np.einsum("...cj,c->...j", scores, LUMINANCE)
    return (116 * response(luminance) - 16) / 100


def _values(x: Float64[np.ndarray, "*k n_components"]) -> Float64[np.ndarray, "*k n_networks"]:
    return np.stack([network.of(x) for network in networks().values()], axis=-1)


def _trust(name: str, was_rated: bool) -> str:
    if not was_rated or EXPLAINED[name] < FAIR:
        return "low"
    return "high" if EXPLAINED[name] >= HIGH else "fair"


@cache
def _pairs() -> tuple[Directions, Directions]:
    wi, wo = from_half_diff(quadrature.spread_angles(N_PAIRS))
    lit = (wi[:, 2] > 0) & (wo[:, 2] > 0)
    return wi[lit], wo[lit]


@lru_cache(maxsize=2)
def _corners(grid: Grid) -> Corners:
    """Where the pairs are on a grid; finding them takes four times as long as reading a table there."""
    return grid.multilinear(*_pairs())


def _has_merl(library: Library) -> bool:
    return len(set(library.names) & set(builtin(STAND_INS).models)) == FULL_SET


@cache
def _of_stand_ins() -> dict[str, np.ndarray]:
    """Seconds of work whose result is the package's own."""
    return _components(None, HERE)


def _components(library: Library | None, work: Work) -> dict[str, np.ndarray]:
    stand_ins = builtin(STAND_INS).models
    names = [name for name in (library.names if library else stand_ins) if name in stand_ins]
    of = library.material if library else stand_ins.__getitem__
    rows = np.stack(list(work.run(partial(_row, of), names, label="Perception")))
    values = rows.reshape(-1, rows.shape[-1])
    # Where nothing is measured, all are alike.
    values = np.where(np.isnan(values).all(axis=0), 0, values)
    median = np.nanmedian(values, axis=0)
    mapped = np.log((values + EPSILON) / (median + EPSILON))
    mean = np.nanmean(mapped, axis=0)
    u, s, v = np.linalg.svd(np.nan_to_num(mapped - mean), full_matrices=False)
    axes = v[:N_COMPONENTS].T / s[:N_COMPONENTS]
    scores = u[:, :N_COMPONENTS].reshape(len(names), 3, N_COMPONENTS)
    signs = np.sign((scores[names.index(ANCHOR)] * ANCHOR_SCORES).sum(axis=0))
    x = lightness(scores * signs)
    rated = np.stack([x.min(axis=0), x.max(axis=0)])
    return {"median": median, "mean": mean, "axes": axes * signs, "rated": rated}


def _row(of: Callable[[str], Brdf], name: str) -> Values:
    return samples(of(name))
