#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# usage: judge_mutants.sh [--fits | NAME ...]
# Judges that are wrong on purpose: each is made by one substitution in a copy of the tree, and some test must fail.
# Prints mutant and the tests that killed it. Exit status 0: all are dead; 1: one lives, or could not be made.
set -eu
cd "$(dirname "$0")/../.."
what=judge
judge='judge_mutants stats_estimate stats_pyramid stats film' shown='pictures/core exr/films verify/words'
suites="$judge $shown"
. verify/tests/wrong_copy.sh
suites=$judge

estimate=verify/stats/estimate.c pyramid=verify/stats/pyramid.c budget=verify/stats/budget.c
claim=verify/judge/claim.c render=src/core/render.c
pictures=verify/report/pictures.c exr=src/io/exr.c

# p values.
mutant p_inverted $estimate 's/lc_t_log_sf(side == LC_LOW ? -t : t, /lc_t_log_sf(side == LC_LOW ? t : -t, /'
mutant p_one_for_still_pixels $estimate 's/if (arm->sampled && !(arm->variance > 0 && arm->least >= 2))/if (0)/'
mutant normal_instead_of_t $estimate 's/double log_p = lc_t_log_sf(\(.*\), s->df) + correction/double log_p = lc_normal_log_sf(\1) + correction/'
mutant degrees_of_all_samples $estimate 's/s.df = variance \* variance/s.df = pixels * variance * variance/'
mutant bound_ignored $estimate 's/(s->difference - bound) \/ s->error/s->difference \/ s->error/'

# Variances.
mutant one_arms_variance_dropped $estimate 's/double variance = e->arm\[0\].variance + e->arm\[1\].variance,/double variance = e->arm[0].variance,/'
mutant variance_of_a_sample $estimate 's|arm.variance = m->m2 / (n \* (n - 1));|arm.variance = m->m2 / (n - 1);|'
mutant variance_floor $estimate 's|arm.variance = m->m2 / (n \* (n - 1));|arm.variance = fmax(m->m2 / (n * (n - 1)), 1e-4);|'
mutant measured_margin_is_exact $pyramid 's/state->plan->relative > 0 ?/0 ?/'

# Heavy tails.
mutant guard_switched_off verify/stats/estimate.h 's/#define LC_SKEW_LIMIT 2.08/#define LC_SKEW_LIMIT 1e30/'
mutant guard_of_the_image_alone $pyramid 's/raise_skew(student, &state->level\[a\].around, state->level\[a\].pixels \/ pixels, a == top);/if (a == top) raise_skew(student, \&state->level[a].around, state->level[a].pixels \/ pixels, 1);/'
mutant guard_without_the_even_image $pyramid '/raise_skew(student, &state->even, /d'
mutant guard_counts_nothing $pyramid 's/if (always || around->events\[side\] < ENOUGH_EVENTS \* parts)/if (1)/'
mutant guard_of_the_tile_alone $pyramid 's/if (state->plan->guard != LC_GUARD_POOLED || l == top)/if (1)/'
mutant tails_not_corrected $estimate 's/return s->skew\[side\] \* lc_skew_weight(alpha) \/ 3 + log(LC_RESERVE);/return 0;/'
mutant skewness_of_the_wrong_side $estimate 's/double third = i == 0 ? arm->third : -arm->third;/double third = i == 1 ? arm->third : -arm->third;/'
mutant skewness_cancels_between_arms $estimate 's/spoil\[LC_LOW\] += fmax(third, 0)/spoil[LC_LOW] += third/'
mutant sixteen_samples_are_enough $pyramid 's/plan->least\[l\] = LC_LEAST_SAMPLES/plan->least[l] = 16/'

mutant margin_of_a_relation_is_exact verify/judge/paired.c 's/fmax(0, mean - 8 \* error)/mean + 0 * error/'
mutant few_differences_are_never_enough verify/judge/paired.c 's/pyramid.verdict == LC_GO_ON && terms.least > 0/0 \&\& terms.least > 0/'
mutant few_differences_are_no_error verify/judge/paired.c 's/return most > 0 ? lc_met_bound/return most < 0 ? lc_met_bound/'
mutant few_differences_have_no_size verify/stats/bounds.c 's/2 \* largest, 4 \* exp(-l)) + (3 + exp(1)) \* largest/1e-9 * largest, 4 * exp(-l)) + 1e-9 * largest/'
mutant few_differences_end_with_the_plan verify/judge/paired.c 's/if (!lc_film_is_black(film))/if (lc_film_is_black(film))/'
mutant tiles_of_differences verify/judge/paired.c 's/^    lc_plan_whole(&plan/    if (claim->whole_only) lc_plan_whole(\&plan/'

