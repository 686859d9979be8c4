"""Our OpenPBR and the shader that MaterialX itself generates for it, run in WebGL on the same pairs of directions.

Every pair is one pixel drawn into a float texture: normal +z, the camera along wo, one directional light along wi, so that the
shader's colour is f_r times the cosine of the light.
"""

from dataclasses import replace
from importlib import import_module
from typing import Any

import numpy as np
import pytest
from conftest import opened  # pyright: ignore[reportMissingImports]
from numpy.testing import assert_allclose
from playwright.sync_api import Browser

from halfway.brdf import Quality
from halfway.export.materialx import to_materialx
from halfway.fit import Fit, OpenPbr

VERTEX = """#version 300 es
out vec3 normalWorld; out vec3 tangentWorld; out vec3 positionWorld;
void main() {
    normalWorld = vec3(0, 0, 1); tangentWorld = vec3(1, 0, 0); positionWorld = vec3(0);
    gl_Position = vec4(0, 0, 0, 1); gl_PointSize = 1.0;
}"""

DRAW = """({ vertex, fragment, models, pairs }) => {
    const gl = document.createElement("canvas").getContext("webgl2");
    gl.getExtension("EXT_color_buffer_float");
    const program = gl.createProgram();
    for (const [type, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
        const shader = gl.createShader(type);
        gl.shaderSource(shader, source);
        gl.compileShader(shader);
        if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw gl.getShaderInfoLog(shader);
        gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    gl.useProgram(program);
    gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
    gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA32F, pairs.length, 1);
    gl.bindFramebuffer(gl.FRAMEBUFFER, gl.createFramebuffer());
    const attached = gl.getParameter(gl.TEXTURE_BINDING_2D);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, attached, 0);
    const at = (name) => gl.getUniformLocation(program, name);
    const set = (name, value) =>
        Array.isArray(value) ? gl.uniform3fv(at(name), value)
        : typeof value === "boolean" ? gl.uniform1i(at(name), value) : gl.uniform1f(at(name), value);
    gl.uniform1i(at("u_numActiveLightSources"), 1);
    gl.uniform1i(at("u_lightData[0].type"), 1);
    set("u_lightData[0].color", [1, 1, 1]);
    set("u_lightData[0].intensity", 1);
    return models.map((model) => {
        for (const name in model) set(name, model[name]);
        pairs.forEach(([wi, wo], i) => {
            set("u_viewPosition", wo);
            set("u_lightData[0].direction", wi.map((x) => -x));
            gl.viewport(i, 0, 1, 1);
            gl.drawArrays(gl.POINTS, 0, 1);
        });
        const pixels = new Float32Array(4 * pairs.length);
        gl.readPixels(0, 0, pairs.length, 1, gl.RGBA, gl.FLOAT, pixels);
        return pairs.map((_, i) => Array.from(pixels.slice(4 * i, 4 * i + 3)));
    });
}"""

MODELS = {
    "plastic": OpenPbr([0.1, 0.4, 0.7], specular_roughness=0.25, specular_ior=1.6),
    "rough": OpenPbr([0.9, 0.5, 0.2], base_diffuse_roughness=0.8, specular_ior=1.01),
    "metal": OpenPbr(
        [0.9, 0.6, 0.3], base_metalness=1.0, specular_color=[0.9, 0.5, 0.7], specular_roughness=0.5
    ),
    "brushed": OpenPbr(
        [0.9, 0.6, 0.3],
        base_metalness=0.7,
        specular_roughness=0.5,
        specular_roughness_anisotropy=0.8,
    ),
    "velvet": OpenPbr(
        [0.3, 0.1, 0.1], fuzz_weight=0.7, fuzz_color=[0.9, 0.8, 0.4], fuzz_roughness=0.4
    ),
    "lacquer": OpenPbr([0.6, 0.1, 0.1], coat_weight=0.8, coat_roughness=0.2),
    "everything": OpenPbr(
        [0.5, 0.4, 0.3],
        base_diffuse_roughness=0.3,
        base_metalness=0.4,
        specular_color=[0.8, 0.7, 0.9],
        specular_roughness=0.4,
        specular_ior=2.2,
        coat_weight=0.3,
        coat_roughness=0.3,
        fuzz_weight=0.2,
        fuzz_color=[0.2, 0.9, 0.5],
        fuzz_roughness=0.9,
    ),
}


