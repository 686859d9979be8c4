"""`halfway_table`: a measured table as a Mitsuba 3 BSDF, exactly as `TabularBrdf` evaluates it.

Mitsuba calls the direction to the viewer ``si.wi`` and asks for the one to the light, ``wo``. In halfway ``wi`` points
to the light and ``wo`` to the viewer: they are swapped in `TableBsdf` and nowhere else. As for every Mitsuba BSDF,
``eval`` is f_r times the cosine of the light. Where no sample is measured nothing is reflected, and a negative value
(of a truncated reconstruction) counts as 0.

Angles come from the two directions without acos, so that float32 resolves the first cells of theta_h (0.01 degrees):

    H = wi + wo, u = wi - wo            perpendicular, of length 2 cos(theta_d) and 2 sin(theta_d)
    theta_h = atan2(|H_xy|, H_z)        theta_d = atan2(|u|, |H|)
    phi_d   = atan2((H_x u_y - H_y u_x) |H|, (H_x u_x + H_y u_y) H_z - u_z |H_xy|^2)

A table with an axis of phi_h is laid along the tangent of the surface, which is the x of Mitsuba's shading frame: where the
first texture coordinate grows. It may be turned against that about the normal.

In a spectral variant the value at a wavelength is that of three smooth primaries (`halfway.formats.spectra`), so that
its colour under D65 is the table's, and a mix has the mix of the spectra.

The class belongs to the Mitsuba variant that is set when this module is imported: `halfway.render.register` sees to it.
"""

from collections.abc import Sequence
from itertools import product
from pathlib import Path
from typing import Any

import drjit as dr
import mitsuba as mi
import numpy as np

from ..brdf import TabularBrdf, tabulate
from ..errors import RenderError
from ..formats import read_brdf, spectra
from ..halfdiff import Axis, Grid
from ..library import DEFAULT_LIBRARY, open_library
from ..recipes import Mixer, Recipe
from .sampling import HalfVectorSampling, buffer

VARIANT = mi.variant()
"""The Mitsuba variant that `TableBsdf` belongs to."""
UNMEASURED = -1e30
"""Stands for NaN in the renderer's buffer: NaN does not survive a compiler that assumes there is none."""


