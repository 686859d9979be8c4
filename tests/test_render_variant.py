"""Which Mitsuba runs: devices, LLVM libraries, variants, and what the doctor says of them."""

import importlib.metadata
import signal
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from halfway.brdf import TabularBrdf
from halfway.errors import RenderError
from halfway.halfdiff import Grid
from halfway.render import Renderer, doctor, llvm, variant
from halfway.render.interrupts import interrupts_wait
from halfway.render.llvm import OLDEST_LLVM, Llvm, find_llvm, require_llvm
from halfway.render.variant import VARIANTS, load_mitsuba, require_tables

GRID = Grid.merl(4, 4, 8)
GREY = TabularBrdf(np.full((3, *GRID.shape), 0.2, np.float32), GRID)


def run(trial: str) -> subprocess.CompletedProcess[str]:
    """A program of its own: Mitsuba is imported, and a variant set, once in each."""
    return subprocess.run([sys.executable, "-c", trial], capture_output=True, text=True, check=True)


def test_the_doctor_names_everything_and_what_its_absence_costs():
    findings = {finding.what: finding for finding in doctor()}
    assert list(findings) == ["Mitsuba", "GPU", "LLVM", "variant", "denoiser", "video writer"]
    assert all(f.cost for f in findings.values())
    assert [f.what for f in findings.values() if f.needed] == ["Mitsuba", "variant"]
    # The keys of `halfway doctor --json`.
    assert [*asdict(findings["GPU"])] == ["what", "found", "cost", "needed"]
    assert findings["variant"].found == VARIANTS["gpu" if findings["GPU"].found else "cpu"]


def test_the_doctor_says_why_no_variant_renders(monkeypatch, tmp_path):
    library = tmp_path / "libLLVM-14.so.1"
    library.touch()
    monkeypatch.setenv("DRJIT_LIBLLVM_PATH", str(library))
    monkeypatch.setenv("DRJIT_LIBCUDA_PATH", str(tmp_path / "none.so"))
    findings = {finding.what: finding for finding in doctor()}
    assert findings["GPU"].found is None
    assert findings["variant"].found is None
    assert "LLVM 14" in findings["variant"].cost


@pytest.mark.parametrize(
    ("device", "lacks", "expected"),
    [
        ("auto", None, "cuda_ad_rgb"),
        ("auto", "no card", "llvm_ad_rgb"),
        ("cpu", None, "llvm_ad_rgb"),
        ("gpu", None, "cuda_ad_rgb"),
    ],
)
def test_a_gpu_that_works_is_taken_unless_the_cpu_is_asked_for(
    monkeypatch, device, lacks, expected
):
    monkeypatch.setattr(variant, "gpu_lacks", lambda: lacks)
    assert variant._fitting(device) == expected


def test_a_gpu_that_is_asked_for_and_not_there_is_an_error_that_says_why(monkeypatch):
    monkeypatch.setattr(variant, "gpu_lacks", lambda: "no card")
    with pytest.raises(RenderError, match=r"no GPU to render on: no card\. Use --device cpu"):
        variant._fitting("gpu")


def test_a_driver_without_ray_tracing_is_no_gpu(monkeypatch):
    monkeypatch.setattr(variant, "_DRIVER", {sys.platform: {"HALFWAY_NONE": "libnone.so.1"}})
    assert "libnone.so.1, a part of NVIDIA's driver" in str(variant.gpu_lacks())


def test_the_device_of_a_program_stays():
    here = load_mitsuba().variant()
    other = "cpu" if here.startswith("cuda") else "gpu"
    with pytest.raises(RenderError, match=f"{here}, which is set, does not run on the {other}"):
        Renderer("sphere", device=other)


def test_another_device_is_refused():
    done = run("""
from halfway import HalfwayError
from halfway.render import register
try:
    register("tpu")
except HalfwayError as error:
    print(error)
""")
    assert done.stdout == "there is no device 'tpu': expected auto, cpu or gpu.\n"


def test_a_system_library_that_mitsuba_lacks_is_named(monkeypatch, tmp_path):
    """As drjit/__init__.py does: what is missing, and a second error over it."""
    package = "try:\n    raise ImportError('libatomic.so.1: cannot open')\nexcept ImportError:\n    undefined\n"
    (tmp_path / "lacking.py").write_text(package)
    monkeypatch.syspath_prepend(tmp_path)
    with pytest.raises(
        RenderError, match=r"lacking cannot be imported \(libatomic\.so\.1: cannot open\)"
    ):
        variant._import("lacking")


@pytest.mark.parametrize("name", ["scalar_rgb", "scalar_spectral", "llvm_ad_spectral_polarized"])
def test_variants_that_cannot_look_up_tables_are_refused(name):
    with pytest.raises(RenderError, match=name):
        require_tables(name)


def test_the_table_is_known_in_variants_that_are_set_later():
    done = run("""
import halfway.render
halfway.render.register("cpu")
import mitsuba as mi
table = {"type": "halfway_table", "recipe": "gold-paint=1"}
for variant in ("llvm_ad_spectral", "scalar_rgb", "llvm_ad_mono", "llvm_ad_rgb"):
    mi.set_variant(variant)
    if variant != "scalar_rgb":
        print(mi.load_dict(table))
""")
    assert done.stdout.split("\n")[:3] == ["TableBsdf[90 x 90 x 180]"] * 3


