# Two commands do everything: `make demo` and `make test`. The build itself is CMake's.
build := build/release
jobs := $(shell expr $$(nproc) + 1)

# Where `make install` puts the program; DESTDIR stages it.
PREFIX ?= /usr/local

.PHONY: demo test test-all program build install uninstall package check mutants bench numerics references packages clean

demo: program
	scripts/demo.sh $(build)/cli/weft demo-out

# Every behaviour once.
test: build
	ctest --preset test -j $(jobs)

# The long tests, too: short memory at every step, more fuzzing, torture, extremes by the million.
test-all: build
	ctest --preset test-all -j $(jobs)

build: program
	cmake --build --preset release

program: packages
	cmake --preset release -Wno-dev --log-level=WARNING $(if $(WEFT_SHARED),-DWEFT_SHARED=$(WEFT_SHARED))
	cmake --build --preset release --target weft

install: program
	cmake --build --preset release --target manual weft_shared weft_static
	cmake --install $(build) --prefix $(PREFIX)

# What the last `make install` from here has put there, with the same DESTDIR.
uninstall:
	while read -r file || [ -n "$$file" ]; do rm -f "$(DESTDIR)$$file"; done <$(build)/install_manifest.txt

# build/release/weft.deb, libweft0.deb, libweft-dev.deb, python3-weft.deb
package: program
	cmake --build --preset release --target manual weft_shared weft_static
	cpack --config $(build)/CPackConfig.cmake

packages:
	scripts/install-packages.sh

# What a reviewer runs: formatting, static analysis, and every test under AddressSanitizer and UndefinedBehaviorSanitizer.
check:
	scripts/install-packages.sh check
	scripts/check.sh

# Puts known faults into a copy of the program and expects the tests to fail: all faults, or those of the stages ROOMS.
mutants: packages
	scripts/mutants.sh $(ROOMS)

# TEXELS and SIZE make it shorter or longer (scripts/bench.sh).
bench:
	scripts/install-packages.sh bench
	$(MAKE) build
	scripts/bench.sh $(build) $(or $(TEXELS),100) $(or $(SIZE),64)

# That of the system has the packages; another may come first on the path.
python := $(firstword $(wildcard /usr/bin/python3) python3)

# Computes the reference values of the tests anew, by programs that share no code with Weft, and compares.
references:
	$(python) tests/data/generate/reference_values.py
	$(python) tests/data/generate/reference_values.py --conditions
	$(python) tests/data/generate/foreign_dataset.py
	$(python) tests/data/generate/bonn_files.py
	$(python) tests/data/generate/component_files.py
	$(python) tests/data/generate/material_files.py

# Worst-case errors of every model, by search against binary128: remakes the tables of docs/notes/numerics.md.
numerics: build
	scripts/numerics.sh $(build) $(or $(EVALUATIONS),3000)

clean:
	rm -rf build demo-out
