/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * furnace: closed rooms whose light is known for any number of reflections.
 *
 * The inside of a Lambertian sphere: irradiance is the same everywhere for any emission and albedo, so after up to K reflections
 * sum of L_k (1 <= k <= K) = rho(x) <Le> (1 + <rho> + ... + <rho>^(K-1)). Not uniform, so it sees what uniform furnaces are blind to.
 * The thermal furnace: every surface emits L0 (1 - rho), so L = L0 for any geometry and material. It proves energy only.
 */
#include <string.h>

#include "verify/analytic/analytic.h"
#include "verify/checks/checks.h"
#include "verify/checks/family.h"

static lc_status inside_view(lc_rgb *value, int *kind, const lc_scene *scene, const lc_hit *hit, void *user,
                             lc_error *err)
{
    const lc_rgb *irradiance = user;
    if (!hit->valid)
        return lc_fail(err, LC_FAULT, "%s: a camera ray left the closed sphere", lc_scene_description(scene)->name);
    lc_rgb rho = lc_material_at(scene, hit).diffuse;
    if (value)
        *value = lc_rgb_scale(LC_INV_PI, lc_rgb_mul(rho, *irradiance));
    *kind = (int)(1e6 * (rho.r + 2 * rho.g + 4 * rho.b)); /* the cell of the checkerboard */
    return LC_OK;
}

lc_status lc_expect_inside(lc_expected *out, const lc_claim *claim, const lc_scene *scene, int threads,
                               lc_error *err)
{
    const lc_scene_desc *desc = lc_scene_description(scene);
    if (desc->shape_count != 1 || desc->shapes[0].kind != LC_SPHERE || !desc->shapes[0].emits)
        return lc_fail(err, LC_BAD_INPUT, "%s: a furnace of this kind is one emitting sphere", desc->name);
    const lc_side *inner = &desc->materials[desc->shapes[0].material].side[desc->shapes[0].flip_normals ? 0 : 1];
    lc_rgb le = lc_texture_sphere_mean(&desc->shapes[0].radiance), rho = lc_texture_sphere_mean(&inner->diffuse);
    lc_rgb irradiance = lc_color(lc_inside_sphere_irradiance(le.r, rho.r, claim->max_bounces),
                                 lc_inside_sphere_irradiance(le.g, rho.g, claim->max_bounces),
                                 lc_inside_sphere_irradiance(le.b, rho.b, claim->max_bounces));
    return lc_expect_view(out, inside_view, &irradiance, scene, claim->tolerance, threads, err);
}

/* L0 = 1; the reflected part is what the surface does not emit itself. */
static lc_status thermal_view(lc_rgb *value, int *kind, const lc_scene *scene, const lc_hit *hit, void *user,
                              lc_error *err)
{
    (void)user;
    if (!hit->valid)
        return lc_fail(err, LC_FAULT, "%s: a camera ray left the closed room", lc_scene_description(scene)->name);
    *kind = hit->shape;
    lc_rgb le = lc_emission(scene, hit);
    if (value)
        *value = lc_color(1 - le.r, 1 - le.g, 1 - le.b);
    return LC_OK;
}

static lc_status expect_thermal(lc_expected *out, const lc_claim *claim, const lc_scene *scene, int threads,
                                lc_error *err)
{
    return lc_expect_view(out, thermal_view, NULL, scene, claim->tolerance, threads, err);
}

