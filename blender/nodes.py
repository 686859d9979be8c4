"""Node trees that show a table: a Principled BSDF, lobes by the angle of view, or the table itself under suns and points.

    principled    one node; every renderer and every light
    lobes         closures whose weights an image gives for the angle of view; every light
    table         the table itself, looked up by half/difference angles in an image, times the light of each sun and point

A shader is not told where light comes from, so the last is emission: of each light that it is made for, it computes the direction by
vector maths, and shadows by a ray. It shows no other light, and lights nothing up.
"""

from itertools import pairwise

import bpy
import numpy as np

from .halfway.brdf import TabularBrdf
from .lobes import N_VIEWS, ROUGHNESSES, Lobes, views

INPUTS = {
    "base_color": "Base Color",
    "metallic": "Metallic",
    "roughness": "Roughness",
    "ior": "IOR",
    "specular_tint": "Specular Tint",
    "coat_weight": "Coat Weight",
    "coat_roughness": "Coat Roughness",
}
"""Parameters of `halfway.fit.cycles` under the node's names."""
LIGHTS = ("SUN", "POINT")


class Tree:
    """Nodes of one material, made by their formulas."""

    def __init__(self, material: bpy.types.Material) -> None:
        self._tree = material.node_tree
        self._tree.nodes.clear()
        self._n = 0

    def add(self, kind: str, inputs: dict | None = None, **settings) -> bpy.types.Node:
        """A node of ``kind`` with values or sockets at its inputs."""
        node = self._tree.nodes.new(f"ShaderNode{kind}")
        node.location = (200 * (self._n % 8), -250 * (self._n // 8))
        self._n += 1
        for name, value in settings.items():
            setattr(node, name, value)
        for name, value in (inputs or {}).items():
            self.set(node.inputs[name], value)
        return node

    def set(self, socket: bpy.types.NodeSocket, value) -> None:
        """Link a socket to another, or give it a value."""
        if isinstance(value, bpy.types.NodeSocket):
            self._tree.links.new(value, socket)
        else:
            socket.default_value = value

    def math(self, operation: str, *values, clamp: bool = False) -> bpy.types.NodeSocket:
        """A number."""
        node = self.add("Math", dict(enumerate(values)), operation=operation, use_clamp=clamp)
        return node.outputs[0]

    def vector(self, operation: str, *values) -> bpy.types.NodeSocket:
        """A vector, or the number that two make."""
        node = self.add("VectorMath", dict(enumerate(values)), operation=operation)
        number = operation in ("DOT_PRODUCT", "LENGTH")
        return node.outputs["Value" if number else "Vector"]

    def scaled(self, vector, factor) -> bpy.types.NodeSocket:
        """A vector times a number."""
        node = self.add("VectorMath", {0: vector, "Scale": factor}, operation="SCALE")
        return node.outputs["Vector"]

    def image(
        self, image: bpy.types.Image, u, v, extension: str, interpolation: str = "Linear"
    ) -> bpy.types.NodeSocket:
        """What an image holds at a place: of the pixel, or linear between the middles of pixels."""
        at = self.add("CombineXYZ", {0: u, 1: v}).outputs[0]
        node = self.add(
            "TexImage", {"Vector": at}, interpolation=interpolation, extension=extension
        )
        node.image = image
        return node.outputs["Color"]

    def surface(self, shader: bpy.types.NodeSocket) -> None:
        """End in this."""
        self.add("OutputMaterial", {"Surface": shader})


def principled(material: bpy.types.Material, parameters: dict) -> None:
    """One Principled BSDF with fitted inputs."""
    values = {
        INPUTS[name]: (*value, 1.0) if isinstance(value, list) else value
        for name, value in parameters.items()
    }
    tree = Tree(material)
    tree.surface(tree.add("BsdfPrincipled", values, distribution="GGX").outputs[0])


def lobes(material: bpy.types.Material, found: Lobes) -> None:
    """A diffuse and several glossy closures, their colours by the angle of view; a material that has them gets new colours."""
    rows = len(found.weights)
    if material.get("halfway_nodes") == "lobes":
        fill(
            next(node.image for node in material.node_tree.nodes if node.type == "TEX_IMAGE"),
            found.weights,
        )
        return
    image = image_of(f"{material.name} lobes", found.weights)
    tree = Tree(material)
    geometry = tree.add("NewGeometry").outputs
    cosine = tree.vector("DOT_PRODUCT", geometry["Normal"], geometry["Incoming"])
    position = tree.math(
        "MULTIPLY", tree.math("ARCCOSINE", cosine), (N_VIEWS - 1) / float(views()[-1])
    )
    u = tree.math("DIVIDE", tree.math("ADD", position, 0.5), float(N_VIEWS))
    total = None
    for row in range(rows):
        colour = tree.image(image, u, (row + 0.5) / rows, "EXTEND")
        if row == 0:
            shader = tree.add("BsdfDiffuse", {"Color": colour}).outputs[0]
        else:
            inputs = {"Color": colour, "Roughness": ROUGHNESSES[row - 1]}
            shader = tree.add("BsdfGlossy", inputs, distribution="GGX").outputs[0]
        total = shader if total is None else tree.add("AddShader", {0: total, 1: shader}).outputs[0]
    tree.surface(total)


def table(material: bpy.types.Material, brdf: TabularBrdf, lights: list[bpy.types.Object]) -> None:
    """The table itself under ``lights``, suns and points; each is followed when it moves or changes."""
    image = image_of(
        f"{material.name} table",
        _filled(brdf).reshape(3, -1, brdf.grid.shape[2]).transpose(1, 2, 0),
    )
    tree = Tree(material)
    total = None
    for light in lights:
        shown = _lit(tree, image, brdf, light)
        total = shown if total is None else tree.vector("ADD", total, shown)
    emission = tree.add("Emission", {"Color": total if total is not None else (0, 0, 0, 1)})
    tree.surface(emission.outputs[0])
    material.cycles.emission_sampling = "NONE"


def _lit(
    tree: Tree, image: bpy.types.Image, brdf: TabularBrdf, light: bpy.types.Object
) -> bpy.types.NodeSocket:
    """f_r times the cosine times the irradiance of one light across its direction, with its shadow."""
    geometry = tree.add("NewGeometry").outputs
    normal, viewer, place = geometry["Normal"], geometry["Incoming"], geometry["Position"]
    direction, power, length = _light(tree, light, place)
    cosine = tree.math("MAXIMUM", tree.vector("DOT_PRODUCT", normal, direction), 0.0)
    ray = tree.add("Raycast", {"Position": place, "Direction": direction, "Length": length})
    seen = tree.math("SUBTRACT", 1.0, ray.outputs["Is Hit"])
    values = _looked_up(tree, image, brdf, normal, viewer, direction)
    return tree.vector("MULTIPLY", tree.scaled(values, tree.math("MULTIPLY", cosine, seen)), power)


def _light(tree: Tree, light: bpy.types.Object, place) -> tuple:
    """The direction to a light, its irradiance across that, and how far it is."""
    colour = tree.add("CombineXYZ", label=light.name)
    for i in range(3):
        _follow(colour.inputs[i], light.data, f"color[{i}]")
    energy = _followed(tree, light.data, "energy")
    exposure = _followed(tree, light.data, "exposure")
    energy = tree.math("MULTIPLY", energy, tree.math("POWER", 2.0, exposure))
    axis = tree.add("CombineXYZ", label=light.name)
    if light.data.type == "SUN":
        for i in range(3):
            _follow(axis.inputs[i], light, f"matrix_world[2][{i}]")
        direction = tree.vector("NORMALIZE", axis.outputs[0])
        return direction, tree.scaled(colour.outputs[0], energy), 1e6
    for i in range(3):
        _follow(axis.inputs[i], light, f"matrix_world[3][{i}]")
    away = tree.vector("SUBTRACT", axis.outputs[0], place)
    length = tree.vector("LENGTH", away)
    # The irradiance of a point of power P is P / (4 pi r^2).
    sphere = tree.math("MULTIPLY", tree.math("MULTIPLY", length, length), 4 * np.pi)
    power = tree.math("DIVIDE", energy, sphere)
    return tree.vector("NORMALIZE", away), tree.scaled(colour.outputs[0], power), length


def _followed(tree: Tree, of: bpy.types.ID, path: str) -> bpy.types.NodeSocket:
    value = tree.add("Value").outputs[0]
    _follow(value, of, path)
    return value


def _follow(socket: bpy.types.NodeSocket, of: bpy.types.ID, path: str) -> None:
    """Let a value follow another one."""
    driver = socket.driver_add("default_value").driver
    driver.type = "SUM"
    variable = driver.variables.new()
    target = variable.targets[0]
    target.id_type = "LIGHT" if isinstance(of, bpy.types.Light) else "OBJECT"
    target.id, target.data_path = of, path


def _looked_up(tree: Tree, image, brdf: TabularBrdf, normal, viewer, direction):
    """The table at the half/difference angles of two directions: see `halfway.halfdiff`."""
    n_h, n_d, n_p = brdf.grid.shape
    half = tree.vector("NORMALIZE", tree.vector("ADD", viewer, direction))
    across = tree.vector("CROSS_PRODUCT", normal, half)
    cos_h = tree.vector("DOT_PRODUCT", normal, half)
    # The arc tangent keeps its digits where the cosine loses them.
    theta_h = tree.math("ARCTAN2", tree.vector("LENGTH", across), cos_h)
    cos_d = tree.vector("DOT_PRODUCT", direction, half)
    sin_d = tree.vector("LENGTH", tree.vector("CROSS_PRODUCT", direction, half))
    theta_d = tree.math("ARCTAN2", sin_d, cos_d)
    along = tree.vector("SUBTRACT", tree.scaled(half, cos_h), normal)
    phi_d = tree.math("ARCTAN2", tree.vector("DOT_PRODUCT", direction, across), tree.vector("DOT_PRODUCT", direction, along))  # fmt: skip
    quarter = 2 / np.pi
    at_h = tree.math(
        "MULTIPLY", tree.math("SQRT", tree.math("MULTIPLY", theta_h, quarter)), float(n_h)
    )
    at_d = tree.math("MULTIPLY", theta_d, n_d * quarter)
    at_p = tree.math("MULTIPLY", tree.math("FRACT", tree.math("DIVIDE", phi_d, np.pi)), float(n_p))
    total = None
    for h, share_h in _between(tree, at_h, n_h):
        for d, share_d in _between(tree, at_d, n_d):
            row = tree.math("ADD", tree.math("MULTIPLY", h, float(n_d)), d)
            v = tree.math("DIVIDE", tree.math("ADD", row, 0.5), float(n_h * n_d))
            share = tree.math("MULTIPLY", share_h, share_d)
            for p, share_p in _between(tree, at_p, n_p, wraps=True):
                u = tree.math("DIVIDE", tree.math("ADD", p, 0.5), float(n_p))
                found = tree.image(image, u, v, "REPEAT", "Closest")
                found = tree.scaled(found, tree.math("MULTIPLY", share, share_p))
                total = found if total is None else tree.vector("ADD", total, found)
    return total


def _between(tree: Tree, at, n: int, *, wraps: bool = False) -> list[tuple]:
    """The two of ``n`` cells whose middles a place lies between, counted in cells from the first one's edge, and the share of each.

    Images are not left to interpolate: EEVEE would take the mean of many pixels, as of a texture seen from afar.
    """
    at = tree.math("SUBTRACT", at, 0.5)
    if not wraps:
        at = tree.math("MINIMUM", tree.math("MAXIMUM", at, 0.0), n - 1.0)
    low = tree.math("FLOOR", at)
    if not wraps:
        low = tree.math("MINIMUM", low, n - 2.0)
    share = tree.math("SUBTRACT", at, low)
    return [(low, tree.math("SUBTRACT", 1.0, share)), (tree.math("ADD", low, 1.0), share)]


def _filled(brdf: TabularBrdf) -> np.ndarray:
    """The samples, negative ones 0, an unmeasured one that of its neighbour nearer to the normal."""
    values = np.maximum(np.array(brdf.values), 0)
    for axis in (1, 2):
        rows = np.moveaxis(values, axis, 0)
        for row, following in pairwise(rows):
            np.copyto(following, row, where=np.isnan(following))
    return np.nan_to_num(values, nan=0.0)


def image_of(name: str, values: np.ndarray) -> bpy.types.Image:
    """A new image of float values, shape (height, width, 3), the first row at the bottom."""
    height, width, _ = values.shape
    image = bpy.data.images.new(name, width, height, alpha=False, float_buffer=True, is_data=True)
    fill(image, values)
    return image


def fill(image: bpy.types.Image, values: np.ndarray) -> None:
    """Give an image other values; they are packed into the file."""
    pixels = np.ones((*values.shape[:2], 4), np.float32)
    pixels[..., :3] = values
    image.pixels.foreach_set(pixels.ravel())
    image.update()
    image.pack()
    image.update_tag()
