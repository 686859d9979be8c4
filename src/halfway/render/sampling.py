"""Importance sampling of a table: a cosine lobe for its diffuse floor, tabulated half vectors for the rest.

The best density for a view ``wo`` is proportional to f_r cos(theta_i). Near a highlight it is smooth in the half vector
``h``, so it is tabulated there, for a few view angles theta_o, over the cosine drop x = 1 - cos(theta_h) and the azimuth
phi of ``h`` against the view (dh = dx dphi, so no Jacobian is left; the two sides of the plane of incidence are
averaged):

    q(h) = max(0, f_r - c) cos(theta_i) 4 (wo . h)         bilinear between nodes in (x, phi)
    p(wi) = a cos(theta_i) / pi + (1 - a) q(h) / (4 (wo . h) integral of q)

c is the diffuse floor of that view angle and ``a`` the share of the albedo that it makes. The nodes in x are the table's own
cell centres in theta_h: between them a trilinear table has no structure that bilinear interpolation would miss. Between two view
angles one of the neighbours is chosen at random, in proportion, and the density is the blend of both.

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

N_VIEWS = 24
"""View angles, evenly spaced from 0 to the last, `STEEPEST_VIEW`."""
STEEPEST_VIEW = np.radians(89.0)
VIEWS = np.linspace(0, STEEPEST_VIEW, N_VIEWS)
N_AZIMUTHS = 16
"""Cells in phi over half a turn."""
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
        theta_h = np.concatenate([[0], self._axis.centres(), [self._axis.stop]])
        azimuths = np.linspace(0, np.pi, N_AZIMUTHS + 1)
        self._steps = np.diff(2 * np.sin(theta_h / 2) ** 2)
        self._drops = buffer(2 * np.sin(theta_h / 2) ** 2)
        self._n_rows = len(self._steps)
        wi, wo, self._jacobian = _pairs(theta_h, azimuths)
        self._wi, self._wo = (mi.Vector3f(*map(buffer, v)) for v in (wi, wo))
        self._measure = (
            self._jacobian * np.outer(_trapezoid(self._steps), _trapezoid(np.diff(azimuths))) / 2
        )

    def follow(self, values: Callable[[Any, Any, Any], Any]) -> None:
        """Take the density of a table, given its f_r of pairs of directions (light, viewer, mask)."""
        f = np.array(values(self._wi, self._wo, True)).reshape(3, *self._jacobian.shape)
        grey = f.mean(axis=0) * (self._jacobian > 0)
        floor = _quantiles(grey, self._measure)
        rest = np.maximum(grey - floor[:, None, None, None], 0)
        density, totals = _normalised((rest * self._jacobian).mean(axis=1), self._steps)
        self._cells = buffer(density.cells)
        self._rows = buffer(density.rows)
        self._columns = buffer(density.columns)
        self._shares = buffer(_shares(np.pi * floor, totals))

        albedo = np.einsum("cksij,ksij->kc", f, 2 * self._measure)
        weight = np.sin(2 * VIEWS)
        self.reflectance = mi.Color3f(*map(buffer, weight @ albedo / weight.sum()))

    def pdf(self, wi: Any, wo: Any, active: Any) -> Any:
        """Density of ``wi`` per solid angle, given the view ``wo``."""
        view, fraction = self._view(wo)
        share = self._share(view, fraction, active)
        H = wi + wo
        length = dr.norm(H)
        across2 = dr.square(H.x) + dr.square(H.y)
        row = self._row(dr.atan2(dr.sqrt(across2), H.z))
        x = across2 / (length * (length + H.z))
        turn = dr.atan2(wo.x * H.y - wo.y * H.x, wo.x * H.x + wo.y * H.y)
        column = dr.abs(turn) * (N_AZIMUTHS / np.pi)
        q = dr.lerp(
            self._density(view, row, x, column, active),
            self._density(view + 1, row, x, column, active),
            fraction,
        )
        return share * wi.z / np.pi + (1 - share) * q / (2 * length)

    def sample(self, wo: Any, sample1: Any, sample2: Any, active: Any) -> Any:
        """A direction to the light for the view ``wo``; it may fall below the horizon.

        ``sample2`` chooses the lobe too, and each lobe gets a stretch of it: strata of the sampler stay strata.
        """
        view, fraction = self._view(wo)
        share = self._share(view, fraction, active)
        is_diffuse = sample2.x < share
        x = dr.select(is_diffuse, sample2.x / share, (sample2.x - share) / (1 - share))
        sample2 = mi.Point2f(dr.minimum(x, dr.one_minus_epsilon(mi.Float)), sample2.y)
        diffuse = mi.warp.square_to_cosine_hemisphere(sample2)
        view = dr.select(sample1 < fraction, view + 1, view)
        h = self._half_vector(wo, view, sample2, active)
        glossy = dr.normalize(2 * dr.dot(wo, h) * h - wo)
        return dr.select(is_diffuse, diffuse, glossy)

    def _half_vector(self, wo: Any, view: Any, sample: Any, active: Any) -> Any:
        row, u = _search(self._rows, view * (self._n_rows + 1), self._n_rows, sample.x, active)
        side = 2 * sample.y - 1
        cell = view * self._n_rows + row
        column, v = _search(
            self._columns, cell * (N_AZIMUTHS + 1), N_AZIMUTHS, dr.abs(side), active
        )
        q = dr.gather(mi.Vector4f, self._cells, cell * N_AZIMUTHS + column, active)
        inside, _ = mi.warp.square_to_bilinear(q.x, q.y, q.z, q.w, mi.Point2f(u, v))
        lower, upper = self._edges(row, active)
        x = dr.lerp(lower, upper, inside.x)
        phi = dr.mulsign((mi.Float(column) + inside.y) * (np.pi / N_AZIMUTHS), side)
        sin_phi, cos_phi = dr.sincos(phi)
        across = dr.sqrt(dr.square(wo.x) + dr.square(wo.y))
        cos_o = dr.select(across > 0, wo.x / across, 1)
        sin_o = dr.select(across > 0, wo.y / across, 0)
        sin_theta = dr.safe_sqrt(x * (2 - x))
        return mi.Vector3f(
            sin_theta * (cos_o * cos_phi - sin_o * sin_phi),
            sin_theta * (sin_o * cos_phi + cos_o * sin_phi),
            1 - x,
        )

    def _density(self, view: Any, row: Any, x: Any, column: Any, active: Any) -> Any:
        j = dr.minimum(mi.UInt32(column), N_AZIMUTHS - 1)
        cell = (view * self._n_rows + row) * N_AZIMUTHS + j
        q = dr.gather(mi.Vector4f, self._cells, cell, active)
        lower, upper = self._edges(row, active)
        u = dr.clip((x - lower) / (upper - lower), 0, 1)
        return dr.lerp(dr.lerp(q.x, q.y, u), dr.lerp(q.z, q.w, u), column - mi.Float(j))

    def _view(self, wo: Any) -> tuple[Any, Any]:
        theta = dr.atan2(dr.sqrt(dr.square(wo.x) + dr.square(wo.y)), wo.z)
        position = dr.clip(theta * ((N_VIEWS - 1) / STEEPEST_VIEW), 0, N_VIEWS - 1)
        view = dr.minimum(mi.UInt32(position), N_VIEWS - 2)
        return view, position - mi.Float(view)

    def _share(self, view: Any, fraction: Any, active: Any) -> Any:
        here, there = dr.gather(mi.Vector2f, self._shares, view, active)
        return dr.lerp(here, there, fraction)

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


def _pairs(theta_h: np.ndarray, azimuths: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Lights and viewers, shape (3, n), of the nodes; and cos(theta_i) 4 (wo . h), shape (view, side, row node, column node).

    The last is 0 where a pair is not above the horizon.
    """
    shape = (N_VIEWS, 2, len(theta_h), len(azimuths))
    sides = np.array([1.0, -1.0])
    v, s, t, p = (a.ravel() for a in np.meshgrid(VIEWS, sides, theta_h, azimuths, indexing="ij"))
    h = np.stack([np.sin(t) * np.cos(p), s * np.sin(t) * np.sin(p), np.cos(t)])
    wo = np.stack([np.sin(v), 0 * v, np.cos(v)])
    cos_d = (h * wo).sum(axis=0)
    wi = reflect(wo.T, h.T, cos_d).T
    lit = (cos_d > 0) & (wi[2] > 0)
    return wi, wo, np.where(lit, 4 * cos_d * wi[2], 0).reshape(shape)


