"""How near a blend comes to the material halfway, where that is known.

A ladder is a family of materials whose highlights widen from rung to rung by one factor, everything else the same or going
straight. The material halfway between two rungs is the rung in the middle; a blend is given the two alone, half and half.

    conductor, plastic   GGX, alpha from .03 to .6                        `halfway.fit.OpenPbr`
    ABC                  the same widths by 1 / sqrt(B), equal energy     `halfway.models.AbcModel`
    OpenPBR              a plastic of which colour and index change too

Widths are as perception has them: equal factors, not equal steps. The test is that of N. Bonneel et al., "Displacement
Interpolation Using Lagrangian Mass Transport", SIGGRAPH Asia 2011, for tables of BRDFs.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float64

from ..brdf import Brdf, TabularBrdf, difference
from ..colour import Lab
from ..fit import OpenPbr
from ..halfdiff import MERL, Grid
from ..library import Library, ProceduralLibrary
from ..look import JUDGING_SCENE, SphereOperator, appearance, cielab_difference
from ..models import AbcModel
from ..recipes import Blend, Mixer, Recipe

N_RUNGS = 7
ALPHAS = np.geomspace(0.03, 0.6, N_RUNGS)
"""Widths of GGX."""


def ladders(grid: Grid = MERL) -> list[Library]:
    """The ladders, each a library whose materials are its rungs."""
    return [
        _ladder("conductor", [_conductor(alpha) for alpha in ALPHAS], grid),
        _ladder("plastic", [_plastic(alpha) for alpha in ALPHAS], grid),
        _ladder("ABC", [_abc(alpha) for alpha in ALPHAS], grid),
        _ladder("OpenPBR", [_changing(i / (N_RUNGS - 1)) for i in range(N_RUNGS)], grid),
    ]


@dataclass(frozen=True, eq=False)
class LadderErrors:
    """Errors of a blend on a ladder, for each pair of rungs that has one in the middle."""

    log: Float64[np.ndarray, " n_pairs"]
    """`halfway.brdf.difference` in the metric ``log``."""
    seen: Float64[np.ndarray, " n_pairs"]
    """Mean CIELAB difference in the judging scene."""


def ladder_errors(ladder: Library, blend: Blend) -> LadderErrors:
    """What a blend of two rungs is off the rung in the middle."""
    mixer, operator = Mixer(ladder), SphereOperator.of(JUDGING_SCENE, ladder.grid)

    def look(table: TabularBrdf) -> Lab:
        return appearance(operator.picture(table.values.reshape(3, -1)))

    rungs = [ladder.brdf(name) for name in ladder.names]
    looks = [look(rung) for rung in rungs]
    errors: list[tuple[float, float]] = []
    for i in range(len(ladder)):
        for j in range(i + 2, len(ladder), 2):
            ends: Mapping[str, float] = {ladder.names[i]: 0.5, ladder.names[j]: 0.5}
            mixed = mixer.mix(Recipe.of(ladder, ends, blend))
            middle = (i + j) // 2
            seen = cielab_difference(look(mixed), looks[middle])
            errors.append((difference(rungs[middle], mixed).below, float(seen)))
    log, seen = np.array(errors).T
    return LadderErrors(log, seen)


def _ladder(name: str, rungs: list[Brdf], grid: Grid) -> Library:
    return ProceduralLibrary(name, {f"rung-{i}": rung for i, rung in enumerate(rungs)}, grid=grid)


def _conductor(alpha: float) -> Brdf:
    return OpenPbr([0.9, 0.6, 0.3], base_metalness=1.0, specular_roughness=float(np.sqrt(alpha)))


def _plastic(alpha: float) -> Brdf:
    return OpenPbr([0.5, 0.1, 0.05], specular_roughness=float(np.sqrt(alpha)))


def _abc(alpha: float) -> Brdf:
    b = 1 / alpha**2
    diffuse, strength = np.array([0.1, 0.2, 0.4]), 0.2 * b
    return AbcModel(diffuse, np.full(3, strength), b, 1.5, 1.5)


def _changing(share: float) -> Brdf:
    colour = (1 - share) * np.array([0.6, 0.1, 0.05]) + share * np.array([0.1, 0.2, 0.6])
    width = ALPHAS[0] * (ALPHAS[-1] / ALPHAS[0]) ** share
    ior = 1.4 + 0.4 * share
    return OpenPbr(colour, specular_roughness=float(np.sqrt(width)), specular_ior=ior)
