/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Images by POV-Ray that know their error, and the files that keep them.
 */
#include "verify/renderers/pov_reference.h"

#include <inttypes.h>
#include <jansson.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include "io/exr.h"
#include "io/outfile.h"

enum { PATH_SIZE = 4096 };

static const char *const mode_names[] = {"direct", "radiosity", "specular", "gathered"}; /* in the order of lc_pov_mode */

#define DIRECT "POV-Ray, lamps as quadratures; band 0.2% of the mean from its convergence, pixels beyond it left out"
#define DELTA "POV-Ray; band 0.2% of the mean from its convergence, pixels beyond it left out"

#define CHAIN "POV-Ray, mirrors and glass; band 0.2% of the mean from its convergence, pixels beyond it left out"
#define DARK "POV-Ray; black exactly"
#define SKY "POV-Ray's radiosity, which gathers a sky; band 0.2% of the mean for tiles of 8 x 8 pixels"
#define GLOWING "POV-Ray's radiosity, which gathers what glows, off mirrors too; band 5% of the mean for tiles of 8 x 8 pixels"
#define SKY_CUT "POV-Ray's radiosity, which gathers a sky that a wall cuts; band 1.5% of the mean for tiles of 8 x 8 pixels"
#define GATHERED "POV-Ray's radiosity on top of its direct light; band 1.5% of the mean for tiles of 8 x 8 pixels"

