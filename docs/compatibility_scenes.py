"""Rows of the page on compatibility: meshes, environments, and our fits in Blender."""

import subprocess
from collections.abc import Callable
from pathlib import Path

import numpy as np
from compatibility_rows import Row, python_with

from halfway.export import write_fit
from halfway.fit import fit
from halfway.models import builtin
from halfway.render.assets import read_mesh
from halfway.render.variant import load_mitsuba

BLENDER = "5.3.0"
VALIDATOR = "2.0.0-dev.3.10"


def in_blender(program: str, folder: Path) -> list[str]:
    """The lines behind ``SAID `` that Blender prints; it needs Python 3.13."""
    start = "import bpy\nbpy.ops.wm.read_factory_settings(use_empty=True)\n"
    said = python_with([f"bpy=={BLENDER}"], start + program, folder, python="3.13")
    return [line.removeprefix("SAID ") for line in said.splitlines() if line.startswith("SAID ")]


def blenders_mesh(call: str, file: str) -> Callable[[Path], str]:
    """A cylinder: 32 quads and two polygons of 32 corners."""

    def tried(folder: Path) -> str:
        in_blender(
            f"bpy.ops.mesh.primitive_cylinder_add()\nbpy.ops.wm.{call}(filepath='{file}')", folder
        )
        return the_solid(folder / file, 16 * np.sin(2 * np.pi / 32) * 2)

    return tried


def mesh(file: str, content: str, volume: float) -> Callable[[Path], str]:
    """A file of this content."""

    def tried(folder: Path) -> str:
        (folder / file).write_text(content)
        return the_solid(folder / file, volume)

    return tried


def the_solid(path: Path, volume: float) -> str:
    """The mesh of a file, which must be closed and have this volume."""
    found = read_mesh(path)
    a, b, c = np.moveaxis(found.positions[found.faces].astype(float), 1, 0)
    assert np.isclose(np.einsum("ij,ij->", a, np.cross(b, c)) / 6, volume, rtol=1e-5)
    return f"the same solid, of {len(found.faces)} triangles"


def blenders_picture(kind: str, file: str, media: str = "IMAGE") -> Callable[[Path], str]:
    """A world of one colour."""
    program = f"""
s = bpy.context.scene
s.world = bpy.data.worlds.new("w")
s.world.use_nodes = True
s.world.node_tree.nodes["Background"].inputs[0].default_value = (0.25, 0.5, 1, 1)
s.camera = bpy.data.objects.new("c", bpy.data.cameras.new("c"))
s.collection.objects.link(s.camera)
s.view_layers[0].use_pass_z = True
s.render.engine, s.cycles.samples, s.cycles.use_denoising = "CYCLES", 1, False
s.render.resolution_x, s.render.resolution_y, s.render.use_file_extension = 32, 16, False
s.render.image_settings.media_type = "{media}"
s.render.image_settings.file_format = "{kind}"
s.render.filepath = "{file}"
bpy.ops.render.render(write_still=True)
"""

    def tried(folder: Path) -> str:
        in_blender(program.replace(f'"{file}"', f'"{folder / file}"'), folder)
        load_mitsuba()
        from halfway.render.environment import read_environment

        found = read_environment(folder / file)
        assert found.shape == (16, 32, 3)
        assert np.allclose(found, [0.25, 0.5, 1], rtol=0.01)
        return "the same picture"

    return tried


def lights_in_blender(folder: Path) -> str:
    """What the suns of our asset become, in both lighting modes."""
    write_fit(
        folder / "gold.glb",
        fit(builtin("merl-abc").models["gold-paint"], "gltf", name="gold-paint"),
    )
    program = """
for mode in ("SPEC", "COMPAT"):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath="gold.glb", export_import_convert_lighting_mode=mode)
    print("SAID", max(light.energy for light in bpy.data.lights))
"""
    standard, unitless = map(float, in_blender(program, folder))
    assert np.isclose(unitless, 2.4)
    return f"Lighting Mode Unitless: the brightest sun is {unitless:.2g}, as written; by default {standard:.2g}, and the picture is black"


def usd_in_blender(folder: Path) -> str:
    """A stage that references a material whose name begins with a digit."""
    write_fit(folder / "001.mtlx", fit(builtin("merl-abc").models["gold-paint"], name="001"))
    (folder / "stage.usda").write_text(STAGE)
    program = """
bpy.ops.wm.usd_import(filepath="stage.usda")
print("SAID", [material.name for material in bpy.data.objects["mesh"].data.materials])
"""
    (found,) = in_blender(program, folder)
    assert found == "['_001']"
    return "the stage opens and the mesh wears the material, of which Blender makes no nodes"


