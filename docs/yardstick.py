"""The picture and the tables of docs/yardstick.md, of a finished benchmark.

python docs/yardstick.py FOLDER        # what `halfway benchmark ... -o FOLDER` wrote
"""

import argparse
import json
from collections.abc import Iterator, Sequence
from pathlib import Path

from halfway.yardstick import Result
from halfway.yardstick.plots import figure

IMAGE = Path(__file__).parent / "images" / "yardstick.webp"
NUMBERS = (1, 2, 5, 10, 20, 40, 100, 400)
PARAMETERS = (5, 10, 20)
"""Of methods that hold a material in any number of parameters."""
MEASURES = ("mean-log", "psnr.judging", "ssim.judging", "flip.judging", "ciede2000.judging")
DIGITS = (3, 1, 3, 3, 1)


def main() -> None:
    """Draw the picture, print the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    document = json.loads((parser.parse_args().folder / "benchmark.json").read_text())
    results = [Result(**each) for each in document["results"] if each["split"] == "liu2023"]
    recovered = [each for each in results if each.task == "recover"]
    plots = figure(recovered, ("mean-log", "psnr.judging"), "measured pairs of directions, n")
    plots.savefig(IMAGE, dpi=144, pil_kwargs={"quality": 88})
    print(*_recovered(recovered), sep="\n")
    print()
    print(*_reconstructed([each for each in results if each.task == "reconstruct"]), sep="\n")


def _recovered(results: Sequence[Result]) -> Iterator[str]:
    yield "| | " + " | ".join(map(str, NUMBERS)) + " |"
    yield "|---" * (1 + len(NUMBERS)) + "|"
    for method in dict.fromkeys(each.method for each in results):
        of = {each.setting: _with_interval(each) for each in results if each.method == method}
        yield f"| {method} | " + " | ".join(of.get(n, "") for n in NUMBERS) + " |"


def _with_interval(result: Result) -> str:
    mean, *ends = (each["mean-log"] for each in (result.scores, result.low, result.high) if each)
    return _short(mean, 3) + (f" ({' to '.join(_short(end, 3) for end in ends)})" if ends else "")


def _reconstructed(results: Sequence[Result]) -> Iterator[str]:
    methods = [each.method for each in results]
    yield "| | k | mean log | PSNR | SSIM | FLIP | CIEDE2000 |"
    yield "|---" * (2 + len(MEASURES)) + "|"
    for each in results:
        if methods.count(each.method) == 1 or each.setting in PARAMETERS:
            shown = (_short(each.scores[m], n) for m, n in zip(MEASURES, DIGITS, strict=True))
            yield f"| {each.method} | {each.setting} | " + " | ".join(shown) + " |"


def _short(value: float, digits: int) -> str:
    return f"{value:.{digits}f}".removeprefix("0") if digits > 1 else f"{value:.{digits}f}"


if __name__ == "__main__":
    main()
