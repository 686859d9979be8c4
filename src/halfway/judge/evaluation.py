"""How well a space moves between materials.

For each of a set of pairs of materials, on the way from one to the other in `N_STEPS` materials:

    detour          length of the path / distance of its ends, mean CIELAB difference on the basis images; 1 is straight
    jump            largest step / mean step, per pace; 1 is even: in mean CIEDE2000 on the basis images, where the
                    perceptual pace is made, in mean CIELAB difference there ("cielab_jump"), and in mean CIEDE2000 in a
                    scene that no pace knows ("judged_jump")
    hue_excursion   how far the body colour strays, in the (a*, b*) plane of CIELAB, from where plain mixing of the two
                    ends' body colours would take it; 0 is on the way
    realism         difference between the mix at t = 1/2 and the nearest measured material: in the log metric, by solid
                    angle ("log") and by cell of the grid ("log by cell"), and mean CIELAB in the judging scene ("seen")
    others          share of weight, at t = 1/2, on materials other than the two ends

Coherence alone is no achievement: plain linear interpolation has detour 1 and passes through few real materials. Look
at detour and realism together.

Pictures are those of `halfway.look.Looks`, table metrics those of `halfway.look.CellSamples`.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Float, Float32, Float64, Int

from ..colour import to_lab
from ..library import Library
from ..look import (
    JUDGING_SCENE,
    PACING_SCENE,
    CellSamples,
    Looks,
    SphereOperator,
    appearance,
    ciede2000_difference,
    cielab_difference,
    shown,
)
from ..recipes import Blend, Mixer, Recipe
from ..space import Route, Space, perceptual
from ..tasks import HERE, Work

N_STEPS = 41
"""Materials on the way of each pair, both ends included."""
LEAST_DISTANCE = 3.0
"""Pairs whose ends look nearer than this (mean CIELAB difference) are left out of a summary's detours: a ratio to nothing."""

REALISM = ("log", "log by cell", "seen")

Pairs = Int[np.ndarray, "n_pairs 2"]
Pace = Callable[[Route], Route]
"""The same way with other spacing."""


def uniform(route: Route) -> Route:
    """The route as it is: evenly spaced t, the paper's way."""
    return route


def sample_pairs(n_materials: int, n_pairs: int | None = None, *, seed: int = 0) -> Pairs:
    """``n_pairs`` different pairs of materials, the same for the same seed; all of them for None."""
    pairs = np.stack(np.triu_indices(n_materials, 1), axis=1)
    if n_pairs is None or n_pairs >= len(pairs):
        return pairs
    drawn = np.random.default_rng(seed).choice(len(pairs), n_pairs, replace=False)
    return pairs[np.sort(drawn)]


@dataclass(frozen=True, eq=False)
class Bench:
    """What spaces of one library are measured with."""

    pacing: Looks
    judging: Looks
    """Of another scene; used for nothing but judging."""
    samples: CellSamples
    library: Library

    @classmethod
    def fit(cls, library: Library, *, work: Work = HERE) -> "Bench":
        """The bench of ``library``; kept in the cache for the next time."""
        return cls(
            Looks.fit(library, PACING_SCENE, work=work),
            Looks.fit(library, JUDGING_SCENE, work=work),
            CellSamples.fit(library, work=work),
            library,
        )

    def seen(self, weights: Float64[np.ndarray, "3 n N"], blend: Blend) -> "Seen":
        """What mixes of full tables are judged by."""
        if blend is Blend.LINEAR:
            return Seen(self.samples.mix(weights), self.judging.mix(weights, blend))
        recipes = (
            Recipe.from_dense("", self.samples.names, each, blend)
            for each in weights.swapaxes(0, 1)
        )
        rows = [self._mixer.mix(recipe).values.reshape(3, -1) for recipe in recipes]
        values = np.stack([row[:, self.samples.cells] for row in rows], axis=1)
        return Seen(values, np.stack([self._operator.picture(row) for row in rows]))

    def body_colour(
        self, weights: Float64[np.ndarray, "3 n N"], blend: Blend
    ) -> Float64[np.ndarray, "n 3"]:
        """Body colours of mixes, 1/sr; those that are not linear from small tables."""
        if blend is Blend.LINEAR:
            return self.samples.body_colour(weights)
        return self.pacing.tables.body_colour(weights, blend)

    @cached_property
    def _mixer(self) -> Mixer:
        return Mixer(self.library)

    @cached_property
    def _operator(self) -> SphereOperator:
        return SphereOperator.of(self.judging.scene, self.library.grid)


