# Every target works alone from a clean clone: it needs Python ≥ 3.11 and make.
PYTHON ?= python3
VENV   := .venv
BIN    := $(VENV)/bin

.DEFAULT_GOAL := help
# Without files of bytecode, each process that a test starts compiles all modules again.
unexport PYTHONDONTWRITEBYTECODE
.PHONY: help demo lab page static-lab test quick test-rest test-all test-python test-lowest uv coverage mutants lint docs site \
	figures sheet digits bench validation clean

help:  ## list the targets
	@grep -hE '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed -E 's/:[^#]*## /\t/' | expand -t 14

$(BIN)/python:
	@command -v $(PYTHON) >/dev/null || { echo "$(PYTHON) not found: install Python 3.11 or newer, or name one: make PYTHON=python3.12"; exit 1; }
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' \
		|| { echo "$(PYTHON) is older than Python 3.11: name a newer one, for example make PYTHON=python3.12"; exit 1; }
	@$(PYTHON) -c 'import venv, ensurepip' 2>/dev/null \
		|| { echo "Python's venv module is missing: install it (on Debian or Ubuntu: apt install python3-venv) and run make again"; exit 1; }
	@$(PYTHON) -m venv $(VENV)

# An environment made by hand may be of an older Python, without pip (uv makes such), or with a pip that knows no groups.
$(VENV)/.pip: | $(BIN)/python
	@$(BIN)/python -c 'import sys; sys.exit(sys.version_info < (3, 11))' \
		|| { echo "$(VENV) has a Python older than 3.11: remove the folder and run make again"; exit 1; }
	@$(BIN)/python -m pip --version >/dev/null 2>&1 || $(BIN)/python -m ensurepip >/dev/null
	@$(BIN)/python -c 'import sys, pip; sys.exit(tuple(map(int, pip.__version__.split(".")[:2])) < (25, 1))' \
		|| $(BIN)/python -m pip install --quiet --upgrade 'pip>=25.1'
	@touch $@

# One stamp for each set of dependencies, renewed when pyproject.toml changes. Python compiles a module when it is first
# imported; pip would compile all of them, for half a minute.
$(VENV)/.core: pyproject.toml | $(VENV)/.pip
	$(BIN)/python -m pip install --quiet --no-compile --editable .
	@touch $@

$(VENV)/.%: pyproject.toml | $(VENV)/.core
	$(BIN)/python -m pip install --quiet --no-compile --group $*
	@touch $@

demo: $(VENV)/.core  ## reproduce, check and draw the source paper into stylobate-paper/
	$(BIN)/stylobate paper

WEB     := src/stylobate/lab/web
PAGE    := src/stylobate/lab/page/index.html

$(PAGE): $(WEB)/package-lock.json $(wildcard $(WEB)/*.mjs) $(WEB)/index.html $(shell find $(WEB)/src -type f)
	@command -v npm >/dev/null || { echo "npm not found: the laboratory's page is bundled with Node 20 or newer (on Debian or Ubuntu: apt install nodejs npm)"; exit 1; }
	cd $(WEB) && npm ci --no-audit --no-fund && npm run build
	@touch $@

page: $(PAGE)  ## the laboratory's page and the viewer of moving pictures, bundled with Node

lab: $(VENV)/.core $(PAGE)  ## the laboratory, in the browser
	$(BIN)/stylobate lab

static-lab: $(VENV)/.core $(PAGE)  ## the laboratory as files for any web server, and as one file, into static-lab/
	$(BIN)/stylobate lab --static static-lab

static-lab/index.html: $(PAGE) | $(VENV)/.core
	$(BIN)/stylobate lab --static static-lab

test: $(VENV)/.core $(VENV)/.test  ## the tests that need Python alone, six minutes on two cores
	$(BIN)/python -m pytest -n auto

quick: $(VENV)/.core $(VENV)/.test $(VENV)/.lint  ## style, wording and the tests next to what has changed, below 90 seconds
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/python tools/wording.py
	$(BIN)/python tools/quick_tests.py

test-rest: $(VENV)/.core $(VENV)/.test  ## longer tests, and those of Chromium, Node and Pango; the page needs `make page`
	$(BIN)/python -m pytest -n auto -m "(long or system) and not slow"

test-all: $(VENV)/.core $(VENV)/.test  ## all tests, the slow ones included
	$(BIN)/python -m pytest -n auto -m ""

# uv makes an environment of its own for another interpreter, which it fetches if need be, and for the lowest versions.
UV := $(if $(shell command -v uv 2>/dev/null),uv,.venv-uv/bin/uv)

.venv-uv/bin/uv:
	python3 -m venv .venv-uv
	.venv-uv/bin/python -m pip install --quiet uv

define test-with
	$(UV) venv --quiet --clear --python $(PYTHON) .venv-$(1)
	VIRTUAL_ENV=.venv-$(1) $(UV) pip install --quiet --resolution $(2) --editable '.[cluster,records,video]' --group test
	VIRTUAL_ENV=.venv-$(1) $(UV) run --quiet --no-project --active python -m pytest -n auto
endef

test-python: $(UV)  ## the tests with another interpreter and the newest versions allowed: make test-python PYTHON=3.13
	$(call test-with,$(notdir $(PYTHON)),highest)

test-lowest: $(UV)  ## the tests with the lowest version of each dependency that pyproject.toml allows
	$(call test-with,lowest,lowest-direct)

coverage: $(VENV)/.core $(VENV)/.test  ## the tests that take seconds, and the lines of source they reach
	$(BIN)/python -m pytest -n 2 --cov=stylobate --cov-report=term:skip-covered

ROOM := earthquakes
N    := 50
SEED := 1

mutants: $(VENV)/.core $(VENV)/.test  ## small faults in a room that the tests miss: make mutants ROOM=earthquakes N=50 SEED=1
	$(BIN)/python tools/mutants.py $(ROOM) --count $(N) --seed $(SEED)

lint: $(VENV)/.core $(VENV)/.test $(VENV)/.lint  ## style, types, import contracts, wording
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/mypy --platform win32 --cache-dir .mypy_cache/win32
	$(BIN)/lint-imports
	$(BIN)/python tools/wording.py

# Without Node, or as make docs LAB=, the documentation has no laboratory, and no links to it.
LAB := $(if $(shell command -v npm 2>/dev/null),static-lab/index.html)

docs: $(VENV)/.core $(VENV)/.docs $(LAB)  ## the documentation into docs/_build/html, with the laboratory
	$(BIN)/sphinx-build --fail-on-warning --keep-going docs docs/_build/html

site: $(VENV)/.core $(VENV)/.docs static-lab/index.html  ## the documentation with the laboratory as one archive that opens from disk
	$(BIN)/sphinx-build --fail-on-warning --keep-going docs docs/_build/html
	$(BIN)/python tools/site_archive.py docs/_build/html

FIGURES := $(filter-out %/saving.py %/choose_a_model.py,$(wildcard docs/figures/*.py))

figures: $(VENV)/.core $(VENV)/.test $(PAGE)  ## all figures and animations of the documentation into docs/_static, ten minutes on two cores
	for one in $(FIGURES); do echo "$$one"; $(BIN)/python "$$one" || exit 1; done

sheet: $(VENV)/.core  ## all kinds of figures in light, dark, one column and as a slide into figure-sheet/, to look at
	$(BIN)/python tools/figure_sheet.py figure-sheet

digits: $(VENV)/.core $(VENV)/.test  ## examples with other tolerances, starts and processors: which printed digits change
	$(BIN)/python tools/printed_digits.py

bench: $(VENV)/.core $(VENV)/.test  ## the benchmarks, beside the engines that can be installed, into the documentation
	-$(BIN)/python -m pip install --quiet --group bench
	$(BIN)/python -m pytest benchmarks -n 0 --benchmark-enable --benchmark-only
	$(BIN)/python -m benchmarks.ensembles
	$(BIN)/python -m benchmarks.ensembles.columns
	$(BIN)/python -m benchmarks.ensembles.stores
	$(BIN)/python -m benchmarks.ensembles.levels
	$(BIN)/python -m benchmarks.ensembles.shares
	$(BIN)/python -m benchmarks.ensembles.precision
	$(BIN)/python -m benchmarks.ensembles.contacts
	$(BIN)/python -m benchmarks.ensembles.sliding
	$(BIN)/python -m benchmarks.ensembles.records
	$(BIN)/python -m benchmarks.inventories
	$(BIN)/python -m benchmarks.early_ends
	$(BIN)/python -m benchmarks.orbits
	$(BIN)/python -m benchmarks.page

validation: $(VENV)/.core $(VENV)/.validation  ## comparisons with other people's numbers, into the documentation
	$(BIN)/python -m validation

clean:  ## remove what the targets made
	rm -rf $(VENV) .venv-* .mutants docs/_build docs/gallery docs/tutorials stylobate-paper static-lab stylobate-*-docs.zip