def validated(folder: Path) -> str:
    """What Khronos' validator says of the whole built-in library as `.glb`."""
    for name, brdf in builtin("merl-abc").models.items():
        write_fit(folder / f"{name}.glb", fit(brdf, "gltf", name=name))
    (folder / "validate.js").write_text(VALIDATE)
    install = [
        "npm",
        "install",
        "--silent",
        "--no-audit",
        "--no-fund",
        f"gltf-validator@{VALIDATOR}",
    ]
    subprocess.run(install, cwd=folder, check=True, capture_output=True)
    done = subprocess.run(
        ["node", "validate.js"], cwd=folder, check=True, capture_output=True, text=True
    )
    n_files, n_errors, n_warnings = map(int, done.stdout.split())
    assert (n_files, n_errors, n_warnings) == (100, 0, 0), done.stdout
    return "0 errors and 0 warnings"


VALIDATE = """
const { readFileSync, readdirSync } = require("fs");
const { validateBytes } = require("gltf-validator");
const files = readdirSync(".").filter((name) => name.endsWith(".glb"));
Promise.all(files.map((name) => validateBytes(new Uint8Array(readFileSync(name))))).then((reports) => {
  const sum = (key) => reports.reduce((total, report) => total + report.issues[key], 0);
  console.log(files.length, sum("numErrors"), sum("numWarnings"));
});
"""
STAGE = """#usda 1.0
def Xform "root" {
    def "mtl" (references = @./001.mtlx@</MaterialX>) {}
    def Mesh "mesh" (prepend apiSchemas = ["MaterialBindingAPI"]) {
        int[] faceVertexCounts = [3]
        int[] faceVertexIndices = [0, 1, 2]
        point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]
        rel material:binding = </root/mtl/Materials/_001>
    }
}
"""
MESHLAB = """ply
format ascii 1.0
comment VCGLIB generated
element vertex 4
property float x
property float y
property float z
element face 4
property list uchar int vertex_indices
property list uchar float texcoord
end_header
0 0 0
1 0 0
0 1 0
0 0 1
3 0 2 1 6 0 0 0 0 0 0
3 0 1 3 6 0 0 0 0 0 0
3 0 3 2 6 0 0 0 0 0 0
3 1 2 3 6 0 0 0 0 0 0
"""
COUNTED_BACK = (
    "v 0 0 0\nv\t1 0 0\nv 0 1 0\nv 0 0 1\nf -4 -2 -3\nf\t-4\t-3\t-1\nf -4 -1 -2\nf -3 -2 -1"
)

SCENES = {
    "Meshes": [
        Row(f"Blender {BLENDER}", "run", "`.ply`, as it exports by default, with quads and larger polygons", blenders_mesh("ply_export", "cylinder.ply")),
        Row(f"Blender {BLENDER}", "run", "`.obj`, as it exports by default", blenders_mesh("obj_export", "cylinder.obj")),
        Row("MeshLab", "emulated", "`.ply` with a list of texture coordinates for each face", mesh("x.ply", MESHLAB, 1 / 6)),
        Row("scripts", "emulated", "`.obj` that counts back from the last vertex, with tabs", mesh("x.obj", COUNTED_BACK, 1 / 6)),
    ],
    "Environments": [
        Row(f"Blender {BLENDER}", "run", "OpenEXR", blenders_picture("OPEN_EXR", "x.exr")),
        Row(f"Blender {BLENDER}", "run", "OpenEXR MultiLayer, a part for each pass", blenders_picture("OPEN_EXR_MULTILAYER", "x.exr", "MULTI_LAYER_IMAGE")),
        Row(f"Blender {BLENDER}", "run", "Radiance HDR", blenders_picture("HDR", "x.hdr")),
    ],
    "Fits in other programs": [
        Row(f"Khronos glTF Validator {VALIDATOR}", "run", "`.glb` of `halfway fit`, of each of the 100 built-in materials", validated),
        Row(f"Blender {BLENDER}", "run", "`.glb` of `halfway fit`", lights_in_blender),
        Row(f"Blender {BLENDER}, USD with MaterialX", "run", "a stage that references `.mtlx` of a material called 001", usd_in_blender),
    ],
}  # fmt: skip