class Seen(NamedTuple):
    """What mixes are judged by."""

    values: Float32[np.ndarray, "3 n n_cells"]
    """On the cells of `CellSamples`, 1/sr."""
    pictures: Float32[np.ndarray, "n n_pixels 3"]
    """Of the judging scene, linear RGB."""


@dataclass(frozen=True, eq=False)
class Evaluation:
    """One space on a set of pairs; each array has one value per pair."""

    space: str
    pairs: Pairs
    distance: Float64[np.ndarray, " n_pairs"]
    """Of the ends: mean CIELAB difference on the basis images."""
    detour: Float64[np.ndarray, " n_pairs"]
    jump: Mapping[str, Float64[np.ndarray, " n_pairs"]]
    """By pace."""
    cielab_jump: Mapping[str, Float64[np.ndarray, " n_pairs"]]
    judged_jump: Mapping[str, Float64[np.ndarray, " n_pairs"]]
    hue_excursion: Float64[np.ndarray, " n_pairs"]
    realism: Mapping[str, Float64[np.ndarray, " n_pairs"]]
    """By the ways of `REALISM`; small is real."""
    others: Float64[np.ndarray, " n_pairs"]

    def to_json(self) -> dict[str, Any]:
        """Median, 90th percentile and maximum of each measure; ratios over pairs that are `LEAST_DISTANCE` apart."""
        apart = self.distance >= LEAST_DISTANCE
        return {
            "space": self.space,
            "n_pairs": len(self.pairs),
            "n_pairs_apart": int(apart.sum()),
            "detour": _spread(self.detour[apart]),
            "jump": {pace: _spread(jump[apart]) for pace, jump in self.jump.items()},
            "cielab_jump": {pace: _spread(jump[apart]) for pace, jump in self.cielab_jump.items()},
            "judged_jump": {pace: _spread(jump[apart]) for pace, jump in self.judged_jump.items()},
            "hue_excursion": _spread(self.hue_excursion),
            "realism": {way: _spread(realism) for way, realism in self.realism.items()},
            "others": _spread(self.others),
        }


def evaluate(
    space: Space,
    bench: Bench,
    pairs: Pairs,
    *,
    paces: Mapping[str, Pace] | None = None,
    work: Work = HERE,
) -> Evaluation:
    """The measures of ``space`` on ``pairs``, with jumps at the uniform and the perceptual pace or at those given."""
    if paces is None:
        paces = {"uniform": uniform, "perceptual": partial(perceptual, images=bench.pacing)}
    measure = partial(_measure, space, bench, _Measured.of(bench), tuple(paces.values()))
    rows = list(work.run(measure, list(pairs), label=f"Evaluating {space.name}"))
    distance, detour, jumps, hue_excursion, realism, others = map(np.array, zip(*rows, strict=True))
    jump, cielab_jump, judged_jump = (
        dict(zip(paces, each, strict=True)) for each in jumps.transpose(2, 1, 0)
    )
    return Evaluation(
        space.name,
        pairs,
        distance,
        detour,
        jump,
        cielab_jump,
        judged_jump,
        hue_excursion,
        dict(zip(REALISM, realism.T, strict=True)),
        others,
    )


class _Row(NamedTuple):
    distance: float
    detour: float
    jumps: list[list[float]]
    """By pace: jump, cielab_jump, judged_jump."""
    hue_excursion: float
    realism: list[float]
    others: float


class _Measured(NamedTuple):
    """The measured materials as `REALISM` sees them."""

    by_solid_angle: Float32[np.ndarray, "N n_features"]
    by_cell: Float32[np.ndarray, "N n_features"]
    seen: Float32[np.ndarray, "N n_pixels 3"]

    @classmethod
    def of(cls, bench: Bench) -> "_Measured":
        alone = np.broadcast_to(
            np.eye(len(bench.samples.names)), (3, *[len(bench.samples.names)] * 2)
        )
        return cls(*_looks(bench, alone, Blend.LINEAR))  # alone in every blend

    def nearest(
        self, bench: Bench, weights: Float64[np.ndarray, "3 1 N"], blend: Blend
    ) -> list[float]:
        """The difference of a recipe from the nearest of the materials, each way."""
        by_solid_angle, by_cell, seen = _looks(bench, weights, blend)
        return [
            _nearest(self.by_solid_angle, by_solid_angle[0]),
            _nearest(self.by_cell, by_cell[0]),
            float(np.min(cielab_difference(self.seen, seen))),
        ]


