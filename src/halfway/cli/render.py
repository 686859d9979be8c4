"""``halfway render``: pictures of materials."""

from functools import partial
from pathlib import Path

from . import options
from .console import say, work
from .outputs import writing


def render(
    words: options.What,
    output: options.Image,
    scene: options.SceneName = "teapot",
    env: options.Environment = None,
    show_env: options.ShowEnv = False,
    mesh: options.Mesh = None,
    size: options.Size = "384",
    quality: options.Quality = "normal",
    spp: options.Spp = None,
    denoise: options.Denoise = None,
    bounces: options.Bounces = None,
    n: options.InStrip = 8,
    layout: options.Layout = "strip",
    turntable: options.Turntable = 0,
    turn: options.Turn = 0,
    exposure: options.Exposure = 0.0,
    seed: options.Seed = 0,
    device: options.Device = "auto",
    fps: options.Fps = 12,
    format: options.Pictures = "png",
    library: options.Library = "",
    force: options.Force = False,
) -> None:
    """Render materials in Mitsuba 3.

    With direct light (teapot, spheres, sphere) a route costs one render per measured material it touches. Routes of one
    length stand below each other, and side by side in an animation. Into a folder, the same command again goes on
    where it stopped.

    \b
    halfway render gold-paint teflon -o two.png
    halfway render fabric -o fabric.webp --scene spheres
    halfway render fabric fabric-paper -o compared.webp
    halfway render fabric -o frames --format exr
    halfway render new.binary -o new.png --size 1024 --quality final
    halfway render teflon chrome gold-paint -o three.png --scene trio
    halfway render gold-paint -o around.webp --turntable 24
    halfway render builtin:anisotropic:hairline-steel -o turned.png --scene brushed --turn 90
    halfway render chrome -o outside.png --scene sphere --env forest.exr --show-env
    """
    from halfway.recipes import open_materials
    from halfway.render import QUALITY, Renderer, denoiser_available, in_rows, write_pictures

    rows = in_rows([open_materials([word], library=library) for word in words])
    lit = partial(Renderer, scene, env=env, show_env=show_env, mesh=mesh, bounces=bounces)
    renderer = lit(
        size=options.parse_size(size),
        spp=QUALITY[quality] if spp is None else spp,
        denoise=denoiser_available() if denoise is None else denoise,
        seed=seed,
        turn_degrees=turn,
        device=device,
        work=work(),
    )
    write = partial(write_pictures, n_turns=turntable, fps=fps, exposure=exposure, work=work())
    with writing(output if output.suffix else None, force=force):
        written = write(
            output,
            renderer,
            rows,
            labels=[Path(word).name for word in words],
            most=None if layout == "sheet" else n,
            suffix=f".{format}",
        )
    say(f"{output}: {written}")
