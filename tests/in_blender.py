"""What runs inside Blender: see `blender`. ``python in_blender.py check|measure|eevee FOLDER``.

The scene is that of `halfway.brdf.quality`: a sphere seen from afar under five suns; a white world without them is the furnace.
"""

import json
import sys
from importlib import import_module
from pathlib import Path

import bpy
import numpy as np
from mathutils import Vector

ADDON = "bl_ext.user_default.halfway"
SIZE, SAMPLES = 48, 128
# As `halfway.brdf.quality`: x to the right, y up, z to the viewer; and the weight.
LIGHTS = (
    ((0.5, 0.6, 0.7), 0.6),
    ((-0.8, 0.2, 0.35), 0.5),
    ((0.3, -0.9, -0.2), 0.5),
    ((0.05, 0.1, 1.0), 0.3),
    ((-0.3, 0.8, -0.4), 0.5),
)
POINT, POWER, COLOUR = Vector((2.0, 1.0, 3.0)), 40.0, (1.0, 0.5, 0.25)
TREES = ("table", "lobes", "principled")


def main(what: str, folder: Path) -> None:
    """Install the extension and do ``what``."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.extensions.package_install_files(
        filepath=str(folder / "addon.zip"), repo="user_default", enable_on_install=True
    )
    {"check": check, "measure": measure, "eevee": measure_in_eevee}[what](folder)


def module(name: str):
    """A module of the extension."""
    return import_module(f"{ADDON}.{name}")


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
    """Every table as every tree, on the lit sphere and in the furnace."""
    build_scene()
    tables = np.load(folder / "tables.npz")
    grid = module("halfway.halfdiff").Grid.merl(*tables["grid"].tolist())
    found = {}
    for name in tables.files[1:]:
        brdf = module("halfway.brdf").TabularBrdf(tables[name], grid, name=name)
        expected, furnace = reference(brdf), albedo(brdf)
        found[name] = {}
        for tree, material in shown_as(folder, name, brdf).items():
            picture = lit(material)
            errors = {"psnr": psnr(picture, expected), "l1": relative(picture, expected)}
            if tree != "table":
                off = np.abs(in_furnace(material) - furnace)[inside(0.96)]
                errors["furnace"] = float(off.max())
            found[name][tree] = errors
        say(name, {tree: {key: round(value, 4) for key, value in errors.items()} for tree, errors in found[name].items()})  # fmt: skip
    (folder / "errors.json").write_text(json.dumps(found))


def measure_in_eevee(folder: Path) -> None:
    """The node trees on the lit sphere, in the renderer of Blender's windows."""
    build_scene()
    scene = bpy.context.scene
    scene.render.engine, scene.eevee.taa_render_samples = "BLENDER_EEVEE", SAMPLES
    scene.render.filter_size = 1.0
    tables = np.load(folder / "tables.npz")
    grid = module("halfway.halfdiff").Grid.merl(*tables["grid"].tolist())
    found = {}
    for name in tables.files[1:]:
        brdf = module("halfway.brdf").TabularBrdf(tables[name], grid, name=name)
        expected = reference(brdf)
        pictures = {tree: lit(module("making").make(name, brdf, tree)) for tree in TREES}
        found[name] = {
            tree: {"psnr": psnr(picture, expected), "l1": relative(picture, expected)}
            for tree, picture in pictures.items()
        }
        say(name, found[name])
    (folder / "errors.json").write_text(json.dumps(found))


def shown_as(folder: Path, name: str, brdf) -> dict[str, bpy.types.Material]:
    """A material as each tree of ours, and as Blender reads it from our files."""
    made = {tree: module("making").make(name, brdf, tree) for tree in TREES}
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


def build_scene() -> None:
    """The sphere, the camera, the suns."""
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.max_bounces = SAMPLES, False, 0
    scene.cycles.pixel_filter_type, scene.cycles.use_adaptive_sampling = "BOX", False
    scene.render.resolution_x = scene.render.resolution_y = SIZE
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.render.use_persistent_data = True
    scene.world = bpy.data.worlds.new("world")
    bpy.ops.mesh.primitive_uv_sphere_add(segments=256, ring_count=128)
    bpy.context.object.name = "sphere"
    bpy.ops.object.shade_smooth()
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    scene.collection.objects.link(camera)
    scene.camera = camera
    camera.data.type, camera.data.ortho_scale, camera.location = "ORTHO", 2, (0, 0, 5)
    build_lights()