def _nearest(
    features: Float32[np.ndarray, "N n_features"], own: Float32[np.ndarray, " n_features"]
) -> float:
    # Which is nearest follows from products; its distance does not lose digits in their difference.
    squares = np.einsum("nf,nf->n", features, features)
    return float(np.linalg.norm(features[(squares - 2 * (features @ own)).argmin()] - own))


def _looks(
    bench: Bench, weights: Float64[np.ndarray, "3 n N"], blend: Blend
) -> tuple[
    Float32[np.ndarray, "n n_features"],
    Float32[np.ndarray, "n n_features"],
    Float32[np.ndarray, "n n_pixels 3"],
]:
    seen = bench.seen(weights, blend)
    return (
        bench.samples.features(seen.values),
        bench.samples.features(seen.values, by="cell"),
        appearance(seen.pictures),
    )


def _measure(
    space: Space,
    bench: Bench,
    measured: _Measured,
    paces: Sequence[Pace],
    pair: Int[np.ndarray, " 2"],
) -> _Row:
    route = Route.through(space, [space.names[i] for i in pair])
    evenly, middle = route.at(np.linspace(0, 1, N_STEPS)), route.at(np.array([0.5]))
    pictures = appearance(bench.pacing.mix(evenly, route.blend))
    distance = float(cielab_difference(pictures[0], pictures[-1]))
    length = float(cielab_difference(pictures[1:], pictures[:-1]).sum())
    return _Row(
        distance,
        length / distance if distance else np.nan,
        [_jumps(bench, pace(route)) for pace in paces],
        _hue_excursion(bench.body_colour(evenly, route.blend)),
        measured.nearest(bench, middle, route.blend),
        1.0 - float(middle[:, 0, pair].sum()) / 3,
    )


def _jumps(bench: Bench, route: Route) -> list[float]:
    weights = route.at(np.linspace(0, 1, N_STEPS))
    seen, judge = (
        appearance(images.mix(weights, route.blend)) for images in (bench.pacing, bench.judging)
    )
    return [
        _jump(ciede2000_difference(seen[1:], seen[:-1])),
        _jump(cielab_difference(seen[1:], seen[:-1])),
        _jump(ciede2000_difference(judge[1:], judge[:-1])),
    ]


def _jump(steps: Float[np.ndarray | np.floating, "..."]) -> float:
    mean = float(steps.mean())
    return float(steps.max()) / mean if mean else np.nan


def _hue_excursion(body: Float64[np.ndarray, "n_steps 3"]) -> float:
    """The largest distance in (a*, b*) from the curve of the ends' linear mixes; a white matte body is white."""
    t = np.linspace(0, 1, 201)[:, None]
    plain = (1 - t) * body[0] + t * body[-1]
    colours, way = (to_lab(shown(np.pi * x))[:, 1:] for x in (body, plain))
    return float(_distance_to_polyline(colours, way).max())


def _distance_to_polyline(
    points: Float64[np.ndarray, "n 2"], line: Float64[np.ndarray, "m 2"]
) -> Float64[np.ndarray, " n"]:
    start, along = line[:-1], np.diff(line, axis=0)
    from_start = points[:, None] - start
    square = np.maximum((along**2).sum(axis=-1), np.finfo(np.float64).tiny)
    share = np.clip((from_start * along).sum(axis=-1) / square, 0, 1)
    return np.linalg.norm(from_start - share[..., None] * along, axis=-1).min(axis=1)


def _spread(values: Float64[np.ndarray, " n"]) -> dict[str, float]:
    if not len(values):
        return {}
    median, high = np.nanquantile(values, [0.5, 0.9])
    return {
        "median": float(median),
        "90th percentile": float(high),
        "max": float(np.nanmax(values)),
    }
