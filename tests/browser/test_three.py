"""A ``.glb`` as three.js, which most of the web draws with, reads it."""

from pathlib import Path

import pytest
from in_three import draw  # pyright: ignore[reportMissingImports]
from playwright.sync_api import Browser

from halfway.brdf import Quality
from halfway.export import write_fit
from halfway.fit import Fit, Gltf

# Of a lobe three.js has another shadowing and adds what light of several facets brings.
MODELS = {
    "body": (Gltf([0.6, 0.3, 0.1], specular=0.0), 70),
    "plastic": (Gltf([0.5, 0.1, 0.1], roughness=0.3), 40),
    "lacquer": (Gltf([0.1, 0.2, 0.5], roughness=0.6, clearcoat=1.0, clearcoat_roughness=0.2), 40),
}


@pytest.fixture(scope="module")
def psnr(browser: Browser, tmp_path_factory: pytest.TempPathFactory) -> dict[str, float]:
    folder: Path = tmp_path_factory.mktemp("glb")
    files = [folder / f"{name}.glb" for name in MODELS]
    for path, (model, _) in zip(files, MODELS.values(), strict=True):
        write_fit(path, Fit(path.stem, model, 0.0, Quality(40.0, 0.0), 0.0))
    drawn = draw(browser, files)
    return {
        name: pictures.errors(model)[0]
        for (name, (model, _)), pictures in zip(MODELS.items(), drawn, strict=True)
    }


@pytest.mark.parametrize("name", MODELS)
def test_three_js_shows_what_the_file_means(name: str, psnr: dict[str, float]) -> None:
    assert psnr[name] > MODELS[name][1]
