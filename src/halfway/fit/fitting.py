"""The model that stands for a material best.

Bounded least squares (a trust region, reflective: M. A. Branch, T. F. Coleman, Y. Li, SIAM Journal on Scientific Computing
21(1), 1999) in the metric of `halfway.fit.metric`, from the best few of eight starts: four widths of the main lobe, as a
dielectric and as a metal. Two terms are added to the metric: what a model reflects above 1, times ten, and the distance of the
parameters from where they do nothing, times .003, so that a parameter that the material does not need stays out.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from threadpoolctl import threadpool_limits

from ..brdf import Brdf, Quality, directional_albedo, lit_sphere, quality
from ..errors import HalfwayError
from .gltf import Gltf
from .metric import Target, Terms
from .model import AnalyticModel, Vector
from .openpbr import OpenPbr
from .principled import Principled

MODELS: dict[str, type[AnalyticModel]] = {
    "openpbr": OpenPbr,
    "principled": Principled,
    "gltf": Gltf,
}
"""The models by name."""
DEFAULT_MODEL = "openpbr"

ALBEDO_DEGREES = (5.0, 20.0, 40.0, 60.0, 75.0)
"""Where albedos are compared; other angles than those of the metric."""
N_SEARCHES = 2
MOST_EVALUATIONS = 40
TOLERANCE = 1e-3
DECIMALS = 5
"""Of the parameters: files hold them as they are, and what is nearly nothing is nothing."""
STAY_NEUTRAL = 3e-3
STAY_PASSIVE = 10.0


@dataclass(frozen=True)
class Fit:
    """A model that stands for a material, and how well it does."""

    name: str
    """The material's."""
    model: AnalyticModel
    distance: float
    """In the metric of `halfway.fit.metric`: 0.01 is one step of lightness in a hundred."""
    picture: Quality
    """Of the lit sphere, against the material's."""
    albedo_error: float
    """The largest difference of directional albedos, over channels and `ALBEDO_DEGREES`."""

    @property
    def model_name(self) -> str:
        """The model's, one of `MODELS`."""
        return next(name for name, kind in MODELS.items() if isinstance(self.model, kind))

    @property
    def summary(self) -> str:
        """What the model is and how far off, in words."""
        return (
            f"as {self.model.formula}: {self.picture.psnr:.1f} dB on a lit sphere, "
            f"off by {self.picture.relative_l1:.1%} in the mean, albedo off by at most {self.albedo_error:.3f}"
        )

    def to_json(self) -> dict[str, Any]:
        """The fit as a JSON object."""
        return {
            "format": 1,
            "material": self.name,
            "model": self.model_name,
            "parameters": self.model.parameters(),
            "error": {
                "distance": self.distance,
                "psnr": self.picture.psnr,
                "relative_l1": self.picture.relative_l1,
                "albedo": self.albedo_error,
            },
        }


def fit(brdf: Brdf, model: str = DEFAULT_MODEL, *, name: str = "") -> Fit:
    """The parameters of ``model``, one of `MODELS`, that stand for a material best.

    Raises
    ------
    HalfwayError
        When there is no such model.
    FormatError
        When the material is not measured where it is compared.

    Examples
    --------
    >>> from halfway import open_library
    >>> from halfway.fit import fit
    >>> found = fit(open_library("builtin:merl-abc").brdf("blue-acrylic"), name="blue-acrylic")
    >>> round(float(found.model.base_metalness), 1)
    0.0
    """
    if model not in MODELS:
        raise HalfwayError(f"there is no model {model!r}: expected {', '.join(MODELS)}.")
    target = Target.of(brdf, name)
    with threadpool_limits(1, "blas"):
        found, distance = _search(MODELS[model], target)
    angles = np.radians(ALBEDO_DEGREES)
    albedo_error = np.abs(directional_albedo(found, angles) - directional_albedo(brdf, angles))
    return Fit(
        name,
        found,
        distance,
        quality(lit_sphere(found), lit_sphere(brdf)),
        float(albedo_error.max()),
    )


def _search(kind: type[AnalyticModel], target: Target) -> tuple[AnalyticModel, float]:
    from scipy.optimize import least_squares

    low, high = kind.bounds()
    neutral, width = kind.neutral(), high - low

    def residuals(x: Vector) -> Terms:
        terms, above = target.difference(kind.from_vector(x))
        return np.concatenate([terms, STAY_PASSIVE * above, STAY_NEUTRAL * (x - neutral) / width])

    inside = low + 1e-3 * width, high - 1e-3 * width
    starts = [
        np.clip(start.to_vector(), *inside) for start in kind.starts(target.body(), target.albedo())
    ]
    starts.sort(key=lambda x: float(np.square(residuals(x)).sum()))
    found: list[Any] = [
        least_squares(
            residuals,
            start,
            bounds=(low, high),
            x_scale="jac",
            ftol=TOLERANCE,
            xtol=TOLERANCE,
            max_nfev=MOST_EVALUATIONS,
        )
        for start in starts[:N_SEARCHES]
    ]
    x = min(found, key=_cost).x
    model = kind.from_vector(np.clip(x.round(DECIMALS), low, high))
    return model, float(np.linalg.norm(target.difference(model)[0]))


def _cost(result: Any) -> float:
    return result.cost
