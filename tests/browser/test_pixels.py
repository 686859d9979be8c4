"""The page's pixels against quadrature in float64, and against Mitsuba.

The camera, the sphere and the lights are those of `halfway.render.scenes`; the page shows 8-bit sRGB.
"""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from conftest import (  # pyright: ignore[reportMissingImports]
    Explorer,
    in_mitsuba,
    squares,
    to_linear,
)
from numpy.testing import assert_array_equal

from halfway.brdf import TabularBrdf
from halfway.brdf.quadrature import hemisphere
from halfway.library import ProceduralLibrary
from halfway.recipes import mix
from halfway.render.pictures import to_8_bit
from halfway.render.scenes import SCENES, Scene
from halfway.render.studio import studio

MATERIALS = ["pink-felt", "cherry-235", "chrome"]
SCENE = SCENES["spheres"]
SIZE = {"width": 460, "height": 420}
# A pixel is the mean over its area; this many points along each side stand for it.
N_POINTS = 5
LEVELS = 2
"""Half floats (.05 %), the fixed-point weights of the hardware filter and 8 bits: at most two levels, where the picture is smooth."""


@pytest.fixture(scope="module")
def scale() -> float:
    return 0.5


@dataclass
class Picture:
    """Pixels of the page, and the camera that they belong to."""

    bytes: np.ndarray
    """(height, width, 4)"""

    def rays(self, rows: np.ndarray, columns: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Eye and unit rays through the given places, in pixels."""
        height, width = self.bytes.shape[:2]
        eye, target = np.array(SCENE.camera.at), np.array(SCENE.camera.target)
        forward = (target - eye) / np.linalg.norm(target - eye)
        right = np.cross(forward, [0.0, 0.0, 1.0])
        up = np.cross(right, forward)
        scale = np.tan(np.radians(SCENE.camera.fov_degrees) / 2) / (min(width, height) / 2)
        x, y = (columns - width / 2) * scale, (height / 2 - rows) * scale
        rays = forward + x[..., None] * right + y[..., None] * up
        return eye, rays / np.linalg.norm(rays, axis=-1, keepdims=True)


def surface(
    shown: Picture, rows: np.ndarray, columns: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Position, normal and direction to the eye where the rays meet the sphere."""
    eye, rays = shown.rays(rows, columns)
    centre = np.array([0.0, 0.0, 1.0]) - eye
    along = rays @ centre
    miss = centre - along[..., None] * rays
    at = eye + (along - np.sqrt(1 - (miss**2).sum(-1)))[..., None] * rays
    return at, at - [0.0, 0.0, 1.0], -rays


def local(normal: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    """Directions in a frame about the normal; isotropic materials do not care which."""
    helper = np.where(np.abs(normal[..., :1]) > 0.5, [0.0, 1.0, 0.0], [1.0, 0.0, 0.0])
    x = np.cross(helper, normal)
    x /= np.linalg.norm(x, axis=-1, keepdims=True)
    y = np.cross(normal, x)
    return np.stack([(vectors * axis).sum(-1) for axis in (x, y, normal)], axis=-1)


def under_points(
    brdf: TabularBrdf, at: np.ndarray, normal: np.ndarray, wo: np.ndarray
) -> np.ndarray:
    radiance = np.zeros((*at.shape[:-1], 3))
    for light in SCENE.points:
        way = np.array(light.at) - at
        distance = np.linalg.norm(way, axis=-1, keepdims=True)
        wi = local(normal, way / distance)
        values = np.nan_to_num(brdf.eval(wi, local(normal, wo)))
        radiance += values * np.maximum(wi[..., 2:], 0) * light.intensity / distance**2
    return radiance


def in_studio(
    brdf: TabularBrdf, normal: np.ndarray, wo: np.ndarray, environment: np.ndarray
) -> np.ndarray:
    """One point, by the midpoint rule over half vectors, where the table is smooth."""
    z = np.array(normal)
    x = np.cross([1.0, 0.0, 0.0], z)
    x /= np.linalg.norm(x)
    frame = np.stack([x, np.cross(z, x), z])
    out = frame @ wo
    h, dh = hemisphere(360, 240)
    cosine = h @ out
    wi = 2 * cosine[:, None] * h - out
    lit = (cosine > 0) & (wi[:, 2] > 0)
    wi, measure = wi[lit], (4 * cosine * dh)[lit]
    values = np.nan_to_num(brdf.eval(wi, np.broadcast_to(out, wi.shape)))
    light = seen(environment, wi @ frame)
    return ((measure * wi[:, 2])[:, None] * values * light).sum(axis=0)


def seen(environment: np.ndarray, w: np.ndarray) -> np.ndarray:
    """The latitude-longitude picture along directions, linear between pixel centres."""
    height, width = environment.shape[:2]
    column = width * (np.arctan2(w[:, 0], w[:, 1]) / (2 * np.pi) + 0.5) - 0.5
    row = np.clip(height * np.arccos(np.clip(w[:, 2], -1, 1)) / np.pi - 0.5, 0, height - 1)
    j, i = np.floor(column).astype(int), np.minimum(np.floor(row).astype(int), height - 2)
    u, v = (column - j)[:, None], (row - i)[:, None]
    left, right = j % width, (j + 1) % width
    top = (1 - u) * environment[i, left] + u * environment[i, right]
    return (1 - v) * top + v * ((1 - u) * environment[i + 1, left] + u * environment[i + 1, right])


def places(shown: Picture, n: int, seed: int) -> np.ndarray:
    """Pixels well inside the sphere, (n, 2): row, column."""
    height, width = shown.bytes.shape[:2]
    rng = np.random.default_rng(seed)
    radius = 0.38 * min(height, width) * np.sqrt(rng.random(n))
    turn = 2 * np.pi * rng.random(n)
    return np.stack(
        [height / 2 + radius * np.sin(turn), width / 2 + radius * np.cos(turn)], -1
    ).astype(int)


def settled(explorer: Explorer, name: str, light: str) -> Picture:
    """The finished picture of one material, its exposure halved."""
    explorer.page.set_viewport_size(SIZE)
    explorer.open(f"#space=linear&stops={name},teflon&t=0&light={light}&exposure=-1")
    explorer.wait_until_settled()
    return Picture(explorer.drawn())


def difference_from_mitsuba(shown: Picture, scene: Scene, brdf: TabularBrdf, spp: int) -> float:
    """Mean absolute difference of the sphere's linear values in squares of pixels, over their mean."""
    rendered = squares((in_mitsuba(scene, brdf, shown.bytes, spp=spp) / 2).clip(0, 1))
    opaque = shown.bytes[..., 3] == 255
    # The outermost pixels are partly beside the sphere.
    whole = opaque & np.roll(opaque, 1, 0) & np.roll(opaque, 1, 1)
    inside = squares(whole[..., None])[..., 0] == 1
    difference = np.abs(squares(to_linear(shown.bytes)) - rendered)[inside]
    return difference.mean() / rendered[inside].mean()


@pytest.mark.parametrize("name", MATERIALS)
def test_three_lights(explorer: Explorer, library: ProceduralLibrary, name: str) -> None:
    shown = settled(explorer, name, "points")
    brdf = library.brdf(name)
    agrees_under_points(shown, brdf)
    assert difference_from_mitsuba(shown, SCENE, brdf, spp=128) < 0.015


def test_a_mix_of_lobes_under_three_lights(explorer: Explorer, library: ProceduralLibrary) -> None:
    explorer.page.set_viewport_size(SIZE)
    explorer.open(
        "#space=linear&blend=lobes&pace=uniform&stops=pink-felt,gold-paint&t=0.375&light=points&exposure=-1"
    )
    explorer.wait_until_settled()
    shown = Picture(explorer.drawn())
    weights = {"pink-felt": 0.625, "gold-paint": 0.375}
    agrees_under_points(shown, mix(library, weights, blend="lobes"))
    # While it is dragged it is drawn from a coarser table: the same to the eye, and then the same again.
    explorer.set_t(0.5)
    explorer.set_t(0.375)
    explorer.wait_until_settled()
    assert_array_equal(explorer.drawn(), shown.bytes)


def agrees_under_points(shown: Picture, brdf: TabularBrdf) -> None:
    """The page's picture, its exposure halved, is that of quadrature."""
    pixels = places(shown, 300, seed=1)
    offsets = (np.arange(N_POINTS) + 0.5) / N_POINTS
    rows = pixels[:, 0, None, None] + offsets[:, None]
    columns = pixels[:, 1, None, None] + offsets
    at, normal, wo = surface(shown, *np.broadcast_arrays(rows, columns))
    radiance = under_points(brdf, at, normal, wo)
    radiance /= 2
    expected = to_8_bit(radiance.mean(axis=(1, 2))).astype(int)
    # Inside a highlight's edge 16 points do not settle a pixel: compare where the pixel is nearly even.
    spread = to_8_bit(radiance.max(axis=(1, 2))).astype(int) - to_8_bit(radiance.min(axis=(1, 2)))
    even = (spread <= 8).all(axis=-1)
    assert even.sum() > 200
    difference = np.abs(shown.bytes[tuple(pixels.T)][:, :3].astype(int) - expected)[even]
    assert difference.max() <= LEVELS


@pytest.mark.parametrize("name", MATERIALS)
def test_studio(explorer: Explorer, library: ProceduralLibrary, name: str) -> None:
    shown = settled(explorer, name, "studio")
    pixels = places(shown, 24, seed=2)
    _, normal, wo = surface(shown, pixels[:, 0] + 0.5, pixels[:, 1] + 0.5)
    environment = studio().astype(np.float64)
    brdf = library.brdf(name)
    radiance = np.stack(
        [in_studio(brdf, n, o, environment) for n, o in zip(normal, wo, strict=True)]
    )
    expected = to_8_bit(radiance / 2).astype(float)
    # The mean over a few pixels around each place: less noise, and the picture is smooth there.
    got = np.stack(
        [shown.bytes[i - 2 : i + 3, j - 2 : j + 3, :3].mean(axis=(0, 1)) for i, j in pixels]
    )
    error = np.abs(got - expected)
    # A mirror shows the edges of the lamps, where a few pixels' mean is no point's value.
    assert np.median(error) < 1
    assert np.quantile(error, 0.8) < 2.5
    assert difference_from_mitsuba(shown, replace(SCENE, points=()), brdf, spp=64) < 0.015
