/* SPDX-License-Identifier: MIT
 *
 * template: emitted light only; start here.
 *
 * Integral:   L = L_0 + ... (write down what you estimate)
 * Estimator:  ... (and the quotient that estimates it)
 * Omits:      all reflected light.
 */
#include "lightcheck.h"

static lc_rgb radiance(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                       lc_sampler *sampler)
{
    lc_rgb sum = lc_black();
    (void)ray;
    (void)sampler; /* lc_next(sampler) is the next random number in [0, 1) */
    if (options->min_bounces <= 0)
        sum = lc_rgb_add(sum, lc_emission(scene, hit)); /* L_0: what the first hit emits itself */
    return sum;
}

LC_ESTIMATOR(template) = {
    LC_ABI,     /* interface it was written for */
    "template", /* name on the command line */
    "emitted light only: a place to start",
    "your source: paper or lecture, and equation",
    0, /* lobes: LC_DIFFUSE | LC_GLOSSY | LC_MIRROR | LC_GLASS */
    0, /* emitters: LC_AREA | LC_POINT | LC_DIRECTIONAL | LC_SKY */
    0, /* max_bounces */
    radiance,
};
