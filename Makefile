# surfmesh: `make mesh` sets everything up and runs the main job; `make help` lists the rest.

PYTHON ?= python3
VENV ?= .venv
CONSTRAINTS ?= constraints.txt
LOWEST_PYTHON ?= python3.11
BIN := $(VENV)/bin
BUILD ?= build/dev
SOURCES := $(shell find src -name '*.[ch]pp')
LOWEST := .venv-lowest
USED := .[cad,view]

# what the lowest versions are tried with: all that calls the libraries, little of what is our own
CORE := tests/geometry tests/sizing tests/result/test_surface_mesh.py tests/cli/test_cli.py \
    tests/io/test_formats.py tests/io/test_format_groups.py tests/view/test_view.py \
    tests/quality/opinion tests/whole/test_gallery_meshes.py tests/whole/test_planar_regions.py \
    tests/cad/conversion tests/cad/cadquery tests/cad/reading/test_read_file.py \
    tests/cad/selection

# $(call install,ENVIRONMENT,CONSTRAINTS,REQUIREMENT): uv does it in seconds, pip where uv cannot
define install
@$(1)/bin/python tools/build_backend.py
@echo "installing $(3) and what it needs into $(1)"
@$(1)/bin/python -m pip --disable-pip-version-check install -qq --only-binary=:all: -c $(CONSTRAINTS) uv || \
    echo "there is no uv for this machine" >&2
@$(1)/bin/uv pip install --quiet --python $(1)/bin/python --only-binary=:all: -c $(2) -e '$(3)' || \
    { echo "pip installs instead of uv" >&2; $(1)/bin/python -m pip \
    --disable-pip-version-check install -qq --only-binary=:all: -c $(2) -e '$(3)'; }
@touch $(1)/.installed
endef

.DEFAULT_GOAL := help
.PHONY: help venv core stubs wheel mesh test sanitize races fuzz lint lowest docs bench constraints licences \
    clean

COMPILE := $(BIN)/uv pip compile --quiet --only-binary=:all: --python-version 3.11 \
    --no-annotate --custom-compile-command 'make constraints'

help: ## this list
	@grep -E '^[a-z]+:.*##' $(MAKEFILE_LIST) | sed -E 's/^([a-z]+):[^#]*## /  make \1\t/' | expand -t 20

venv: $(VENV)/.installed ## virtual environment with surfmesh (VENV=.venv, PYTHON=python3)

core: ## the compiled core anew, where it lies (BUILD=build/dev, CORE_OPTIONS=-D...)
	@test -f $(BUILD)/build.ninja || cmake -S . -B $(BUILD) -G Ninja -DSURFMESH_WARNINGS=ON \
	    -DPython_EXECUTABLE=$(abspath $(BIN)/python) $(CORE_OPTIONS) >/dev/null
	cmake --build $(BUILD)

stubs: core ## types of the compiled core, for mypy: surfmesh/_core/*.pyi
	PYTHONPATH=. $(BIN)/python -m nanobind.stubgen -q -r -m surfmesh._core -O surfmesh

wheel: $(VENV)/.installed-dev ## a wheel in dist/, tried in an empty environment
	rm -rf dist build/wheel-try
	$(BIN)/python -m build --wheel --installer uv --outdir dist .
	$(BIN)/python -m venv build/wheel-try
	$(BIN)/uv pip install --quiet --python build/wheel-try/bin/python --only-binary=:all: \
	    -c $(CONSTRAINTS) dist/surfmesh-*.whl
	cd build/wheel-try && bin/python -P -I -m surfmesh mesh torus -o torus.vtu && \
	    bin/python -P -I -m surfmesh check torus.vtu

mesh: $(VENV)/.installed ## mesh, check and draw the wavy surface; results in outputs/
	$(BIN)/surfmesh mesh wavy -o outputs/wavy.vtu --picture outputs/wavy.png --report outputs/wavy.json --second-opinion

test: lint ## lint, layers, types and tests
	$(BIN)/python -m pytest -n 2 --dist worksteal

SANITIZED := build/sanitize/package/surfmesh
PRELOADED = $(shell $(or $(CXX),c++) -print-file-name=libasan.so) \
    $(shell $(or $(CXX),c++) -print-file-name=libstdc++.so)
