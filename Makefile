# surfmesh: `make mesh` sets everything up and runs the main job; `make help` lists the rest.

PYTHON ?= python3
VENV ?= .venv
BIN := $(VENV)/bin
PIP := $(BIN)/python -m pip --disable-pip-version-check install -qq --only-binary=:all:

.DEFAULT_GOAL := help
.PHONY: help venv mesh test fuzz lint docs bench clean

help: ## this list
	@grep -E '^[a-z]+:.*##' $(MAKEFILE_LIST) | sed -E 's/^([a-z]+):[^#]*## /  make \1\t/' | expand -t 16

venv: $(VENV)/.installed ## virtual environment with surfmesh (VENV=.venv, PYTHON=python3)

mesh: $(VENV)/.installed ## mesh, check and draw the wavy surface; results in outputs/
	$(BIN)/surfmesh mesh wavy -o outputs/wavy.vtu --picture outputs/wavy.png --report outputs/wavy.json

test: lint ## lint, layers, types and tests
	$(BIN)/python -m pytest -n 2 --dist worksteal

fuzz: $(VENV)/.installed-dev ## hostile input by thousands: the table (SURFMESH_FUZZ=1000 a kind)
	SURFMESH_FUZZ=$${SURFMESH_FUZZ:-1000} $(BIN)/python benchmarks/trust.py --parts readers formulas

lint: $(VENV)/.installed-dev ## ruff, the layers of the package, types of the public face
	$(BIN)/ruff check .
	$(BIN)/lint-imports --no-logo
	$(BIN)/mypy

docs: $(VENV)/.installed-docs ## HTML pages with executed notebooks, in outputs/docs
	$(BIN)/sphinx-build -q -b html docs outputs/docs
	@echo "outputs/docs/index.html"

bench: $(VENV)/.installed-bench ## the figures, gmsh beside them
	$(BIN)/python benchmarks/parametric.py

clean: ## remove what is generated, but for the virtual environment
	find . -name __pycache__ -not -path './.venv/*' -type d -prune -exec rm -rf {} +
	rm -rf docs/notebooks build dist *.egg-info .pytest_cache .mypy_cache .hypothesis .ruff_cache .import_linter_cache
	find outputs -mindepth 1 ! -name README.md -delete

$(VENV)/bin/python:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
		{ echo "surfmesh needs Python 3.11 or later: make PYTHON=python3.12 ..." >&2; exit 1; }
	@echo "creating the virtual environment $(VENV)"
	@$(PYTHON) -m venv $(VENV)

$(VENV)/.installed: pyproject.toml | $(VENV)/bin/python
	@echo "installing surfmesh and what it needs into $(VENV)"
	@$(PIP) -e .
	@touch $@

$(VENV)/.installed-dev: pyproject.toml | $(VENV)/bin/python
	@echo "installing surfmesh and what its tests need into $(VENV)"
	@$(PIP) -e '.[dev]'
	@touch $@ $(VENV)/.installed

$(VENV)/.installed-docs: pyproject.toml | $(VENV)/bin/python
	@echo "installing surfmesh and what its pages need into $(VENV)"
	@$(PIP) -e '.[docs]'
	@touch $@ $(VENV)/.installed

$(VENV)/.installed-bench: pyproject.toml | $(VENV)/bin/python
	@echo "installing surfmesh and what its benchmarks need into $(VENV)"
	@$(PIP) -e '.[bench]'
	@touch $@ $(VENV)/.installed
