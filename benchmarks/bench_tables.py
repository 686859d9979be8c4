"""Tables: read, mixed, written, evaluated, one by one and in batches."""

import json
import os
import shutil
from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from racing import race, ratio
from scipy.spatial import Delaunay

from halfway import HalfDiff, PaperSpace, Pca, Recipe, Route, from_half_diff
from halfway.export import write_route
from halfway.formats import read_merl, write_merl
from halfway.formats.merl import SCALES
from halfway.recipes import Blend, Mixer
from halfway.recipes.mixing import N_AT_ONCE

STOPS = ["cherry-235", "tungsten-carbide"]


@pytest.fixture(scope="module")
def recipe(library):
    weights = dict(zip(library.names[:4], (0.1, 0.2, 0.3, 0.4), strict=True))
    return Recipe.of(library.name, weights)


@pytest.fixture(scope="module")
def space(library):
    return PaperSpace.fit(library, Pca.fit(library))


@pytest.fixture(scope="module")
def route(space):
    return Route.through(space, STOPS)


def bench_read(figures, library, tmp_path):
    path = tmp_path / "one.binary"
    write_merl(path, library.brdf(library.names[0]))

    def numpy():
        with path.open("rb") as file:
            shape = np.fromfile(file, "<i4", 3)
            samples = np.fromfile(file, "<f8").reshape(3, *shape)
        return samples * SCALES[:, None, None, None]

    buffer = bytearray(path.stat().st_size)

    def raw():
        with path.open("rb", buffering=0) as file:
            file.readinto(buffer)

    seconds = race(lambda: read_merl(path), numpy, raw, rounds=9)
    what = "read a MERL file, checked, NaN where unmeasured"
    figures.note(what, "numpy.fromfile and scale / ours", ratio(seconds, 1, 0))
    figures.note(what, "ours / reading the bytes", ratio(seconds, 0, 2))


@pytest.fixture
def mixer(library, recipe):
    """One whose loops are compiled by now."""
    mixer = Mixer(library)
    for _ in range(N_AT_ONCE + 1):
        mixer.mix(recipe)
    return mixer


