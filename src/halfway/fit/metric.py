"""The metric in which models are fitted.

A surface is seen from five angles theta_o, and half vectors stand on a grid over the hemisphere, close together near the
normal. Each half vector h says where the light is, wi = 2 (wo.h) h - wo. An anisotropic surface is turned as well, so that all half
vectors together are close in phi_h too.

    d^2 = sum_j w_j (m(pi f_j cos_i) - m(pi g_j cos_i))^2  +  sum_k v_k (a_k^(1/3) - b_k^(1/3))^2

The first sum runs over the pairs, of the radiance of a surface that light of irradiance pi falls on from wi: m(x) is the cube
root of x up to the display's white, which is near to lightness, and 1 + ln(x)/3 above, with the same slope, so that a highlight
counts and does not rule. w_j = (wo.h) dh / sqrt(sin theta_h): between the solid angle, in which a mirror-like lobe is nothing,
and the angle alone. The second sum, of the same weight, runs over the directional albedos a and b that the same pairs integrate to:
what a lobe adds under an even light, however narrow it is. v_k and w_j hold the share sin(2 theta_o) of a sphere's picture.

Only measured pairs count. d is a root mean square in units of the lightness of white.
"""

from functools import cache
from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float64

from .._types import Directions
from ..brdf import Brdf, quadrature
from ..errors import FormatError
from ..halfdiff import to_half_diff
from .microfacet import Pair
from .model import AnalyticModel, Colour, Vector

VIEWS_DEGREES = (10.0, 30.0, 50.0, 65.0, 77.0)
GRAZING_DEGREES = 85.0
"""No light comes from beyond."""
N_THETA_H, N_PHI_H = 28, 12
N_AZIMUTHS = 7
"""Of each view of an anisotropic surface: no divisor of the half vectors' number, so that no two of them are at one phi_h."""
BODY_DEGREES = 35.0
"""Beyond, highlights are over."""

Samples = Float64[np.ndarray, "3 n"]
Terms = Float64[np.ndarray, " n_terms"]
"""What the metric squares and adds up."""


class Pairs(NamedTuple):
    """Where tables and models are compared."""

    wi: Directions
    wo: Directions
    pair: Pair
    weight: Vector
    """The root of w_j, and sums of squares to 1."""
    reflected: Float64[np.ndarray, "n_views n"]
    """Takes f to the directional albedo of each view."""
    view_weight: Float64[np.ndarray, " n_views"]

    def of(self, model: AnalyticModel) -> Samples:
        """Values of a model, in 1/sr."""
        return model.of(self.pair._replace(azimuths=None) if model.is_isotropic else self.pair)


class Target(NamedTuple):
    """A material as the metric sees it."""

    pairs: Pairs
    known: Bool[np.ndarray, " n"]
    """Pairs at which all channels are measured."""
    samples: Samples
    seen: Terms
    is_isotropic: bool

    @classmethod
    def of(cls, brdf: Brdf, name: str) -> "Target":
        """What is to be fitted; negative samples count as 0.

        Raises
        ------
        FormatError
            When the material is measured nowhere the metric looks.
        """
        pairs = comparison_pairs(1 if brdf.is_isotropic else N_AZIMUTHS)
        samples = brdf.eval(pairs.wi, pairs.wo).T
        known = np.asarray(np.isfinite(samples).all(axis=0))
        if not known.any():
            raise FormatError(
                f"{name or 'the material'} is measured at none of the {len(known)} pairs of directions that a fit "
                "looks at: expected a table of a whole material. `halfway check` says what is in it."
            )
        samples = np.where(known, np.maximum(samples, 0), 0)
        return cls(pairs, known, samples, _seen(pairs, samples), brdf.is_isotropic)

    def difference(self, model: AnalyticModel) -> tuple[Terms, np.ndarray]:
        """The terms of d, of which d is the norm; and by how much each albedo is above 1."""
        f = np.where(self.known, self.pairs.of(model), 0)
        return _seen(self.pairs, f) - self.seen, np.maximum(
            f @ self.pairs.reflected.T - 1, 0
        ).ravel()

    def body(self) -> Colour:
        """The diffuse albedo, off the highlight."""
        off = self.known & (self.pairs.pair.theta_h > np.radians(BODY_DEGREES))
        return np.pi * np.median(self.samples[:, off], axis=1) if off.any() else np.full(3, 0.5)

    def albedo(self) -> Colour:
        """The whole albedo, seen from 30 degrees."""
        views = np.array_split(self.samples @ self.pairs.reflected.T, len(VIEWS_DEGREES), axis=1)
        return views[1].mean(axis=1)

    def widest(self) -> float:
        """The direction along the surface in which the highlight is widest: that of the second moments of its half vectors."""
        light = self.samples.mean(axis=0) * self.pairs.wi[:, 2] * self.pairs.weight**2
        theta_h, phi_h, *_ = to_half_diff(self.pairs.wi, self.pairs.wo)
        # Of a tensor along phi, the sum of exp(2 i phi) is at twice the angle of its longer axis.
        moment = np.sin(theta_h) ** 2 * np.exp(2j * phi_h)
        return float(np.angle((light * moment).sum()) / 2)


@cache
def comparison_pairs(n_azimuths: int = 1) -> Pairs:
    """The pairs of directions and their weights, from so many azimuths of each view."""
    least_cosine = np.cos(np.radians(GRAZING_DEGREES))
    theta_o = np.repeat(np.radians(VIEWS_DEGREES), n_azimuths)
    phi_o = 2 * np.pi * np.tile(np.arange(n_azimuths) / n_azimuths, len(VIEWS_DEGREES))
    views = [
        quadrature.HalfVectors.at(theta, N_THETA_H, N_PHI_H, least_cosine=least_cosine).turned(phi)
        for theta, phi in zip(theta_o, phi_o, strict=True)
    ]
    view = np.repeat(np.arange(len(views)), [len(rule.dh) for rule in views])
    h, wo, wi, cos_d, dh = (np.concatenate(part) for part in zip(*views, strict=True))
    shares = np.sin(2 * theta_o)
    weight = shares[view] * cos_d * dh / np.sqrt(np.hypot(h[:, 0], h[:, 1]))
    reflected = np.zeros((len(views), len(view)))
    reflected[view, np.arange(len(view))] = np.concatenate([rule.weights for rule in views])
    return Pairs(
        wi,
        wo,
        Pair.of(wi, wo),
        np.sqrt(weight / weight.sum()),
        reflected,
        np.sqrt(shares / shares.sum()),
    )


def _seen(pairs: Pairs, f: Samples) -> Terms:
    """What the metric compares, weighted, so that d is the norm of a difference."""
    bright = np.cbrt(np.pi * f * pairs.wi[:, 2])
    bright = np.where(bright < 1, bright, 1 + np.log(np.maximum(bright, 1)))
    albedo = np.cbrt(f @ pairs.reflected.T)
    parts = (bright * pairs.weight, albedo * pairs.view_weight)
    return np.concatenate([part.ravel() for part in parts]) / np.sqrt(3)
