# Footfall: one plain GNU Makefile. `make help` lists the targets.
#
#   CC=gcc|clang   CXX=g++|clang++   config=release|sanitize   B=folder for everything built
config ?= release
ifeq ($(origin CC),default)
CC := gcc
endif
ifeq ($(origin CXX),default)
CXX := $(if $(findstring clang,$(CC)),clang++,g++)
endif
B ?= $(if $(filter release,$(config)),build,build/$(config))
PREFIX ?= /usr/local

flags_release  := -O2
flags_sanitize := -O1 -fno-omit-frame-pointer -fsanitize=address,undefined -fno-sanitize-recover=all
warnings := -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Werror
# No contraction and no extra precision: the same bits from every compiler (runtime/README.md, determinism).
common   := -g -I. -MMD -MP -ffp-contract=off -fPIC -pthread $(flags_$(config))
CFLAGS_ALL   := -std=c17 $(warnings) $(common) $(CFLAGS)
CXXFLAGS_ALL := -std=c++17 -Wall -Wextra -Wshadow -Werror $(common) -isystem /usr/include/opencv4 $(CXXFLAGS)
LDFLAGS_ALL  := -pthread $(flags_$(config)) $(LDFLAGS)

opencv := -lopencv_imgcodecs -lopencv_imgproc -lopencv_core
libs   := -ljansson -ltinygltf $(opencv) -lxxhash -lstdc++ -lm

# ---------------------------------------------------------------------------------------------------- sources
core_src       := $(wildcard runtime/core/*.c runtime/core/*/*.c)
tool_src       := $(wildcard runtime/tool/*.c)
export_src     := $(wildcard runtime/export/*.c runtime/export/*.cpp)
crowd_src      := $(wildcard runtime/program/*.c)
mocap_src      := $(wildcard mocap/*.c mocap/*/*.c)
preprocess_src := $(filter-out preprocess/main.c,$(wildcard preprocess/*.c preprocess/*.cpp))
obj = $(patsubst %,$(B)/obj/%.o,$(1))

libfootfall := $(B)/libfootfall.a
room_libs   := $(B)/libroom_preprocess.a $(B)/libroom_mocap.a $(B)/libroom_export.a $(B)/libroom_tool.a $(libfootfall)

.PHONY: all
all: $(B)/footfall-pack $(B)/footfall-crowd $(libfootfall) $(B)/libfootfall.so ## build both programs and the library

$(B)/obj/%.c.o: %.c
	@mkdir -p $(@D)
	$(CC) $(CFLAGS_ALL) -c -o $@ $<
$(B)/obj/%.cpp.o: %.cpp
	@mkdir -p $(@D)
	$(CXX) $(CXXFLAGS_ALL) -c -o $@ $<

define archive
	@mkdir -p $(@D)
	@rm -f $@
	$(AR) rcs $@ $^
endef
$(libfootfall): $(call obj,$(core_src))
	$(archive)
$(B)/libroom_tool.a: $(call obj,$(tool_src))
	$(archive)
$(B)/libroom_mocap.a: $(call obj,$(mocap_src))
	$(archive)
$(B)/libroom_preprocess.a: $(call obj,$(preprocess_src))
	$(archive)
$(B)/libroom_export.a: $(call obj,$(export_src))
	$(archive)
$(B)/libfootfall.so: $(call obj,$(core_src))
	$(CC) -shared $(LDFLAGS_ALL) -Wl,-soname,libfootfall.so -o $@ $^ -lm

$(B)/footfall-pack: $(call obj,preprocess/main.c) $(room_libs)
	$(CC) $(LDFLAGS_ALL) -o $@ $^ $(libs)
$(B)/footfall-crowd: $(call obj,$(crowd_src)) $(room_libs)
	$(CC) $(LDFLAGS_ALL) -o $@ $^ $(libs)

# ------------------------------------------------------------------------------------------------------ tests
test_src := $(wildcard tests/*/test_*.c)
tests    := $(patsubst %.c,$(B)/%,$(test_src))
$(B)/tests/%: $(B)/obj/tests/%.c.o $(room_libs)
	@mkdir -p $(@D)
	$(CC) $(LDFLAGS_ALL) -o $@ $< $(room_libs) -lcmocka $(libs)
.SECONDARY: $(call obj,$(test_src))

.PHONY: unit
unit: $(tests) ## build and run the unit tests of this config
	scripts/run-tests.sh $(tests)

.PHONY: clean
clean: ## remove everything built
	rm -rf build out

.PHONY: format
format: ## rewrite every source file in the project's style
	git ls-files '*.c' '*.h' '*.cpp' | xargs clang-format -i

.PHONY: help
help: ## list the targets
	@grep -hE '^[a-z-]+:.*## ' $(MAKEFILE_LIST) | awk -F':.*## ' '{printf "  make %-10s %s\n", $$1, $$2}'

-include $(patsubst %.o,%.d,$(call obj,$(core_src) $(tool_src) $(export_src) $(crowd_src) $(mocap_src) $(preprocess_src) preprocess/main.c $(test_src)))
