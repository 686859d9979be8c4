"""The picture and the figures of the page on interchange: ``python docs/interchange.py [RGL_FOLDER]``.

RGL_FOLDER holds `NAME_rgb.bsdf` files, as ``halfway fetch rgl:NAME -o RGL_FOLDER`` leaves them; without it the parts on
measurements are left out.
"""

import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from halfway import MERL, Brdf, mix, open_library, tabulate
from halfway.brdf import check
from halfway.brdf.quality import lit_sphere, quality
from halfway.export import write_scene
from halfway.formats import read_brdf, read_rgl, write_merl, write_rgl
from halfway.render.variant import load_mitsuba, register
from halfway.space import route

FOLDER = Path(__file__).parent / "images"
STOPS = "cherry-235", "tungsten-carbide"
SIZE, SPP = 256, 256


def main(rgl: str = "") -> None:
    """Write the picture, print the figures."""
    with tempfile.TemporaryDirectory() as folder:
        picture(Path(folder))
        spectral(Path(folder))
        if rgl:
            measurements(sorted(Path(rgl).glob("*_rgb.bsdf")), Path(folder))
        checks()
        conversions(Path(folder))


def picture(folder: Path) -> None:
    """The middle of a route: stock Mitsuba in a process without this package, beside the table itself."""
    library = open_library("builtin:merl-abc")
    middle = mix(library, route(library, *STOPS, pace="uniform").recipe(0.5))
    scene = write_scene(folder, middle, "mitsuba", name="the middle of a route")
    for file in folder.glob("*.xml"):
        text = file.read_text().replace('value="512"', f'value="{SIZE}"')
        file.write_text(text.replace('name="sample_count" value="64"', f'name="sample_count" value="{SPP}"'))  # fmt: skip
    stock = (
        "import sys, mitsuba as mi; mi.set_variant('scalar_rgb'); import numpy as np;"
        "np.save('stock.npy', np.array(mi.render(mi.load_file('scene.xml'))));"
        "assert 'halfway' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", stock], cwd=folder, check=True)
    register()
    mi = load_mitsuba()
    exact = np.array(mi.render(mi.load_file(str(folder / "scene-exact.xml"))))
    shown = np.load(folder / "stock.npy")
    mi.Bitmap(np.concatenate([shown, exact], axis=1)).convert(
        mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.UInt8, True
    ).write(str(folder / "both.png"))
    _to_webp(folder / "both.png", FOLDER / "interchange.webp")
    print(
        f"route {' to '.join(STOPS)}, t = 0.5: {quality(shown, exact).psnr:.1f} dB between the pictures"
    )
    page = scene.folder / "README.md"
    print(next(line for line in page.read_text().splitlines() if line.startswith("`material.bsdf`")))  # fmt: skip


def spectral(folder: Path) -> None:
    """Stock Mitsuba's spectral value under D65, weighted by its own observer, against the table's RGB."""
    library = open_library("builtin:merl-abc")
    mi = load_mitsuba()
    wi, wo = _pairs(200, seed=1)
    with mi.variant_context("scalar_spectral"):
        nm = np.arange(380, 781, 5.0)
        observer = np.array([list(mi.cie1931_xyz(w)) for w in nm])
        white = np.array([mi.cie_d65(w) for w in nm])
        to_rgb = np.stack([list(mi.xyz_to_srgb(mi.Color3f(*row))) for row in np.eye(3)], axis=1)
        for name in ("gold-paint", "pink-felt", "blue-acrylic"):
            brdf = library.brdf(name)
            path = folder / "spectral.bsdf"
            write_rgl(path, brdf, spectral=True)
            spectra = _plugin(mi, path, wi, wo, nm)
            write_rgl(path, brdf)
            rgb = read_rgl(path).eval(wi, wo) * wi[:, 2:]
            for light, s in (("D65", white), ("E", np.ones_like(nm))):
                weights = observer * s[:, None] / (observer[:, 1] * s).sum()
                # A white surface is shown white: as a camera does that is balanced for the light.
                white_rgb = weights.sum(axis=0) @ to_rgb.T
                seen = spectra @ weights @ to_rgb.T / white_rgb
                error = np.abs(seen - rgb).sum() / np.abs(rgb).sum()
                print(f"spectral {name} under {light}: {error:.2%} mean error")


