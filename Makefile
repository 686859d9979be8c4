# Everything a person or CI does with this repository. `make` alone says what there is.

UV := $(shell command -v uv 2>/dev/null || echo python3 -m uv)
RUN := $(UV) run --frozen
# Two workers: a test run leaves the machine usable.
PYTEST := $(RUN) pytest -n 2

.DEFAULT_GOAL := help
.PHONY: help setup demo test lint check-python bench docs pictures

help:           ## this list
	@grep -hE '^[a-z-]+: .*##|^[a-z-]+:  *##' $(MAKEFILE_LIST) | sed -E 's/:.*## */\t/' | expand -t 14

setup:          ## install what the rest needs into .venv
	@$(UV) --version >/dev/null 2>&1 || python3 -m pip install --quiet uv || python3 -m pip install --quiet --user --break-system-packages uv
	@$(UV) sync --frozen --quiet

demo: setup     ## the paper's main run on the built-in library; leaves pictures in demo/
	$(RUN) halfway demo -o demo

lint: setup     ## style, types, layers
	$(RUN) ruff check
	$(RUN) ruff format --check
	$(RUN) pyright
	$(RUN) lint-imports

test: lint      ## every check
	$(PYTEST)

bench: setup    ## speed, as ratios measured in one run
	$(RUN) pytest benchmarks --benchmark-only --benchmark-group-by=group -o python_files='bench_*.py' -o addopts=''

pictures: setup ## regenerate the pictures of the README
	$(RUN) python docs/pictures.py
