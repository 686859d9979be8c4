"""Build the extension: ``python blender/build.py [ZIP]``.

The zip holds the add-on, the part of the package that needs numpy alone, as ``halfway/``, and the wheels of what that imports, with the
versions and checksums of the lock file.
"""

import shutil
import subprocess
import sys
import tempfile
import tomllib
import zipfile
from pathlib import Path

HERE = Path(__file__).parent
ROOT = HERE.parent
PACKAGE = ROOT / "src" / "halfway"
FOLDERS = ("brdf", "fit", "formats", "halfdiff", "library", "models", "recipes")
NO_ADDON = {"build.py", "check.py", "figures.py"}
WHEELS = ("jaxtyping", "threadpoolctl", "wadler-lindig")
A_DAY = (1980, 1, 1, 0, 0, 0)
"""Of the files in the zip: the same sources give the same bytes."""


def build(target: Path) -> Path:
    """Write the zip."""
    with tempfile.TemporaryDirectory() as folder:
        stage = Path(folder)
        for source in sorted(HERE.glob("*.py")):
            if source.name not in NO_ADDON:
                shutil.copy(source, stage)
        shutil.copy(ROOT / "LICENSE", stage)
        ignore = shutil.ignore_patterns("__pycache__", "*.nbi", "*.nbc")
        for name in FOLDERS:
            shutil.copytree(PACKAGE / name, stage / "halfway" / name, ignore=ignore)
        for source in PACKAGE.glob("*.py"):
            shutil.copy(source, stage / "halfway")
        download(stage / "wheels")
        wheels = ", ".join(f'"./wheels/{wheel.name}"' for wheel in sorted(stage.glob("wheels/*")))
        manifest = (HERE / "blender_manifest.toml").read_text()
        manifest = manifest.replace("\n[permissions]", f"wheels = [{wheels}]\n\n[permissions]")
        tomllib.loads(manifest)
        (stage / "blender_manifest.toml").write_text(manifest)
        target.parent.mkdir(parents=True, exist_ok=True)
        with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED) as file:
            for path in sorted(path for path in stage.rglob("*") if path.is_file()):
                info = zipfile.ZipInfo(path.relative_to(stage).as_posix(), A_DAY)
                info.compress_type = zipfile.ZIP_DEFLATED
                file.writestr(info, path.read_bytes())
    return target


def download(folder: Path) -> None:
    """The wheels, by pip, which checks them against the lock file's checksums."""
    export = ["uv", "export", "--quiet", "--frozen", "--no-dev", "--no-emit-project"]
    locked = subprocess.run(export, cwd=ROOT, check=True, capture_output=True, text=True).stdout
    entries = locked.replace("\\\n", " ").splitlines()
    wanted = [entry for entry in entries if entry.startswith(tuple(f"{name}==" for name in WHEELS))]
    assert len(wanted) == len(WHEELS), wanted
    folder.mkdir()
    requirements = folder / "requirements.txt"
    requirements.write_text("\n".join(wanted))
    pip = ["uv", "run", "--quiet", "--no-project", "--with", "pip", "python", "-m", "pip"]
    options = ["--quiet", "--no-deps", "--require-hashes", "--only-binary", ":all:"]
    subprocess.run(
        [*pip, "download", *options, "-d", str(folder), "-r", str(requirements)], check=True
    )
    requirements.unlink()


def version() -> str:
    """Of the extension."""
    return tomllib.loads((HERE / "blender_manifest.toml").read_text())["version"]


if __name__ == "__main__":
    default = ROOT / "dist" / f"halfway-blender-{version()}.zip"
    print(build(Path(sys.argv[1]) if len(sys.argv) > 1 else default))