@pytest.fixture(scope="module")
def pairs() -> tuple[np.ndarray, np.ndarray]:
    """Within 85 degrees of the normal, half of them near the mirror direction."""
    rng = np.random.default_rng(3)
    theta, phi = np.radians(85) * np.sqrt(rng.random((2, 120))), 2 * np.pi * rng.random((2, 120))
    theta[1, ::2], phi[1, ::2] = theta[0, ::2] * 0.98, phi[0, ::2] + np.pi
    sin = np.sin(theta)
    wi, wo = np.stack([sin * np.cos(phi), sin * np.sin(phi), np.cos(theta)], axis=-1)
    return wi, wo


@pytest.fixture(scope="module")
def drawn(browser: Browser, pairs: tuple[np.ndarray, np.ndarray]) -> dict[str, np.ndarray]:
    """What MaterialX's shader makes of each of `MODELS`, f_r times the cosine of the light."""
    document = import_module("MaterialX").createDocument()
    surface = document.addNode("open_pbr_surface", "surface", "surfaceshader")
    # A mention keeps an input from being folded into the code.
    surface.setInputValue("fuzz_weight", 0.5, "float")
    document.addMaterialNode("worn", surface)
    models = [
        {f"surface_{name}": value for name, value in model.parameters().items()}
        for model in MODELS.values()
    ]
    return dict(zip(MODELS, draw(browser, document, models, pairs), strict=True))


def draw(
    browser: Browser,
    document: Any,
    models: list[dict[str, Any]],
    pairs: tuple[np.ndarray, np.ndarray],
) -> list[np.ndarray]:
    """The colours of a document's material with each of these values of its uniforms in place of its own."""
    fragment, uniforms = shader(document)
    argument = {
        "vertex": VERTEX,
        "fragment": fragment,
        "models": [{**uniforms, **model} for model in models],
        "pairs": np.stack(pairs, axis=1).tolist(),
    }
    with opened(browser) as page:
        return [np.array(colours) for colours in page.evaluate(DRAW, argument)]


def shader(document: Any) -> tuple[str, dict[str, Any]]:
    """The fragment shader that MaterialX generates for a document's material, and the values of its uniforms."""
    mx: Any = import_module("MaterialX")
    generation: Any = import_module("MaterialX.PyMaterialXGenShader")
    essl: Any = import_module("MaterialX.PyMaterialXGenGlsl")
    library = mx.createDocument()
    mx.loadLibraries(mx.getDefaultDataLibraryFolders(), mx.getDefaultDataSearchPath(), library)
    document.setDataLibrary(library)
    (material,) = document.getMaterialNodes()
    generator = essl.EsslShaderGenerator.create()
    context = generation.GenContext(generator)
    context.registerSourceCodeSearchPath(mx.getDefaultDataSearchPath())
    options = context.getOptions()
    options.hwMaxActiveLightSources = 1
    none = generation.HwSpecularEnvironmentMethod.SPECULAR_ENVIRONMENT_NONE
    options.hwSpecularEnvironmentMethod = none
    light = library.getNodeDef("ND_directional_light")
    generation.HwShaderGenerator.bindLightShader(light, 1, context)
    made = generator.generate("shader", material, context)
    block = made.getStage("pixel").getUniformBlock("PublicUniforms")
    ports = [block[i] for i in range(block.size())]
    values = {p.getVariable(): p.getValue().getData() for p in ports if p.getValue() is not None}
    uniforms = {name: list(v) if hasattr(v, "asTuple") else v for name, v in values.items()}
    # Without an environment the generator mentions a uniform that it does not declare.
    missing = "precision highp float;\nuniform bool u_refractionTwoSided;"
    return made.getSourceCode("pixel").replace("precision highp float;", missing, 1), uniforms


def test_the_tangent_that_a_file_turns_is_the_models(
    browser: Browser, pairs: tuple[np.ndarray, np.ndarray]
) -> None:
    mx: Any = import_module("MaterialX")
    model = replace(MODELS["brushed"], tangent_rotation=0.5)
    document = mx.createDocument()
    text = to_materialx(Fit("a", model, 0.0, Quality(40.0, 0.0), 0.0))
    mx.readFromXmlString(document, text)
    (found,) = draw(browser, document, [{}], pairs)
    wi, wo = pairs
    assert_allclose(found, model.eval(wi, wo) * wi[:, 2:], rtol=1e-3, atol=1e-6)


@pytest.mark.parametrize("name", MODELS)
def test_values_are_those_of_materialx(
    name: str, drawn: dict[str, np.ndarray], pairs: tuple[np.ndarray, np.ndarray]
) -> None:
    wi, wo = pairs
    expected = MODELS[name].eval(wi, wo) * wi[:, 2:]
    # The shader counts in float32, and takes sin^2 of the half vector from its rounded components.
    assert_allclose(drawn[name], expected, rtol=1e-3, atol=1e-6)