# The pyramid.
mutant pyramid_stops_early $pyramid 's/^\( *\)judge_tile(state, l, x, y, &sum);/\1if (l < state->out->levels - 1) judge_tile(state, l, x, y, \&sum);/'
mutant pyramid_without_pixels $pyramid 's/^\( *\)judge_tile(state, l, x, y, &sum);/\1if (l > 0) judge_tile(state, l, x, y, \&sum);/'
mutant quarter_of_a_tile_lost $pyramid 's/for (int i = 1, cx, cy; i < 4; ++i)/for (int i = 1, cx, cy; i < 3; ++i)/'
mutant narrow_images_lose_levels $pyramid 's/< width || 1 << (levels - 1) < height/< width \&\& 1 << (levels - 1) < height/'
mutant tiles_not_paid_for $pyramid 's|plan->alpha_fail / out->levels / tiles|plan->alpha_fail / out->levels|; s/log(2 \* tiles \* out->levels)/log(2.0 * out->levels)/'
mutant levels_not_paid_for $pyramid 's|plan->alpha_fail / out->levels / tiles|plan->alpha_fail / tiles|; s/log(2 \* tiles \* out->levels)/log(2 * tiles)/'
mutant one_side_not_paid_for $pyramid 's/log(2 \* tiles \* out->levels)/log(tiles * out->levels)/'
mutant tolerance_ignored $pyramid 's/double bound = side == LC_LOW ? -s->tolerance : s->tolerance,/double bound = 0,/'

# Images whose pixels move together.
tiles=verify/stats/tiles.c
mutant spread_of_tiles_ignored $tiles 's/arm->variance = fmax(arm->variance, own->variance);//' stats_tiles
mutant degrees_of_the_pixels $tiles 's/arm->variance2 = fmax(.*;//' stats_tiles
mutant third_moment_of_the_pixels $tiles 's/arm->third = own->third;/(void)channel;/' stats_tiles
mutant third_moment_always_the_images $tiles 's/if (is_together(arm, own, n) && /if (/' stats_tiles
mutant one_level_fails_at_the_budget_of_all $tiles 's|plan->alpha_fail \* (levels - level) / levels|plan->alpha_fail|' stats_tiles
mutant images_taken_as_independent verify/judge/foreign.c 's/r->skip, f->tiles, row->margin/r->skip, NULL, row->margin/' adapter/images

# The budget.
mutant looks_not_paid_for $budget 's|b->fail / ((double)b->rows \* b->channels \* b->looks)|b->fail / ((double)b->rows * b->channels)|'
mutant one_look_paid_for $claim 's/session->rows, 3, LC_MOST_LOOKS};/session->rows, 3, 1};/'
mutant channels_not_paid_for $claim 's/session->rows, 3, LC_MOST_LOOKS};/session->rows, 1, LC_MOST_LOOKS};/'
mutant pass_not_split_over_looks $budget 's|b->pass / ((double)b->rows \* b->looks)|b->pass / b->rows|'
mutant cut_plan_rounded_beyond $budget '/most -= most % LC_BLOCK/d'
mutant looks_below_the_least $budget 's/if (n < LC_LEAST_SAMPLES)/if (n < 16)/'
mutant last_looks_cut $budget 's/{0.2, 0.4, 0.6, 1, 4}/{0.2, 0.4, 0.6, 0.6, 0.6}/'

