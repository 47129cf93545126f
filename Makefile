# SPDX-License-Identifier: Apache-2.0
# Every target installs what it needs first (scripts/setup) and then works offline.
.DEFAULT_GOAL := help
.PHONY: help demo build test tsan bench tidy format clean

# What `make demo` lights, and how well: make demo SCENE=scenes/cornell.toml ERROR=0.01
SCENE ?= scenes/office.toml
ERROR ?= 0.05
DEMO := out/$(basename $(notdir $(SCENE)))

help: ## list the targets
	@sed -n 's/^\([a-z]*\):.*## \(.*\)/  make \1\t\2/p' $(MAKEFILE_LIST) | expand -t 16

demo: build ## light a room: a solution file, pictures and a page in out/
	@scripts/setup demo
	@mkdir -p out
	build/bin/exitance solve $(SCENE) -o $(DEMO).glb --error $(ERROR)
	build/bin/exitance render $(DEMO).glb -o $(DEMO).png
	build/bin/exitance view $(DEMO).glb --html $(DEMO).html
	node scripts/walkthrough_picture.mjs $(DEMO).glb $(DEMO)-walkthrough.png
	@scripts/demo-notes $(DEMO)

build: ## the program: build/bin/exitance
	@scripts/setup build
	@[ -f build/build.ninja ] || cmake --preset program --log-level=NOTICE
	@cmake --build build --target exitance_app

test: ## every check, also under the sanitizers, and fuzzers
	@scripts/setup build test
	@cmake --preset release --log-level=NOTICE
	@cmake --build --preset release
	@cmake --preset asan --log-level=NOTICE
	@cmake --build --preset asan
	@cmake --preset fuzz --log-level=NOTICE
	@cmake --build --preset fuzz
	@ctest --test-dir build --output-on-failure --no-label-summary -j $$(nproc)

tsan: ## the parallel parts under the thread sanitizer
	@scripts/setup build test
	@cmake --preset tsan --log-level=NOTICE
	@cmake --build --preset tsan
	@ctest --test-dir build-tsan --output-on-failure -j $$(nproc)

bench: ## speed and memory against what the machine can do
	@scripts/setup build demo bench
	@cmake --preset bench --log-level=NOTICE
	@cmake --build --preset bench
	@benchmarks/run

tidy: ## clang-tidy over the sources
	@scripts/setup build test
	@cmake --preset release --log-level=NOTICE
	@run-clang-tidy -quiet -p build '/(src|apps)/'

format: ## lay out the sources as .clang-format says
	@scripts/setup test
	@scripts/format

clean: ## remove everything that was built
	rm -rf build build-asan build-fuzz build-tsan build-bench out