sanitize: $(VENV)/.installed-dev ## tests of the core under address and undefined-behaviour sanitizers
	mkdir -p $(SANITIZED) && ln -sfn $(filter-out surfmesh/_core%,$(wildcard $(CURDIR)/surfmesh/*)) $(SANITIZED)
	rm -f $(SANITIZED)/_core*
	PATH="$(abspath $(BIN)):$$PATH" cmake -S . -B build/sanitize -G Ninja -DSURFMESH_SANITIZE=ON \
	    -DSURFMESH_UNITY=ON \
	    -DPython_EXECUTABLE=$(abspath $(BIN)/python) -DSURFMESH_MODULE=$(abspath $(SANITIZED)) >/dev/null
	PATH="$(abspath $(BIN)):$$PATH" cmake --build build/sanitize
	LD_PRELOAD="$(PRELOADED)" ASAN_OPTIONS=detect_leaks=0 PYTHONPATH=build/sanitize/package \
	    $(BIN)/python -P -m pytest -q -p no:cacheprovider -n 2 tests/core

RACES := build/races/package/surfmesh
races: $(VENV)/.installed-dev ## tests of what threads of one call do, under the thread sanitizer
	mkdir -p $(RACES) && ln -sfn $(filter-out surfmesh/_core%,$(wildcard $(CURDIR)/surfmesh/*)) $(RACES)
	rm -f $(RACES)/_core*
	PATH="$(abspath $(BIN)):$$PATH" cmake -S . -B build/races -G Ninja -DSURFMESH_RACES=ON \
	    -DSURFMESH_UNITY=ON \
	    -DPython_EXECUTABLE=$(abspath $(BIN)/python) -DSURFMESH_MODULE=$(abspath $(RACES)) >/dev/null
	PATH="$(abspath $(BIN)):$$PATH" cmake --build build/races
	LD_PRELOAD="$(shell $(or $(CXX),c++) -print-file-name=libtsan.so)" TSAN_OPTIONS=halt_on_error=1 \
	    PYTHONPATH=build/races/package $(BIN)/python -P -m pytest -q -x -p no:cacheprovider -n 0 \
	    tests/core/patch/test_parts_of_a_patch.py tests/core/packing/test_packing_in_halves.py \
	    tests/core/faces/test_face_joining.py tests/meshing/faces/test_face_queue.py \
	    tests/meshing/faces/test_graded_faces.py

fuzz: $(VENV)/.installed-dev ## hostile input by thousands: the table (SURFMESH_FUZZ=1000 a kind)
	SURFMESH_FUZZ=$${SURFMESH_FUZZ:-1000} $(BIN)/python benchmarks/trust.py --parts readers formulas random

lint: $(VENV)/.installed-dev ## ruff, clang-format, the layers of the package, types
	$(BIN)/ruff check .
	$(BIN)/ruff format --check --quiet .
	$(BIN)/clang-format --dry-run -Werror $(SOURCES)
	$(BIN)/lint-imports --no-logo
	$(BIN)/mypy

lowest: $(LOWEST)/.installed ## the tests' core on the lowest versions that work (Python 3.11)
	$(LOWEST)/bin/python -m pytest -n 2 --dist worksteal $(CORE)

docs: $(VENV)/.installed-docs ## HTML pages with executed notebooks, in outputs/docs
	$(BIN)/sphinx-build -q -b html docs outputs/docs
	@echo "outputs/docs/index.html"

bench: $(VENV)/.installed-bench ## the figures, gmsh beside them
	$(BIN)/python benchmarks/parametric.py

constraints: $(VENV)/.installed-install ## constraints*.txt anew: the newest versions, and the lowest
	$(COMPILE) --upgrade --universal --all-extras pyproject.toml -o constraints.txt
	$(COMPILE) --upgrade --resolution lowest-direct --extra cad --extra view --extra test pyproject.toml \
	    -o constraints-lowest.txt

licences: $(VENV)/.installed-dev $(VENV)/.installed-bench ## licences of all that is installed
	$(BIN)/python tools/licences.py

clean: ## remove what is generated, but for the virtual environments
	find . -name __pycache__ -not -path './.venv*' -type d -prune -exec rm -rf {} +
	rm -rf docs/notebooks build dist *.egg-info .pytest_cache .mypy_cache .hypothesis .ruff_cache .import_linter_cache
	find outputs -mindepth 1 ! -name README.md -delete

$(VENV)/bin/python:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
		{ echo "surfmesh needs Python 3.11 or later: make PYTHON=python3.12 ..." >&2; exit 1; }
	@echo "creating the virtual environment $(VENV)"
	@$(PYTHON) -m venv $(VENV)

$(LOWEST)/bin/python:
	@$(LOWEST_PYTHON) -c 'import sys; sys.exit(sys.version_info[:2] != (3, 11))' || \
		{ echo "the lowest versions are for Python 3.11: make lowest LOWEST_PYTHON=..." >&2; exit 1; }
	@$(LOWEST_PYTHON) -m venv $(LOWEST)

$(VENV)/.installed: pyproject.toml $(CONSTRAINTS) CMakeLists.txt $(SOURCES) | $(VENV)/bin/python
	$(call install,$(VENV),$(CONSTRAINTS),$(USED))

$(VENV)/.installed-%: pyproject.toml $(CONSTRAINTS) CMakeLists.txt $(SOURCES) | $(VENV)/bin/python
	$(call install,$(VENV),$(CONSTRAINTS),.[$*])
	@touch $@

$(LOWEST)/.installed: pyproject.toml constraints-lowest.txt | $(LOWEST)/bin/python
	$(call install,$(LOWEST),constraints-lowest.txt,.[test])
