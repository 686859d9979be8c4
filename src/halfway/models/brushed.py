"""Some forty anisotropic materials as models: synthetic, since no anisotropic measurement may come with the package.

Metals have the refractive indices that were measured of their films, at 617, 549 and 451 nm [1, 2; aluminium 3]; how they are
brushed is ours: the first slope is along the brush, the second across. Anodised aluminium is dyed. Ward's are the numbers that
he measured of real samples, without colour [4]. Cloth has a glossy and a dyed lobe for each direction of its threads, with indices as
in [5]; its colours, widths and shares are ours.

[1] P. B. Johnson, R. W. Christy, "Optical constants of the noble metals", Phys. Rev. B 6, 1972: Cu, Ag, Au.
[2] P. B. Johnson, R. W. Christy, "Optical constants of transition metals", Phys. Rev. B 9, 1974: Ti, Cr, Fe, Ni, Pd.
[3] A. D. Rakić, "Algorithm for the determination of intrinsic optical constants of metal films: application to aluminum", Applied
Optics 34, 1995.
[4] G. Ward, "Measuring and Modeling Anisotropic Reflection", SIGGRAPH 1992, table 1.
[5] I. Sadeghi et al., "A Practical Microcylinder Appearance Model for Cloth Rendering", ACM TOG 32(2), 2013, table 2.
"""

import math
from types import MappingProxyType

import numpy as np

from ..halfdiff import Grid
from ..origin import Origin
from .anisotropic import AnisotropicModel, Colour, Lobe, Microfacets, Ward
from .published import ModelSet

_METALS: dict[str, tuple[Colour, Colour]] = {
    "aluminium": ((1.300, 0.937, 0.618), (7.48, 6.62, 5.47)),
    "chrome": ((3.17, 3.18, 2.33), (3.30, 3.33, 3.14)),
    "copper": ((0.30, 1.02, 1.24), (3.205, 2.577, 2.397)),
    "gold": ((0.21, 0.43, 1.38), (3.272, 2.455, 1.914)),
    "nickel": ((1.99, 1.92, 1.73), (4.02, 3.61, 2.95)),
    "palladium": ((1.75, 1.64, 1.41), (4.21, 3.84, 3.26)),
    "silver": ((0.06, 0.06, 0.04), (4.152, 3.586, 2.657)),
    "steel": ((2.88, 2.95, 2.59), (3.05, 2.93, 2.77)),  # iron
    "titanium": ((2.67, 2.54, 2.27), (3.72, 3.43, 3.04)),
}
_BRUSHED = {
    "brushed-steel": (0.08, 0.35),
    "hairline-steel": (0.05, 0.20),
    "satin-steel": (0.15, 0.40),
    "turned-steel": (0.05, 0.50),
    "brushed-aluminium": (0.10, 0.40),
    "hairline-aluminium": (0.05, 0.25),
    "satin-aluminium": (0.20, 0.45),
    "brushed-gold": (0.08, 0.30),
    "satin-gold": (0.15, 0.40),
    "brushed-copper": (0.10, 0.35),
    "hairline-copper": (0.05, 0.20),
    "brushed-silver": (0.08, 0.30),
    "satin-silver": (0.20, 0.40),
    "brushed-nickel": (0.12, 0.35),
    "satin-nickel": (0.20, 0.45),
    "brushed-chrome": (0.05, 0.20),
    "turned-chrome": (0.05, 0.50),
    "brushed-titanium": (0.10, 0.45),
    "satin-titanium": (0.20, 0.50),
    "brushed-palladium": (0.08, 0.25),
}
"""Slopes along the brush and across it."""
_ANODISED: dict[str, Colour] = {
    "anodised-blue": (0.08, 0.20, 0.75),
    "anodised-red": (0.75, 0.08, 0.10),
    "anodised-green": (0.15, 0.60, 0.20),
    "anodised-black": (0.05, 0.05, 0.05),
}
_HAIRLINE_PLASTIC: dict[str, Colour] = {
    "hairline-plastic-white": (0.75, 0.75, 0.72),
    "hairline-plastic-red": (0.55, 0.06, 0.05),
    "hairline-plastic-black": (0.02, 0.02, 0.02),
}
_WARD = {
    "rolled-brass": Ward(0.10, 0.33, 0.050, 0.16),
    "rolled-aluminium": Ward(0.10, 0.21, 0.040, 0.09),
    "lightly-brushed-aluminium": Ward(0.15, 0.19, 0.088, 0.13),
    "varnished-plywood": Ward(0.33, 0.025, 0.040, 0.11),
    "enamelled-metal": Ward(0.25, 0.047, 0.080, 0.096),
    "painted-cardboard": Ward(0.19, 0.043, 0.076, 0.085),
}
_SILK, _LINEN, _POLYESTER = 1.345, 1.46, 1.539


