"""What runs inside Blender: see `blender`. ``python in_blender.py check|measure|eevee FOLDER``."""

import json
import sys
from pathlib import Path

import bpy
import numpy as np
from blender_scene import (
    ADDON,
    LIGHTS,
    SAMPLES,
    add_point,
    albedo,
    build_lights,
    build_scene,
    in_furnace,
    inside,
    lit,
    module,
    psnr,
    reference,
    relative,
    turn,
)
from mathutils import Vector

TREES = ("table", "lobes", "principled")


def main(what: str, folder: Path) -> None:
    """Install the extension and do ``what``."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.extensions.package_install_files(
        filepath=str(folder / "addon.zip"), repo="user_default", enable_on_install=True
    )
    {"check": check, "measure": measure, "eevee": measure_in_eevee}[what](folder)


def say(*words) -> None:
    print("SAID", *words, flush=True)


def check(folder: Path) -> None:
    """Everything that a person does with the extension."""
    build_scene()
    for each in (
        validation,
        formats,
        recipes,
        library,
        route,
        slider,
        assets,
        lights,
        shadows,
        kept,
    ):
        each(folder)
        say(f"{each.__name__}: ok")


def validation(folder: Path) -> None:
    """Blender's own validation of the zip."""
    from bl_pkg.cli import blender_ext

    assert blender_ext.main(["validate", str(folder / "addon.zip")]) in (0, None)


def formats(folder: Path) -> None:
    """Each format becomes each kind of tree."""
    for file in ("gold.binary", "gold.bsdf", "network.h5"):
        for kind in TREES if file == "gold.binary" else ("lobes",):
            assert imported(folder / file, kind).node_tree.nodes
    shown = [lit(bpy.data.materials[f"gold{end}"]) for end in ("", ".003")]
    assert psnr(shown[0], shown[1]) > 40


def imported(path: Path, kind: str) -> bpy.types.Material:
    known = set(bpy.data.materials)
    assert bpy.ops.halfway.import_files(filepath=str(path), kind=kind) == {"FINISHED"}
    (made,) = set(bpy.data.materials) - known
    return made


def recipes(folder: Path) -> None:
    """What needs more than numpy goes to the installed command; without it that is said."""
    chosen = bpy.context.preferences.addons[ADDON].preferences
    chosen.command = (folder / "command").read_text()
    assert imported(folder / "mix.recipe.json", "lobes").node_tree.nodes
    chosen.command = "no-such-command"
    said = ""
    try:
        bpy.ops.halfway.import_files(filepath=str(folder / "mix.recipe.json"))
    except RuntimeError as error:
        said = str(error)
    assert "there is no command no-such-command" in said


def library(folder: Path) -> None:
    """A library opens with a picture for each stop, and a route between the first two."""
    (path,) = folder.glob("*.brdfspace")
    bpy.ops.halfway.import_files(filepath=str(path))
    settings = bpy.context.scene.halfway
    space = module("panel").space_of(bpy.context.scene)
    assert [stop.name for stop in settings.stops] == list(space.stops[:2])
    assert {name for name, *_ in module("panel")._materials(settings, None)} == set(space.stops)
    settings.choice = space.stops[2]
    bpy.ops.halfway.add_stop()
    ends = [space.weights(space.stops, t) for t in (0, 0.5, 1)]
    assert ends == [{name: 1.0} for name in space.stops]
    assert all(
        abs(sum(space.weights(space.stops, t).values()) - 1) < 1e-9 for t in np.linspace(0, 1, 33)
    )


def route(_folder: Path) -> None:
    """A route of five, as each kind of tree."""
    settings = bpy.context.scene.halfway
    settings.n = 5
    for kind in TREES:
        known = set(bpy.data.materials)
        settings.kind = kind
        bpy.ops.halfway.make_route()
        made = set(bpy.data.materials) - known
        assert len(made) == 5
        assert lit(made.pop()).mean() > 0.01


def slider(_folder: Path) -> None:
    """A material follows t, and is the same as one made there."""
    settings = bpy.context.scene.halfway
    settings.kind, settings.t = "lobes", 0.1
    bpy.ops.halfway.make_material()
    follower = settings.follower
    before = lit(follower)
    settings.t = 0.4
    after = lit(follower)
    bpy.ops.halfway.make_material()
    assert psnr(after, lit(settings.follower)) > 60
    assert psnr(before, after) < 40


def assets(folder: Path) -> None:
    """An asset library with the materials under their own names, and a picture of each."""
    settings = bpy.context.scene.halfway
    settings.kind = "principled"
    bpy.ops.halfway.make_assets(directory=str(folder))
    (path,) = folder.glob("*.blend")
    space = module("panel").space_of(bpy.context.scene)
    with bpy.data.libraries.load(str(path), assets_only=True) as (there, here):
        assert sorted(there.materials) == sorted(space.stops)
        here.materials = list(there.materials)
    for material in here.materials:
        assert material.asset_data.description == space.origin.description
        assert np.ptp(material.preview.image_pixels_float[:]) > 0.1