def test_what_mitsuba_warns_of_does_not_go_among_the_data():
    done = run("""
from halfway.render.variant import load_mitsuba
mi = load_mitsuba("cpu")
mi.Log(mi.LogLevel.Warn, "beware")
""")
    assert done.stdout == ""
    assert "beware" in done.stderr


def test_ctrl_c_waits_for_compiled_code():
    done = []

    def press_and_go_on():
        signal.raise_signal(signal.SIGINT)
        done.append("the block")

    with pytest.raises(KeyboardInterrupt), interrupts_wait():
        press_and_go_on()
    assert done == ["the block"]
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_other_threads_have_no_ctrl_c_to_wait_for():
    def block() -> str:
        with interrupts_wait():
            return "done"

    with ThreadPoolExecutor(1) as pool:
        assert pool.submit(block).result() == "done"


def test_an_llvm_that_aborts_is_not_chosen():
    assert not Llvm(Path("libLLVM-15.so"), 15, "system").works
    assert not Llvm(Path("libLLVM.so"), None, "system").works
    assert Llvm(Path("libLLVM-19.so"), 19, "system").works


@pytest.mark.skipif(sys.platform != "linux", reason="the LLVM of the environment is for Linux")
def test_the_llvm_of_the_environment_is_found(monkeypatch):
    monkeypatch.delenv("DRJIT_LIBLLVM_PATH", raising=False)
    found = find_llvm()
    assert found is not None
    assert found.path.is_file()
    assert found.works
    monkeypatch.setenv("DRJIT_LIBLLVM_PATH", "/somewhere/libLLVM-20.so")
    chosen = find_llvm()
    assert chosen is not None
    assert (str(chosen.path), chosen.version) == ("/somewhere/libLLVM-20.so", 20)


@pytest.mark.skipif(sys.platform != "linux", reason="the LLVM of the environment is for Linux")
def test_the_llvm_of_the_environment_is_found_before_its_links_are_made(monkeypatch):
    listed = importlib.metadata.files("karellen-llvm-core") or []
    without = [file for file in listed if file.name != "libLLVM.so"]
    monkeypatch.delenv("DRJIT_LIBLLVM_PATH", raising=False)
    monkeypatch.setattr(llvm.importlib.metadata, "files", lambda _: without)
    found = find_llvm()
    assert found is not None
    assert found.origin == "karellen-llvm-core"


@pytest.mark.parametrize(
    ("name", "loaded", "message"),
    [
        ("libLLVM-14.so.1", None, "LLVM 14 .set by DRJIT_LIBLLVM_PATH.*Unset DRJIT_LIBLLVM_PATH"),
        ("own.so", 15, "own.so. cannot compile what renders, and may abort: expected 19 or later"),
        ("own.so", -1, "own.so. cannot compile what renders"),
        (None, 16, "LLVM 16 .loaded by Mitsuba.*register.. before Mitsuba is imported"),
    ],
)
def test_an_llvm_that_cannot_compile_is_refused_in_one_line(
    monkeypatch, tmp_path, name, loaded, message
):
    """By its name, else by what Dr.Jit says it has loaded: no process dies at the first render."""
    monkeypatch.delenv("DRJIT_LIBLLVM_PATH", raising=False)
    if name is not None:
        (tmp_path / name).touch()
        monkeypatch.setenv("DRJIT_LIBLLVM_PATH", str(tmp_path / name))
    monkeypatch.setattr(llvm, "_loaded_version", lambda: loaded)
    with pytest.raises(RenderError, match=message) as caught:
        require_llvm()
    assert "\n" not in str(caught.value)


def test_an_llvm_that_is_no_file_is_refused(monkeypatch):
    monkeypatch.setenv("DRJIT_LIBLLVM_PATH", "/nowhere/libLLVM.so")
    with pytest.raises(RenderError, match=r"names /nowhere/libLLVM\.so, which is no file"):
        require_llvm()


def test_an_llvm_that_works_is_let_through(monkeypatch):
    monkeypatch.delenv("DRJIT_LIBLLVM_PATH", raising=False)
    monkeypatch.setattr(llvm, "_loaded_version", lambda: OLDEST_LLVM)
    require_llvm()


def test_without_gpu_and_llvm_a_file_stands_for_the_table(tmp_path):
    """A Lambertian sphere looks the same either way."""
    done = run(f"""
import numpy as np
from halfway.render import Renderer, variant
variant.find_llvm = lambda: None
from halfway.brdf import TabularBrdf
from halfway.halfdiff import Grid
grid = Grid.merl(4, 4, 8)
renderer = Renderer("sphere", size=(24, 24), spp=4, device="cpu")
picture = renderer.picture(TabularBrdf(np.full((3, *grid.shape), 0.2, np.float32), grid))
import mitsuba
print(mitsuba.variant(), renderer.exact)
np.save({str(tmp_path / "picture.npy")!r}, picture)
""")
    assert done.stdout.split() == ["scalar_rgb", "False"]
    exact = Renderer("sphere", size=(24, 24), spp=4)
    assert exact.exact
    # At the edge pixels are only partly covered, by other samples.
    inside = (slice(6, 18), slice(6, 18))
    picture = np.load(tmp_path / "picture.npy")
    assert_allclose(picture[inside], exact.picture(GREY)[inside], atol=0.05)