class TableBsdf(mi.BSDF):
    """A one-sided reflector whose values are those of a table.

    Parameters (of the plugin ``halfway_table``)
    ----------
    filename : string
        A file of any format that halfway reads.
    recipe : string
        In place of a file: ``"gold-paint=0.7, teflon=0.3"``.
    library : string
        Of the recipe: ``builtin:NAME`` (by default ``builtin:merl-abc``), a library folder, an archive of neural fits.
    values : tensor, float32, shape (3, n_theta_h, n_theta_d, n_phi_d) or (3, n_theta_h, n_phi_h, n_theta_d, n_phi_d)
        In place of a file: f_r in 1/sr at the cell centres of a MERL grid, or of an anisotropic one, NaN where unmeasured.
    turn : float
        By how many degrees an anisotropic material is turned against the tangent, counter-clockwise seen from outside.

    Traversable: ``table``, the samples as a flat buffer of 4 floats a cell (see `pack`), and ``turn``. After an update the
    importance sampling follows the new table; nothing is compiled again.
    """

    def __init__(self, props: Any, brdf: TabularBrdf | None = None) -> None:
        super().__init__(props)
        brdf = brdf or _read(props)
        self.grid = brdf.grid
        self.turn = dr.opaque(mi.Float, props.get("turn", 0.0))
        self.table = pack(brdf)
        self.sampling = HalfVectorSampling(brdf.grid)
        self.sampling.follow(self.values)
        self.primaries = buffer(_primaries()) if mi.is_spectral else None
        self.m_flags = mi.BSDFFlags.GlossyReflection | mi.BSDFFlags.FrontSide
        if not self.grid.is_isotropic:
            self.m_flags |= mi.BSDFFlags.Anisotropic
        self.m_components = [self.m_flags]

    def eval(self, ctx: Any, si: Any, wo: Any, active: Any = True) -> Any:
        wi, wo = self._laid(wo), self._laid(si.wi)
        active = active & self._enabled(ctx) & (wi.z > 0) & (wo.z > 0)
        return self._spectrum(self.values(wi, wo, active) * wi.z, si) & active

    def pdf(self, ctx: Any, si: Any, wo: Any, active: Any = True) -> Any:
        wi, wo = self._laid(wo), self._laid(si.wi)
        active = active & self._enabled(ctx) & (wi.z > 0) & (wo.z > 0)
        return dr.select(active, self.sampling.pdf(wi, wo, active), 0)

    def eval_pdf(self, ctx: Any, si: Any, wo: Any, active: Any = True) -> tuple[Any, Any]:
        return self.eval(ctx, si, wo, active), self.pdf(ctx, si, wo, active)

    def sample(
        self, ctx: Any, si: Any, sample1: Any, sample2: Any, active: Any = True
    ) -> tuple[Any, Any]:
        active = active & self._enabled(ctx) & (si.wi.z > 0)
        bs: Any = dr.zeros(mi.BSDFSample3f)
        wi = self.sampling.sample(self._laid(si.wi), sample1, sample2, active)
        bs.wo = self._laid(wi, back=True)
        bs.pdf = self.pdf(ctx, si, bs.wo, active)
        bs.eta = 1.0
        bs.sampled_type = mi.UInt32(+mi.BSDFFlags.GlossyReflection)
        bs.sampled_component = mi.UInt32(0)
        active = active & (bs.pdf > 0)
        weight = self.eval(ctx, si, bs.wo, active) / bs.pdf
        return bs, weight & active

    def eval_diffuse_reflectance(self, si: Any, active: Any = True) -> Any:
        """The material's mean reflectance: an albedo, as a denoiser's guide."""
        return self._spectrum(self.sampling.reflectance, si) & active

    def values(self, wi: Any, wo: Any, active: Any) -> Any:
        """f_r in 1/sr of pairs above the horizon: `TabularBrdf.eval`, never negative."""
        corners = multilinear(self.grid, wi, wo)
        total, measured = mi.Color3f(0), mi.Color3f(0)
        for cell, weight in corners:
            sample = dr.gather(mi.Vector4f, self.table, cell, active)
            sample = mi.Color3f(sample.x, sample.y, sample.z)
            weights = dr.select(sample > UNMEASURED / 2, weight, 0)
            total = dr.fma(weights, sample, total)
            measured += weights
        return dr.maximum(dr.select(measured > 0, total / measured, 0), 0)

    def traverse(self, cb: Any) -> None:
        cb.put("table", self.table, mi.ParamFlags.Differentiable)
        cb.put("turn", self.turn, mi.ParamFlags.NonDifferentiable)

    def parameters_changed(self, keys: Sequence[str] = ()) -> None:
        if not keys or "table" in keys:
            if dr.width(self.table) != 4 * self.grid.size:
                raise RenderError(
                    f"the new table has {dr.width(self.table)} floats: a {self.grid} grid takes {4 * self.grid.size}."
                )
            self.sampling.follow(self.values)

    def _laid(self, v: Any, *, back: bool = False) -> Any:
        """A direction in the frame of the table, of one in that of the surface; or ``back``."""
        if self.grid.is_isotropic:
            return v
        sin, cos = dr.sincos(self.turn * (np.pi / 180))
        sin = sin if back else -sin
        return mi.Vector3f(cos * v.x - sin * v.y, sin * v.x + cos * v.y, v.z)

    def _spectrum(self, color: Any, si: Any) -> Any:
        """The colour as this variant carries it."""
        if mi.is_monochromatic:
            return mi.Color1f(mi.luminance(color))
        if not mi.is_spectral:
            return color
        first, last = spectra.WAVELENGTHS[[0, -1]]
        position = (si.wavelengths - first) * ((len(spectra.WAVELENGTHS) - 1) / (last - first))
        spectrum = mi.UnpolarizedSpectrum(0)
        for i in range(len(spectrum)):
            at = dr.clip(position[i], 0, len(spectra.WAVELENGTHS) - 1)
            lower = dr.minimum(mi.UInt32(at), len(spectra.WAVELENGTHS) - 2)
            below, above = (
                dr.gather(mi.Vector4f, self.primaries, index) for index in (lower, lower + 1)
            )
            weights = dr.lerp(below, above, at - mi.Float(lower))
            spectrum[i] = weights.x * color.x + weights.y * color.y + weights.z * color.z
        return spectrum

    def _enabled(self, ctx: Any) -> bool:
        return ctx.is_enabled(mi.BSDFFlags.GlossyReflection)

    def to_string(self) -> str:
        return f"TableBsdf[{self.grid}]"