def lights(_folder: Path) -> None:
    """The table's tree follows a light that moves, turns or changes, a point as well as a sun."""
    table = a_table()
    material = module("making").make("moved", table, "table")
    diffuse = bpy.data.materials.new("diffuse")
    tree = module("nodes").Tree(diffuse)
    tree.surface(tree.add("BsdfDiffuse", {"Color": (1, 1, 1, 1)}).outputs[0])
    white = module("halfway.brdf").TabularBrdf(np.full_like(table.values, 1 / np.pi), table.grid)
    shown = module("making").make("white", white, "table")
    sun = bpy.data.objects["sun 0"]
    for change in (lambda: None, lambda: turn(sun, (0, -1, 1)), lambda: setattr(sun.data, "energy", 3), lambda: setattr(sun.data, "exposure", -1), add_point):  # fmt: skip
        change()
        if "point" in bpy.data.objects:
            shown = module("making").make("white", white, "table")
        # Cycles chooses a light for each sample, which is noise.
        assert np.abs(lit(shown) - lit(diffuse))[inside(0.97)].mean() < 5e-3
    assert lit(material).mean() > 0
    bpy.data.objects.remove(bpy.data.objects["point"])
    build_lights()


def shadows(_folder: Path) -> None:
    """A disc between the sphere and a light is seen in it as Cycles itself sees it."""
    bpy.ops.mesh.primitive_circle_add(
        fill_type="NGON", radius=0.4, location=Vector(LIGHTS[0][0]) * 2
    )
    disc = bpy.context.object
    disc.visible_camera = False
    turn(disc, LIGHTS[0][0])
    white = module("halfway.brdf").TabularBrdf(
        np.full_like(a_table().values, 1 / np.pi), a_table().grid
    )
    shown, bare = (module("making").make("white", white, kind) for kind in ("table", "principled"))
    tree = module("nodes").Tree(bare)
    tree.surface(tree.add("BsdfDiffuse", {"Color": (1, 1, 1, 1)}).outputs[0])
    shaded = lit(bare)
    # Where the shadow's edge runs through a pixel the two draw other samples.
    assert np.abs(lit(shown) - shaded)[inside(0.97)].mean() < 5e-3
    bpy.data.objects.remove(disc)
    assert np.abs(lit(bare) - shaded)[inside(0.97)].mean() > 2e-2


def kept(folder: Path) -> None:
    """What is saved and opened again looks the same: images lie in the file."""
    names = ("table", "lobes")
    made = [module("making").make(kind, a_table(), kind) for kind in names]
    before = [lit(material) for material in made]
    for material in made:
        material.use_fake_user = True
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / "kept.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(folder / "kept.blend"))
    for name, picture in zip(names, before, strict=True):
        assert picture.mean() > 0.01
        # Lights come in another order, and so does the noise of choosing among them.
        assert psnr(lit(bpy.data.materials[name]), picture) > 35, name


def measure(folder: Path) -> None:
    """Every table as every tree, and as Blender reads it from our files, on the lit sphere and in the furnace."""
    build_scene()
    judge(folder, shown_as)


def measure_in_eevee(folder: Path) -> None:
    """The node trees on the lit sphere, in the renderer of Blender's windows."""
    build_scene()
    scene = bpy.context.scene
    scene.render.engine, scene.eevee.taa_render_samples = "BLENDER_EEVEE", SAMPLES
    scene.render.filter_size = 1.0
    judge(folder, as_trees)


def judge(folder: Path, shown) -> None:
    """Write how far each table is from what ``shown`` makes of it; those that more than suns light, in the furnace as well."""
    tables = np.load(folder / "tables.npz")
    grid = module("halfway.halfdiff").Grid.merl(*tables["grid"].tolist())
    has_furnace = bpy.context.scene.render.engine == "CYCLES"
    found = {}
    for name in tables.files[1:]:
        brdf = module("halfway.brdf").TabularBrdf(tables[name], grid, name=name)
        expected, furnace = reference(brdf), albedo(brdf)
        found[name] = {}
        for tree, material in shown(folder, name, brdf).items():
            picture = lit(material)
            errors = {"psnr": psnr(picture, expected), "l1": relative(picture, expected)}
            if has_furnace and tree != "table":
                off = np.abs(in_furnace(material) - furnace)[inside(0.96)]
                errors["furnace"] = float(off.max())
            found[name][tree] = errors
        say(name, {tree: {key: round(value, 4) for key, value in errors.items()} for tree, errors in found[name].items()})  # fmt: skip
    (folder / "errors.json").write_text(json.dumps(found))


def as_trees(_folder: Path, name: str, brdf) -> dict[str, bpy.types.Material]:
    """A material as each tree of ours."""
    return {tree: module("making").make(name, brdf, tree) for tree in TREES}


def shown_as(folder: Path, name: str, brdf) -> dict[str, bpy.types.Material]:
    """A material as each tree of ours, and as Blender reads it from our files."""
    made = as_trees(folder, name, brdf)
    glb, usd = folder / f"{name}.glb", folder / name / "scene.usda"
    made[".glb"] = read_by(lambda: bpy.ops.import_scene.gltf(filepath=str(glb)))
    # Blender puts no material on USD's own sphere.
    made[".usda"] = read_by(
        lambda: bpy.ops.wm.usd_import(filepath=str(usd), import_all_materials=True)
    )
    return made


def read_by(read) -> bpy.types.Material:
    """The material that an importer brings, without its scene."""
    scene = bpy.context.scene
    world, objects, materials = scene.world, set(bpy.data.objects), set(bpy.data.materials)
    read()
    (material,) = set(bpy.data.materials) - materials
    material.use_fake_user = True
    for each in set(bpy.data.objects) - objects:
        bpy.data.objects.remove(each)
    scene.world, scene.camera = world, bpy.data.objects["camera"]
    return material


def a_table():
    """Some table."""
    return module("panel").table_at(bpy.context.scene, 0.5)[0]


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]))
