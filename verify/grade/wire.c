/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _GNU_SOURCE
#include "verify/grade/wire.h"

#include <errno.h>
#include <fcntl.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

enum { ARRAYS = 4 };

/* One array of a scene: where its pointer and its number stand in lc_scene_desc. */
static const struct {
    size_t pointer, count, size;
} arrays[ARRAYS] = {
    {offsetof(lc_scene_desc, materials), offsetof(lc_scene_desc, material_count), sizeof(lc_material_desc)},
    {offsetof(lc_scene_desc, shapes), offsetof(lc_scene_desc, shape_count), sizeof(lc_shape_desc)},
    {offsetof(lc_scene_desc, points), offsetof(lc_scene_desc, point_count), sizeof(lc_point_desc)},
    {offsetof(lc_scene_desc, directionals), offsetof(lc_scene_desc, directional_count), sizeof(lc_directional_desc)},
};

static void *get_pointer(const lc_scene_desc *scene, int i)
{
    void *pointer;
    memcpy(&pointer, (const char *)scene + arrays[i].pointer, sizeof pointer);
    return pointer;
}

static void set_pointer(lc_scene_desc *scene, int i, void *pointer)
{
    memcpy((char *)scene + arrays[i].pointer, &pointer, sizeof pointer);
}

static size_t size_of(const lc_scene_desc *scene, int i)
{
    int count;
    memcpy(&count, (const char *)scene + arrays[i].count, sizeof count);
    return (size_t)count * arrays[i].size;
}

uint64_t lc_wire_build(void)
{
    static const char when[] = LC_VERSION;
    uint64_t hash = 1469598103934665603u; /* FNV-1a, 64 bits */
    const size_t sizes[] = {LC_ABI,
                            sizeof(lc_wire_request),
                            sizeof(lc_wire_greeting),
                            sizeof(lc_wire_description),
                            sizeof(lc_material_desc),
                            sizeof(lc_shape_desc),
                            sizeof(lc_point_desc),
                            sizeof(lc_directional_desc)};
    for (size_t i = 0; i < sizeof when; ++i)
        hash = (hash ^ (unsigned char)when[i]) * 1099511628211u;
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; ++i)
        hash = (hash ^ sizes[i]) * 1099511628211u;
    return hash;
}

int lc_wire_send(int to, const void *data, size_t size)
{
    const char *at = data;
    while (size > 0) {
        ssize_t n = write(to, at, size);
        if (n < 0 && errno == EINTR)
            continue;
        if (n <= 0)
            return 0;
        at += n;
        size -= (size_t)n;
    }
    return 1;
}

static int write_scene(int fd, const lc_scene_desc *scene)
{
    for (int i = 0; i < ARRAYS; ++i) {
        const char *array = get_pointer(scene, i);
        size_t size = size_of(scene, i);
        if (arrays[i].size != sizeof(lc_material_desc) || i != 0) {
            if (!lc_wire_send(fd, array, size))
                return 0;
            continue;
        }
        for (size_t k = 0; k < size / sizeof(lc_material_desc); ++k) {
            lc_material_desc material = scene->materials[k];
            memset(material.id, 0, sizeof material.id);
            if (!lc_wire_send(fd, &material, sizeof material))
                return 0;
        }
    }
    return 1;
}

/* Without names and pointers. */
static void bare(lc_scene_desc *out, const lc_scene_desc *scene)
{
    *out = *scene;
    memset(out->name, 0, sizeof out->name);
    for (int i = 0; i < ARRAYS; ++i)
        set_pointer(out, i, NULL);
}

static int write_request(int fd, lc_wire_request *copy, const lc_scene *scene)
{
    const lc_scene_desc *scenes[1 + LC_MAX_TERMS];
    int count = scene ? 1 + copy->options.minus_count : 0;
    for (int i = 0; i < count; ++i) {
        scenes[i] = lc_scene_description(i ? copy->options.minus[i - 1].scene : scene);
        bare(&copy->scenes[i], scenes[i]);
        if (i) {
            copy->terms[i - 1] = copy->options.minus[i - 1];
            copy->terms[i - 1].scene = NULL;
        }
    }
    copy->options.minus = NULL;
    if (!lc_wire_send(fd, copy, sizeof *copy))
        return 0;
    for (int i = 0; i < count; ++i)
        if (!write_scene(fd, scenes[i]))
            return 0;
    return 1;
}

lc_status lc_wire_write(int *fd, const lc_wire_request *request, const lc_scene *scene, lc_error *err)
{
    lc_wire_request copy = *request;
    copy.build = lc_wire_build();
    copy.options.progress = NULL;
    copy.options.user = NULL;
    int file = memfd_create("request", MFD_CLOEXEC | MFD_ALLOW_SEALING);
    if (file >= 0 && write_request(file, &copy, scene) &&
        fcntl(file, F_ADD_SEALS, F_SEAL_WRITE | F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL) == 0) {
        *fd = file;
        return LC_OK;
    }
    lc_status status = lc_fail(err, LC_FAULT, "no file in memory for a worker's request: %s", strerror(errno));
    if (file >= 0)
        close(file);
    return status;
}

lc_wire_request *lc_wire_read(int fd)
{
    struct stat info;
    if (fstat(fd, &info) != 0 || (size_t)info.st_size < sizeof(lc_wire_request))
        return NULL;
    size_t size = (size_t)info.st_size, at = sizeof(lc_wire_request);
    char *map = mmap(NULL, size, PROT_READ | PROT_WRITE, MAP_PRIVATE, fd, 0);
    if (map == MAP_FAILED)
        return NULL;
    lc_wire_request *request = (lc_wire_request *)(void *)map;
    int count = request->build != lc_wire_build()      ? -1
                : request->task == LC_WIRE_DESCRIBE ? 0
                                                    : 1 + request->options.minus_count;
    for (int k = 0; k < count; ++k)
        for (int i = 0; i < ARRAYS; ++i) {
            set_pointer(&request->scenes[k], i, map + at);
            at += size_of(&request->scenes[k], i);
        }
    return count >= 0 && at == size ? request : NULL;
}
