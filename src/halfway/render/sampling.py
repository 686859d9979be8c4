"""Importance sampling of a table: a cosine lobe for its diffuse floor, tabulated half vectors for the rest.

The best density for a view ``wo`` is proportional to f_r cos(theta_i). Near a highlight it is smooth in the half vector
``h``, so it is tabulated there, for a few views, over the cosine drop x = 1 - cos(theta_h) and an azimuth phi of ``h``
(dh = dx dphi, so no Jacobian is left):

    q(h) = max(0, f_r - c) cos(theta_i) 4 (wo . h)         bilinear between nodes in (x, phi)
    p(wi) = a cos(theta_i) / pi + (1 - a) q(h) / (4 (wo . h) integral of q)

c is the diffuse floor of that view and ``a`` the share of the albedo that it makes. The nodes in x are the table's own
cell centres in theta_h: between them a multilinear table has no structure that bilinear interpolation would miss. Between
views one of the neighbours is chosen at random, in proportion, and the density is the blend of them. What a view is, and
from where phi counts, depends on whether a highlight turns with the view (`azimuths`).

A cell of the density is found by its cumulative sums (rows by one coordinate of the sample, columns by the other, so stratified
samples stay stratified), a point in it by the closed form of a bilinear density. The first coordinate chooses the lobe before that.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import drjit as dr
import mitsuba as mi
import numpy as np
from numpy.typing import ArrayLike

from ..halfdiff import Grid, reflect
from .azimuths import AboutTangent, AboutView, View

STEEPEST_VIEW = np.radians(89.0)
"""Views are evenly spaced from 0 to it."""
DEFENCE = 0.02
"""The least share of the cosine lobe: it bounds the weight where the tabulated density is too low."""
FLOOR_QUANTILE = 0.25
"""The diffuse floor is the value that this share of the reflected solid angle (cosine-weighted) stays below."""


class HalfVectorSampling:
    """The density of one table, on the device, for tables of one grid; finished when `follow` has seen a table.

    Attributes
    ----------
    reflectance : Color3f
        Mean reflectance: the share of evenly diffuse light that leaves the surface.
    """

    def __init__(self, grid: Grid) -> None:
        self._axis = grid.axis("theta_h")
        self._azimuths = AboutView() if grid.is_isotropic else AboutTangent(grid.axis("phi_h"))
        self._thetas = np.linspace(0, STEEPEST_VIEW, self._azimuths.n_thetas)
        theta_h = np.concatenate([[0], self._axis.centres(), [self._axis.stop]])
        self._steps = np.diff(2 * np.sin(theta_h / 2) ** 2)
        self._drops = buffer(2 * np.sin(theta_h / 2) ** 2)
        self._n_rows, self._n_columns = len(self._steps), self._azimuths.n_columns
        of_views = self._azimuths.of_views
        views = np.repeat(self._thetas, len(of_views)), np.tile(of_views, len(self._thetas))
        azimuths = np.multiply.outer(self._azimuths.sides, self._azimuths.nodes)
        wi, wo, self._jacobian = _pairs(*views, theta_h, azimuths)
        self._wi, self._wo = (mi.Vector3f(*map(buffer, v)) for v in (wi, wo))
        columns = np.full(self._n_columns, self._azimuths.step)
        self._measure = self._jacobian * np.outer(_trapezoid(self._steps), _trapezoid(columns))

    def follow(self, values: Callable[[Any, Any, Any], Any]) -> None:
        """Take the density of a table, given its f_r of pairs of directions (light, viewer, mask)."""
        f = np.array(values(self._wi, self._wo, True)).reshape(3, *self._jacobian.shape)
        grey = f.mean(axis=0) * (self._jacobian > 0)
        floor = _quantiles(grey, self._measure)
        rest = np.maximum(grey - floor[:, None, None, None], 0)
        areas = self._steps[:, None] * self._azimuths.step * len(self._azimuths.sides)
        density, totals = _normalised((rest * self._jacobian).mean(axis=1), areas)
        self._cells = buffer(density.cells)
        self._rows = buffer(density.rows)
        self._columns = buffer(density.columns)
        self._shares = buffer(_shares(np.pi * floor, totals))

        albedo = np.einsum("cksij,ksij->kc", f, self._measure)
        weight = np.repeat(np.sin(2 * self._thetas), len(self._azimuths.of_views))
        self.reflectance = mi.Color3f(*map(buffer, weight @ albedo / weight.sum()))

    def pdf(self, wi: Any, wo: Any, active: Any) -> Any:
        """Density of ``wi`` per solid angle, given the view ``wo``."""
        views = self._views(wo)
        share = self._share(views, active)
        H = wi + wo
        length = dr.norm(H)
        across2 = dr.square(H.x) + dr.square(H.y)
        row = self._row(dr.atan2(dr.sqrt(across2), H.z))
        x = across2 / (length * (length + H.z))
        column = self._azimuths.to_column(wo, H)
        q = mi.Float(0)
        for view, weight in views:
            q = dr.fma(weight, self._density(view, row, x, column, active), q)
        return share * wi.z / np.pi + (1 - share) * q / (2 * length)

    def sample(self, wo: Any, sample1: Any, sample2: Any, active: Any) -> Any:
        """A direction to the light for the view ``wo``; it may fall below the horizon.

        ``sample2`` chooses the lobe too, and each lobe gets a stretch of it: strata of the sampler stay strata.
        """
        views = self._views(wo)
        share = self._share(views, active)
        is_diffuse = sample2.x < share
        x = dr.select(is_diffuse, sample2.x / share, (sample2.x - share) / (1 - share))
        sample2 = mi.Point2f(dr.minimum(x, dr.one_minus_epsilon(mi.Float)), sample2.y)
        diffuse = mi.warp.square_to_cosine_hemisphere(sample2)
        h = self._half_vector(wo, _chosen(views, sample1), sample2, active)
        glossy = dr.normalize(2 * dr.dot(wo, h) * h - wo)
        return dr.select(is_diffuse, diffuse, glossy)

    def _half_vector(self, wo: Any, view: Any, sample: Any, active: Any) -> Any:
        row, u = _search(self._rows, view * (self._n_rows + 1), self._n_rows, sample.x, active)
        share, side = self._azimuths.to_side(sample.y)
        cell = view * self._n_rows + row
        n = self._n_columns
        column, v = _search(self._columns, cell * (n + 1), n, share, active)
        q = dr.gather(mi.Vector4f, self._cells, cell * n + column, active)
        inside, _ = mi.warp.square_to_bilinear(q.x, q.y, q.z, q.w, mi.Point2f(u, v))
        lower, upper = self._edges(row, active)
        x = dr.lerp(lower, upper, inside.x)
        cos_phi, sin_phi = self._azimuths.to_azimuth(wo, mi.Float(column) + inside.y, side)
        sin_theta = dr.safe_sqrt(x * (2 - x))
        return mi.Vector3f(sin_theta * cos_phi, sin_theta * sin_phi, 1 - x)

    def _density(self, view: Any, row: Any, x: Any, column: Any, active: Any) -> Any:
        j = dr.minimum(mi.UInt32(column), self._n_columns - 1)
        cell = (view * self._n_rows + row) * self._n_columns + j
        q = dr.gather(mi.Vector4f, self._cells, cell, active)
        lower, upper = self._edges(row, active)
        u = dr.clip((x - lower) / (upper - lower), 0, 1)
        return dr.lerp(dr.lerp(q.x, q.y, u), dr.lerp(q.z, q.w, u), column - mi.Float(j))

    def _views(self, wo: Any) -> list[View]:
        """The tabulated views about one, and their weights."""
        theta = dr.atan2(dr.sqrt(dr.square(wo.x) + dr.square(wo.y)), wo.z)
        last = self._azimuths.n_thetas - 1
        position = dr.clip(theta * (last / STEEPEST_VIEW), 0, last)
        lower = dr.minimum(mi.UInt32(position), last - 1)
        fraction = position - mi.Float(lower)
        return self._azimuths.around(wo, [(lower, 1 - fraction), (lower + 1, fraction)])

    def _share(self, views: list[View], active: Any) -> Any:
        share = mi.Float(0)
        for view, weight in views:
            share = dr.fma(weight, dr.gather(mi.Float, self._shares, view, active), share)
        return share

    def _row(self, theta_h: Any) -> Any:
        """The row between two nodes: they stand at positions 0, 1/2, 3/2, ..., n - 1/2, n."""
        position = self._axis.size * dr.sqrt(dr.clip(theta_h / self._axis.stop, 0, 1))
        return mi.UInt32(position + 0.5)

    def _edges(self, row: Any, active: Any) -> tuple[Any, Any]:
        return dr.gather(mi.Float, self._drops, row, active), dr.gather(
            mi.Float, self._drops, row + 1, active
        )


def buffer(values: ArrayLike) -> Any:
    """A Dr.Jit float array of these values.

    On the CPU Dr.Jit maps numpy's memory as it lies, and compiles anew for another alignment: so it lies at a multiple of
    64 bytes.
    """
    flat = np.ravel(values)
    if dr.backend_v(mi.Float) == dr.JitBackend.CUDA:
        return mi.Float(np.asarray(flat, np.float32))
    spare = np.empty(flat.size + 16, np.float32)
    start = -spare.ctypes.data % 64 // 4
    aligned = spare[start : start + flat.size]
    aligned[:] = flat
    return mi.Float(aligned)


class _Density(NamedTuple):
    """A bilinear density over the cells of a grid, one per view angle, as it is looked up."""

    cells: np.ndarray  # (view, row, column, 4): the density at the cell's corners; x runs fastest
    rows: np.ndarray  # (view, row + 1): cumulative share of the rows
    columns: np.ndarray  # (view, row, column + 1): cumulative share of the cells of a row


def _pairs(
    thetas: np.ndarray, phis: np.ndarray, theta_h: np.ndarray, azimuths: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Lights and viewers, shape (3, n), of the nodes; and cos(theta_i) 4 (wo . h), shape (view, side, row node, column node).

    Views are at (thetas, phis), and the azimuths of half vectors of shape (side, column node). The cosines are 0 where a pair
    is not above the horizon.
    """
    shape = (len(thetas), len(azimuths), len(theta_h), azimuths.shape[1])
    t, p = theta_h[:, None], azimuths[:, None, :]
    wo = _direction(thetas[:, None, None, None], phis[:, None, None, None], shape)
    h = _direction(t, p, shape)
    cos_d = (h * wo).sum(axis=-1)
    wi = reflect(wo, h, cos_d)
    lit = (cos_d > 0) & (wi[..., 2] > 0)
    jacobian = np.where(lit, 4 * cos_d * wi[..., 2], 0)
    return wi.reshape(-1, 3).T, wo.reshape(-1, 3).T, jacobian


