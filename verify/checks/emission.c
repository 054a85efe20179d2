/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * emission: L_0, what the camera sees glow, sample by sample and exactly: an estimator with min = max = 0 bounces returns the front-side
 * emission of the first hit, or the sky on a miss. Checked apart, because a visible lamp would drown an error in the reflected light.
 */
#include <string.h>

#include "verify/checks/checks.h"

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    (void)ray;
    (void)sampler;
    return options->min_bounces <= 0 ? lc_emission(scene, hit) : lc_black();
}

static const lc_estimator emission_only = {
    LC_ABI, "emission_only", "L_0 alone", "lightcheck.h", 0, LC_AREA | LC_SKY, 0, radiance,
};

static lc_status plan(const lc_check *self, lc_claims *claims, const lc_scene *scene, const lc_estimator *estimator,
                      lc_error *err)
{
    /* A lamp from its front and from its back, a sky (scene `sky` shows none of it), a checkerboard. */
    static const char *const scenes[] = {"cornell", "light_behind", "glass_sphere", "furnace_checker"};
    for (size_t i = 0; i < sizeof scenes / sizeof scenes[0]; ++i) {
        if (strcmp(scenes[i], lc_scene_description(scene)->name) != 0)
            continue;
        lc_claim *claim = lc_claims_add(claims, self, scene, estimator);
        if (!claim)
            return lc_fail(err, LC_FAULT, "out of memory for the claims");
        claim->min_bounces = claim->max_bounces = 0;
        claim->other = &emission_only;
        claim->exact = 1;
        claim->source = "lc_emission() of the first hit, same camera rays";
    }
    return LC_OK;
}

const lc_check lc_check_emission = {
    "emission",
    "L_0 is the emission of the first hit, exactly",
    "Kajiya 1986, eq. 1: the first term",
    plan,
    NULL,
};
