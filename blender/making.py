"""Materials of Blender's from tables."""

import tempfile
from pathlib import Path

import bpy

from . import nodes
from .halfway.brdf import Brdf, TabularBrdf, tabulate
from .halfway.errors import FormatError
from .halfway.fit import fit
from .halfway.halfdiff import MERL
from .lobes import Lobes
from .solver import least_squares

KINDS = (
    ("lobes", "Lobes", "Closures whose weights depend on the angle of view: near to the table under every light"),
    ("principled", "Principled", "One Principled BSDF, fitted: for other renderers, and to edit"),
    ("table", "Table", "The table itself, under the scene's suns and points, and under no other light"),
)  # fmt: skip


def make(name: str, brdf: Brdf, kind: str, *, parameters: dict | None = None) -> bpy.types.Material:
    """A new material that shows a BRDF; ``parameters``: of the Principled BSDF, where they are known."""
    material = bpy.data.materials.new(name)
    show(material, brdf, kind, parameters=parameters)
    return material


def show(
    material: bpy.types.Material, brdf: Brdf, kind: str, *, parameters: dict | None = None
) -> None:
    """Let a material show another BRDF."""
    if not brdf.is_isotropic:
        raise FormatError(
            f"{material.name} depends on phi_h (it is anisotropic): the node trees are of isotropic materials. "
            "Take the mean over turns about its normal."
        )
    match kind:
        case "principled":
            nodes.principled(material, parameters or fitted(brdf))
        case "lobes":
            nodes.lobes(material, Lobes.of(brdf))
        case _:
            table = brdf if isinstance(brdf, TabularBrdf) else tabulate(brdf, MERL)
            nodes.table(material, table, lights())
    material["halfway_nodes"] = kind


def fitted(brdf: Brdf) -> dict:
    """The inputs of the Principled BSDF that stand for a BRDF best."""
    return fit(brdf, "cycles", solver=least_squares).model.parameters()


def lights() -> list[bpy.types.Object]:
    """The suns and points of the scene."""
    return [
        each
        for each in bpy.context.scene.objects
        if each.type == "LIGHT" and each.data.type in nodes.LIGHTS
    ]


def set_preview(what: bpy.types.ID, png: bytes) -> None:
    """Give an asset or an item its picture."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "preview.png")
        path.write_bytes(png)
        image = bpy.data.images.load(str(path))
        preview = what.preview_ensure()
        preview.image_size = image.size
        preview.image_pixels_float[:] = image.pixels[:]
        bpy.data.images.remove(image)
