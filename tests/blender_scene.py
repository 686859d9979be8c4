"""The scene in Blender, that of `halfway.brdf.quality`: a sphere seen from afar under five suns; a white world without them is the furnace.

Pictures of it are compared with what the table says itself.
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
# Those of `halfway.brdf.quality`, which is not here: x to the right, y up, z to the viewer; and the weight.
LIGHTS = json.loads(Path(sys.argv[2], "lights.json").read_text())
POINT, POWER, COLOUR = Vector((2.0, 1.0, 3.0)), 40.0, (1.0, 0.5, 0.25)


def module(name: str):
    """A module of the extension."""
    return import_module(f"{ADDON}.{name}")


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