def anisotropic() -> ModelSet:
    """The set ``builtin:anisotropic``."""
    models = {
        **{name: _brushed(name.split("-")[1], *alphas) for name, alphas in _BRUSHED.items()},
        "crosshatched-steel": _crosshatched("steel", 0.06, 0.30),
        **{name: _brushed("aluminium", 0.12, 0.35, dye) for name, dye in _ANODISED.items()},
        **{name: _plastic(0.06, 0.25, body) for name, body in _HAIRLINE_PLASTIC.items()},
        "vinyl-record": _plastic(0.04, 0.40, (0.01, 0.01, 0.01)),
        **_WARD,
        **_cloths(),
    }
    return ModelSet(
        "anisotropic",
        Origin(
            f"{len(models)} anisotropic materials as models (brushed metals, plastics, cloths): synthetic, not measurements",
            "refractive indices and fits of the literature, see the module models/brushed.py",
            "published numbers (facts); the models are our own implementation, BSD-3-Clause",
        ),
        MappingProxyType(models),
        Grid.anisotropic(period=math.pi),  # all of them look the same after half a turn
    )


def refractive_index(metal: str) -> tuple[Colour, Colour]:
    """N and k of a metal, red, green and blue."""
    return _METALS[metal]


def _brushed(
    metal: str, alpha_x: float, alpha_y: float, share: Colour = (1.0, 1.0, 1.0)
) -> AnisotropicModel:
    n, k = _METALS[metal]
    return Microfacets((Lobe(alpha_x, alpha_y, n, k, share),))


def _crosshatched(metal: str, alpha_x: float, alpha_y: float) -> AnisotropicModel:
    """Brushed once, and once more at a right angle."""
    n, k = _METALS[metal]
    half = (0.5, 0.5, 0.5)
    return Microfacets(
        tuple(Lobe(alpha_x, alpha_y, n, k, half, degrees) for degrees in (0.0, 90.0))
    )


def _plastic(alpha_x: float, alpha_y: float, body: Colour) -> AnisotropicModel:
    return Microfacets((Lobe(alpha_x, alpha_y, (1.5, 1.5, 1.5)),), body)


def _cloths() -> dict[str, AnisotropicModel]:
    purple, amber, blue = (0.30, 0.06, 0.34), (0.62, 0.40, 0.07), (0.05, 0.10, 0.45)
    white, black, flax = (0.72, 0.70, 0.66), (0.015, 0.015, 0.018), (0.52, 0.43, 0.31)
    red, green, indigo = (0.60, 0.05, 0.06), (0.05, 0.32, 0.10), (0.025, 0.05, 0.14)
    return {
        # Satin shows one set of threads, taffeta both; shot cloth has them in two colours.
        "satin-purple": _cloth(_SILK, (purple, purple), 0.85),
        "satin-amber": _cloth(_SILK, (amber, amber), 0.85),
        "satin-white": _cloth(_POLYESTER, (white, white), 0.85),
        "satin-black": _cloth(_POLYESTER, (black, black), 0.85),
        "taffeta-blue": _cloth(_SILK, (blue, blue), 0.5, along=0.10),
        "shot-silk": _cloth(_SILK, (red, green), 0.5),
        "linen": _cloth(_LINEN, (flax, flax), 0.5, along=0.35, across=0.8),
        "denim": _cloth(_LINEN, (indigo, white), 0.9, along=0.30, across=0.8, twist=20.0),
    }


def _cloth(
    n: float,
    dyes: tuple[Colour, Colour],
    warp: float,
    *,
    along: float = 0.14,
    across: float = 0.60,
    twist: float = 0.0,
) -> AnisotropicModel:
    """Threads along the tangent, which cover ``warp`` of the surface, and across it; their fibres are twisted by some degrees.

    A third of what a dyed thread scatters is glossy, along its fibres; the rest is matte.
    """
    lobes: list[Lobe] = []
    for dye, share, degrees in zip(dyes, (warp, 1 - warp), (twist, 90 - twist), strict=True):
        lobes.append(
            Lobe(along, across, (n, n, n), share=(share, share, share), turn_degrees=degrees)
        )
        r, g, b = (float(x) for x in np.multiply(dye, share / 3))
        lobes.append(Lobe(2 * along, across, share=(r, g, b), turn_degrees=degrees))
    r, g, b = (float(x) for x in np.average(dyes, axis=0, weights=(warp, 1 - warp)) * 2 / 3)
    return Microfacets(tuple(lobes), (r, g, b), ((n - 1) / (n + 1)) ** 2)
