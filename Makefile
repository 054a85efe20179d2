# lightcheck. `make help` lists what can be made; `make` builds build/lightcheck.
#
# Variables: CC, CFLAGS, BUILD (folder of the objects), WERROR=1, SANITIZE=address,undefined

CC      ?= cc
CFLAGS  ?= -O3 -g
BUILD   ?= build
PKGCONF ?= pkg-config

# What the build needs. One call of the preprocessor finds which headers are missing, and which Embree is there.

NEEDS := stdio.h=libc6-dev OpenEXR/openexr.h=libopenexr-dev png.h=libpng-dev expat.h=libexpat1-dev \
         jansson.h=libjansson-dev gsl/gsl_cdf.h=libgsl-dev Random123/philox.h=librandom123-dev seccomp.h=libseccomp-dev
ifneq ($(filter needs check asan-check $(BUILD)/tests,$(MAKECMDGOALS)),)
NEEDS += check.h=check
CHECK_LIBS = $(shell $(PKGCONF) --libs check 2>/dev/null || echo -lcheck -lsubunit -lrt)
endif

ifneq ($(filter-out clean help lint fresh,$(or $(MAKECMDGOALS),all)),)
SETUP := or run ./setup.sh, which installs all that lightcheck needs
ifeq ($(shell command -v $(firstword $(CC)) 2>/dev/null),)
$(error missing compiler $(firstword $(CC)): install gcc, $(SETUP))
endif
H := \#
header  = $(firstword $(subst =, ,$(1)))
package = $(lastword $(subst =, ,$(1)))
FOUND := $(subst ",,$(shell printf '%s\n' \
    '$Hif __has_include(<embree4/rtcore.h>)' '"embree4"' '$Helif __has_include(<embree3/rtcore.h>)' '"embree3"' \
    '$Helse' '"missing=embree3/rtcore.h=libembree-dev"' '$Hendif' \
    $(foreach n,$(NEEDS),'$Hif !__has_include(<$(call header,$n)>)' '"missing=$n"' '$Hendif') \
    | $(CC) $(CFLAGS) -E -P -x c -))
ifeq ($(FOUND),)
$(error $(CC) -E failed: install gcc, $(SETUP))
endif
MISSING := $(patsubst missing=%,%,$(filter missing=%,$(FOUND)))
ifneq ($(MISSING),)
$(error missing $(foreach n,$(MISSING),$(call header,$n)): install $(foreach n,$(MISSING),$(call package,$n)), $(SETUP))
endif
NEEDS_CFLAGS := -DLC_EMBREE=$(patsubst embree%,%,$(FOUND))
NEEDS_LIBS   := -l$(FOUND) -lOpenEXRCore -lpng -lexpat -ljansson -lgsl -lgslcblas -lseccomp
endif

WARN := -std=c99 -pedantic -Wall -Wextra -Wshadow -Wconversion -Wmissing-prototypes -Wvla -Wstrict-prototypes
ifdef WERROR
WARN += -Werror
endif
ifdef SANITIZE
override CFLAGS += -fsanitize=$(SANITIZE) -fno-omit-frame-pointer -fno-sanitize-recover=all
override LDFLAGS += -fsanitize=$(SANITIZE)
endif
# No -ffast-math: it would break the checks for NaN. No fused multiply-add: the same bits from gcc and clang.
ALL_CFLAGS := $(WARN) $(CFLAGS) -ffp-contract=off -D_POSIX_C_SOURCE=200809L -I. -Isrc -Isrc/core $(NEEDS_CFLAGS) -pthread -MMD -MP
ALL_LIBS   := $(NEEDS_LIBS) -lm -pthread

DIRS := src/core src/io estimators verify/stats verify/analytic verify/renderers verify/judge verify/checks \
        verify/mutants verify/diagnose verify/report verify/grade
LIB  := $(BUILD)/obj/texts.o $(patsubst %.c,$(BUILD)/obj/%.o,$(filter-out estimators/template.c,$(wildcard $(DIRS:%=%/*.c))))
CLI  := $(patsubst %.c,$(BUILD)/obj/%.o,$(wildcard src/cli/*.c))
TEST := $(patsubst %.c,$(BUILD)/obj/%.o,$(wildcard verify/tests/*.c))
# The worker of the jail: the tracer and what it shares with verify/grade; no estimator, no check, no reader of files.
WORKER := $(patsubst %.c,$(BUILD)/obj/%.o,$(wildcard src/core/*.c verify/grade/worker/*.c) verify/grade/confine.c verify/grade/wire.c)
# The proofs of the judge: programs of their own, three of whose files have a main.
PROOF := $(patsubst %.c,$(BUILD)/obj/%.o,$(filter-out %/calibrate.c %/power.c %/kill.c,$(wildcard verify/proof/*.c)))

.PHONY: all check verify verify-table full-table specular-proof pictures povray-reference mitsuba-table renderer-study lint asan-check \
        calibrate power seeds few-seeds proof judge-mutants host-mutants mutants diagnosis-proof gradings bench \
        student-kit gradescope-zip gradescope-check docker-check class needs fresh clean help
all: $(BUILD)/lightcheck $(BUILD)/lightcheck-worker $(BUILD)/obj/estimators/template.o ## build the program

# A plug-in finds the functions of lightcheck.h in the program, and no others.
EXPORT = -Wl,--dynamic-list=$(BUILD)/lightcheck.syms
$(BUILD)/lightcheck.syms: src/core/lightcheck.h
	@mkdir -p $(@D)
	{ echo '{'; sed -n 's/^[a-z_0-9]* \(lc_[a-z_0-9]*\)(.*/    \1;/p' $<; echo '};'; } > $@

$(BUILD)/lightcheck: $(CLI) $(LIB) | $(BUILD)/lightcheck.syms
	$(CC) $(LDFLAGS) $(EXPORT) -o $@ $^ $(ALL_LIBS)

$(BUILD)/lightcheck-worker: $(WORKER) | $(BUILD)/lightcheck.syms
	$(CC) $(LDFLAGS) $(EXPORT) -o $@ $^ -l$(FOUND) -lseccomp -lm -pthread

$(BUILD)/tests: $(TEST) $(LIB) | $(BUILD)/lightcheck-worker $(BUILD)/lightcheck.syms
	$(CC) $(LDFLAGS) $(EXPORT) -o $@ $^ $(CHECK_LIBS) $(ALL_LIBS)

# The texts that the program carries in itself.
$(BUILD)/texts.c: src/core/lightcheck.h estimators/template.c
	@mkdir -p $(@D)
	{ echo '#include "verify/grade/texts.h"'; \
	    for f in $^; do n=$${f##*/}; echo "const unsigned char lc_text_$${n%.*}_$${n##*.}[] = {"; \
	        od -An -v -tx1 $$f | sed 's/ \(..\)/0x\1,/g'; echo '0};'; done; } > $@

$(BUILD)/obj/texts.o: $(BUILD)/texts.c $(BUILD)/flags
	@mkdir -p $(@D)
	$(CC) $(ALL_CFLAGS) -c -o $@ $<

$(BUILD)/calibrate $(BUILD)/power $(BUILD)/kill: $(BUILD)/%: $(BUILD)/obj/verify/proof/%.o $(PROOF) $(LIB)
	$(CC) $(LDFLAGS) -o $@ $^ $(ALL_LIBS)

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

verify-table: SUITE = quick
verify-table: TABLE = results/verify.md
verify-table: ## the quick suite once more: results/verify.md
full-table: SUITE = full
full-table: TABLE = results/verify_full.md
full-table: ## the full suite: results/verify_full.md
verify-table full-table: all
	$(BUILD)/lightcheck verify --suite $(SUITE) > $(BUILD)/$@.txt
	{ printf '# The $(SUITE) suite\n\nMade by `make $@`. On one class of CPU each run gives the same bits.\n\n'; \
	    printf '```text\n'; cat $(BUILD)/$@.txt; printf '```\n'; } > $(TABLE)

# One row after the other, the cheap ones first; of the corridors nothing is left to chance, they are exact.
specular-proof: all ## mirrors and glass to 1e-4: results/specular.md (half an hour of one core)
	for s in $(or $(SCENES),mirror_corridor random_corridor critical_angle glass_sphere glass_slab mirror_sky glass_blend); do \
	    $(BUILD)/lightcheck verify --suite full -c specular -e dielectric --scene $$s --margin 0.0001 || exit; \
	done > $(BUILD)/$@.txt
	{ printf '# Mirrors and glass, to 1e-4\n\nMade by `make $@`: the closed forms of the specular check, '; \
	    printf 'at a margin of 0.01%% of the mean. On one class of CPU each run gives the same bits.\n\n```text\n'; \
	    { grep -m 1 '^check ' $(BUILD)/$@.txt; grep '^specular ' $(BUILD)/$@.txt; grep -m 1 '^false FAIL' $(BUILD)/$@.txt; \
	        grep -m 1 '^false PASS' $(BUILD)/$@.txt; }; printf '```\n'; } > results/specular.md

pictures: all ## the pictures of the README: results/cornell_*.png (about three minutes of one core)
	for p in light_direct=256 three_point=256 hemisphere_direct=2048 path=2048 mirror=2048 dielectric=2048; do \
	    $(BUILD)/lightcheck render cornell -e $${p%=*} -s $${p#*=} --size 192x192 -o results/cornell_$${p%=*}.png || \
	    exit; done

check: all $(BUILD)/tests ## run the unit and command-line tests, and the examples of the documents
	@LIGHTCHECK=$(BUILD)/lightcheck sh verify/tests/run.sh $(BUILD)/tests
	@sh verify/tests/docs_selftest.sh $(BUILD)/lightcheck
	@sh verify/tests/docs.sh $(BUILD)/lightcheck
	@[ -n "$(SANITIZE)" ] || sh verify/tests/kit.sh $(BUILD)/lightcheck # it is about files, not about memory

student-kit: all ## what a course gives to its students, without any solution: build/lightcheck-student.tar.gz (ASSIGNMENTS='FILE.json ...': these only)
	rm -rf $(BUILD)/lightcheck-student
	sh verify/grade/kit/make_kit.sh $(BUILD)/lightcheck $(BUILD)/lightcheck-student $(ASSIGNMENTS)
	tar -C $(BUILD) -czf $(BUILD)/lightcheck-student.tar.gz lightcheck-student

gradescope-zip: all ## an autograder for Gradescope: build/gradescope-NAME.zip (ASSIGNMENT=NAME or FILE.json)
	@test -n "$(ASSIGNMENT)" || { echo 'make gradescope-zip ASSIGNMENT=NAME: see `lightcheck list assignments`' >&2; exit 2; }
	sh verify/grade/gradescope/make_zip.sh $(BUILD)/lightcheck $(ASSIGNMENT) $(BUILD)/gradescope-$(basename $(notdir $(ASSIGNMENT))).zip

gradescope-check: all ## such an autograder in a new minimal Debian laid out as Gradescope's image (root, debootstrap)
	@sh verify/tests/gradescope.sh

docker-check: all ## the student's Dockerfile, the jail and all cheats in Docker itself (a running Docker; DOCKER_NETWORK=host where its builds have no network)
	@sh verify/tests/docker.sh

class: all ## grade a class of 60 hand-ins that hang, crash or do not compile, and kill the grader: results/class.md
	sh verify/tests/class.sh $(BUILD)/lightcheck 60 light_direct results/class.md

povray-reference: all ## render the references of the povray check anew (needs POV-Ray, takes minutes)
	$(BUILD)/lightcheck reference

mitsuba-table: all ## every scene against Mitsuba 3: results/mitsuba.md (needs `pip install mitsuba numpy`; PYTHON=interpreter)
	$(or $(PYTHON),python3) verify/renderers/mitsuba_table.py -o results/mitsuba.md

renderer-study: all ## what the suite finds in Mitsuba 3 and POV-Ray: results/renderers.md (needs both; PYTHON=interpreter)
	$(or $(PYTHON),python3) verify/renderers/study.py -o results/renderers.md

asan-check: ## the same under the address and undefined-behaviour sanitizers, but for what is about files, and tests that only need many samples
	CK_EXCLUDE_TAGS=long $(MAKE) BUILD=$(BUILD)/asan SANITIZE=address,undefined CFLAGS='-O1 -g' check

lint: ## dependencies between folders run one way, and other rules that a compiler does not know
	@sh verify/tests/lint.sh
	@sh verify/tests/lint_selftest.sh
	@sh verify/tests/judge_mutants.sh --fits
	@sh verify/tests/host_mutants.sh --fits

calibrate: $(BUILD)/calibrate ## how often the judge decides wrongly: results/calibration.md
	$(BUILD)/calibrate results/calibration.md

power: $(BUILD)/power ## samples that the judge needs, beside other programs' rules: results/power.md
	$(BUILD)/power results/power.md

seeds: SEEDS = 50
seeds: SHARDS = 1
seeds: all ## the quick suite with SEEDS=50 other seeds, each a minute; goes on where it was stopped: results/seeds.md
	sh verify/proof/seeds.sh $(BUILD)/lightcheck $(BUILD)/seeds.txt $(SEEDS) $(SHARDS) > $(BUILD)/seeds.md; status=$$?; \
	    cat $(BUILD)/seeds.md; [ $$status -gt 1 ] || [ $(SHARDS) != 1 ] || cp $(BUILD)/seeds.md results/seeds.md; exit $$status

few-seeds: ## a handful of that: a fifth of the scenes with each of three seeds, in less than a minute
	@$(MAKE) seeds SEEDS=3 SHARDS=5

proof: all ## the full suite at margins of 0.05% max(1, c), overnight; goes on where it was stopped: results/proof.md (SCENE=one: not kept)
	sh verify/proof/proof.sh $(BUILD)/lightcheck $(BUILD)/proof $(SCENE) > $(BUILD)/proof.md; status=$$?; \
	    [ $$status -gt 1 ] || [ -n "$(SCENE)" ] || cp $(BUILD)/proof.md results/proof.md; exit $$status

judge-mutants: ## wrong judges, each of which the tests must catch
	@sh verify/tests/judge_mutants.sh

host-mutants: ## wrong hosts (BSDF, warps, sampler, film, camera, lights, rays), each of which the tests must catch
	@sh verify/tests/host_mutants.sh

bench: all ## how fast the tracer is on this machine: paths a second of one core
	@sh verify/tests/bench.sh $(BUILD)/lightcheck

mutants: $(BUILD)/kill ## which checks kill which mutants, and that right variants pass: results/mutants.md
	$(BUILD)/kill -s $(BUILD)/kill.state -o results/mutants.md

diagnosis-proof: all ## wrong files that diagnose has never seen: results/diagnosis.md
	@bash verify/tests/diagnosis.sh $(BUILD)/lightcheck $(BUILD)/held_out > $(BUILD)/diagnosis.md; status=$$?; \
	    cp $(BUILD)/diagnosis.md results/diagnosis.md; exit $$status

gradings: all ## right solutions of every assignment, graded 200 times: results/gradings.md (N=count; goes on where it ended)
	@sh verify/tests/gradings.sh $(BUILD)/lightcheck $(BUILD)/gradings.log $(or $(N),200) > $(BUILD)/gradings.md; status=$$?; \
	    cp $(BUILD)/gradings.md results/gradings.md; exit $$status

needs: ## say what is missing, if anything is
	@:

fresh: ## the two commands of the README in a new minimal Debian 12 (root, debootstrap)
	@sh verify/tests/fresh.sh

clean: ## remove what was built
	rm -rf $(BUILD)

help: ## this list
	@sed -n 's/^\([a-z-]*\):.*## \(.*\)/  make \1\t\2/p' $(firstword $(MAKEFILE_LIST)) | expand -t 25

-include $(LIB:.o=.d) $(WORKER:.o=.d) $(CLI:.o=.d) $(TEST:.o=.d) $(wildcard $(BUILD)/obj/verify/proof/*.d)