def measurements(files: list[Path], folder: Path) -> None:
    """Each file: our values and stock Mitsuba's; to a MERL file and back; and on to a .bsdf."""
    mi = load_mitsuba()
    for file in files:
        wi, wo = _pairs(2000, seed=0)
        wo = np.abs(wo) * [-1, -1, 1]
        brdf = read_rgl(file)
        ours = brdf.eval(wi, wo) * wi[:, 2:]
        with mi.variant_context("scalar_rgb"):
            theirs = _plugin(mi, file, wi, wo)
        differ = (np.abs(ours - theirs) / np.maximum(1, np.abs(theirs))).max()
        table = tabulate(brdf, MERL, name=brdf.name)
        write_merl(folder / "x.binary", table)
        again = read_brdf(folder / "x.binary")
        written = write_rgl(folder / "x.bsdf", again)
        final = lit_sphere(read_brdf(folder / "x.bsdf"))
        print(
            f"{brdf.name:22} stock {differ:.1e}  table {_db(lit_sphere(again), brdf):5.1f} dB  "
            f".bsdf {written.quality.psnr:5.1f} dB of the table, {_db(final, brdf):5.1f} dB of the measurement",
            flush=True,
        )


def checks() -> None:
    """The validity cards of the built-in materials."""
    library = open_library("builtin:merl-abc")
    start = time.perf_counter()
    cards = [check(library.brdf(name)) for name in library.names]
    n_broken = sum(not card.ok for card in cards)
    print(
        f"check: {len(cards)} materials, {n_broken} break a law, {time.perf_counter() - start:.1f} s"
    )


def conversions(folder: Path) -> None:
    """Every built-in material as .bsdf at the default resolution."""
    library = open_library("builtin:merl-abc")
    errors, sides, seconds = [], [], []
    for name in library.names:
        brdf = library.brdf(name)
        start = time.perf_counter()
        written = write_rgl(folder / "x.bsdf", brdf)
        seconds.append(time.perf_counter() - start)
        errors.append(written.quality.psnr)
        sides.append(written.resolution.size)
    worst = library.names[int(np.argmin(errors))]
    counts = ", ".join(f"{sides.count(n)} at {n} x {n}" for n in sorted(set(sides)))
    print(
        f".bsdf: least {min(errors):.1f} dB ({worst}), median {np.median(errors):.1f} dB; {counts}; "
        f"median {np.median(seconds):.1f} s, at most {max(seconds):.1f} s"
    )


def _db(seen: np.ndarray, brdf: Brdf) -> float:
    return quality(seen, lit_sphere(brdf)).psnr


def _pairs(n: int, *, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Random pairs above the horizon, exact in float32 as a renderer holds them."""
    rng = np.random.default_rng(seed)
    z, phi = rng.uniform(0.02, 1, (2, n)), rng.uniform(0, 2 * np.pi, (2, n))
    r = np.sqrt(1 - z * z)
    pair = np.stack([r * np.cos(phi), r * np.sin(phi), z], axis=-1)
    wi, wo = pair.astype(np.float32).astype(float)
    return wi, wo


def _plugin(mi, file: Path, wi, wo, wavelengths=None) -> np.ndarray:
    """Values times the cosine by the stock plugin, whose ``wi`` is the viewer; spectral at ``wavelengths``, four at a time."""
    bsdf = mi.load_dict({"type": "measured", "filename": str(file)})
    si, context = mi.SurfaceInteraction3f(), mi.BSDFContext()
    rows = []
    for light, viewer in zip(wi.tolist(), wo.tolist(), strict=True):
        si.wi = viewer
        if wavelengths is None:
            rows.append(list(bsdf.eval(context, si, light)))
            continue
        row = []
        for start in range(0, len(wavelengths), 4):
            four = np.resize(wavelengths[start : start + 4], 4).tolist()
            si.wavelengths = four
            row += list(bsdf.eval(context, si, light))
        rows.append(row[: len(wavelengths)])
    return np.array(rows)


def _to_webp(source: Path, path: Path) -> None:
    from PIL import Image

    with Image.open(source) as image:
        image.save(path, lossless=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
