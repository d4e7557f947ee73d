# make demo | gallery | techniques | test | bench | report | lint | tidy | format | sanitize | clean
#
# Each target sets up what it needs and is quick the second time: the stamps in build/stamps say what is done.
#
#   Debian packages ──▶ .venv ──▶ build/release (C++ and decalgl._core, installed into .venv) ──▶ demo, test, bench

SHELL := /bin/bash
.SHELLFLAGS := -euo pipefail -c
.DELETE_ON_ERROR:
.DEFAULT_GOAL := help

PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
STAMPS := build/stamps
BUILD := build/release
JOBS ?= $(shell nproc)
# Of the report: quick or full.
SIZE ?= quick
# CI treats warnings as errors.
WERROR := $(if $(CI),ON,OFF)

CPP_FILES = $(shell find cpp tests python/bindings -name '*.cpp' -o -name '*.h' 2>/dev/null)
# What the installed module is made of; Python files are live in an editable install.
NATIVE_SOURCES = $(shell find cpp cmake python/bindings -type f 2>/dev/null) CMakeLists.txt python/CMakeLists.txt

export PIP_DISABLE_PIP_VERSION_CHECK := 1
export CMAKE_BUILD_PARALLEL_LEVEL := $(JOBS)

.PHONY: help setup build demo gallery techniques test bench report lint tidy format sanitize wheel wheeltest clean distclean

help:  ## Show the targets
	@grep -E '^[a-z]+:.*##' Makefile | sed -E 's/^([a-z]+):.*## (.*)/  make \1\t\2/' | expand -t 18

setup: $(STAMPS)/debian $(STAMPS)/venv  ## Install the Debian packages and the Python environment

build: $(STAMPS)/package  ## Build everything and install the package into .venv

demo: build  ## Draw the demo picture
	$(BIN)/python examples/demo.py

gallery: build  ## Draw the pictures of docs/gallery.md
	$(BIN)/python -m tools.gallery

techniques: build  ## Draw one scene by each technique, with error and time
	$(BIN)/python -m tools.side_by_side

test: build  ## Run the C++ and Python tests
	cmake --build $(BUILD)
	ctest --test-dir $(BUILD) --output-on-failure --no-tests=error
	$(BIN)/python -m pytest --numprocesses $(JOBS) --dist loadfile

bench: build  ## Measure speed and memory on real data
	$(BIN)/decalgl bench

report: build  ## Draw a report of error against run time into build/report (SIZE=full takes two to three hours)
	test $(SIZE) = quick || $(BIN)/python -m pip install --quiet --constraint packages/python.txt pyflwdir
	$(BIN)/decalgl report --out build/report --size $(SIZE)

lint: setup  ## Check formatting, style and types
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	clang-format --dry-run --Werror $(CPP_FILES)

tidy: build  ## Check the C++ with clang-tidy (slow)
	find cpp/src -name '*.cpp' -print0 | xargs -0 -n 1 -P $(JOBS) clang-tidy --quiet -p $(BUILD)

format: setup  ## Format all sources
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .
	clang-format -i $(CPP_FILES)

sanitize: setup  ## Run the C++ tests, and changes from Python, under the address, undefined and thread sanitizers
	for preset in asan tsan; do \
		cmake --preset $$preset && cmake --build --preset $$preset && ctest --preset $$preset; \
	done
	tests/sanitize/run.sh $(BIN)/python build/asan

wheel: setup  ## Build a wheel into dist/
	$(BIN)/python -m pip wheel --no-deps --wheel-dir dist .

wheeltest: setup  ## Draw from a wheel in an empty environment
	tests/wheel/run.sh $(BIN)/python

clean:  ## Remove what was built
	rm -rf build dist

distclean: clean  ## Remove the Python environment too
	rm -rf $(VENV)

$(STAMPS):
	mkdir -p $@

$(STAMPS)/debian: packages/debian.txt packages/install.sh | $(STAMPS)
	packages/install.sh
	touch $@

# Build tools live in the environment, since the editable install does without isolation.
$(STAMPS)/venv: pyproject.toml packages/python.txt packages/build.txt $(STAMPS)/debian
	test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --constraint packages/python.txt --requirement packages/build.txt
	touch $@

$(STAMPS)/package: $(STAMPS)/venv $(NATIVE_SOURCES)
	$(BIN)/python -m pip install --quiet --no-build-isolation --constraint packages/python.txt \
		--config-settings=build-dir=$(BUILD) \
		--config-settings=cmake.define.DECALGL_TESTS=ON \
		--config-settings=cmake.define.DECALGL_DEMO=ON \
		--config-settings=cmake.define.DECALGL_BENCH=ON \
		--config-settings=cmake.define.DECALGL_WERROR=$(WERROR) \
		--editable '.[test,dev]'
	touch $@
