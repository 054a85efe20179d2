# lightcheck. `make help` lists what can be made; `make` builds build/lightcheck.
#
# Variables: CC, CFLAGS, BUILD (folder of the objects), WERROR=1, SANITIZE=address,undefined

CC      ?= cc
CFLAGS  ?= -O2 -g
BUILD   ?= build
PKGCONF ?= pkg-config

# What the build needs, and the flags it gives. Each missing piece is named with its Debian package.

have = $(shell $(CC) -E -include $(1) -x c /dev/null >/dev/null 2>&1 && echo yes)
need_header = $(if $(call have,$(1)),,$(error missing header $(1): install $(2), or run ./setup.sh, which installs all that lightcheck needs))

ifneq ($(filter-out clean help lint,$(or $(MAKECMDGOALS),all)),)
$(if $(shell command -v $(CC) 2>/dev/null),,$(error missing compiler $(CC): install gcc, or run ./setup.sh, which installs all that lightcheck needs))
ifeq ($(call have,embree4/rtcore.h),yes)
EMBREE_LIBS := -lembree4
NEEDS_CFLAGS := -DLC_EMBREE=4
else
$(call need_header,embree3/rtcore.h,libembree-dev)
EMBREE_LIBS := -lembree3
NEEDS_CFLAGS := -DLC_EMBREE=3
endif
$(call need_header,OpenEXR/openexr.h,libopenexr-dev)
$(call need_header,png.h,libpng-dev)
$(call need_header,expat.h,libexpat1-dev)
$(call need_header,jansson.h,libjansson-dev)
$(call need_header,gsl/gsl_cdf.h,libgsl-dev)
$(call need_header,Random123/philox.h,librandom123-dev)
ifneq ($(filter check asan-check,$(MAKECMDGOALS)),)
$(call need_header,check.h,check)
CHECK_LIBS := $(shell $(PKGCONF) --libs check 2>/dev/null || echo -lcheck -lsubunit -lrt)
endif
NEEDS_LIBS := $(EMBREE_LIBS) -lOpenEXRCore -lpng -lexpat -ljansson -lgsl -lgslcblas
endif

WARN := -std=c99 -pedantic -Wall -Wextra -Wshadow -Wconversion -Wmissing-prototypes -Wvla -Wstrict-prototypes
ifdef WERROR
WARN += -Werror
endif
ifdef SANITIZE
CFLAGS += -fsanitize=$(SANITIZE) -fno-omit-frame-pointer -fno-sanitize-recover=all
LDFLAGS += -fsanitize=$(SANITIZE)
endif
# No -ffast-math: it would break the checks for NaN. No fused multiply-add: the same bits from gcc and clang.
ALL_CFLAGS := $(WARN) $(CFLAGS) -ffp-contract=off -D_POSIX_C_SOURCE=200809L -I. -Isrc -Isrc/core $(NEEDS_CFLAGS) -pthread -MMD -MP
ALL_LIBS   := $(NEEDS_LIBS) -lm -pthread

DIRS := src/core src/io estimators verify/stats verify/analytic verify/judge verify/checks verify/mutants verify/report
LIB  := $(patsubst %.c,$(BUILD)/obj/%.o,$(filter-out estimators/template.c,$(wildcard $(DIRS:%=%/*.c))))
CLI  := $(patsubst %.c,$(BUILD)/obj/%.o,$(wildcard src/cli/*.c))
TEST := $(patsubst %.c,$(BUILD)/obj/%.o,$(wildcard verify/tests/*.c))

.PHONY: all check verify lint asan-check format clean help
all: $(BUILD)/lightcheck $(BUILD)/obj/estimators/template.o ## build the program

$(BUILD)/lightcheck: $(CLI) $(LIB)
	$(CC) $(LDFLAGS) -o $@ $^ $(ALL_LIBS)

$(BUILD)/tests: $(TEST) $(LIB)
	$(CC) $(LDFLAGS) -o $@ $^ $(ALL_LIBS) $(CHECK_LIBS)

$(BUILD)/obj/verify/tests/%.o: ALL_CFLAGS += $(CHECK_CFLAGS)
$(BUILD)/obj/%.o: %.c $(BUILD)/flags
	@mkdir -p $(@D)
	$(CC) $(ALL_CFLAGS) -c -o $@ $<

# Objects depend on the flags they were made with.
$(BUILD)/flags: FORCE
	@mkdir -p $(BUILD)
	@echo '$(CC) $(ALL_CFLAGS)' | cmp -s - $@ || echo '$(CC) $(ALL_CFLAGS)' > $@
FORCE:

verify: all ## run the harness: every estimator against every check that applies
	$(BUILD)/lightcheck verify

check: all $(BUILD)/tests ## run the unit and command-line tests
	LIGHTCHECK=$(BUILD)/lightcheck $(BUILD)/tests

asan-check: ## the same under the address and undefined-behaviour sanitizers
	$(MAKE) BUILD=$(BUILD)/asan SANITIZE=address,undefined CFLAGS='-O1 -g' check

lint: ## dependencies between folders run one way
	sh verify/tests/lint.sh

clean: ## remove what was built
	rm -rf $(BUILD)

help: ## this list
	@sed -n 's/^\([a-z-]*\):.*## \(.*\)/  make \1\t\2/p' $(firstword $(MAKEFILE_LIST)) | expand -t 22

-include $(LIB:.o=.d) $(CLI:.o=.d) $(TEST:.o=.d)