/* Infinite plates: the first two shapes; what a plate does not emit itself was reflected. */
static lc_status plates_view(lc_rgb *value, int *kind, const lc_scene *scene, const lc_hit *hit, void *user,
                             lc_error *err)
{
    const lc_scene_desc *desc = lc_scene_description(scene);
    (void)user;
    /* A mirror shows a plate, as bright as the plate itself, which it is not worth following to find out which. */
    *kind = hit->valid ? hit->shape : -1;
    if (!hit->valid)
        return lc_fail(err, LC_FAULT, "%s: a camera ray left the closed room", desc->name);
    if (!value)
        return LC_OK;
    double rgb[3];
    int own = hit->shape == 0 ? 0 : 1;
    const lc_shape_desc *a = &desc->shapes[own], *b = &desc->shapes[1 - own];
    const lc_rgb le[2] = {a->radiance.color[0], b->radiance.color[0]};
    const lc_rgb rho[2] = {desc->materials[a->material].side[0].diffuse.color[0],
                           desc->materials[b->material].side[0].diffuse.color[0]};
    rgb[0] = lc_parallel_plates_radiance(le[0].r, rho[0].r, le[1].r, rho[1].r, LC_ALL_REFLECTIONS) - le[0].r;
    rgb[1] = lc_parallel_plates_radiance(le[0].g, rho[0].g, le[1].g, rho[1].g, LC_ALL_REFLECTIONS) - le[0].g;
    rgb[2] = lc_parallel_plates_radiance(le[0].b, rho[0].b, le[1].b, rho[1].b, LC_ALL_REFLECTIONS) - le[0].b;
    *value = lc_color(rgb[0], rgb[1], rgb[2]);
    return LC_OK;
}

/* Pixels that see a mirror are left out. */
static lc_status expect_plates(lc_expected *out, const lc_claim *claim, const lc_scene *scene, int threads,
                               lc_error *err)
{
    const lc_camera_desc *camera = &lc_scene_description(scene)->camera;
    lc_status status = lc_expect_view(out, plates_view, NULL, scene, claim->tolerance, threads, err);
    for (int i = 0; i < out->width * out->height && status == LC_OK; ++i) {
        lc_ray ray = lc_camera_ray(camera, out->width, out->height, i % out->width + 0.5, i / out->width + 0.5);
        lc_hit hit;
        lc_camera_see(scene, &ray, &hit);
        if (hit.shape > 1)
            out->skip[i] = 1, out->rgb[3 * i] = out->rgb[3 * i + 1] = out->rgb[3 * i + 2] = 0;
    }
    return status;
}

/* A cube of 4 m and 10 000 lm, CIE 171:2006, case 5.8: the mean over the image is the mean over a wall. */
static lc_status expect_enclosure(lc_expected *out, const lc_claim *claim, const lc_scene *scene, int threads,
                                  lc_error *err)
{
    const lc_scene_desc *desc = lc_scene_description(scene);
    lc_rgb rho = desc->materials[desc->shapes[0].material].side[0].diffuse.color[0];
    double irradiance =
        lc_closed_mean_irradiance(10000, 96, rho.r, claim->max_bounces > 1 ? LC_ALL_REFLECTIONS : 1);
    (void)threads;
    (void)err;
    for (int i = 0; i < 3 * out->width * out->height; ++i)
        out->rgb[i] = lc_lambert_reflected(rho.r, irradiance);
    return LC_OK;
}

static lc_status add(lc_claim **out, lc_claims *claims, const lc_check *self, const lc_scene *scene,
                     const lc_estimator *estimator, int bounces, lc_error *err)
{
    *out = lc_claims_add(claims, self, scene, estimator);
    if (!*out)
        return lc_fail(err, LC_FAULT, "out of memory for the claims");
    (*out)->max_bounces = bounces;
    return LC_OK;
}

