"""Interpolation and warping of functions on the unit square that depend on parameters.

RGL's `.bsdf` files store functions of u = (u_theta, u_phi) at evenly spaced nodes of the unit square, for a list of
values of each parameter (phi_i, theta_i). In between they are bilinear in u and linear in the parameters:

    f(u; p) = sum_s w_s(p) f_s(u)              s: the slices around p; w_s >= 0, summing to 1

A `Warp` reads f(.; p) as a density and maps the square to itself so that the image of an evenly spread point follows
the density: u_phi by the marginal distribution, then u_theta by the conditional one, both continuous. `invert` is its
inverse, which is what evaluation needs; `sample` is needed to place the samples of a file to write.

Source: J. Dupuy, W. Jakob, "An Adaptive Parameterization for Efficient Material Acquisition and Rendering", ACM TOG
37(6), 2018, section 4, and the conventions of the readers (Mitsuba's `measured` and rgl-epfl/brdf-loader).
"""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product
from typing import NamedTuple

import numpy as np

from .._types import Indices

Coordinate = np.ndarray
"""One coordinate of n points, shape (n,)."""


class Slices(NamedTuple):
    """The slices that each of n points blends: pairs of arrays of shape (n,), or () where no parameter matters."""

    indices: list[Indices]
    weights: list[Coordinate]


def slices(axes: tuple[np.ndarray, ...], parameters: tuple[Coordinate, ...]) -> Slices:
    """The slices around each point and their weights; linear between the values of an axis, constant beyond.

    ``axes`` are the ascending values of each parameter, the last varying fastest; an axis with one value stands for
    no dependence.
    """
    sides = [_sides(axis, p) for axis, p in zip(axes, parameters, strict=True)]
    indices: list[Indices] = []
    weights: list[Coordinate] = []
    for corner in product(*sides):
        index, weight = np.zeros((), np.intp), np.ones(())
        for axis, (i, w) in zip(axes, corner, strict=True):
            index, weight = index * len(axis) + i, weight * w
        indices.append(index)
        weights.append(weight)
    return Slices(indices, weights)


def _sides(axis: np.ndarray, p: Coordinate) -> list[tuple[Indices, Coordinate]]:
    if len(axis) == 1:
        return [(np.zeros(p.shape, np.intp), np.ones(p.shape))]
    i = np.clip(np.searchsorted(axis, p) - 1, 0, len(axis) - 2)
    w = np.clip((p - axis[i]) / (axis[i + 1] - axis[i]), 0, 1)
    return [(i, 1 - w), (i + 1, w)]


@dataclass(frozen=True, eq=False)
class Interpolant:
    """Values at the nodes of the square, shape (n_slices, n_phi, n_theta, n_channels)."""

    nodes: np.ndarray

    def at(self, u_theta: Coordinate, u_phi: Coordinate, where: Slices) -> np.ndarray:
        """Bilinear values, shape (n, n_channels)."""
        _, n_phi, n_theta, n_channels = self.nodes.shape
        x, fx = _split(u_theta, n_theta)
        y, fy = _split(u_phi, n_phi)
        flat = self.nodes.reshape(-1, n_channels)
        total = np.zeros((*np.shape(u_theta), n_channels))
        for index, weight in zip(*where, strict=True):
            for dy, dx in product((0, 1), (0, 1)):
                corner = weight * (fy if dy else 1 - fy) * (fx if dx else 1 - fx)
                node = (index * n_phi + y + dy) * n_theta + x + dx
                total += corner[..., None] * flat[node]
        return total


