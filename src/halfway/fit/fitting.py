"""The model that stands for a material best.

Bounded least squares (a trust region, reflective: M. A. Branch, T. F. Coleman, Y. Li, SIAM Journal on Scientific Computing
21(1), 1999) in the metric of `halfway.fit.metric`, from the best few of eight starts: four widths of the main lobe, as a
dielectric and as a metal; of an anisotropic material, somewhat anisotropic in the direction of its own highlight. Terms are added to the metric: what a model reflects above 1, times ten; the distance of the parameters from
where they do nothing, times .003, so that a parameter that the material does not need stays out; and the same metric for each of the
model's readings, as a weak voice: of models that are about as good, the one that other programs read best is found.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from typing import Any

import numpy as np
from threadpoolctl import threadpool_limits

from .._types import Values
from ..brdf import Brdf, Quality, directional_albedo, lit_sphere, quality
from ..errors import HalfwayError
from .cycles import Cycles
from .gltf import Gltf, GltfBlender, GltfCore, PreviewSurface
from .metric import Target, Terms
from .model import AnalyticModel, Vector
from .openpbr import OpenPbr
from .principled import Principled

MODELS: dict[str, type[AnalyticModel]] = {
    "openpbr": OpenPbr,
    "principled": Principled,
    "cycles": Cycles,
    "gltf": Gltf,
    "gltf-blender": GltfBlender,
    "gltf-core": GltfCore,
    "preview": PreviewSurface,
}
"""The models by name."""
DEFAULT_MODEL = "openpbr"
Solver = Callable[..., Any]
"""Bounded least squares, with the arguments and the result (``x``, ``cost``) of `scipy.optimize.least_squares`."""

ALBEDO_DEGREES = (5.0, 20.0, 40.0, 60.0, 75.0)
"""Where albedos are compared; other angles than those of the metric."""
ABOUT_EQUAL_DB = 1.0
INDISTINGUISHABLE_DB = 40.0
"""Above, nobody sees a difference, so it settles nothing."""
MOST_EVALUATIONS = 40
TOLERANCE = 1e-3
DECIMALS = 5
"""Of the parameters: files hold them as they are, and what is nearly nothing is nothing."""
SOMEWHAT_ANISOTROPIC = 0.6
"""Where a search for how anisotropic a material is begins."""
STAY_NEUTRAL = 3e-3
STAY_PASSIVE = 10.0
READ_WELL = 0.1
"""The factor of a reading's terms: their squares count a hundredth."""
POOR_DB, POOR_L1 = 30.0, 0.3
"""A fit below the one or above the other is called poor."""


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
    readings: Mapping[str, Quality] = field(default_factory=dict[str, Quality])
    """Pictures of what other programs make of the model, by which: `AnalyticModel.readings`."""

    @property
    def is_poor(self) -> bool:
        """Whether the model cannot look like the material."""
        return self.picture.psnr < POOR_DB or self.picture.relative_l1 > POOR_L1

    @property
    def model_name(self) -> str:
        """The model's, one of `MODELS`."""
        return next(name for name, kind in MODELS.items() if type(self.model) is kind)

    @property
    def summary(self) -> str:
        """What the model is and how far off, in words."""
        readings = "".join(f"; {name} {read.psnr:.1f} dB" for name, read in self.readings.items())
        caution = "; a poor fit: look at it before you use it" if self.is_poor else ""
        return (
            f"as {self.model.formula}: {self.picture.psnr:.1f} dB on a lit sphere, "
            f"off by {self.picture.relative_l1:.1%} in the mean, albedo off by at most {self.albedo_error:.3f}"
            f"{readings}{caution}"
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
                **asdict(self.picture),
                "albedo": self.albedo_error,
                "poor": self.is_poor,
                "readings": {name: asdict(read) for name, read in self.readings.items()},
            },
        }