def build_lights() -> None:
    """The suns as they were; a white diffuse sphere facing one of weight 1 shows 1."""
    scene = bpy.context.scene
    for old in [each for each in scene.objects if each.type == "LIGHT"]:
        bpy.data.objects.remove(old)
    for i, (direction, weight) in enumerate(LIGHTS):
        sun = bpy.data.lights.new(f"sun {i}", "SUN")
        sun.angle, sun.energy = 0, weight * np.pi
        there = bpy.data.objects.new(f"sun {i}", sun)
        scene.collection.objects.link(there)
        turn(there, direction)


def add_point() -> None:
    point = bpy.data.lights.new("point", "POINT")
    point.energy, point.color, point.shadow_soft_size = POWER, COLOUR, 0
    there = bpy.data.objects.new("point", point)
    there.location = POINT
    bpy.context.scene.collection.objects.link(there)


def turn(what: bpy.types.Object, towards) -> None:
    """Let an object's z axis point there."""
    what.rotation_euler = Vector(towards).to_track_quat("Z", "Y").to_euler()
    bpy.context.view_layer.update()


def lit(material: bpy.types.Material) -> np.ndarray:
    """The sphere under the lights."""
    return rendered(material, 0.0)


def in_furnace(material: bpy.types.Material) -> np.ndarray:
    """The sphere in a white world, without the lights."""
    suns = [each for each in bpy.context.scene.objects if each.type == "LIGHT"]
    for each in suns:
        each.hide_render = True
    picture = rendered(material, 1.0)
    for each in suns:
        each.hide_render = False
    return picture


def rendered(material: bpy.types.Material, world: float) -> np.ndarray:
    scene = bpy.context.scene
    sphere = bpy.data.objects["sphere"]
    sphere.data.materials.clear()
    sphere.data.materials.append(material)
    background = scene.world.node_tree.nodes["Background"].inputs
    background["Color"].default_value, background["Strength"].default_value = (1, 1, 1, 1), world
    scene.render.filepath = str(Path(bpy.app.tempdir, "picture.exr"))
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(scene.render.filepath)
    pixels = np.array(image.pixels[:]).reshape(SIZE, SIZE, 4)[..., :3]
    bpy.data.images.remove(image)
    return pixels


def a_table():
    """Some table."""
    return module("panel").table_at(bpy.context.scene, 0.5)[0]


def inside(radius: float = 1.0) -> np.ndarray:
    """The pixels within a share of the sphere's radius."""
    across = 2 * (np.arange(SIZE) + 0.5) / SIZE - 1
    return np.hypot(*np.meshgrid(across, across)) < radius


def reference(brdf, fine: int = 8) -> np.ndarray:
    """The lit sphere, each pixel the mean of fine x fine points."""
    across = 2 * (np.arange(SIZE * fine) + 0.5) / (SIZE * fine) - 1
    x, y = np.meshgrid(across, across)
    on = x**2 + y**2 < 1
    normal = np.stack([x[on], y[on], np.sqrt(1 - x[on] ** 2 - y[on] ** 2)], axis=-1)
    tangent = np.cross([0.0, 1.0, 1e-9], normal)
    tangent /= np.linalg.norm(tangent, axis=-1, keepdims=True)
    frames = np.stack([tangent, np.cross(normal, tangent), normal], axis=1)
    wo = frames @ np.array([0.0, 0.0, 1.0])
    total = np.zeros_like(wo)
    for direction, weight in LIGHTS:
        wi = frames @ (np.array(direction) / np.linalg.norm(direction))
        values = np.nan_to_num(brdf.eval(wi, wo), nan=0.0)
        total += weight * np.pi * values * np.maximum(wi[:, 2:], 0)
    picture = np.zeros((*x.shape, 3))
    picture[on] = total
    return picture.reshape(SIZE, fine, SIZE, fine, 3).mean(axis=(1, 3))


def albedo(brdf) -> np.ndarray:
    """The sphere in the furnace: the directional albedo at each pixel's angle."""
    across = 2 * (np.arange(SIZE) + 0.5) / SIZE - 1
    radius = np.hypot(*np.meshgrid(across, across))
    angles = np.radians(np.arange(0, 86, 5))
    table = module("halfway.brdf").directional_albedo(brdf, angles)
    angle = np.arcsin(np.minimum(radius, 1))
    return np.stack([np.interp(angle, angles, channel) for channel in table.T], axis=-1)


def psnr(picture: np.ndarray, expected: np.ndarray) -> float:
    """Of the display pictures, over the sphere, as `halfway.brdf.quality`."""
    curve = module("halfway.colour").to_srgb
    error = np.mean((curve(picture) - curve(expected))[inside(0.985)] ** 2)
    return float(-10 * np.log10(max(error, 1e-12)))


def relative(picture: np.ndarray, expected: np.ndarray) -> float:
    on = inside(0.985)
    return float(np.abs(picture - expected)[on].sum() / expected[on].sum())


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]))