/* Points and samples are chosen so that few pixels are beyond the band; cost grows as the square of each. */
const lc_pov_case lc_pov_cases[] = {
    {"plane_point", LC_POV_DIRECT, 2, 8, 1, 1, 1, 0.002, 1, "light_direct", DELTA},
    {"plane_directional", LC_POV_DIRECT, 2, 8, 1, 1, 1, 0.002, 1, "light_direct", DELTA},
    {"plane_rectangle", LC_POV_DIRECT, 16, 4, 1, 1, 1, 0.002, 1, "light_direct", DIRECT},
    {"plane_tilted", LC_POV_DIRECT, 24, 8, 1, 1, 1, 0.002, 0, "light_direct", DIRECT},
    {"plane_disk", LC_POV_DIRECT, 16, 8, 1, 1, 1, 0.002, 0, "light_direct", DIRECT},
    {"plane_sphere", LC_POV_DIRECT, 32, 8, 1, 1, 1, 0.002, 0, "light_direct", DIRECT},
    {"two_lights", LC_POV_DIRECT, 16, 8, 1, 1, 1, 0.002, 0, "light_direct", DIRECT},
    {"five_lights", LC_POV_DIRECT, 24, 8, 1, 1, 1, 0.002, 0, "light_direct", DIRECT},
    {"mixed_lights", LC_POV_DIRECT, 16, 8, 1, 1, 1, 0.002, 0, "light_direct", DIRECT},
    {"occluder", LC_POV_DIRECT, 40, 8, 1, 1, 1, 0.002, 0, "light_direct", DIRECT},
    {"cornell", LC_POV_DIRECT, 32, 8, 1, 1, 1, 0.002, 0, "light_direct", DIRECT},
    {"mirror_corridor", LC_POV_SPECULAR, 2, 8, 1, 0, 12, 0.002, 0, "mirror", CHAIN},
    {"plane_cube", LC_POV_DIRECT, 24, 8, 1, 1, 1, 0.002, 0, "light_direct", DIRECT},
    {"lamp_100w", LC_POV_DIRECT, 16, 8, 1, 1, 1, 0.002, 0, "light_direct", DIRECT},
    {"textured_lamp", LC_POV_DIRECT, 24, 8, 1, 1, 1, 0.002, 0, "light_direct", DIRECT},
    {"flipped_twosided", LC_POV_DIRECT, 24, 8, 1, 1, 1, 0.002, 0, "light_direct", DIRECT},
    {"cornell_small", LC_POV_DIRECT, 32, 8, 1, 1, 1, 0.002, 0, "light_direct", DIRECT},
    {"cornell_large", LC_POV_DIRECT, 32, 8, 1, 1, 1, 0.002, 0, "light_direct", DIRECT},
    {"furnace_sphere", LC_POV_DIRECT, 32, 4, 1, 1, 1, 0.002, 0, "light_direct", DIRECT},
    {"light_behind", LC_POV_DIRECT, 8, 2, 1, 1, 1, 0, 0, "light_direct", DARK},
    {"light_below", LC_POV_DIRECT, 8, 2, 1, 1, 1, 0, 0, "light_direct", DARK},
    {"no_lights", LC_POV_DIRECT, 2, 2, 1, 1, 1, 0, 0, "light_direct", DARK},
    {"sky", LC_POV_RADIOSITY, 2, 4, 400, 1, 1, 0.002, 0, "hemisphere_direct", SKY},
    {"mirror_sky", LC_POV_RADIOSITY, 2, 8, 400, 1, 1, 0.002, 0, "dielectric", SKY},
    {"glass_slab", LC_POV_SPECULAR, 2, 8, 1, 0, 8, 0.002, 0, "dielectric", CHAIN},
    {"glass_sphere", LC_POV_SPECULAR, 2, 8, 1, 0, 2, 0.002, 0, "dielectric", CHAIN},
    {"bright_room", LC_POV_RADIOSITY, 12, 4, 100, 1, 3, 0.015, 0, "path", GATHERED},
    {"two_patches", LC_POV_DIRECT, 24, 8, 1, 1, 1, 0.002, 0, "light_direct", DIRECT},
    {"two_surfaces", LC_POV_RADIOSITY, 12, 8, 400, 1, 2, 0.015, 0, "path", GATHERED},
    {"cornell", LC_POV_RADIOSITY, 8, 2, 400, 1, 3, 0.015, 0, "path_nee", GATHERED},
    {"sky_wall", LC_POV_RADIOSITY, 2, 4, 400, 1, 1, 0.015, 0, "hemisphere_direct", SKY_CUT},
    {"enclosure", LC_POV_DIRECT, 32, 4, 1, 1, 1, 0.002, 0, "light_direct", DIRECT},
    {"enclosure_point", LC_POV_DIRECT, 2, 8, 1, 1, 1, 0.002, 0, "light_direct", DELTA},
    {"mirror_wall", LC_POV_GATHERED, 2, 4, 1600, 1, 2, 0.05, 0, "dielectric", GLOWING},
    {NULL, LC_POV_DIRECT, 0, 0, 0, 0, 0, 0, 0, NULL, NULL},
};

void lc_pov_image_release(lc_pov_image *image)
{
    free(image->rgb);
    free(image->error);
    image->rgb = image->error = NULL;
}

static lc_status make_image(lc_pov_image *out, int width, int height, lc_error *err)
{
    size_t count = (size_t)width * (size_t)height;
    out->width = width;
    out->height = height;
    out->seconds = out->change = 0;
    out->rgb = calloc(3 * count, sizeof *out->rgb);
    out->error = calloc(count, sizeof *out->error);
    if (out->rgb && out->error)
        return LC_OK;
    lc_pov_image_release(out);
    return lc_fail(err, LC_FAULT, "out of memory for a reference of %d x %d pixels", width, height);
}

static double image_mean(const lc_pov_image *image)
{
    size_t count = 3 * (size_t)image->width * (size_t)image->height;
    double sum = 0;
    for (size_t i = 0; i < count; ++i)
        sum += image->rgb[i];
    return sum / (double)count;
}

double lc_pov_share_left_out(const lc_pov_image *image, double band)
{
    size_t count = (size_t)image->width * (size_t)image->height, out = 0;
    double most = band * image_mean(image);
    for (size_t i = 0; i < count; ++i)
        out += image->error[i] > most;
    return (double)out / (double)count;
}

/* ---- rendering --------------------------------------------------------------------------------------------------- */