def fit(
    brdf: Brdf, model: str = DEFAULT_MODEL, *, name: str = "", solver: Solver | None = None
) -> Fit:
    """The parameters of ``model``, one of `MODELS`, that stand for a material best.

    ``solver`` does what `scipy.optimize.least_squares` does, where that is not to be had.

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
    target, truth = Target.of(brdf, name), lit_sphere(brdf)
    with threadpool_limits(1, "blas"):
        fitted = _chosen(_candidates(MODELS[model], target, solver or _scipys), truth)
    angles = np.radians(ALBEDO_DEGREES)
    albedo_error = np.abs(directional_albedo(fitted, angles) - directional_albedo(brdf, angles))
    return Fit(
        name,
        fitted,
        float(np.linalg.norm(target.difference(fitted)[0])),
        quality(lit_sphere(fitted), truth),
        float(albedo_error.max()),
        {read: quality(lit_sphere(other), truth) for read, other in fitted.readings.items()},
    )


def _chosen(candidates: Sequence[AnalyticModel], truth: Values) -> AnalyticModel:
    """Of those that are about as like the material as any, the first that is about as well read as any."""
    likeness = np.array(
        [[_likeness(m, truth) for m in (c, *c.readings.values())] for c in candidates]
    )
    own, read = likeness[:, 0], likeness.mean(axis=1)
    good = own > own.max() - ABOUT_EQUAL_DB
    return candidates[int(np.argmax(good & (read > read[good].max() - ABOUT_EQUAL_DB)))]


def _likeness(model: AnalyticModel, truth: Values) -> float:
    """How far the pictures agree, in dB."""
    return min(INDISTINGUISHABLE_DB, quality(lit_sphere(model), truth).psnr)


def _candidates(kind: type[AnalyticModel], target: Target, solver: Solver) -> list[AnalyticModel]:
    """The best of a search in all parameters; where programs read the model in several ways, all that searches end at."""
    even = dict.fromkeys(kind.grain, 0.0) if target.is_isotropic else {}
    if not kind.simpler:
        return _searched(kind, target, kind.held(even), solver)[:1]
    return [
        model
        for held in (*kind.simpler, {})
        for model in _searched(kind, target, kind.held({**even, **held}), solver)
    ]


def _scipys(*args: Any, **options: Any) -> Any:
    from scipy.optimize import least_squares  # takes a second to load

    return least_squares(*args, **options)


def _searched(
    kind: type[AnalyticModel], target: Target, held: Vector, solver: Solver
) -> list[AnalyticModel]:
    """What the best few starts lead to, with some parameters held; the best first."""
    low, high = kind.bounds()
    neutral, width = kind.neutral(), high - low
    free = np.isnan(held)

    def whole(x: np.ndarray) -> Vector:
        vector = held.copy()
        vector[free] = x
        return vector

    def residuals(x: np.ndarray) -> Terms:
        vector = whole(x)
        model = kind.from_vector(vector)
        terms, above = target.difference(model)
        read = [READ_WELL * target.difference(other)[0] for other in model.readings.values()]
        return np.concatenate(
            [terms, STAY_PASSIVE * above, STAY_NEUTRAL * (vector - neutral) / width, *read]
        )

    inside = low + 1e-3 * width, high - 1e-3 * width
    starts = [np.clip(start.to_vector(), *inside)[free] for start in _starts(kind, target)]
    starts.sort(key=lambda x: float(np.square(residuals(x)).sum()))
    ends: list[Any] = [
        solver(
            residuals,
            start,
            bounds=(low[free], high[free]),
            x_scale="jac",
            ftol=TOLERANCE,
            xtol=TOLERANCE,
            max_nfev=MOST_EVALUATIONS,
        )
        for start in starts[: kind.n_searches]
    ]
    ends.sort(key=_cost)
    return [
        _within_half_a_turn(kind.from_vector(np.clip(whole(result.x).round(DECIMALS), low, high)))
        for result in ends
    ]


def _starts(kind: type[AnalyticModel], target: Target) -> Sequence[AnalyticModel]:
    starts = kind.starts(target.body(), target.albedo())
    if target.is_isotropic or not kind.grain:
        return starts
    grain = dict(zip(kind.grain, (SOMEWHAT_ANISOTROPIC, target.widest()), strict=True))
    return [replace(start, **grain) for start in starts]


def _within_half_a_turn(model: AnalyticModel) -> AnalyticModel:
    """The same with its direction in [0, pi)."""
    if not model.grain:
        return model
    if model.is_isotropic:
        return replace(model, **{model.grain[1]: 0.0})
    direction = round(getattr(model, model.grain[1]) % np.pi, DECIMALS)
    return replace(model, **{model.grain[1]: direction})


def _cost(result: Any) -> float:
    return result.cost
