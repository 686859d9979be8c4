"""The extension in Blender itself: ``make blender-check``. With ``--table`` and libraries behind it, the tables of its page instead;
with ``--eevee``, that of EEVEE, which needs a display and its graphics (``xvfb-run`` and Mesa do).

Blender is ``bpy`` from PyPI, which takes Python 3.13 and no other; `in_blender` runs in an environment of its own with nothing else.
Where Python 3.13 or the wheel cannot be had, that is said in a line, and nothing is checked.
"""

import json
import os
import subprocess
import sys
import tempfile
from collections import defaultdict
from collections.abc import Sequence
from pathlib import Path

import numpy as np

ROOT = Path(__file__).parents[1]
sys.path[:0] = [str(ROOT / "tests"), str(ROOT / "blender")]

import glossy  # noqa: E402
from build import build  # noqa: E402
from chromium import chromium  # noqa: E402
from in_three import draw  # noqa: E402
from written_files import keras, nbrdf_layers  # noqa: E402

from halfway import open_library  # noqa: E402
from halfway.brdf.quality import LIGHTS  # noqa: E402
from halfway.export import write_fit, write_recipe, write_scenes  # noqa: E402
from halfway.export.usd import Fits, write_usd  # noqa: E402
from halfway.fit import fit  # noqa: E402
from halfway.formats import write_brdf  # noqa: E402
from halfway.library import Library  # noqa: E402
from halfway.recipes import NamedBrdf, Recipe  # noqa: E402

UV = os.environ.get("UV", "uv")  # `uv run` says where it is
BLENDER = "5.3.0"
LIBRARY = "builtin:merl-abc"
KINDS = {
    "metal": ("brass", "nickel"),
    "metallic paint": ("blue-metallic-paint2", "gold-metallic-paint"),
    "glossy plastic": ("red-specular-plastic", "yellow-phenolic"),
    "paint, wood": ("dark-red-paint", "cherry-235"),
    "rubber, matte plastic": ("blue-rubber", "neoprene-rubber"),
    "fabric": ("red-fabric", "light-brown-fabric"),
}
"""Materials of each kind, the first of them for the check."""
OPENPBR, MITSUBA = "openpbr by its formula", "mitsuba by its formula"
THREE = ".glb in three.js"
LEAST_DB = {"table": 50, "lobes": 40, "principled": 26}
"""Of every kind: three decibels below the worst that was measured."""
TREES = {"table": "table", "lobes": "lobes", "principled": "Principled"}
FITS = {
    "principled": "Cycles, Principled",
    ".glb": "Blender, `.glb`",
    ".usda": "Blender, `.usda`",
    THREE: "three.js, `.glb`",
    MITSUBA: "Mitsuba, `principled`",
    OPENPBR: "MaterialX, OpenPBR",
}
"""Columns of the two tables, and what they are called there."""


def main(arguments: Sequence[str]) -> None:
    """The check, or the table."""
    if missing := missing_blender():
        print(f"Not checked: Blender {BLENDER} (bpy, Python 3.13) cannot be had here: {missing}")
        return
    with tempfile.TemporaryDirectory() as folder:
        work = Path(folder)
        build(work / "addon.zip")
        if arguments[:1] == ["--eevee"]:
            for where in arguments[1:] or [LIBRARY]:
                means = measured(work, open_library(where), one_of_each(), "eevee")
                print_table(where, means, TREES)
            return
        if arguments[:1] == ["--table"]:
            for where in arguments[1:] or [LIBRARY]:
                library = open_library(where)
                means = measured(work, library, KINDS)
                for more in (by_formula(library, KINDS), in_three(work, library, KINDS)):
                    for kind, errors in more.items():
                        means[kind].update(errors)
                print_table(where, means, TREES)
                print_table(where, means, FITS)
            return
        write_files(work)
        in_blender("check", work)
        for name, errors in measured(work, open_library(LIBRARY), one_of_each()).items():
            print(f"{name}: {errors}")
            for tree, least in LEAST_DB.items():
                assert errors[tree]["psnr"] > least, (name, tree)


def missing_blender() -> str:
    """Why there is no Blender, in a line; nothing where there is one."""
    said = blender("-c", "import bpy")
    return (said.stderr.strip().splitlines() or ["no reason given"])[-1] if said.returncode else ""


def blender(*words: str, **options: str) -> subprocess.CompletedProcess[str]:
    """Run Python in Blender's environment."""
    start = [UV, "run", "--quiet", "--no-project", "--python", "3.13", "--with", f"bpy=={BLENDER}"]
    return subprocess.run([*start, "python", *words], capture_output=True, text=True, env={**os.environ, **options})  # fmt: skip