def _direction(theta: np.ndarray, phi: np.ndarray, shape: tuple[int, ...]) -> np.ndarray:
    sin = np.sin(theta)
    parts = (sin * np.cos(phi), sin * np.sin(phi), np.cos(theta))
    return np.stack([np.broadcast_to(part, shape) for part in parts], axis=-1)


def _trapezoid(steps: np.ndarray) -> np.ndarray:
    """Weights of the trapezoidal rule on nodes that are so far apart."""
    return (np.append(steps, 0) + np.append(0, steps)) / 2


def _quantiles(values: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """For each view, the value that `FLOOR_QUANTILE` of the weight stays below.

    Both sides are alike, and azimuths are dense: one side and every second azimuth say enough, in a quarter of the time.
    """
    values, weights = (a[:, 0, :, ::2].reshape(len(a), -1) for a in (values, weights))
    order = np.argsort(values, axis=-1)
    below = np.cumsum(np.take_along_axis(weights, order, -1), axis=-1)
    at = (below < FLOOR_QUANTILE * below[:, -1:]).sum(axis=-1, keepdims=True)
    return np.take_along_axis(values, np.take_along_axis(order, at, -1), -1)[:, 0]


def _normalised(q: np.ndarray, areas: np.ndarray) -> tuple[_Density, np.ndarray]:
    """The density of nodes, shape (view, row node, column node), over cells of so much measure, and its integrals."""
    corners = np.stack([q[:, :-1, :-1], q[:, 1:, :-1], q[:, :-1, 1:], q[:, 1:, 1:]], axis=-1)
    mass = corners.mean(axis=-1) * areas
    totals = mass.sum(axis=(1, 2))
    scale = 1 / np.maximum(totals, np.finfo(float).tiny)
    density = _Density(
        cells=corners * scale[:, None, None, None],
        rows=_cumulative(mass.sum(axis=2)),
        columns=_cumulative(mass),
    )
    return density, totals


def _cumulative(mass: np.ndarray) -> np.ndarray:
    sums = np.cumsum(mass, axis=-1)
    last = np.maximum(sums[..., -1:], np.finfo(float).tiny)
    return np.concatenate([np.zeros_like(last), sums / last], axis=-1)


def _shares(floors: np.ndarray, rests: np.ndarray) -> np.ndarray:
    """Share of the cosine lobe at each view."""
    share = floors / np.maximum(floors + rests, np.finfo(float).tiny)
    return np.where(rests > 0, np.clip(share, DEFENCE, 1), 1)


def _chosen(views: list[View], sample: Any) -> Any:
    """One of the views, as often as its weight says."""
    (chosen, _), *others = views
    for view, weight in others:
        chosen = dr.select((sample >= 0) & (sample < weight), view, chosen)
        sample = sample - weight
    return chosen


def _search(cumulative: Any, start: Any, size: int, sample: Any, active: Any) -> tuple[Any, Any]:
    """The interval of ``cumulative[start : start + size + 1]`` that holds ``sample``, and where in it."""
    lower, upper = mi.UInt32(0), mi.UInt32(size)
    for _ in range((size - 1).bit_length()):
        middle = (lower + upper) >> 1
        beyond = dr.gather(mi.Float, cumulative, start + middle, active) <= sample
        lower = dr.select(beyond, middle, lower)
        upper = dr.select(beyond, upper, middle)
    below = dr.gather(mi.Float, cumulative, start + lower, active)
    above = dr.gather(mi.Float, cumulative, start + lower + 1, active)
    return lower, dr.clip((sample - below) / (above - below), 0, 1)