def _trapezoid(steps: np.ndarray) -> np.ndarray:
    """Weights of the trapezoidal rule on nodes that are so far apart."""
    return (np.append(steps, 0) + np.append(0, steps)) / 2


def _quantiles(values: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """For each view, the value that `FLOOR_QUANTILE` of the weight stays below.

    Both sides are alike, and azimuths are dense: one side and every second azimuth say enough, in a quarter of the time.
    """
    values, weights = (a[:, 0, :, ::2].reshape(N_VIEWS, -1) for a in (values, weights))
    order = np.argsort(values, axis=-1)
    below = np.cumsum(np.take_along_axis(weights, order, -1), axis=-1)
    at = (below < FLOOR_QUANTILE * below[:, -1:]).sum(axis=-1, keepdims=True)
    return np.take_along_axis(values, np.take_along_axis(order, at, -1), -1)[:, 0]


def _normalised(q: np.ndarray, steps: np.ndarray) -> tuple[_Density, np.ndarray]:
    """The density of nodes, shape (view, row node, column node), and its integrals over both sides."""
    corners = np.stack([q[:, :-1, :-1], q[:, 1:, :-1], q[:, :-1, 1:], q[:, 1:, 1:]], axis=-1)
    mass = corners.mean(axis=-1) * steps[:, None] * (np.pi / N_AZIMUTHS)
    totals = 2 * mass.sum(axis=(1, 2))
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
    """Share of the cosine lobe at each view angle and the next, flat."""
    share = floors / np.maximum(floors + rests, np.finfo(float).tiny)
    share = np.where(rests > 0, np.clip(share, DEFENCE, 1), 1)
    return np.stack([share[:-1], share[1:]], axis=-1).ravel()


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