def in_blender(what: str, folder: Path) -> None:
    """Run `in_blender`; what it prints for us, and its failure, are ours."""
    (folder / "lights.json").write_text(json.dumps(LIGHTS))
    options = {"BLENDER_USER_RESOURCES": str(folder / "user"), "PYTHONWARNINGS": "ignore"}
    done = blender(str(ROOT / "tests" / "in_blender.py"), what, str(folder), **options)
    print(*(line[5:] for line in done.stdout.splitlines() if line.startswith("SAID ")), sep="\n")
    if done.returncode:
        sys.exit(f"{done.stdout[-2000:]}\n{done.stderr[-4000:]}")


def write_files(folder: Path) -> None:
    """A file of every format that the extension imports, and the command for those it hands over."""
    library = open_library(LIBRARY)
    brdf = library.brdf("gold-paint")
    write_brdf(folder / "gold.binary", brdf)
    write_brdf(folder / "gold.bsdf", brdf)
    (folder / "network.h5").write_bytes(keras(nbrdf_layers()))
    write_recipe(folder / "mix.recipe.json", library, Recipe.of(library, {"gold-paint": 0.5, "teflon": 0.5}))  # fmt: skip
    few = glossy.library(6)
    stops = [NamedBrdf.mixed(few, Recipe.of(few, {name: 1.0})) for name in ("m0", "m3", "m5")]
    write_scenes(folder, stops, "blender")
    (folder / "command").write_text(str(Path(sys.executable).with_name("halfway")))


def one_of_each() -> dict[str, tuple[str, ...]]:
    """The first material of each kind."""
    return {kind: names[:1] for kind, names in KINDS.items()}


def measured(
    folder: Path, library: Library, kinds: dict[str, tuple[str, ...]], how: str = "measure"
) -> dict[str, dict[str, dict[str, float]]]:
    """For each kind and node tree the mean errors of what Blender renders."""
    names = [name for names in kinds.values() for name in names]
    tables = {name: library.row(library.index(name)).reshape(3, *library.grid.shape) for name in names}  # fmt: skip
    for name in names:
        brdf = library.brdf(name)
        write_fit(folder / f"{name}.glb", fit(brdf, "gltf-blender", name=name))
        write_usd(folder / name, [Fits(*(fit(brdf, model, name=name) for model in Fits._fields))])
    np.savez(folder / "tables.npz", grid=np.array(library.grid.shape), **tables)
    in_blender(how, folder)
    found = json.loads((folder / "errors.json").read_text())
    means: dict[str, dict[str, dict[str, float]]] = defaultdict(dict)
    for kind, members in kinds.items():
        for tree in found[members[0]]:
            rows = [found[name][tree] for name in members]
            means[kind][tree] = {key: float(np.mean([row[key] for row in rows])) for key in rows[0]}
    return means


def by_formula(
    library: Library, kinds: dict[str, tuple[str, ...]]
) -> dict[str, dict[str, dict[str, float]]]:
    """For each kind the mean errors of fits whose formulas were checked against their renderers."""
    means: dict[str, dict[str, dict[str, float]]] = defaultdict(dict)
    for kind, names in kinds.items():
        for model, column in (("openpbr", OPENPBR), ("principled", MITSUBA)):
            fits = [fit(library.brdf(name), model, name=name) for name in names]
            means[kind][column] = _mean([(f.picture.psnr, f.picture.relative_l1, f.albedo_error) for f in fits])  # fmt: skip
    return means


def in_three(
    folder: Path, library: Library, kinds: dict[str, tuple[str, ...]]
) -> dict[str, dict[str, dict[str, float]]]:
    """For each kind the mean errors of what three.js draws of a glTF fit: Chromium and the viewer's packages are needed."""
    names = [name for names in kinds.values() for name in names]
    files = [folder / f"{name}.three.glb" for name in names]
    for name, path in zip(names, files, strict=True):
        write_fit(path, fit(library.brdf(name), "gltf", name=name))
    with chromium() as browser:
        drawn = dict(zip(names, draw(browser, files), strict=True))
    return {
        kind: {THREE: _mean([drawn[name].errors(library.brdf(name)) for name in members])}
        for kind, members in kinds.items()
    }


def _mean(rows: Sequence[tuple[float, float, float]]) -> dict[str, float]:
    psnr, l1, furnace = np.mean(rows, axis=0).tolist()
    return {"psnr": psnr, "l1": l1, "furnace": furnace}


def print_table(
    where: str, means: dict[str, dict[str, dict[str, float]]], columns: dict[str, str]
) -> None:
    """In Markdown: on the lit sphere dB and mean error, in the furnace the largest error of the albedo."""
    print(f"\n{where}\n\n| kind | {' | '.join(columns.values())} |\n|---|{'---|' * len(columns)}")
    for kind, row in means.items():
        print(f"| {kind} | {' | '.join(_cell(row[column]) for column in columns)} |")


def _cell(errors: dict[str, float]) -> str:
    furnace = f", {errors['furnace']:.3f}" if "furnace" in errors else ""
    return f"{errors['psnr']:.1f} dB, {errors['l1']:.1%}{furnace}"


if __name__ == "__main__":
    main(sys.argv[1:])
