"""What is taken home from the page, and brought to it."""

from io import BytesIO
from pathlib import Path
from types import SimpleNamespace
from urllib.parse import unquote
from zipfile import ZipFile

import pytest
from fastapi.testclient import TestClient
from served import HOST, client_of, recipe_of

from halfway.formats import write_merl
from halfway.formats.rgl_writer import RESOLUTIONS, Resolution
from halfway.library import ProceduralLibrary
from halfway.recipes import Recipe, mix
from halfway.server import create_app, taking


@pytest.fixture(scope="module")
def client(small_library: ProceduralLibrary) -> TestClient:
    return client_of(small_library)


def test_a_downloaded_file_is_mixed_as_its_recipe_says(
    client: TestClient, small_library: ProceduralLibrary, tmp_path: Path
) -> None:
    answer = client.post("/api/export/merl", json=recipe_of("lobes"))
    write_merl(tmp_path / "mixed.binary", mix(small_library, Recipe.from_json(recipe_of("lobes"))))
    assert answer.content == (tmp_path / "mixed.binary").read_bytes()


def test_the_downloaded_file_is_the_written_one(
    client: TestClient, small_library: ProceduralLibrary, tmp_path: Path
) -> None:
    weights = {
        "r": {"material-1": 1.0},
        "g": {"material-1": 0.25, "material-2": 0.75},
        "b": {"material-5": 1.0},
    }
    answer = client.post("/api/export/merl", json={"library": "small", "weights": weights})
    write_merl(tmp_path / "mixed.binary", mix(small_library, Recipe.of("small", weights)))
    assert answer.content == (tmp_path / "mixed.binary").read_bytes()


def test_a_material_goes_home_to_mitsuba_too(
    client: TestClient, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("halfway.formats.rgl_writer.RESOLUTIONS", [Resolution(8, 8)])
    answer = client.post(
        "/api/export/bsdf", json={"library": "small", "weights": {"material-1": 1}}
    )
    assert answer.content.startswith(b"tensor_file\0")


def test_an_unknown_format_is_refused(client: TestClient) -> None:
    answer = client.post(
        "/api/export/gltf", json={"library": "small", "weights": {"material-1": 1}}
    )
    assert answer.status_code == 400
    assert "expected merl, bsdf, mtlx, glb" in answer.json()["error"]


def test_a_fit_says_how_far_off_it_is(client: TestClient, monkeypatch: pytest.MonkeyPatch) -> None:
    # Fitting takes seconds, and has its own tests.
    monkeypatch.setattr(taking, "fit", lambda *_: SimpleNamespace(summary="off by 3.9% ±"))
    monkeypatch.setattr(taking, "write_fit", lambda path, _: path.write_bytes(b"<materialx>"))
    answer = client.post(
        "/api/export/mtlx", json={"library": "small", "weights": {"material-1": 1}}
    )
    assert answer.content == b"<materialx>"
    assert unquote(answer.headers["halfway-summary"]) == "off by 3.9% ±"


def test_a_scene_is_a_zip_of_its_folder(
    client: TestClient, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("halfway.formats.rgl_writer.RESOLUTIONS", RESOLUTIONS[:1])
    answer = client.post(
        "/api/export/pbrt-v4", json={"library": "small", "weights": {"material-1": 1}}
    )
    with ZipFile(BytesIO(answer.content)) as archive:
        assert {"scene.pbrt", "material.bsdf"} <= set(archive.namelist())


def test_a_measurement_becomes_a_material(small_library: ProceduralLibrary, tmp_path: Path) -> None:
    client = TestClient(create_app(small_library), base_url=HOST)
    refused = client.post("/api/materials/notes.binary", content=b"nothing")
    assert refused.status_code == 400
    assert refused.json()["error"].startswith("notes.binary ")
    before = client.get("/api/tables/material-1").headers["etag"]
    write_merl(tmp_path / "scan.binary", small_library.brdf("material-2"))
    content = (tmp_path / "scan.binary").read_bytes()
    assert client.post("/api/materials/scan.binary", content=content).json() == {"name": "scan"}
    assert client.post("/api/materials/scan.binary", content=content).json()["name"] == "scan (2)"
    summary = client.get("/api/library").json()
    assert [each["name"] for each in summary["materials"]][-2:] == ["scan", "scan (2)"]
    own, theirs = (client.get(f"/api/tables/{name}") for name in ("scan", "material-2"))
    assert own.content == theirs.content
    assert own.headers["etag"] != before
