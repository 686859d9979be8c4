"""Reading of RGL `.bsdf` files: a tensor file with these fields, of n directions, r^2 colours a direction.

    description  u8   [length]
    phi_i        f32  [p]               2 or fewer: isotropic
    theta_i      f32  [n]
    ndf, sigma   f32  [phi, theta]      the last axis is u_theta, the one before u_phi
    vndf         f32  [p, n, phi, theta]
    rgb          f32  [p, n, 3, r, r]   or wavelengths f32 [l] and spectra f32 [p, n, l, r, r]
    luminance    f32  [p, n, r, r]      for sampling only; not read here
    jacobian     u8   [1]

Source: the readers (Mitsuba's `measured`, rgl-epfl/brdf-loader).
"""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from ..errors import FormatError
from .rgl import RglBrdf
from .rgl_warp import Interpolant, Warp
from .spectra import ILLUMINANT, rgb_weights
from .tensor_file import read_tensor_file

_MAX_DESCRIPTION = 1000


def read_rgl(path: Path) -> RglBrdf:
    """The material of a `.bsdf` file, isotropic or anisotropic, RGB or spectral.

    Spectra become RGB once, on reading: every step of the evaluation is linear in them.

    Raises
    ------
    FormatError
        When the file is no tensor file, lacks a field, or its fields do not fit together.
    """
    fields = _Fields(read_tensor_file(path), path.name)
    phi_i, theta_i = fields.angles("phi_i"), fields.angles("theta_i")
    n_slices = len(phi_i) * len(theta_i)
    colours, source = _colours(fields, n_slices, (len(phi_i), len(theta_i)))
    vndf = fields.values("vndf", 4, leading=(len(phi_i), len(theta_i)), non_negative=True)
    vndf = vndf.reshape(n_slices, *vndf.shape[2:])
    if not (vndf.max(axis=(1, 2)) > 0).all():
        raise FormatError(
            f"{path.name}: field 'vndf' is 0 everywhere for one of its {n_slices} directions: a density has an "
            "integral. It is damaged."
        )
    return RglBrdf(
        name=path.stem.removesuffix("_rgb").removesuffix("_spec"),
        description=fields.text("description"),
        source=source,
        phi_i=phi_i,
        theta_i=theta_i,
        ndf=_interpolant(fields.values("ndf", 2, non_negative=True)),
        sigma=_interpolant(fields.values("sigma", 2, non_negative=True)),
        vndf=Warp.of(vndf),
        rgb=colours,
        has_jacobian=bool(fields.required("jacobian", 1, "u1")[:1].any()),
    )


def _colours(fields: "_Fields", n_slices: int, leading: tuple[int, int]) -> tuple[Interpolant, str]:
    if fields.has("rgb"):
        rgb = fields.values("rgb", 5, leading=(*leading, 3))
        return Interpolant(_channels_last(rgb, n_slices)), "RGB of the file"
    wavelengths = fields.angles("wavelengths")
    spectra = fields.values("spectra", 5, leading=(*leading, len(wavelengths)))
    weights = rgb_weights(wavelengths).T.astype(np.float32)
    source = (
        f"{len(wavelengths)} wavelengths from {wavelengths[0]:.0f} to {wavelengths[-1]:.0f} nm, "
        f"CIE 1931 observer, illuminant {ILLUMINANT}"
    )
    return Interpolant(_channels_last(spectra, n_slices) @ weights), source


def _channels_last(values: np.ndarray, n_slices: int) -> np.ndarray:
    slices_first = values.reshape(n_slices, *values.shape[2:])
    return np.ascontiguousarray(np.moveaxis(slices_first, 1, -1))


def _interpolant(values: np.ndarray) -> Interpolant:
    return Interpolant(values[None, ..., None])


class _Fields:
    """The fields of one file, each checked when it is asked for."""

    def __init__(self, fields: Mapping[str, np.ndarray], file: str) -> None:
        self._fields = fields
        self._file = file

    def has(self, name: str) -> bool:
        return name in self._fields

    def required(self, name: str, n_dimensions: int, dtype: str) -> np.ndarray:
        if name not in self._fields:
            raise FormatError(
                f"{self._file} has no field {name!r}, only {', '.join(sorted(self._fields)) or 'none'}: "
                "a material of the RGL database has. It is another kind of tensor file."
            )
        values = self._fields[name]
        if values.ndim != n_dimensions or values.dtype != np.dtype(dtype) or values.size == 0:
            raise FormatError(
                f"{self._file}: field {name!r} is {values.dtype} of shape {values.shape}: expected {np.dtype(dtype)} "
                f"with {n_dimensions} dimensions, none empty."
            )
        return values

    def values(
        self,
        name: str,
        n_dimensions: int,
        *,
        leading: tuple[int, ...] = (),
        non_negative: bool = False,
    ) -> np.ndarray:
        """Finite float32 samples at nodes: the last two axes have two nodes or more."""
        values = self.required(name, n_dimensions, "f4")
        if values.shape[: len(leading)] != leading or min(values.shape[-2:]) < 2:
            raise FormatError(
                f"{self._file}: field {name!r} has shape {values.shape}: with this file's directions it takes "
                f"{(*leading, *('2+' for _ in values.shape[len(leading) :]))}."
            )
        n_bad = values.size - int(np.count_nonzero(np.isfinite(values)))
        if n_bad:
            raise FormatError(
                f"{self._file}: {n_bad} of {values.size} values of field {name!r} are not finite."
            )
        if non_negative and values.min() < 0:
            raise FormatError(
                f"{self._file}: field {name!r} goes down to {values.min():.3g}: it is never negative."
            )
        return values

    def angles(self, name: str) -> np.ndarray:
        """Finite ascending values, as float64."""
        values = self.required(name, 1, "f4").astype(np.float64)
        if not (np.isfinite(values).all() and (np.diff(values) > 0).all()):
            raise FormatError(
                f"{self._file}: the {len(values)} values of field {name!r} do not ascend."
            )
        return values

    def text(self, name: str) -> str:
        if not self.has(name):
            return ""
        return (
            self._fields[name]
            .tobytes()[:_MAX_DESCRIPTION]
            .decode("utf-8", errors="replace")
            .rstrip("\0")
        )
