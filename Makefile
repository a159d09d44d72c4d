# Footfall: one plain GNU Makefile. `make help` lists the targets.
#
#   CC=gcc|clang   CXX=g++|clang++   config=release|sanitize|fuzz   B=folder for everything built   -jN
#   V=1 prints whole commands
#
# Adding a file is enough: sources are found by folder. Whatever a changed flag, compiler or list of sources
# touches is rebuilt.
config ?= release
ifeq ($(origin CC),default)
CC := $(if $(filter fuzz,$(config)),clang,gcc)
endif
ifeq ($(origin CXX),default)
CXX := $(if $(findstring clang,$(CC)),clang++,g++)
endif
B ?= $(if $(filter release,$(config)),build,build/$(config))
PREFIX ?= /usr/local
ifndef V
.SILENT:
endif
# On the outermost level only: -jN on the command line is stronger than this.
ifeq ($(MAKELEVEL),0)
MAKEFLAGS += -j$(shell nproc) --no-print-directory
endif
# Data outside the project that some tests use when it is there (tests/README.md).
ifneq ($(wildcard ../shared/.),)
FF_SHARED ?= $(abspath ../shared)
endif
export FF_SHARED

flags_release  := -O2
# -w: warnings are the release build's matter; in instrumented code compilers raise false ones.
flags_sanitize := -O1 -w -fno-omit-frame-pointer -fsanitize=address,undefined -fno-sanitize-recover=all
flags_fuzz     := -O1 -w -fno-omit-frame-pointer -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=all
warnings := -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Werror
# No contraction and no extra precision: the same bits from every compiler (runtime/README.md, determinism).
# Hidden: the shared library shows what footfall.h declares and nothing else.
common   := -g -I. -MMD -MP -ffp-contract=off -fPIC -fvisibility=hidden -pthread $(flags_$(config))
eigen    := $(patsubst -I%,-isystem %,$(shell pkg-config --cflags eigen3 2>/dev/null))
CFLAGS_ALL   := -std=c17 $(warnings) $(common) $(CFLAGS)
CXXFLAGS_ALL := -std=c++17 -Wall -Wextra -Wshadow -Werror $(common) -isystem /usr/include/opencv4 $(eigen) $(CXXFLAGS)
LDFLAGS_ALL  := -pthread -Wl,--as-needed $(flags_$(config)) $(LDFLAGS)

opencv := -lopencv_imgcodecs -lopencv_imgproc -lopencv_core
# Optional: a peer for one bench (runtime/export/detour.h).
ifneq ($(wildcard /usr/include/recastnavigation/DetourCrowd.h),)
CXXFLAGS_ALL += -DFF_HAVE_DETOUR
detour := -lDetourCrowd -lDetour
endif
libs   := -ljansson -ltinygltf $(opencv) $(detour) -lceres -lglog -lOpenMeshTools -lOpenMeshCore -lxxhash -lm

# The version stands in the public header alone. The first number is the shared library's: it changes when programs
# built before would no longer run.
version := $(shell sed -n 's/^.define FF_VERSION "\(.*\)"/\1/p' runtime/footfall.h)
soname  := libfootfall.so.$(firstword $(subst ., ,$(version)))

.PHONY: all
all: programs library examples ## build both programs, the library and the examples