def bench_mix(figures, library, recipe, mixer):
    """Copying moves as many bytes as a mix reads and writes: four tables in, one out."""
    rows = [library.row(i) for i in range(4)]
    stack = np.stack(rows)
    w = recipe.weights[0]
    w32 = w.astype(np.float32)
    moved = np.empty((5 * rows[0].size) // 2, np.float32)
    source = np.concatenate([row.ravel() for row in rows])[: moved.size].copy()

    def naive():
        return sum(a * row.astype(np.float64) for a, row in zip(w, rows, strict=True))

    seconds = race(
        lambda: mixer.mix(recipe),
        naive,
        lambda: np.einsum("i,ijk->jk", w32, stack),
        lambda: np.copyto(moved, source),
        rounds=15,
    )
    what = "mix of 4 materials"
    note = f"{1e3 * np.median(seconds[:, 0]):.1f} ms"
    figures.note(what, "numpy, float64 / ours", ratio(seconds, 1, 0), note=note)
    figures.note(what, "numpy.einsum, float32 / ours", ratio(seconds, 2, 0))
    figures.note(what, "ours / copying as many bytes", ratio(seconds, 0, 3), goal="<= 1.5")


def bench_blends(figures, recipe, mixer, tmp_path):
    """Every blend of the same four materials, and the slowest into a file."""
    path = tmp_path / "mix.binary"
    recipes = [replace(recipe, blend=blend) for blend in Blend]
    seconds = race(*(partial(mixer.mix, each) for each in recipes), rounds=9)
    for i, blend in enumerate(Blend):
        note = f"{1e3 * np.median(seconds[:, i]):.0f} ms"
        if blend is not Blend.LINEAR:
            figures.note(
                f"mix of 4 materials, {blend}",
                "ours / linear",
                ratio(seconds, i, 0),
                goal="<= 6",
                note=note,
            )

    def into_a_file(each):
        write_merl(path, mixer.mix(each))

    pair = [replace(recipe, blend=blend) for blend in (Blend.LOBES, Blend.LINEAR)]
    seconds = race(*(partial(into_a_file, each) for each in pair), rounds=9, after=path.unlink)
    what = "mix of 4 materials into a MERL file, lobes"
    figures.note(what, "ours / linear", ratio(seconds, 0, 1), goal="<= 1.5")


def onto_disk(folder):
    """Wait until the disk has what was written: what the system keeps in memory, a batch soon fills."""
    for path in folder.iterdir():
        with path.open("rb") as file:
            os.fsync(file)


def bench_mix_and_write(figures, recipe, mixer, tmp_path):
    path = tmp_path / "mix.binary"
    write_merl(path, mixer.mix(recipe))
    content = path.read_bytes()
    path.unlink()

    def ours():
        write_merl(path, mixer.mix(recipe))

    def raw():
        path.write_bytes(content)

    def ours_onto_disk():
        ours()
        onto_disk(tmp_path)

    def raw_onto_disk():
        raw()
        onto_disk(tmp_path)

    what = "mix and write a MERL file"
    seconds = race(ours_onto_disk, raw_onto_disk, rounds=25, after=path.unlink)
    figures.note(what, "ours / writing the bytes, to disk", ratio(seconds, 0, 1), goal="<= 1.5")
    seconds = race(ours, raw, rounds=25, after=path.unlink)
    figures.note(what, "ours / writing the bytes, to memory", ratio(seconds, 0, 1))


def bench_batch(figures, library, route, tmp_path):
    """A batch of 24 tables with checksums and manifest, on threads, against writing the same bytes one after another."""
    content = bytes(34_992_012)
    folder = tmp_path / "batch"

    def ours():
        write_route(folder, route, route.steps(24), library, format="merl")
        onto_disk(folder)

    def raw():
        folder.mkdir()
        for i in range(24):
            (folder / f"{i}.raw").write_bytes(content)
        onto_disk(folder)

    seconds = race(ours, raw, rounds=4, after=lambda: shutil.rmtree(folder))
    rate = 24 / float(np.median(seconds[:, 0]))
    figures.note(
        "batch of 24 MERL files, with checksums",
        "ours / writing the bytes, to disk",
        ratio(seconds, 0, 1),
        goal="<= 1.5",
        note=f"{rate:.1f} files/s",
    )


def bench_recipes(figures, library, space):
    """Ten thousand recipes as JSON, against looking every point up in scipy's triangulation, without the JSON."""
    ts = np.arange(1, 10_001) / 10_000
    scores = Pca.fit(library).scores(3)
    triangulations = [Delaunay(points) for points in scores]
    i, j = (library.names.index(stop) for stop in STOPS)

    def scipy():
        for points, triangulation in zip(scores, triangulations, strict=True):
            x = points[i] + ts[:, None] * (points[j] - points[i])
            simplex = triangulation.find_simplex(x)
            transform = triangulation.transform[simplex]
            b = np.einsum("nij,nj->ni", transform[:, :3], x - transform[:, 3])
            weights = np.column_stack([b, 1 - b.sum(axis=1)])
            vertices = triangulation.simplices[simplex]
            [
                {library.names[v]: a for v, a in zip(vs, ws, strict=True)}
                for vs, ws in zip(vertices, weights.tolist(), strict=True)
            ]

    def ours():
        return json.dumps(Route.through(space, STOPS).to_json(ts))

    seconds = race(ours, scipy, rounds=5)
    note = f"{np.median(seconds[:, 0]):.2f} s, solved and as JSON"
    figures.note(
        "10,000 recipes of a route", "scipy find_simplex / ours", ratio(seconds, 1, 0), note=note
    )


def bench_evaluation(figures, library):
    """A million pairs, interpolated: against eight gathers blended in numpy without a look at what is unmeasured."""
    table = library.brdf("gold-paint")
    rng = np.random.default_rng(0)
    n = 1_000_000
    theta_h, theta_d = np.pi / 2 * rng.random((2, n)) * 0.5
    wi, wo = from_half_diff(HalfDiff(theta_h, np.zeros(n), theta_d, np.pi * rng.random(n)))
    values = np.ascontiguousarray(np.moveaxis(table.values, 0, -1)).reshape(-1, 3)

    def gathers():
        coordinates = naive_coordinates(wi, wo)
        total = np.zeros((n, 3))
        for corner in np.ndindex(2, 2, 2):
            index, weight = np.zeros(n, int), np.ones(n)
            for x, size, step in zip(coordinates, (90, 90, 180), corner, strict=True):
                low = np.floor(x)
                weight = weight * np.abs(1 - step - (x - low))
                index = index * size + np.minimum(low.astype(int) + step, size - 1)
            total = total + weight[:, None] * values[index]
        return total

    seconds = race(
        lambda: table.eval(wi, wo),
        gathers,
        lambda: table.eval(wi, wo, interpolation="floor"),
        rounds=3,
    )
    what = "evaluate a million pairs, interpolated"
    note = f"{np.median(seconds[:, 0]):.2f} s"
    figures.note(what, "eight gathers in numpy / ours", ratio(seconds, 1, 0), note=note)
    figures.note(what, "ours / our floor lookup", ratio(seconds, 0, 2))


def naive_coordinates(wi, wo):
    """Fractional indices of pairs in a MERL table, by the arc cosines of Rusinkiewicz's definition."""
    h = wi + wo
    h /= np.linalg.norm(h, axis=-1, keepdims=True)
    theta_h = np.arccos(np.clip(h[..., 2], -1, 1))
    phi_h = np.arctan2(h[..., 1], h[..., 0])
    c, s = np.cos(-phi_h), np.sin(-phi_h)
    x, y = c * wi[..., 0] - s * wi[..., 1], s * wi[..., 0] + c * wi[..., 1]
    c, s = np.cos(-theta_h), np.sin(-theta_h)
    x, z = c * x + s * wi[..., 2], c * wi[..., 2] - s * x
    theta_d = np.arccos(np.clip(z, -1, 1))
    phi_d = np.arctan2(y, x) % np.pi
    return 90 * np.sqrt(theta_h / (np.pi / 2)), 90 * theta_d / (np.pi / 2), 180 * phi_d / np.pi