/* Largest difference of a pixel's channels. */
static double difference(const lc_pov_image *fine, const double *coarse, size_t i)
{
    double most = 0;
    for (size_t c = 3 * i; c < 3 * i + 3; ++c)
        most = fmax(most, fabs(fine->rgb[c] - coarse[c]));
    return most;
}

/* With its neighbours: where an edge crosses a pixel, two grids may agree by chance, but not all along the edge. */
static double difference_around(const lc_pov_image *fine, const double *coarse, int x, int y)
{
    double most = 0;
    for (int v = y > 0 ? y - 1 : 0; v <= y + 1 && v < fine->height; ++v)
        for (int u = x > 0 ? x - 1 : 0; u <= x + 1 && u < fine->width; ++u)
            most = fmax(most, difference(fine, coarse, (size_t)v * (size_t)fine->width + (size_t)u));
    return most;
}

/* Of the means over the tile of 8 x 8 pixels: what is gathered by chance differs from pixel to pixel, but that averages
 * out. */
static double difference_of_tile(const lc_pov_image *fine, const double *coarse, int x, int y)
{
    double sum[3] = {0, 0, 0};
    int count = 0;
    for (int v = y - y % 8; v < y - y % 8 + 8 && v < fine->height; ++v)
        for (int u = x - x % 8; u < x - x % 8 + 8 && u < fine->width; ++u, ++count)
            for (size_t k = 0; k < 3; ++k) {
                size_t at = 3 * ((size_t)v * (size_t)fine->width + (size_t)u) + k;
                sum[k] += fine->rgb[at] - coarse[at];
            }
    return fmax(fabs(sum[0]), fmax(fabs(sum[1]), fabs(sum[2]))) / count;
}