@dataclass(frozen=True, eq=False)
class Warp:
    """The density whose values at the nodes are ``density``, shape (n_slices, n_phi, n_theta), each slice of integral 1.

    ``conditional[s, y, x]`` is the integral of row y from 0 to node x, ``marginal[s, y]`` that of the rows from 0 to
    node y; both by the trapezoidal rule, which is exact for what is linear between nodes.
    """

    density: np.ndarray
    conditional: np.ndarray
    marginal: np.ndarray

    @classmethod
    def of(cls, values: np.ndarray) -> "Warp":
        """The warp of non-negative values at the nodes, each slice normalised."""
        conditional = _cumulative(np.asarray(values, np.float64))
        marginal = _cumulative(conditional[..., -1])
        total = marginal[..., -1]
        return cls(
            values / total[:, None, None],
            conditional / total[:, None, None],
            marginal / total[:, None],
        )

    def invert(
        self, u_theta: Coordinate, u_phi: Coordinate, where: Slices
    ) -> tuple[Coordinate, Coordinate]:
        """The point (s_theta, s_phi) that the warp takes to ``(u_theta, u_phi)``."""
        n_phi, n_theta = self.density.shape[-2:]
        x, fx = _split(u_theta, n_theta)
        y, fy = _split(u_phi, n_phi)

        def along(table: np.ndarray, x: Indices) -> Coordinate:
            """The table's values between rows y and y + 1, at node x of each."""
            rows = _blend(table, (y, x), where), _blend(table, (y + 1, x), where)
            return (1 - fy) * rows[0] + fy * rows[1]

        below = along(self.conditional, x) + _area(
            fx, along(self.density, x), along(self.density, x + 1)
        ) / (n_theta - 1)
        last = np.full_like(x, n_theta - 1)
        row_0, row_1 = (_blend(self.conditional, (row, last), where) for row in (y, y + 1))
        row = (1 - fy) * row_0 + fy * row_1
        s_theta = np.divide(below, row, out=np.zeros_like(below), where=row > 0)
        s_phi = _blend(self.marginal, (y,), where) + _area(fy, row_0, row_1) / (n_phi - 1)
        return s_theta, s_phi

    def sample(
        self, s_theta: Coordinate, s_phi: Coordinate, i_slice: int
    ) -> tuple[Coordinate, Coordinate]:
        """The point ``(u_theta, u_phi)`` to which one slice's warp takes ``(s_theta, s_phi)``."""
        density, conditional, marginal = (
            table[i_slice] for table in (self.density, self.conditional, self.marginal)
        )
        n_phi, n_theta = density.shape
        rows = conditional[:, -1]
        y = np.clip(np.searchsorted(marginal, s_phi) - 1, 0, n_phi - 2)
        fy = _inverse_area((s_phi - marginal[y]) * (n_phi - 1), rows[y], rows[y + 1])
        below = (1 - fy)[:, None] * conditional[y] + fy[:, None] * conditional[y + 1]
        target = s_theta * below[:, -1]
        x = np.clip(np.sum(below < target[:, None], axis=1) - 1, 0, n_theta - 2)
        points = np.arange(len(x))
        left, right = ((1 - fy) * density[y, x + dx] + fy * density[y + 1, x + dx] for dx in (0, 1))
        fx = _inverse_area((target - below[points, x]) * (n_theta - 1), left, right)
        return (x + fx) / (n_theta - 1), (y + fy) / (n_phi - 1)


def _split(u: Coordinate, n_nodes: int) -> tuple[Indices, Coordinate]:
    """The node below each point and the fraction of the way to the next."""
    position = np.clip(u, 0, 1) * (n_nodes - 1)
    node = np.minimum(position.astype(np.intp), n_nodes - 2)
    return node, position - node


def _blend(table: np.ndarray, at: tuple[Indices, ...], where: Slices) -> Coordinate:
    terms: Iterator[Coordinate] = (w * table[(i, *at)] for i, w in zip(*where, strict=True))
    return sum(terms, start=np.zeros(np.shape(at[0])))


def _cumulative(values: np.ndarray) -> np.ndarray:
    """Integrals from 0 to each node of functions that are linear between evenly spaced nodes of [0, 1]."""
    result = np.zeros_like(values)
    np.cumsum((values[..., 1:] + values[..., :-1]) / 2, axis=-1, out=result[..., 1:])
    return result / (values.shape[-1] - 1)


def _area(t: Coordinate, left: Coordinate, right: Coordinate) -> Coordinate:
    """The integral from 0 to t of the line from ``left`` at 0 to ``right`` at 1."""
    return t * (left + t * (right - left) / 2)


def _inverse_area(area: Coordinate, left: Coordinate, right: Coordinate) -> Coordinate:
    """The t in [0, 1] at which `_area` is ``area``; 0 where the line is 0."""
    root = np.sqrt(np.maximum(left * left + 2 * area * (right - left), 0))
    with np.errstate(divide="ignore", invalid="ignore"):
        # This form of the quadratic's solution neither divides by right - left nor cancels.
        return np.nan_to_num(np.clip(2 * area / (left + root), 0, 1))
