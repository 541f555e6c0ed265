# Every target sets up what it needs; a second run only does what changed.
#   make demo    shape-preserving curves through real data, printed and drawn to out/demo
#   make test    the Rust tests, then the Python tests; large generators run a tenth of their cases
#   make test-long  the same with every generated case (takes long)
#   make check   formatting, lints, stubs, types, `make test`, then `make docs`: what CI runs
#   make bench   speed and memory beside SciPy's, as one table
#   make docs    the documentation of both languages in site/: pages and notebooks executed, warnings are errors
#   make packages  wheel, sdist and crates, built and tried in clean environments on CPython 3.10 to 3.14 (takes long)
#   make powerset  every crate under every set of its features (needs cargo-hack)
#   make fuzz    every fuzz target for FUZZ seconds (needs cargo-fuzz and nightly)
#   make clean   forget all of the above

PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin

# maturin, clippy, doc and test must see one and the same interpreter and build mode: pyo3's build script runs again,
# and everything above it is compiled again, whenever one of these differs from the last call.
export PYO3_PYTHON := $(abspath $(BIN)/python)
export PYO3_BUILD_EXTENSION_MODULE := 1
export VIRTUAL_ENV := $(abspath $(VENV))
export PIP_DISABLE_PIP_VERSION_CHECK := 1

# The Rust tests run in the workspace's test profile, not in release mode: it keeps the checks for overflow and the
# debug assertions, and it needs no link-time optimisation of every test binary. Measured on two cores after a change
# in shapespline-geometry: seconds, against nearly two minutes. The extension's own crate holds no mathematics and
# cannot be linked outside Python: pytest is its test.
CARGO_TEST := cargo test --workspace --exclude shapespline-python
# As many processes as there are cores (pytest-xdist). Work is stolen in runs of neighbours, so that what a module
# computes once is mostly computed in one process; it may be in two, hence no test depends on the others or on their
# order, and none measures another's load (tests/threads.py). Plain `pytest` runs the same tests in one process.
PYTEST_ALL := $(BIN)/python -m pytest --numprocesses logical --dist worksteal
# Arguments for pytest, for example: make test PYTEST="-k published -x", or in one process: make test PYTEST="-n 0"
PYTEST ?=
# Arguments for the benchmark, for example: make bench BENCH=--quick
BENCH ?=
# The published crates, in the order of crates/README.md: each after those that it depends on.
CRATES := $(addprefix shapespline-,polynomial geometry banded criteria search nu tension catmull-rom fair monotone) shapespline
# Seconds for each fuzz target.
FUZZ ?= 60

.PHONY: demo test test-long test-rust test-python check lint-rust lint-python bench docs packages powerset fuzz clean \
	extension cargo
.DELETE_ON_ERROR:

demo: extension
	$(BIN)/shapespline demo --out out/demo

test: test-rust test-python

# tests/scale.py and `shapespline_tests::scaled` read the variable.
test-long: export SHAPESPLINE_TESTS := long
test-long: test

test-rust: cargo
	$(CARGO_TEST)

test-python: extension
	$(PYTEST_ALL) $(PYTEST)

check: lint-rust lint-python test docs

# A missing component is an installation matter, not a finding: say so before cargo's own, less helpful, words.
lint-rust: $(VENV)/.python | cargo
	@cargo fmt --version >/dev/null 2>&1 || { \
		echo "make: rustfmt is missing; get it with: rustup component add rustfmt" >&2; exit 1; }
	@cargo clippy --version >/dev/null 2>&1 || { \
		echo "make: clippy is missing; get it with: rustup component add clippy" >&2; exit 1; }
	cargo fmt --all --check
	cargo clippy --workspace --all-targets -- -D warnings
	RUSTDOCFLAGS="-D warnings" cargo doc --workspace --no-deps

lint-python: extension
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/python -m mypy.stubtest shapespline._core

bench: extension
	$(BIN)/python tests/bench/bench.py $(BENCH)

