# make help lists what there is. Every target makes .venv first and keeps it up to date.
# Another interpreter: make PYTHON=python3.13 test.

PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
RUN := $(VENV)/.stamp-run
DEV := $(VENV)/.stamp-dev
DOCS := $(VENV)/.stamp-docs
DEMO := out/demo
unexport PYTHONDONTWRITEBYTECODE  # each program that a test starts would compile all modules

.DEFAULT_GOAL := help
.PHONY: help demo test test-browser check format bench coverage paper docs validate clean

help:  ## list the targets
	@grep -hE '^[a-z-]+:.*##' $(MAKEFILE_LIST) | awk -F ':.*## ' '{printf "  make %-12s %s\n", $$1, $$2}'

$(BIN)/python:
	$(PYTHON) -m venv $(VENV)

$(RUN): pyproject.toml | $(BIN)/python
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable .
	@touch $@

$(DEV): pyproject.toml | $(BIN)/python
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable ".[dev]"
	@touch $@

$(DOCS): pyproject.toml | $(BIN)/python
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable ".[docs]"
	@touch $@

demo: $(RUN)  ## a ball on a disc: case, explanation, solution and pictures in out/demo
	@mkdir -p $(DEMO)
	$(BIN)/tehl new ball-on-disc > $(DEMO)/case.toml
	$(BIN)/tehl explain $(DEMO)/case.toml
	$(BIN)/tehl solve $(DEMO)/case.toml -o $(DEMO)/result.nc --plot $(DEMO)
	@echo "The pictures are in $(DEMO)."

test: $(DEV)  ## the tests that run each time, on all cores
	$(BIN)/tehl doctor --warm  # once, not in each process
	$(BIN)/python -m pytest -m "not slow" --ignore tests/browser --numprocesses auto --maxprocesses 8 --dist loadfile

test-browser: $(DEV)  ## the live page in chromium, which must be installed
	$(BIN)/python -m pytest tests/browser --numprocesses 2 --dist worksteal

check: $(DEV)  ## style, formatting, types and floors
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports

format: $(DEV)  ## let ruff write the formatting
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

bench: $(DEV)  ## one table: time, work, rate, memory, growth with the grid
	$(BIN)/python -m benchmarks

coverage: $(DEV)  ## random contacts: which reach the default error, whether error bars hold and hints work
	$(BIN)/python -m benchmarks.coverage --contacts 300 --judge --follow

paper: $(DEV)  ## the paper on which this package is based, recomputed and judged in out/paper
	$(BIN)/python -m paper -o out/paper

docs: $(DOCS)  ## the documentation as HTML in docs/_build
	$(BIN)/python -m sphinx -W -b html docs docs/_build

validate: $(DEV)  ## the slow comparisons with published and independent values
	$(BIN)/python -m pytest -m slow

clean:  ## remove everything that can be made again
	rm -rf $(VENV) out docs/_build .pytest_cache .mypy_cache .ruff_cache .import_linter_cache
