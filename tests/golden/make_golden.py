"""Values on which Python and TypeScript must agree: ``python tests/golden/make_golden.py`` writes them.

Python's are the reference. ``viewer/tests`` reads the files, and ``tests/test_server.py`` checks that they are current.
"""

import base64
import json
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from halfway.brdf import TabularBrdf, directional_albedo
from halfway.halfdiff import MERL, Grid, HalfDiff, from_half_diff, to_half_diff
from halfway.library import ProceduralLibrary
from halfway.render.pictures import to_8_bit
from halfway.server.blocks import Block

HERE = Path(__file__).parent
GRID = Grid.merl(4, 3, 6)
WITH_PHI_H = Grid.anisotropic(4, 5, 3, 6, period=np.pi)


def golden() -> dict[str, Any]:
    """Each file's contents, by its name."""
    return {
        "halfdiff": _half_diff(),
        "grid": _grid(),
        "lookup": _lookup(GRID),
        "lookup_with_phi_h": _lookup(WITH_PHI_H),
        "albedo": _albedo(GRID),
        "albedo_with_phi_h": _albedo(WITH_PHI_H),
        "route": _route(),
        "points": _points(),
        "colour": _colour(),
    }


def _directions(rng: np.random.Generator, n: int) -> np.ndarray:
    v = rng.normal(size=(n, 3))
    v[:, 2] = np.abs(v[:, 2])
    return v / np.linalg.norm(v, axis=1, keepdims=True)


def _half_diff() -> list[dict[str, Any]]:
    rng = np.random.default_rng(1)
    wi, wo = _directions(rng, 40), _directions(rng, 40)
    # Near the pole, where acos loses digits: the first cells of theta_h are 0.011 degrees wide.
    tiny = HalfDiff(
        *(
            np.array(x)
            for x in ([1e-5, 1e-4, 2e-4], [0.3, 2.0, -1.0], [0.2, 0.9, 1.4], [0.5, -2.0, 3.0])
        )
    )
    near_i, near_o = from_half_diff(tiny)
    wi, wo = np.concatenate([wi, near_i]), np.concatenate([wo, near_o])
    angles = to_half_diff(wi, wo)
    return [
        {
            "wi": wi[i].tolist(),
            "wo": wo[i].tolist(),
            "angles": [float(angle[i]) for angle in angles],
        }
        for i in range(len(wi))
    ]


def _grid() -> list[dict[str, Any]]:
    rows: list[dict[str, Any]] = []
    for axis in MERL.axes:
        low = -axis.stop if axis.periodic else 0.0
        angles = [*np.linspace(low, axis.stop, 23, endpoint=not axis.periodic), 1e-4]
        centres = axis.centres()[[0, 1, -1]]
        rows += [
            {
                "axis": vars(axis),
                "angle": float(angle),
                "position": float(axis.to_position(np.array(angle))),
            }
            for angle in [*angles, *centres]
        ]
    return rows


def _table(grid: Grid) -> TabularBrdf:
    """Half floats, so that nothing is rounded; some samples unmeasured that the mask has, others as the mask says."""
    values = (
        np.random.default_rng(2)
        .gamma(0.5, size=(3, *grid.shape))
        .astype(np.float16)
        .astype(np.float32)
    )
    values[0] *= 2.0**17
    values[:, ~grid.mask()] = np.nan
    values[:, 1, ..., 1, 2] = np.nan
    return TabularBrdf(values, grid, name="golden")


def _lookup(grid: Grid) -> dict[str, Any]:
    table = _table(grid)
    block = Block.of_table(table)
    rng = np.random.default_rng(3)
    wi, wo = _directions(rng, 60), _directions(rng, 60)
    wi[0, 2] *= -1
    values = np.nan_to_num(table.eval(wi, wo))
    return {
        "grid": [vars(axis) for axis in grid.axes],
        "scale": block.scale,
        "halfs": base64.b64encode(block.body).decode(),
        "wi": wi.tolist(),
        "wo": wo.tolist(),
        "values": values.tolist(),
    }