/* Of processors, by the programs that were run. */
static double child_seconds(void)
{
    struct rusage used;
    getrusage(RUSAGE_CHILDREN, &used);
    return (double)(used.ru_utime.tv_sec + used.ru_stime.tv_sec) + 1e-6 * (double)(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
}

static int gathers(lc_pov_mode mode) { return mode == LC_POV_RADIOSITY || mode == LC_POV_GATHERED; }

static void find_errors(lc_pov_image *fine, const double *coarse, lc_pov_mode mode)
{
    for (int y = 0; y < fine->height; ++y)
        for (int x = 0; x < fine->width; ++x) {
            size_t at = (size_t)y * (size_t)fine->width + (size_t)x;
            const double *rgb = &fine->rgb[3 * at];
            fine->error[at] = 0x1p-11 * fmax(rgb[0], fmax(rgb[1], rgb[2]));
            fine->error[at] += gathers(mode) ? difference_of_tile(fine, coarse, x, y) : difference_around(fine, coarse, x, y);
        }
    double sum = 0, before = 0;
    for (size_t i = 0; i < 3 * (size_t)fine->width * (size_t)fine->height; ++i) {
        sum += fine->rgb[i];
        before += coarse[i];
    }
    fine->change = sum > 0 ? before / sum - 1 : 0;
}

static lc_status render_case(double *rgb, const lc_pov_case *c, int divisor, const lc_scene_desc *desc, int threads,
                             lc_error *err)
{
    lc_pov_options options;
    lc_pov_run run;
    lc_pov_options_init(&options);
    lc_pov_run_init(&run);
    options.mode = c->mode;
    options.emission = c->min_bounces == 0;
    options.bounces = c->max_bounces;
    options.area_samples = c->area_samples / divisor < 2 ? 2 : c->area_samples / divisor;
    options.count = c->count / divisor < 1 ? 1 : c->count / divisor;
    run.supersampling = c->supersampling / divisor < 1 ? 1 : c->supersampling / divisor;
    run.threads = gathers(c->mode) ? 1 : threads; /* what is gathered depends on the order of the pixels */
    run.seconds = 3600;
    return lc_pov_render(rgb, desc, &options, &run, err);
}

lc_status lc_pov_measure(lc_pov_image *out, const lc_pov_case *c, const lc_scene_desc *desc, int threads, lc_error *err)
{
    double *coarse = calloc(3 * (size_t)desc->width * (size_t)desc->height, sizeof *coarse);
    lc_status status = coarse ? make_image(out, desc->width, desc->height, err)
                              : lc_fail(err, LC_FAULT, "out of memory for a reference of %s", desc->name);
    if (status != LC_OK) {
        free(coarse);
        return status;
    }
    double start = child_seconds();
    status = render_case(coarse, c, 2, desc, threads, err);
    if (status == LC_OK)
        status = render_case(out->rgb, c, 1, desc, threads, err);
    if (status == LC_OK)
        find_errors(out, coarse, c->mode);
    else
        lc_pov_image_release(out);
    out->seconds = child_seconds() - start;
    free(coarse);
    return status;
}

/* ---- files ------------------------------------------------------------------------------------------------------- */

static lc_status hash_file(char hash[32], const char *path, lc_error *err)
{
    FILE *file = fopen(path, "rb");
    size_t size = 0, room = 1 << 16;
    char *bytes = file ? malloc(room) : NULL;
    while (bytes) {
        size += fread(bytes + size, 1, room - size, file);
        if (size < room)
            break;
        char *more = realloc(bytes, room *= 2);
        if (!more)
            free(bytes);
        bytes = more;
    }
    int ok = bytes && !ferror(file);
    if (ok)
        snprintf(hash, 32, "%016" PRIx64, lc_hash(LC_HASH, bytes, size));
    free(bytes);
    if (file)
        fclose(file);
    return ok ? LC_OK : lc_fail(err, LC_FAULT, "%s: cannot read the scene's file", path);
}

static void name_file(char path[PATH_SIZE], const char *folder, const lc_pov_case *c, const char *extension)
{
    snprintf(path, PATH_SIZE, "%s/%s%s%s.pov.%s", folder, c->scene, c->mode == LC_POV_DIRECT ? "" : ".",
             c->mode == LC_POV_DIRECT ? "" : mode_names[c->mode], extension);
}

static lc_status write_image(const char *path, const lc_pov_case *c, const lc_pov_image *image, lc_error *err)
{
    lc_film *film;
    lc_status status = lc_film_create(&film, image->width, image->height, err);
    if (status != LC_OK)
        return status;
    uint64_t n = (uint64_t)(c->supersampling * c->supersampling);
    n = n < 2 ? 2 : n; /* so that there is a variance to be the square of the error */
    snprintf(film->scene, sizeof film->scene, "%s", c->scene);
    snprintf(film->estimator, sizeof film->estimator, "povray");
    film->min_bounces = c->min_bounces;
    film->max_bounces = c->max_bounces;
    film->count = n;
    film->has_third = 0;
    for (size_t i = 0; i < (size_t)image->width * (size_t)image->height; ++i) {
        film->pixels[i].n = n;
        for (size_t k = 0; k < 3; ++k) {
            film->pixels[i].c[k].mean = image->rgb[3 * i + k];
            film->pixels[i].c[k].m2 = image->error[i] * image->error[i] * (double)(n * (n - 1));
        }
    }
    status = lc_exr_write(path, film, err);
    lc_film_free(film);
    return status;
}

static lc_status write_json(const char *path, json_t *json, lc_error *err)
{
    lc_outfile *out;
    char *text = json ? json_dumps(json, JSON_INDENT(4) | JSON_PRESERVE_ORDER | JSON_REAL_PRECISION(6)) : NULL;
    if (!text)
        return lc_fail(err, LC_FAULT, "%s: out of memory for it", path);
    lc_status status = lc_outfile_open(&out, path, err);
    if (status == LC_OK) {
        fprintf(lc_outfile_stream(out), "%s\n", text);
        status = lc_outfile_commit(out, err);
    }
    free(text);
    return status;
}

lc_status lc_pov_reference_write(const char *folder, const char *scene_file, const lc_pov_case *c,
                                 const lc_pov_image *image, lc_error *err)
{
    char path[PATH_SIZE], hash[32], version[128], command[128];
    lc_status status = hash_file(hash, scene_file, err);
    if (status == LC_OK)
        status = lc_pov_version(version, sizeof version, err);
    if (status != LC_OK)
        return status;
    snprintf(command, sizeof command, "povray +Iscene.pov +Oscene.exr +FE +W%d +H%d -A -D -P",
             image->width * c->supersampling, image->height * c->supersampling);
    json_t *json =
        json_pack("{s:s, s:s, s:s, s:s, s:s, s:s, s:i, s:i, s:i, s:i, s:i, s:f, s:f, s:f, s:f, s:f}", "renderer", "POV-Ray",
                  "version", version, "command", command, "scene", c->scene, "scene_fnv1a64", hash, "mode",
                  mode_names[c->mode], "area_samples", c->area_samples, "supersampling", c->supersampling, "count",
                  c->count, "min_bounces", c->min_bounces, "max_bounces", c->max_bounces, "band", c->band, "mean",
                  image_mean(image), "left_out", lc_pov_share_left_out(image, c->band), "change", image->change, "cpu_seconds", image->seconds);
    name_file(path, folder, c, "json");
    status = write_json(path, json, err);
    json_decref(json);
    name_file(path, folder, c, "exr");
    return status == LC_OK ? write_image(path, c, image, err) : status;
}

/* Whether the sidecar was written for this scene and case. */
static lc_status check_json(const char *path, const char *hash, const lc_pov_case *c, lc_error *err)
{
    json_t *json = json_load_file(path, 0, NULL);
    const char *was = "", *mode = "";
    int points = 0, samples = 0, count = 0, least = -1, most = -1;
    int read =
        json_unpack(json, "{s:s, s:s, s:i, s:i, s:i, s:i, s:i}", "scene_fnv1a64", &was, "mode", &mode, "area_samples",
                    &points, "supersampling", &samples, "count", &count, "min_bounces", &least, "max_bounces", &most);
    lc_status status = LC_OK;
    if (read != 0)
        status = lc_fail(err, LC_WRONG, "%s: missing or damaged: `make povray-reference` renders it", path);
    else if (strcmp(was, hash) != 0)
        status = lc_fail(err, LC_WRONG,
                         "%s: the scene has changed since it was rendered (%s, now %s): `make povray-reference`", path,
                         was, hash);
    else if (strcmp(mode, mode_names[c->mode]) != 0 || points != c->area_samples || samples != c->supersampling ||
             count != c->count || least != c->min_bounces || most != c->max_bounces)
        status = lc_fail(err, LC_WRONG, "%s: rendered with other options than now: `make povray-reference`", path);
    json_decref(json);
    return status;
}

lc_status lc_pov_reference_read(lc_pov_image *out, const char *folder, const char *scene_file, const lc_pov_case *c,
                                lc_error *err)
{
    char path[PATH_SIZE], hash[32];
    lc_film *film;
    lc_error why = {""};
    lc_status status = hash_file(hash, scene_file, err);
    name_file(path, folder, c, "json");
    if (status == LC_OK)
        status = check_json(path, hash, c, err);
    if (status != LC_OK)
        return status;
    name_file(path, folder, c, "exr");
    if (lc_exr_read(&film, path, &why) != LC_OK)
        return lc_fail(err, LC_WRONG, "%.900s: `make povray-reference` renders it", why.text);
    status = make_image(out, film->width, film->height, err);
    for (size_t i = 0; status == LC_OK && i < (size_t)film->width * (size_t)film->height; ++i) {
        out->error[i] = sqrt(lc_pixel_variance(&film->pixels[i], 0));
        for (size_t k = 0; k < 3; ++k)
            out->rgb[3 * i + k] = film->pixels[i].c[k].mean;
    }
    lc_film_free(film);
    return status;
}
