# The front door. `make demo` and `make test` work on a fresh Debian 12 or 13 or Ubuntu 24.04.
PRESET ?= release
BUILD := build/$(PRESET)
JOBS ?= $(shell nproc)
SECONDS ?= 60
ifeq ($(PRESET),tsan)
export TSAN_OPTIONS ?= history_size=7:suppressions=$(CURDIR)/tests/support/thread_sanitizer/suppressions
endif

.PHONY: help setup build demo test bench agreement train-small weights paper-weights fuzz format format-check lint clean

help:                ## Show this list
	@sed -n 's/^\([a-z-]*\):.*## /  make \1\t/p' Makefile | expand -t 24

setup:               ## Install what is missing to build (apt-get)
	@scripts/setup

build: setup         ## Build everything; PRESET=release (default), dev, asan or tsan
	@cmake --preset $(PRESET) $(CMAKE_FLAGS) > /dev/null
	@cmake --build $(BUILD) --parallel $(JOBS)

demo: setup          ## Render the demo scene with plain path tracing and with ODIS, side by side
	@cmake --preset $(PRESET) $(CMAKE_FLAGS) > /dev/null
	@cmake --build $(BUILD) --parallel $(JOBS) --target odis_app
	@scripts/demo $(BUILD)/apps/odis/odis

test: build          ## Build and run all tests
	@ctest --test-dir $(BUILD) --parallel $(JOBS) --output-on-failure --output-log $(BUILD)/ctest.log

bench: setup         ## Compare on all scenes of a folder: SCENES=DIR [OUT=DIR]; see docs/comparing.md
	@cmake --preset $(PRESET) $(CMAKE_FLAGS) > /dev/null
	@cmake --build $(BUILD) --parallel $(JOBS) --target odis_app
	@scripts/bench $(BUILD)/apps/odis/odis "$(SCENES)" $(OUT)

agreement: build     ## Test `path` against other renderers' images: SCENES=DIR REFERENCES=DIR
	@scripts/agreement $(BUILD)/apps/odis/odis "$(SCENES)" "$(REFERENCES)" $(SPP)

train-small:         ## Make data and train weights from nothing, in some ten minutes: out/train-small/run/odis.weights
	@scripts/train small "$(PRESET)" "$(JOBS)" 0-299 --quick $(ASSETS)

weights:             ## Make the shipped weights again (1,000 scenes, 1 to 2 hours; goes on where it stopped): out/weights/run
	@scripts/train full "$(PRESET)" "$(JOBS)" 0-999 $(ASSETS)

paper-weights:       ## Make the weights of `--preset paper` again, data included (an hour to an hour and a half on two cores; goes on where it stopped): out/paper
	@scripts/train paper "$(PRESET)" "$(JOBS)" 0-999 --kind incident-radiance $(ASSETS)

fuzz:                ## Feed damaged input to all readers, SECONDS=60 each; needs `scripts/setup --dev`
	@cmake --preset fuzz $(CMAKE_FLAGS) > /dev/null
	@cmake --build build/fuzz --parallel $(JOBS) --target fuzz
	@scripts/fuzz build/fuzz $(SECONDS)

format:              ## Format the C++ sources in place
	@scripts/format

format-check:        ## Fail if `make format` would change anything
	@scripts/format --check

lint:                ## Run clang-tidy on all sources
	@scripts/lint

clean:               ## Remove what was built and the demo's pictures; data sets, weights and comparisons in out stay
	@rm -rf build out/demo
