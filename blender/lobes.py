"""A table as lobes that Cycles samples: for each angle of view, weights of a diffuse lobe and of GGX lobes of fixed widths.

    f(wi, wo) = sum_k x_k(theta_o) L_k(wi, wo),   L_0 = 1/pi,   L_k = D(a_k) G / (4 cos_i cos_o)

A shader knows wo, so weights may depend on it; no light need be known, and the renderer samples every lobe. The weights are none
negative, and minimise, for each view and channel by itself,

    sum_j w_j m'(s_j)^2 (s_j - sum_k x_k L_kj cos_i)^2  +  m'(a)^2 (a - sum_k x_k a_k)^2

the differences of radiances s and albedos a as `halfway.fit.metric` sees them (m: cube root, then logarithm), linearised at the table.
All terms are non-negative, so the multiplicative steps of D. D. Lee and H. S. Seung, "Algorithms for Non-negative Matrix
Factorization", NIPS 2000, never leave the cone. Weights are linear in nothing but the table: a mix of tables is fitted anew.
"""

from typing import NamedTuple

import numpy as np

from .halfway.brdf import Brdf, quadrature
from .halfway.fit.microfacet import ggx, smith_correlated

ROUGHNESSES = (0.03, 0.07, 0.12, 0.18, 0.26, 0.37, 0.52, 0.74)
N_VIEWS, LAST_VIEW_DEGREES = 24, 88.0
N_THETA_H, N_PHI_H = 40, 12
GRAZING_DEGREES = 89.0
STEPS = 3000
DARK = 1e-3
"""Radiance below which differences no longer count for more."""


class Lobes(NamedTuple):
    """Weights of the lobes, shape (n_lobes, n_views, 3); the diffuse one first."""

    weights: np.ndarray

    @classmethod
    def of(cls, brdf: Brdf) -> "Lobes":
        """The lobes that stand for a material."""
        return cls(np.stack([_at(brdf, theta) for theta in views()], axis=1))

    def eval(self, wi: np.ndarray, wo: np.ndarray) -> np.ndarray:
        """What the node tree shows, in 1/sr."""
        lit = (wi[..., 2] > 0) & (wo[..., 2] > 0)
        found = np.zeros((*lit.shape, 3))
        position = np.arccos(np.clip(wo[lit][:, 2], 0, 1)) / views()[-1] * (N_VIEWS - 1)
        low = np.clip(position.astype(int), 0, N_VIEWS - 2)
        share = np.clip(position - low, 0, 1)[:, None]
        weights = (1 - share) * self.weights[:, low] + share * self.weights[:, low + 1]
        found[lit] = np.einsum("knc,kn->nc", weights, _lobes(wi[lit], wo[lit]))
        return found


def views() -> np.ndarray:
    """The angles of view that have weights of their own, in radians."""
    return np.radians(np.linspace(0, LAST_VIEW_DEGREES, N_VIEWS))


def _at(brdf: Brdf, theta_o: float) -> np.ndarray:
    """Weights for one view, shape (n_lobes, 3)."""
    rule = quadrature.HalfVectors.at(
        max(theta_o, 1e-3), N_THETA_H, N_PHI_H, least_cosine=np.cos(np.radians(GRAZING_DEGREES))
    )
    cos_i = rule.other[:, 2]
    samples = brdf.eval(rule.other, rule.fixed)
    known = np.isfinite(samples).all(axis=1)
    if not known.any():
        return np.zeros((1 + len(ROUGHNESSES), 3))
    samples = np.where(known[:, None], np.maximum(samples, 0), 0)
    lobes = np.where(known, _lobes(rule.other, rule.fixed), 0)
    # As in the metric: between the solid angle and the angle alone.
    importance = rule.cos_d * rule.dh / np.sqrt(np.hypot(rule.h[:, 0], rule.h[:, 1]))
    importance = np.sqrt(importance / importance.sum())
    seen, albedo = np.pi * samples * cos_i[:, None], rule.weights @ samples
    rows = importance[:, None] * _slope(seen) * np.pi * cos_i[:, None]
    design = np.concatenate(
        [
            lobes.T[:, :, None] * rows[:, None],
            (lobes @ rule.weights)[None, :, None] * _slope(albedo),
        ]
    )
    wanted = np.concatenate([samples * rows, albedo[None] * _slope(albedo)])
    return _non_negative(design, wanted)


def _slope(radiance: np.ndarray) -> np.ndarray:
    """m', as far as it falls."""
    x = np.maximum(radiance, DARK)
    return np.where(x < 1, x ** (-2 / 3), 1 / x) / 3


def _lobes(wi: np.ndarray, wo: np.ndarray) -> np.ndarray:
    h = wi + wo
    theta_h = np.arctan2(np.hypot(h[..., 0], h[..., 1]), h[..., 2])
    cos_i, cos_o = wi[..., 2], wo[..., 2]
    lobes = [np.full_like(cos_i, 1 / np.pi)]
    for roughness in ROUGHNESSES:
        a = roughness**2
        lobes.append(ggx(theta_h, a) * smith_correlated(cos_i, cos_o, a, a) / (4 * cos_i * cos_o))
    return np.stack(lobes)


def _non_negative(design: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """The least squares with no weight negative, channel by channel; shape (n_lobes, 3)."""
    right = np.einsum("jkc,jc->kc", design, wanted)
    normal = np.einsum("jkc,jlc->ckl", design, design)
    x = right / np.maximum(np.einsum("ckl->kc", normal), 1e-30)
    for _ in range(STEPS):
        x = x * right / np.maximum(np.einsum("ckl,lc->kc", normal, x), 1e-30)
    return x