static lc_status plan_inside(const lc_check *self, lc_claims *claims, const lc_scene *scene,
                             const lc_estimator *estimator, lc_error *err)
{
    int varies = lc_scene_description(scene)->shapes[0].radiance.is_checkerboard;
    int is_plain = (estimator->lobes & (LC_MIRROR | LC_GLASS)) == 0;
    int is_drawn = lc_family_find(lc_scene_description(scene)->name) != NULL;
    for (int k = 1; k <= 8 && k <= estimator->max_bounces; ++k) {
        lc_claim *claim;
        /* Among diffuse walls mirror and dielectric are path once more: some depths are enough. Of boards, which are looked up at every
         * bounce, fewer are: one bounce, where another is needed for the first time, and the deepest. */
        if (!is_drawn && !is_plain && (varies ? k != 8 : k == 3 || k == 4 || k == 6 || k == 7))
            continue;
        if (!is_drawn && varies && is_plain && (k == 3 || (k >= 5 && k <= 7)))
            continue;
        if (is_drawn && k != (estimator->max_bounces > 1 ? 3 : 1) && (k != 6 || !is_plain))
            continue;
        lc_status status = add(&claim, claims, self, scene, estimator, k, err);
        if (status != LC_OK)
            return status;
        claim->expect = lc_expect_inside;
        claim->tolerance = 1e-9;
        claim->may_be_still = !varies; /* the kernel is constant: cosine weights leave no variance */
        /* Checkerboards are looked up at every bounce: only path tracers of one lobe pay for that in the quick suite. */
        claim->full_only = estimator->max_bounces > 1 && !(is_drawn ? is_plain && k == 3
                                                              : varies   ? is_plain && k == 4
                                                                         : k == 5 || (is_plain && k == 2));
        claim->slack = is_drawn ? 2 : 1;
        claim->source = "inside of a sphere: rho(x) <Le> (1 + <rho> + ... + <rho>^(K-1))";
    }
    return LC_OK;
}

/* Rooms of one row each. */
static const struct room {
    const char *scene;
    lc_expect_fn *expect;
    int bounces;
    double tolerance; /* of what later bounces add */
    int whole_only, full_only;
    double slack;
    const char *source;
} rooms[] = {
    /* L0 (1 - rho_max^25) <= L <= L0, and a few more bounces spent inside the glass */
    {"thermal_furnace", expect_thermal, 24, 1e-5, 0, 0, 1, "thermal furnace: L = L0 on every surface (second law)"},
    {"parallel_plates", expect_plates, 20, 2e-5, 0, 1, 4, "infinite plates: L1 = (Le1 + rho1 Le2) / (1 - rho1 rho2)"},
    {"enclosure", expect_enclosure, 24, 1e-5, 1, 1, 4, "mean E = Phi / (S (1 - rho)) = 208.33 lx, CIE 171 case 5.8"},
    {"enclosure_point", expect_enclosure, 1, 1e-9, 1, 0, 1, "mean E = Phi / S = 104.17 lx, CIE 171 case 5.8"},
};

static lc_status plan(const lc_check *self, lc_claims *claims, const lc_scene *scene, const lc_estimator *estimator,
                      lc_error *err)
{
    const char *name = lc_scene_description(scene)->name;
    if (!lc_sees_everything(scene, estimator) || estimator->max_bounces < 1)
        return LC_OK;
    if (strcmp(name, "furnace_sphere") == 0 || strcmp(name, "furnace_checker") == 0 ||
        strcmp(name, "random_furnace") == 0)
        return plan_inside(self, claims, scene, estimator, err);
    for (size_t i = 0; i < sizeof rooms / sizeof rooms[0]; ++i) {
        const struct room *room = &rooms[i];
        lc_claim *claim;
        if (strcmp(room->scene, name) != 0 || estimator->max_bounces < room->bounces)
            continue;
        lc_status status = add(&claim, claims, self, scene, estimator, room->bounces, err);
        if (status != LC_OK)
            return status;
        claim->expect = room->expect;
        claim->tolerance = room->tolerance;
        claim->whole_only = room->whole_only;
        claim->full_only = room->full_only;
        claim->slack = room->slack;
        claim->source = room->source;
    }
    return LC_OK;
}

const lc_check lc_check_furnace = {
    "furnace",
    "closed rooms: inside of a sphere, infinite plates, enclosure, thermal furnace",
    "Jacquez and Kuppenheim, JOSA 45, 1955; Kirchhoff 1860; CIE 171:2006, case 5.8",
    plan,
    NULL,
};
