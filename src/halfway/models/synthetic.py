"""Synthetic materials: as many as one likes, to try what a large library does. No measurements, and fits of none.

    f_r = rho/pi (1 + r exp(-theta_d^2 / 2 w^2)) + s (1 - cos theta_d)^5
        + sum_l  a_l D_l(theta_h) F_l(theta_d) G / (4 cos_i cos_o)

    D = c exp(sum_j b_j cos(pi j x)) / (sin^2 theta_h + a^2 cos^2 theta_h)^g       x = sqrt(theta_h / (pi/2))
    F = (F0 + (1 - F0)(1 - cos theta_d)^5) ^ exp(sum_j e_j cos(2 j theta_d))
    G = min(1, 2 cos theta_h cos_i / cos theta_d, 2 cos theta_h cos_o / cos theta_d)

a diffuse part that may shine back to the light, a sheen, and two lobes. The exponent g says which family D belongs to: 2 is
GGX, smaller has longer tails, and towards infinity it becomes the Gaussian lobe of Beckmann and Ward. The two sums make
every surface irregular in its own way, as measured ones are, so that the materials have many dimensions; c makes the
integral of D cos(theta_h) over the hemisphere 1.

Material i of a seed is the same in every set: the first 1,000 of 2,000 materials are the set of 1,000.

Sources: B. Burley, "Physically-Based Shading at Disney", SIGGRAPH 2012 course, appendix B (D); C. Schlick, "An Inexpensive
BRDF Model for Physically-based Rendering", CGF 13(3), 1994 (F); R. Cook, K. Torrance, "A Reflectance Model for
Computer Graphics", ACM TOG 1(1), 1982 (G).
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any, ClassVar

import numpy as np
from jaxtyping import Float32

from .._types import Angle, Part
from ..brdf import IsotropicModel
from ..halfdiff import Grid
from .grazing import GRAZING_DEGREES, held

KINDS = ("matte", "plastic", "metal", "coated", "fabric", "satin")
"""What kinds of material there are, in turn."""


@dataclass(frozen=True, eq=False)
class SyntheticModel(IsotropicModel):
    """A diffuse part, a sheen and two lobes; held constant past 80 degrees as `halfway.models.grazing` says.

    Parameters
    ----------
    diffuse, sheen : float64 arrays, shape (3,)
        rho, an albedo, and s in 1/sr; linear RGB.
    retro, retro_width : float64 arrays, shape ()
        r, and w in radians.
    strength, alpha, gamma : float64 arrays, shape (2,)
        a_l, and the width (0 to 1) and exponent (above 1) of D of each lobe.
    F0 : float64 array, shape (2, 3)
        Reflectance of each lobe at theta_d = 0, but for the irregularity.
    c : float64 array, shape (2,)
        Of D, 1/sr.
    irregular_D, irregular_F : float64 arrays, shape (n,)
        b_j and e_j.
    """

    diffuse: np.ndarray
    sheen: np.ndarray
    retro: np.ndarray
    retro_width: np.ndarray
    strength: np.ndarray
    alpha: np.ndarray
    gamma: np.ndarray
    F0: np.ndarray
    c: np.ndarray
    irregular_D: np.ndarray
    irregular_F: np.ndarray

    formula: ClassVar[str] = f"synthetic 2, held past {GRAZING_DEGREES:g} degrees"

    def at(
        self, theta_h: Angle, theta_d: Angle, phi_d: Angle, cos_i: Angle, cos_o: Angle
    ) -> np.ndarray:
        del phi_d  # it acts through the two cosines
        cos_d = np.cos(theta_d)
        cos_i, cos_o = held(cos_i), held(cos_o)
        G = np.minimum(1, 2 * np.cos(theta_h) / cos_d * np.minimum(cos_i, cos_o))
        visible = G / (4 * cos_i * cos_o)
        grazing = (1 - cos_d) ** 5
        back = 1 + self.retro * np.exp(-((theta_d / self.retro_width) ** 2) / 2)
        lobes = [a * self.distribution(theta_h, i) * visible for i, a in enumerate(self.strength)]
        power = np.exp(_cosines(2 * theta_d, self.irregular_F))
        channels = zip(self.diffuse, self.sheen, np.swapaxes(self.F0, 0, 1), strict=True)
        return np.stack(
            [
                rho / np.pi * back
                + s * grazing
                + sum(
                    lobe * (F0 + (1 - F0) * grazing) ** power
                    for lobe, F0 in zip(lobes, F0s, strict=True)
                )
                for rho, s, F0s in channels
            ]
        )

    @classmethod
    def _sample_many(
        cls, brdfs: Sequence[Any], grid: Grid, rows: Part
    ) -> Float32[np.ndarray, "3 N *part"]:
        shape = grid.mask()[rows].shape
        samples = np.empty((3, len(brdfs), *shape), np.float32)
        step = max(1, cls.cells_in_cache // max(1, math.prod(shape)))
        for start in range(0, len(brdfs), step):
            some = brdfs[start : start + step]
            model = _stacked(some, len(grid.axes))
            samples[:, start : start + step] = model._sample_shaped(grid, rows, (3, len(some)))
        return samples

    def distribution(self, theta_h: Angle, lobe: int) -> Angle:
        """D of one lobe, 1/sr."""
        shape = _irregular_gtr(theta_h, self.alpha[lobe], self.gamma[lobe], self.irregular_D)
        return self.c[lobe] * shape


def _nodes() -> tuple[np.ndarray, np.ndarray]:
    """Angles theta_h, dense at the peak, and their weights 2 pi sin(theta_h) cos(theta_h) dtheta_h."""
    edges = np.pi / 2 * np.linspace(0, 1, 513) ** 3
    return (edges[1:] + edges[:-1]) / 2, np.pi * np.diff(np.sin(edges) ** 2)


_NODES, _PROJECTED = _nodes()


def synthetic(n: int, seed: int = 0) -> dict[str, SyntheticModel]:
    """``n`` different materials by name, the same for the same ``seed`` on every machine."""
    digits = max(4, len(str(n - 1)))
    return {f"{KINDS[i % len(KINDS)]}-{i:0{digits}d}": _material(i, seed) for i in range(n)}


def _stacked(models: Sequence[SyntheticModel], n_axes: int) -> SyntheticModel:
    """One formula for all of ``models``: the last axes of its parameters are the models and ``n_axes`` of the grid."""
    parameters = {
        field.name: np.stack([np.asarray(getattr(m, field.name)) for m in models], axis=-1)
        for field in fields(SyntheticModel)
    }
    ones = (1,) * n_axes
    return SyntheticModel(**{k: p.reshape(*p.shape, *ones) for k, p in parameters.items()})


def _irregular_gtr(theta_h: Angle, alpha: Angle, gamma: Angle, irregular: np.ndarray) -> Angle:
    x = np.sqrt(theta_h / (np.pi / 2))
    # sin^2 keeps its digits at the peak, where 1 + (a^2 - 1) cos^2 loses them.
    fall = (np.sin(theta_h) ** 2 + alpha**2 * np.cos(theta_h) ** 2) / alpha**2
    return np.exp(_cosines(np.pi * x, irregular)) * fall**-gamma


def _cosines(angle: Angle, coefficients: np.ndarray) -> Angle:
    return np.asarray(sum(b * np.cos(j * angle) for j, b in enumerate(coefficients, 1)))


def _material(i: int, seed: int) -> SyntheticModel:
    rng = np.random.default_rng([seed, i])
    kind = KINDS[i % len(KINDS)]
    colour = rng.beta(1.2, 1.8, 3) * 0.9
    alpha = np.exp(rng.uniform(np.log(0.02), np.log([0.6, 0.3])))
    gamma = 1.2 + rng.gamma(1.5, 1.2, 2)
    grey = np.full(3, rng.uniform(0.02, 0.08))
    share = rng.uniform(0.3, 0.9)
    match kind:
        case "matte":
            lobes, normal, diffuse, alpha = [0.3 * share, 0], [grey, grey], colour, np.sqrt(alpha)
        case "plastic":
            lobes, normal, diffuse = [1, 0], [grey, grey], 0.8 * colour
        case "metal":
            lobes, normal, diffuse = [share, 1 - share], [0.3 + 0.7 * colour] * 2, 0.0 * colour
        case "coated":
            lobes, normal, diffuse = [0.7 * share, 0.9], [0.2 + 0.8 * colour, grey], 0.2 * colour
        case "fabric":
            lobes, normal, diffuse, alpha = [0.2, 0], [grey, grey], 0.7 * colour, np.sqrt(alpha)
        case _:
            lobes, normal, diffuse = [0.5 * share, 0.3], [colour, grey], 0.4 * colour
    irregular = rng.normal(0, 0.5, 16)
    projected = [
        _irregular_gtr(_NODES, *shape, irregular) @ _PROJECTED
        for shape in zip(alpha, gamma, strict=True)
    ]
    is_fabric = kind == "fabric"
    return SyntheticModel(
        diffuse=diffuse,
        sheen=is_fabric * rng.uniform(0, 0.3) * (0.5 + colour),
        retro=np.array(rng.uniform(0, 0.2) if kind in ("matte", "fabric") else 0.0),
        retro_width=np.array(rng.uniform(0.1, 0.5)),
        strength=np.array(lobes, np.float64),
        alpha=alpha,
        gamma=gamma,
        F0=np.array(normal),
        c=1 / np.array(projected),
        irregular_D=irregular,
        irregular_F=rng.normal(0, 0.2, 4),
    )