# Verdicts.
mutant pass_on_overlap $pyramid 's/double t = (margin - fabs(s->difference)) \/ s->error;/double t = (margin + fabs(s->difference)) \/ s->error; if (fabs(s->difference) - state->pass_z * s->error <= margin) return 1;/'
mutant pass_when_not_shown_different $pyramid 's/else if (declared > 0 && within == declared)/else/'
mutant pass_at_one_end $pyramid 's/lc_student_log_p(s, LC_HIGH, -margin, alpha) <= log(alpha)/1/; s/margin - fabs(s->difference)/margin - s->difference/'
mutant pass_at_one_level $pyramid 's/else if (declared > 0 && within == declared)/else if (within > 0)/'
mutant one_channel_passes_for_all $estimate 's/return a == LC_PASS && b == LC_PASS ? LC_PASS/return a == LC_PASS || b == LC_PASS ? LC_PASS/'
mutant pass_wins_over_fail $estimate 's/if (a == LC_FAIL || b == LC_FAIL)/if (a == LC_FAIL \&\& b == LC_FAIL)/'
mutant undecided_is_pass $claim 's/LC_ROW_FAIL : LC_ROW_UNDECIDED;/LC_ROW_FAIL : LC_ROW_PASS;/'

# Samples.
mutant bad_samples_skipped $render 's/film->bad += bad->count;/(void)0;/'
mutant bad_samples_of_the_hub_skipped $claim 's/int is_bad = film->bad || (other && other->bad);/int is_bad = film->bad != 0;/'
mutant dependence_not_asked $claim 's/dependent = dependent_channel(.*/dependent = -1;/'
mutant dependence_shown_by_anything verify/stats/variance.c 's/b->log_p <= 2 \* log(alpha)/b->log_p <= 0.5 * log(alpha)/'
mutant same_stream_twice $estimate 's/if (x.seed == y.seed \&\& /if (0 \&\& /'
mutant first_stream_only $estimate 's/j <= b->more_count/j <= 0/'
mutant third_moment_not_merged src/core/film.c 's/m->m3 += o->m3 + square/m->m3 += square/'

# Images from files.
mutant rounding_of_files_ignored $claim 's/if (what->is_from_files)/if (0)/' verify/words
mutant rounding_once_for_all_merges $claim 's/return (1 + film->more_count) \* /return /' verify/words

# The line that gives a row again.
mutant margin_not_said verify/judge/reproduce.c 's/if (o->margin > 0)/if (0)/' verify/words
mutant file_not_quoted verify/report/safe.c 's/lc_shell_word(word, whole))/((void)word, whole))/' verify/words

# What a PASS excludes.
mutant missed_by_samples_of_a_pixel $claim 's/look->share \* (double)row->paths/look->share * (double)row->samples/'
mutant missed_counts_what_is_skipped $claim 's/look->share \* (double)row->paths/(double)row->paths/'
mutant exact_row_excludes_everything $claim 's/row->missed = light > 0 ? .*;/row->missed = 0;/'
mutant exact_row_counts_what_is_skipped $claim 's|session->margin, share \* (double)row->paths|session->margin, (double)row->paths|'

# What a FAIL looks like, why a row stays undecided, and what of a film is kept in a file.
suites=$shown
mutant picture_of_the_wrong_sign $pictures 's/mean - should,/should - mean,/'
mutant picture_of_the_wrong_place $pictures 's|\[(size_t)(y / zoom) \* (size_t)difference->width + (size_t)(x / zoom)\]|[(size_t)(x / zoom) * (size_t)difference->width + (size_t)(y / zoom)]|'
mutant picture_of_what_is_skipped $pictures 's/if (e->skip && e->skip\[i\])/if (0)/'
mutant picture_of_the_wrong_channel $pictures 's/(x \/ zoom)\].c\[channel\].mean;/(x \/ zoom)].c[0].mean;/'
mutant picture_without_the_others_noise $pictures 's/mean - should, variance + lc_pixel_variance/mean - should, lc_pixel_variance/'
mutant picture_of_a_pair_doubled $pictures 's/mean - d->c\[c\].mean, 0/mean + d->c[c].mean, 0/'
mutant picture_without_skewness_has_none $pictures 's/(\*out)->has_third = 0;//'
mutant guard_called_width $claim 's/image->skewed || isinf(row->low) || isinf(row->high)/image->skewed/'
mutant file_forgets_the_third_moment $exr 's/m->m3 = skewness \* .*/m->m3 = 0;/'
mutant file_without_skewness_has_none $exr 's/has_third = image->has_third;/has_third = 1;/'
mutant sum_of_known_and_unknown_is_known src/core/film.c 's/if (!into->has_third || !from->has_third)/if (!into->has_third \&\& !from->has_third)/'

sum_up