# Sphinx with MyST-NB: python/docs/conf.py says why. The gallery's pictures are drawn anew, not kept in the repository.
# The crates one after the other, from below: rustdoc links to another crate only if that was documented before.
# What `make check` documented for the sake of its warnings (the extension, the tests) is no part of the site.
docs: extension $(VENV)/.docs
	rm -rf "$${CARGO_TARGET_DIR:-target}/doc" site/rust site/python
	for crate in $(CRATES); do \
		RUSTDOCFLAGS="-D warnings" cargo doc --no-deps --package $$crate || exit 1; \
	done
	mkdir -p site
	cp -r "$${CARGO_TARGET_DIR:-target}/doc" site/rust
	$(BIN)/python python/docs/scripts/gallery.py
	$(BIN)/python -m sphinx -W --keep-going -q -b html -c python/docs python site/python
	echo '<meta http-equiv="refresh" content="0; url=python/docs/index.html">' > site/index.html
	echo '<meta http-equiv="refresh" content="0; url=shapespline/index.html">' > site/rust/index.html
	@echo "open site/index.html (Python) or site/rust/index.html (Rust)"

packages: $(VENV)/.python | cargo
	$(BIN)/python .ci/packages.py

# NLopt is built from source, with cmake: left out where there is none.
powerset: | cargo
	@cargo hack --version >/dev/null 2>&1 || { \
		echo "make: cargo-hack is missing; get it with: cargo install cargo-hack" >&2; exit 1; }
	cargo hack check --workspace --exclude shapespline-python --feature-powerset --no-dev-deps \
		$(if $(shell command -v cmake),,--exclude-features nlopt)

# What is learnt goes to out/fuzz, findings to tests/fuzz/artifacts; tests/fuzz/corpus holds what was once found.
fuzz: | cargo
	@cargo +nightly fuzz --version >/dev/null 2>&1 || { \
		echo "make: cargo-fuzz or nightly is missing: rustup toolchain install nightly; cargo install cargo-fuzz" >&2; \
		exit 1; }
	for target in $$(ls tests/fuzz/corpus); do \
		mkdir -p out/fuzz/$$target && \
		cargo +nightly fuzz run --fuzz-dir tests/fuzz $$target out/fuzz/$$target tests/fuzz/corpus/$$target -- \
			-max_total_time=$(FUZZ) -timeout=10 -max_len=600 -rss_limit_mb=4096 || exit 1; \
	done

clean:
	rm -rf $(VENV) target out site python/docs/images/gallery .pytest_cache .mypy_cache .ruff_cache .hypothesis
	rm -f python/shapespline/_core*.so python/shapespline/_core*.pyd
	find .ci python tests -name __pycache__ -type d -prune -exec rm -rf {} +

# Always asked: maturin and cargo know what changed better than a list of files here would.
extension: $(VENV)/.requirements | cargo
	$(BIN)/maturin develop --release

cargo:
	@command -v cargo >/dev/null || { \
		echo "make: cargo is missing; install Rust 1.88 or later (rustup does)" >&2; exit 1; }

$(VENV)/.python:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 10))' || { \
		echo "make: $(PYTHON) is missing or older than 3.10; name another: make PYTHON=python3.12 $(MAKECMDGOALS)" >&2; \
		exit 1; }
	@$(PYTHON) -c 'import ensurepip, venv' 2>/dev/null || { \
		echo "make: $(PYTHON) has no venv; on Debian and Ubuntu: apt-get install python3-venv" >&2; exit 1; }
	$(PYTHON) -m venv $(VENV)
	touch $@

$(VENV)/.requirements: pyproject.toml .ci/requirements.py $(VENV)/.python
	$(BIN)/python .ci/requirements.py test > $(VENV)/requirements.txt
	$(BIN)/python -m pip install --quiet --requirement $(VENV)/requirements.txt
	touch $@

$(VENV)/.docs: pyproject.toml $(VENV)/.requirements
	$(BIN)/python .ci/requirements.py docs > $(VENV)/requirements-docs.txt
	$(BIN)/python -m pip install --quiet --requirement $(VENV)/requirements-docs.txt
	touch $@