def _albedo(grid: Grid) -> dict[str, Any]:
    """Of the table of ``lookup``, of light from an azimuth; few nodes, which both sides place alike."""
    nodes = {"n_theta_h": 40, "n_phi_h": 12}
    theta_i = np.radians([0.0, 30.0, 60.0, 88.0])
    phi_i = 0.0 if grid.is_isotropic else 0.7
    values = directional_albedo(_table(grid), theta_i, phi_i, **nodes)
    return {**nodes, "theta_i": theta_i.tolist(), "phi_i": phi_i, "values": values.tolist()}


def _library(n: int, seed: int) -> ProceduralLibrary:
    rng = np.random.default_rng(seed)
    tables = {
        f"material-{i}": TabularBrdf(rng.gamma(0.5, size=(3, *GRID.shape)).astype(np.float32), GRID)
        for i in range(n)
    }
    return ProceduralLibrary("golden", tables, grid=GRID)


def _route() -> dict[str, Any]:
    """Legs as they are sent, one of them against the library's order, and the routes and recipes of the whole."""
    from halfway.server.explorer import QUICK_PACES, Explorer

    explorer = Explorer(_library(20, seed=4))
    stops = ["material-0", "material-7", "material-2", "material-9"]
    legs = {
        f"{a} {b}": explorer.leg("paper", a, b).model_dump(mode="json")
        for a, b in (sorted(pair) for pair in pairwise(stops))
    }
    routes: list[dict[str, Any]] = []
    for pace in QUICK_PACES:
        route = explorer.way("paper", stops, pace)
        ts = [0.0, 0.1, 0.25, float(route.stop_ts[1]), float(route.way.knots[9]), 0.7, 0.999, 1.0]
        recipes = zip(ts, route.recipes(ts), strict=True)
        routes.append(
            {
                "pace": pace,
                "stop_t": route.stop_ts.tolist(),
                "recipes": [{"t": t, **recipe.to_json()} for t, recipe in recipes],
            }
        )
    names = list(explorer.library.names)
    return {"names": names, "stops": stops, "legs": legs, "routes": routes}


def _points() -> dict[str, Any]:
    """Charts as they are written, and what the server says of points inside and outside."""
    from halfway.server.explorer import Explorer
    from halfway.server.schema import Point
    from halfway.server.static import BLEND, charts_file, small_space

    explorer = Explorer(_library(10, seed=5), make=small_space)
    rng = np.random.default_rng(5)
    spaces, points = {}, []
    for name in ("anchored", "paper"):
        space = explorer.space(name, BLEND)
        spaces[name] = {
            "view": explorer.space_view(name, BLEND).model_dump(mode="json"),
            "charts": charts_file(space).model_dump(mode="json")["charts"],
        }
        middle = space.points.mean(axis=0)
        for weights in rng.dirichlet(np.full(10, 0.5), size=8):
            # From the middle outwards: the first few are inside.
            for reach in (1.0, 3.0):
                point = Point(
                    space=name,
                    blend=BLEND,
                    point=(middle + reach * (weights @ space.points - middle)).tolist(),
                )
                answer = explorer.position(point).model_dump(mode="json", exclude_none=True)
                points.append({**point.model_dump(mode="json"), "answer": answer})
    return {"names": list(explorer.library.names), "spaces": spaces, "points": points}


def _colour() -> dict[str, list[float]]:
    linear = [0.0, 0.001, 0.0031308, 0.0032, 0.01, 0.18, 0.5, 0.9, 1.0, 3.0]
    return {
        "linear": linear,
        "bytes": to_8_bit(np.array(linear)[:, None, None] * np.ones(3))[:, 0, 0].tolist(),
    }


if __name__ == "__main__":
    for name, document in golden().items():
        (HERE / f"{name}.json").write_text(json.dumps(document) + "\n")
