/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * lightcheck-worker PARENT INDEX COUNT: the process in which a file that nobody vouches for runs. It knows the tracer and one
 * scene, no other estimator, no check, no expected value, no name. It locks itself up, then loads the plug-in, so that even
 * a constructor of it runs in the jail; then it sends bare samples, and has no say in what becomes of them.
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "verify/grade/wire.h"

/* lc_render calls the estimator sample by sample in one fixed order; what it returns is what goes out. */
static struct {
    const lc_estimator *estimator;
    int costs; /* 1: what a sample cost is sent in its place; the estimator cannot know */
    size_t used;
    double buffer[3 * 1024];
} out;

static void flush(void)
{
    if (!lc_wire_send(LC_WIRE_SAMPLES, out.buffer, out.used * sizeof out.buffer[0]))
        _exit(3); /* nobody listens any more */
    out.used = 0;
}

static lc_rgb record(const lc_scene *scene, const lc_ray *ray, const lc_hit *hit, const lc_options *options,
                     lc_sampler *sampler)
{
    lc_rgb c = out.estimator->radiance(scene, ray, hit, options, sampler);
    if (out.costs)
        c = lc_cost_of(sampler);
    out.buffer[out.used++] = c.r;
    out.buffer[out.used++] = c.g;
    out.buffer[out.used++] = c.b;
    if (out.used == sizeof out.buffer / sizeof out.buffer[0])
        flush();
    return lc_black(); /* never bad: lc_render goes on to all terms of a sample, and its film is nothing to us */
}

static double cpu_so_far(void)
{
    struct timespec t;
    return clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t) == 0 ? (double)t.tv_sec + 1e-9 * (double)t.tv_nsec : 0;
}

static int greet(unsigned reached, lc_status status, const char *error)
{
    lc_wire_greeting greeting;
    memset(&greeting, 0, sizeof greeting);
    greeting.build = lc_wire_build();
    greeting.reached = reached;
    greeting.status = (int)status;
    greeting.cpu_seconds = cpu_so_far();
    snprintf(greeting.error, sizeof greeting.error, "%s", error);
    return lc_wire_send(LC_WIRE_SAMPLES, &greeting, sizeof greeting) && status == LC_OK;
}

static const lc_estimator *load(const char **error)
{
    char path[32];
    snprintf(path, sizeof path, "/proc/self/fd/%d", LC_WIRE_PLUGIN);
    void *library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    const lc_estimator *found = library ? dlsym(library, "lc_plugin") : NULL;
    *error = library ? "it defines no estimator" : dlerror();
    return found;
}

static int copy_text(char *to, size_t size, const char *from)
{
    snprintf(to, size, "%s", from ? from : "");
    return from != NULL;
}

static int describe(const lc_estimator *e, const char *error)
{
    lc_wire_description d;
    fflush(NULL); /* as in render() */
    memset(&d, 0, sizeof d);
    if (!e) {
        copy_text(d.source, sizeof d.source, error);
        return lc_wire_send(LC_WIRE_SAMPLES, &d, sizeof d);
    }
    d.loaded = 1;
    d.abi = e->abi;
    if (d.abi == LC_ABI) { /* of another interface nothing more can be read */
        d.has_name = copy_text(d.name, sizeof d.name, e->name);
        d.has_summary = copy_text(d.summary, sizeof d.summary, e->summary);
        d.has_source = copy_text(d.source, sizeof d.source, e->source);
        d.has_radiance = e->radiance != NULL;
        d.lobes = e->lobes;
        d.emitters = e->emitters;
        d.max_bounces = e->max_bounces;
    }
    return lc_wire_send(LC_WIRE_SAMPLES, &d, sizeof d);
}

static lc_status build(lc_scene **scene, lc_wire_request *request, lc_error *err)
{
    lc_status status = lc_scene_build(scene, &request->scenes[0], err);
    for (int i = 0; i < request->options.minus_count && status == LC_OK; ++i) {
        lc_scene *other;
        status = lc_scene_build(&other, &request->scenes[1 + i], err);
        request->terms[i].scene = other;
    }
    request->options.minus = request->terms;
    return status;
}

static int render(const lc_wire_request *request, const lc_scene *scene, const lc_estimator *estimator, int index,
                  int count)
{
    const lc_estimator recorder = {LC_ABI, "worker", "", "", 0, 0, LC_UNBOUNDED, record};
    lc_render_options options = request->options;
    lc_film *film;
    options.threads = 1;
    options.shard += options.shards * index;
    options.shards *= count;
    out.estimator = estimator;
    out.costs = options.costs;
    if (lc_film_create(&film, request->width, request->height, NULL) != LC_OK ||
        lc_render(film, scene, &recorder, &options, NULL) != LC_OK)
        return 0;
    fflush(NULL); /* with the last sample we are killed */
    flush();
    return 1;
}

int main(int argc, char **argv)
{
    lc_scene *scene = NULL;
    lc_error err = {""};
    const char *error = "";
    lc_wire_request *request = lc_wire_read(LC_WIRE_REQUEST);
    int null = open("/dev/null", O_RDONLY | O_CLOEXEC);
    if (argc != 4 || !request || null < 0 || dup2(null, LC_WIRE_REQUEST) < 0)
        return !greet(0, LC_FAULT, request ? "no descriptors" : "not called by a program of the same build");
    close(null);
    if (!lc_confine_follow(atoi(argv[1])))
        return 3;
    if (request->task == LC_WIRE_RENDER && build(&scene, request, &err) != LC_OK)
        return !greet(0, LC_FAULT, err.text);
    if (!greet(lc_confine_worker(&request->confinement, LC_WIRE_SAMPLES), LC_OK, ""))
        return 3;
    const lc_estimator *estimator = load(&error);
    int ok = request->task == LC_WIRE_DESCRIBE ? describe(estimator, error)
             : estimator                       ? render(request, scene, estimator, atoi(argv[2]), atoi(argv[3]))
                                               : 0;
    fflush(NULL);
    _exit(ok ? 0 : 4);
}
