"""The picture of the page on Blender: ``python docs/blender_picture.py``.

Cycles renders it in Blender, with the extension installed: a route of five as lobes, under a sun and a sky of one colour, on a floor
that they mirror and shade; and below it the same route as Principled BSDFs.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image

ROOT = Path(__file__).parents[1]
sys.path[:0] = [str(ROOT / "tests"), str(ROOT / "blender")]

from build import build  # noqa: E402

from blender import blender  # noqa: E402

STOPS = ("blue-metallic-paint2", "cherry-235", "gold-metallic-paint")
TARGET = ROOT / "docs" / "images" / "blender.webp"
PROGRAM = """
import sys
from pathlib import Path
import bpy
import math
folder = Path(sys.argv[1])
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.extensions.package_install_files(filepath=str(folder / "addon.zip"), repo="user_default", enable_on_install=True)
scene = bpy.context.scene
(space,) = folder.glob("*.brdfspace")
bpy.ops.halfway.import_files(filepath=str(space))
settings = scene.halfway
settings.choice = sys.argv[2]
bpy.ops.halfway.add_stop()
settings.n = 5
for row, kind in enumerate(("lobes", "principled")):
    known = set(bpy.data.materials)
    settings.kind = kind
    bpy.ops.halfway.make_route()
    made = [m for m in bpy.data.materials if m not in known]
    middle = [m for m in made if " to " in m.name]
    first, second, last = (next(m for m in made if m.name.startswith(n) and " to " not in m.name) for n in sys.argv[3:6])
    order = [first, middle[0], second, middle[1], last]
    for i, material in enumerate(order):
        bpy.ops.mesh.primitive_uv_sphere_add(segments=128, ring_count=64, location=(2.3 * (i - 2), 3.4 * row, 1))
        bpy.ops.object.shade_smooth()
        bpy.context.object.data.materials.append(material)
bpy.ops.mesh.primitive_plane_add(size=60)
floor = bpy.data.materials.new("floor")
floor.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (0.2, 0.2, 0.2, 1)
bpy.context.object.data.materials.append(floor)
sun = bpy.data.lights.new("sun", "SUN")
sun.energy, sun.angle = 3, 0.02
there = bpy.data.objects.new("sun", sun)
there.rotation_euler = (0.7, 0.25, 0.5)
scene.collection.objects.link(there)
scene.world = bpy.data.worlds.new("sky")
background = scene.world.node_tree.nodes["Background"].inputs
background[0].default_value, background[1].default_value = (0.7, 0.8, 1, 1), 0.5
camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
camera.location, camera.rotation_euler, camera.data.lens = (0, -17, 9), (math.radians(65), 0, 0), 55
scene.collection.objects.link(camera)
scene.camera = camera
scene.render.engine, scene.cycles.samples = "CYCLES", 48
scene.cycles.use_denoising = False
scene.render.resolution_x, scene.render.resolution_y = 960, 360
scene.view_settings.view_transform = "Standard"
scene.render.filepath = str(folder / "picture.png")
bpy.ops.render.render(write_still=True)
"""


def main() -> None:
    """Export, install, render, keep."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        build(folder / "addon.zip")
        words = [f"builtin:merl-abc:{stop}" for stop in STOPS]
        export = [sys.executable, "-m", "halfway", "export", *words, "--for", "blender"]
        subprocess.run([*export, "-o", str(folder / "space")], check=True)
        (space,) = (folder / "space").glob("*.brdfspace")
        space.rename(folder / space.name)
        done = blender(
            "-c", PROGRAM, name, STOPS[-1], *STOPS, BLENDER_USER_RESOURCES=f"{name}/user"
        )
        if done.returncode:
            sys.exit(done.stderr)
        picture = np.asarray(Image.open(folder / "picture.png").convert("RGB"))
        Image.fromarray(picture).save(TARGET, quality=88)


if __name__ == "__main__":
    main()