# ---------------------------------------------------------------------------------------------------- sources
core_src       := $(wildcard runtime/core/*/*.c)
tool_src       := $(wildcard runtime/tool/*.c)
export_src     := $(wildcard runtime/export/*.c runtime/export/*.cpp runtime/scenes/*.c)
crowd_src      := $(wildcard runtime/program/*.c)
mocap_src      := $(wildcard mocap/*.c mocap/*.cpp mocap/*/*.c mocap/*/*.cpp)
preprocess_src := $(wildcard preprocess/*/*.c preprocess/*/*.cpp)
pack_src       := preprocess/main.c
example_src    := $(wildcard runtime/examples/*.c)
test_src       := $(wildcard tests/*/test_*.c)
bench_src      := $(wildcard tests/bench/bench_*.c)
fuzz_src       := $(wildcard tests/fuzz/fuzz_*.c)
e2e_src        := $(wildcard tests/e2e/*.c)
every_src      := $(core_src) $(tool_src) $(export_src) $(crowd_src) $(mocap_src) $(preprocess_src) $(pack_src) \
                  $(example_src) $(test_src) $(e2e_src) $(bench_src) $(fuzz_src)
obj = $(patsubst %,$(B)/obj/%.o,$(1))

# ----------------------------------------------------------------------------------------------- compile, link
# Write a file only when what it says has changed, so that what depends on it is rebuilt then and not before.
remember = mkdir -p $(@D); echo '$(1)' | cmp -s - $@ || echo '$(1)' > $@
$(B)/flags.txt: FORCE
	$(call remember,$(CC) $(CFLAGS_ALL) / $(CXX) $(CXXFLAGS_ALL) / $(LDFLAGS_ALL))
$(B)/sources.txt: FORCE
	$(call remember,$(sort $(core_src) $(tool_src) $(export_src) $(crowd_src) $(mocap_src) $(preprocess_src)))
.PHONY: FORCE
FORCE:

$(B)/obj/%.c.o: %.c $(B)/flags.txt
	mkdir -p $(@D)
	echo "compile $<"
	$(CC) $(CFLAGS_ALL) $(CFLAGS_HERE) -c -o $@ $<
$(B)/obj/%.cpp.o: %.cpp $(B)/flags.txt
	mkdir -p $(@D)
	echo "compile $<"
	$(CXX) $(CXXFLAGS_ALL) -c -o $@ $<
.SECONDARY:

archive = mkdir -p $(@D); rm -f $@; $(AR) rcs $@ $(filter %.o,$^)
# The C++ driver links, as the adapters to OpenCV and tinygltf are C++.
link = mkdir -p $(@D); echo "link $@"; $(CXX) $(LDFLAGS_ALL) -o $@ $(filter %.o,$^) $(filter %.a,$^)

libfootfall := $(B)/libfootfall.a
shared_lib  := $(B)/$(soname)
room_libs   := $(B)/libroom_preprocess.a $(B)/libroom_mocap.a $(B)/libroom_export.a $(B)/libroom_tool.a $(libfootfall)
$(libfootfall): $(call obj,$(core_src)) $(B)/sources.txt
	$(archive)
$(B)/libroom_tool.a: $(call obj,$(tool_src)) $(B)/sources.txt
	$(archive)
$(B)/libroom_mocap.a: $(call obj,$(mocap_src)) $(B)/sources.txt
	$(archive)
# Results that footfall-pack keeps from build to build are those of one code only (preprocess/base/code_version.h).
code_src := $(sort $(core_src) $(mocap_src) $(preprocess_src) \
    $(wildcard runtime/*.h runtime/core/*/*.h mocap/*.h mocap/*/*.h preprocess/*/*.h))
code_version := $(shell (echo '$(CC) $(CFLAGS_ALL) $(CXX) $(CXXFLAGS_ALL)'; cat $(code_src)) | sha256sum | cut -c1-16)
$(B)/code-version.txt: FORCE
	$(call remember,$(code_version))
$(call obj,preprocess/base/code_version.c): CFLAGS_HERE := -DFF_CODE_VERSION='"$(code_version)"'
$(call obj,preprocess/base/code_version.c): $(B)/code-version.txt
$(B)/libroom_preprocess.a: $(call obj,$(preprocess_src)) $(B)/sources.txt
	$(archive)
$(B)/libroom_export.a: $(call obj,$(export_src)) $(B)/sources.txt
	$(archive)
$(shared_lib): $(call obj,$(core_src)) $(B)/sources.txt
	echo "link $@"
	$(CC) -shared $(LDFLAGS_ALL) -Wl,-soname,$(soname) -o $@ $(filter %.o,$^) -lm

.PHONY: programs library examples
programs: $(B)/footfall-pack $(B)/footfall-crowd
library: $(libfootfall) $(shared_lib)
examples: $(patsubst runtime/examples/%.c,$(B)/examples/%,$(example_src))
$(B)/footfall-pack: $(call obj,$(pack_src)) $(room_libs)
	$(link) $(libs)
$(B)/footfall-crowd: $(call obj,$(crowd_src)) $(room_libs)
	$(link) $(libs)
# An example shows what a user of the library needs, so it gets the library alone.
$(call obj,$(example_src)): CFLAGS_HERE := -Iruntime
$(B)/examples/%: $(B)/obj/runtime/examples/%.c.o $(libfootfall)
	mkdir -p $(@D)
	echo "link $@"
	$(CC) $(LDFLAGS_ALL) -o $@ $^ -lm

# ------------------------------------------------------------------------------------------------------ tests
test_bin  := $(patsubst %.c,$(B)/%,$(test_src))
bench_bin := $(patsubst %.c,$(B)/%,$(bench_src))
fuzz_bin  := $(patsubst %.c,$(B)/%,$(fuzz_src))
e2e_bin   := $(patsubst %.c,$(B)/%,$(e2e_src))
e2e       := $(filter-out %/lib.sh,$(wildcard tests/e2e/*.sh))
house     := $(wildcard tests/house/*.sh)
$(test_bin): $(B)/tests/%: $(B)/obj/tests/%.c.o $(room_libs)
	$(link) -lcmocka $(libs)
$(bench_bin): $(B)/tests/%: $(B)/obj/tests/%.c.o $(room_libs)
	$(link) -lcmocka $(libs)
$(e2e_bin): $(B)/tests/%: $(B)/obj/tests/%.c.o $(room_libs)
	$(link) $(libs)
$(fuzz_bin): $(B)/tests/%: $(B)/obj/tests/%.c.o $(room_libs)
	$(link) $(libs) -fsanitize=fuzzer

.PHONY: test unit e2e house soak bench test-programs fuzz-programs bench-programs
test-programs: all $(test_bin) $(e2e_bin) $(B)/builtin.ffpack
# A pack of the built-in clips, for whoever tests with a real one.
$(B)/builtin.ffpack: $(B)/footfall-pack
	echo "pack $@"
	$< build -o $@ --quiet >/dev/null
# And one of captured clips, where the outside data is: feet that slide as they land, toes that stay up, clips that end in a landing.
ifneq ($(wildcard $(FF_SHARED)/data/cmu/.),)
test-programs: $(B)/captured.ffpack
captured := $(patsubst %,$(FF_SHARED)/data/cmu/%,02/02_01.amc 06/06_06.bvh 09/09_12.amc 16/16_13.amc 16/16_17.amc \
    16/16_29.amc 35/35_14.amc 91/91_02.amc 91/91_17.amc 127/127_19.amc)
$(B)/captured.ffpack: $(B)/footfall-pack
	echo "pack $@"
	$< build -o $@ --quiet $(captured) >/dev/null
endif
fuzz-programs: $(fuzz_bin)
bench-programs: $(bench_bin)

build_fuzzers = +$(MAKE) config=fuzz CC=clang CXX=clang++ B=$(B)/fuzz fuzz-programs
run_fuzzers   = $(patsubst tests/fuzz/%.c,$(B)/fuzz:$(B)/fuzz/tests/fuzz/%,$(fuzz_src))
test: ## set up, then every test, plain and under ASan and UBSan, and a short fuzz
	scripts/setup.sh
	+$(MAKE) test-programs
	+$(MAKE) config=sanitize B=$(B)/sanitize test-programs
	$(build_fuzzers)
	scripts/run-tests.sh $(addprefix $(B)/sanitize:,$(e2e)) $(run_fuzzers) $(addprefix $(B):,$(house) $(e2e)) \
	    $(patsubst %.c,$(B)/sanitize:$(B)/sanitize/%,$(test_src)) $(patsubst %,$(B):%,$(test_bin))
unit: test-programs ## only the unit tests, of this config
	scripts/run-tests.sh $(patsubst %,$(B):%,$(test_bin))
e2e: test-programs ## only the end-to-end tests, of this config
	scripts/run-tests.sh $(addprefix $(B):,$(e2e))
house: test-programs ## only the rules of the house: includes, installed tree, commands of the READMEs
	scripts/run-tests.sh $(addprefix $(B):,$(house))
walk_soak = $(B)/footfall-crowd bench walk --pack $(B)/builtin.ffpack --seconds $(or $(WALK_SECONDS),3600)
soak: ## fuzz long: 500,000 runs of every target (FUZZ_RUNS=N); an hour of every way of walking (WALK_SECONDS=N); 10,000 steps of every scene
	scripts/setup.sh
	+$(MAKE) programs $(B)/builtin.ffpack
	for way in blending semi-procedural hybrid; do $(walk_soak) --synthesis $$way --check || exit 1; done
	+$(MAKE) $(B)/tests/export/test_scene_bits $(B)/tests/core/test_footsteps
	FF_WALLS=1000 FF_TEST_SECONDS=3600 scripts/run-tests.sh $(B):$(B)/tests/core/test_footsteps
	FF_SCENE_STEPS=10000 FF_TEST_SECONDS=7200 scripts/run-tests.sh $(B):$(B)/tests/export/test_scene_bits
	$(build_fuzzers)
	FF_FUZZ_RUNS=$(or $(FUZZ_RUNS),500000) scripts/run-tests.sh $(run_fuzzers)
bench: ## measure: every tests/bench/bench_*, one after the other
	+$(MAKE) bench-programs programs
	for program in $(bench_bin); do echo "== $$program"; $$program || exit 1; done

# ------------------------------------------------------------------------------------------------------- demo
.PHONY: demo setup
setup: ## install what is missing from Debian's packages
	scripts/setup.sh
demo: ## set up, build, and show the whole path on the built-in clips: out/demo/
	scripts/setup.sh
	+$(MAKE) programs
	scripts/demo.sh $(B) out/demo

# ---------------------------------------------------------------------------------------------------- install
.PHONY: install
bin_to := $(DESTDIR)$(PREFIX)/bin
inc_to := $(DESTDIR)$(PREFIX)/include
lib_to := $(DESTDIR)$(PREFIX)/lib
man_to := $(DESTDIR)$(PREFIX)/share/man/man1
fill_in = sed -e 's|@PREFIX@|$(PREFIX)|g' -e 's|@VERSION@|$(version)|g' -e 's|@SONAME@|$(soname)|g'
install: programs library ## install below PREFIX (and DESTDIR): programs, library, header, .pc, CMake, man pages
	install -d $(bin_to) $(inc_to) $(lib_to)/pkgconfig $(lib_to)/cmake/footfall $(man_to)
	install -m 755 $(B)/footfall-pack $(B)/footfall-crowd $(bin_to)
	install -m 644 runtime/footfall.h $(inc_to)/footfall.h
	install -m 644 $(libfootfall) $(lib_to)/libfootfall.a
	install -m 755 $(shared_lib) $(lib_to)/libfootfall.so.$(version)
	ln -sf libfootfall.so.$(version) $(lib_to)/$(soname)
	ln -sf $(soname) $(lib_to)/libfootfall.so
	$(fill_in) runtime/install/footfall.pc.in > $(lib_to)/pkgconfig/footfall.pc
	$(fill_in) runtime/install/footfall-config.cmake.in > $(lib_to)/cmake/footfall/footfall-config.cmake
	$(fill_in) runtime/install/footfall-config-version.cmake.in > $(lib_to)/cmake/footfall/footfall-config-version.cmake
	scripts/manual.sh $(B)/footfall-pack preprocess/footfall-pack.1 $(version) > $(man_to)/footfall-pack.1
	scripts/manual.sh $(B)/footfall-crowd runtime/program/footfall-crowd.1 $(version) > $(man_to)/footfall-crowd.1

# ------------------------------------------------------------------------------------------------ style, rest
.PHONY: format lint clean help
own_files := $(sort $(wildcard $(foreach d,mocap preprocess runtime tests,$(foreach e,c h cpp,$(d)/*.$(e) $(d)/*/*.$(e) $(d)/*/*/*.$(e)))))
format: ## rewrite every source file in the project's style
	clang-format -i $(own_files)
lint: ## clang-format, clang-tidy and cppcheck over every source file
	scripts/setup.sh lint
	clang-format --dry-run -Werror $(own_files)
	printf '%s\n' $(filter %.c,$(every_src)) | \
	    xargs -P $$(nproc) -n 4 sh -c 'clang-tidy --quiet "$$@" -- -std=c17 -I. -Iruntime 2>/dev/null' clang-tidy
	cppcheck --quiet --enable=warning,performance,portability --std=c11 --inline-suppr --error-exitcode=1 -j$$(nproc) \
	    --suppressions-list=scripts/cppcheck.txt -I. $(filter %.c,$(every_src))
clean: ## remove everything built
	rm -rf build out
help: ## list the targets
	grep -hE '^[a-z0-9-]+:.*## ' $(MAKEFILE_LIST) | awk -F':.*## ' '{printf "  make %-10s %s\n", $$1, $$2}'

-include $(patsubst %.o,%.d,$(call obj,$(every_src)))
