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
from pathlib import Path, PurePath

import numpy as np

from ..errors import FormatError
from .rgl import RglBrdf
from .rgl_warp import Interpolant, Warp
from .sources import FileSource, Source
from .spectra import ILLUMINANT, rgb_weights
from .tensor_file import read_tensors

_MAX_DESCRIPTION = 1000


def read_rgl(path: str | Path) -> RglBrdf:
    """The material of a `.bsdf` file, isotropic or anisotropic, RGB or spectral.

    Spectra become RGB once, on reading: every step of the evaluation is linear in them.

    Raises
    ------
    FormatError
        When the file is no tensor file, lacks a field, or its fields do not fit together.
    """
    return read_rgl_source(FileSource(Path(path)))


def read_rgl_source(source: Source) -> RglBrdf:
    """As `read_rgl`, from a file or a member of a zip."""
    with source.open() as stream:
        fields = read_tensors(stream, source.label)
    return from_fields(fields, source.label)


def from_fields(fields: Mapping[str, np.ndarray], label: str) -> RglBrdf:
    """As `read_rgl`, from the file's fields; ``label`` is the file's name."""
    checked = _Fields(fields, label)
    phi_i, theta_i = checked.ascending("phi_i"), checked.ascending("theta_i")
    leading = len(phi_i), len(theta_i)
    colours, source = _colours(checked, leading)
    vndf = checked.values("vndf", 4, leading=leading, non_negative=True)
    vndf = vndf.reshape(-1, *vndf.shape[2:])
    if not (vndf.max(axis=(1, 2)) > 0).all():
        raise FormatError(
            f"{label}: field 'vndf' is 0 everywhere for one of its {len(vndf)} directions: a density has an "
            "integral. It is damaged."
        )
    return RglBrdf(
        name=material_name(label),
        description=checked.text("description"),
        source=source,
        phi_i=phi_i,
        theta_i=theta_i,
        ndf=_interpolant(checked.values("ndf", 2, non_negative=True)),
        sigma=_interpolant(checked.values("sigma", 2, non_negative=True)),
        vndf=Warp.of(vndf),
        rgb=Interpolant(colours),
        has_jacobian=bool(checked.required("jacobian", 1, "u1").any()),
    )


def material_name(file: str) -> str:
    """The name in the database of the material in ``NAME_rgb.bsdf`` or ``NAME_spec.bsdf``."""
    return PurePath(file).stem.removesuffix("_rgb").removesuffix("_spec")


def _colours(fields: "_Fields", leading: tuple[int, int]) -> tuple[np.ndarray, str]:
    """Linear RGB at the nodes, shape (n_slices, r, r, 3), and where it comes from."""
    if fields.has("rgb"):
        return _channels_last(fields.values("rgb", 5, leading=(*leading, 3))), "RGB of the file"
    wavelengths = fields.ascending("wavelengths")
    spectra = fields.values("spectra", 5, leading=(*leading, len(wavelengths)))
    weights = rgb_weights(wavelengths).T.astype(np.float32)
    source = (
        f"{len(wavelengths)} wavelengths from {wavelengths[0]:.0f} to {wavelengths[-1]:.0f} nm, "
        f"CIE 1931 observer, illuminant {ILLUMINANT}"
    )
    return _channels_last(spectra) @ weights, source


def _channels_last(values: np.ndarray) -> np.ndarray:
    slices_first = values.reshape(-1, *values.shape[2:])
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

    def ascending(self, name: str) -> np.ndarray:
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