def pack(brdf: TabularBrdf) -> Any:
    """The samples as the renderer reads them, a Dr.Jit float array of 4 * grid.size: r, g, b, 0 of each cell."""
    red, green, blue = (_known(buffer(channel)) for channel in brdf.values)
    return dr.ravel(mi.Vector4f(red, green, blue, 0))


def _known(values: Any) -> Any:
    """The values, `UNMEASURED` for NaN."""
    bits: Any = dr.reinterpret_array(mi.UInt32, values)
    magnitude = bits & 0x7FFFFFFF
    return dr.select(magnitude > 0x7F800000, UNMEASURED, values)


def multilinear(grid: Grid, wi: Any, wo: Any) -> list[tuple[Any, Any]]:
    """Cells and weights of `Grid.multilinear`, for Dr.Jit's vectors."""
    angles = half_diff(wi, wo)
    sides = [_neighbours(axis, angles[axis.angle]) for axis in grid.axes]
    corners: list[tuple[Any, Any]] = []
    for corner in product(*sides):
        cell, weight = mi.UInt32(0), mi.Float(1)
        for axis, (index, fraction) in zip(grid.axes, corner, strict=True):
            cell = cell * axis.size + mi.UInt32(index)
            weight = weight * fraction
        corners.append((cell, weight))
    return corners


def half_diff(wi: Any, wo: Any) -> dict[str, Any]:
    """`to_half_diff` for Dr.Jit's vectors; the formulas are at the top of the module."""
    H, u = wi + wo, wi - wo
    across2 = dr.square(H.x) + dr.square(H.y)
    across, length = dr.sqrt(across2), dr.norm(H)
    # On the normal itself phi_h is 0, as atan2(0, 0) is.
    x = dr.select(across > 0, H.x / across, 1)
    y = dr.select(across > 0, H.y / across, 0)
    return {
        "theta_h": dr.atan2(across, H.z),
        "phi_h": dr.atan2(y, x),
        "theta_d": dr.atan2(dr.norm(u), length),
        "phi_d": dr.atan2((x * u.y - y * u.x) * length, (x * u.x + y * u.y) * H.z - u.z * across),
    }


def to_position(axis: Axis, angle: Any) -> Any:
    """`Axis.to_position` for Dr.Jit's floats."""
    share = angle * (1 / axis.stop)
    if axis.periodic:
        return axis.size * (share - dr.floor(share))
    share = dr.clip(share, 0, 1)
    if axis.power == 2:
        share = dr.sqrt(share)
    elif axis.power != 1:
        share = share ** (1 / axis.power)
    return axis.size * share


def _neighbours(axis: Axis, angle: Any) -> list[tuple[Any, Any]]:
    position = to_position(axis, angle) - 0.5
    floor = dr.floor(position)
    lower, fraction = mi.Int32(floor), position - floor
    upper = lower + 1
    if axis.periodic:
        lower = dr.select(lower < 0, axis.size - 1, lower)
        upper = dr.select(upper >= axis.size, 0, upper)
    # A direction that is no number must not read outside the table.
    last = axis.size - 1
    return [(dr.clip(lower, 0, last), 1 - fraction), (dr.clip(upper, 0, last), fraction)]


def _primaries() -> np.ndarray:
    """The smooth primaries as the renderer reads them, shape (n wavelengths, 4)."""
    return np.pad(spectra.smooth_primaries(spectra.WAVELENGTHS), [(0, 0), (0, 1)])


def _read(props: Any) -> TabularBrdf:
    if "values" in props:
        values = np.array(props["values"], np.float32)
        grid = Grid.merl if values.ndim == 4 else Grid.anisotropic
        return TabularBrdf(values, grid(*values.shape[1:]), name=props.id())
    if "recipe" in props:
        return _mixed(props.get("library", DEFAULT_LIBRARY), props["recipe"])
    if "filename" in props:
        file_resolver: Any = mi.file_resolver
        path = Path(str(file_resolver().resolve(props["filename"])))
        brdf = read_brdf(path)
        table = isinstance(brdf, TabularBrdf)
        return brdf if table else tabulate(brdf, brdf.own_grid, name=path.stem)
    raise RenderError(
        "halfway_table has neither a filename, nor a recipe, nor values: expected one of them."
    )


def _mixed(library: str, recipe: str) -> TabularBrdf:
    return Mixer(open_library(library)).mix(Recipe.from_text(library, recipe))
