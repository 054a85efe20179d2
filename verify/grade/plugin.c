/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "verify/grade/plugin.h"

#include <dlfcn.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

int lc_is_plugin(const char *name)
{
    size_t length = strlen(name);
    return lc_is_source(name) || (length > 3 && strcmp(name + length - 3, ".so") == 0);
}

static int is_name(const char *name)
{
    static const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_";
    size_t length = strlen(name);
    return length > 0 && length < sizeof((lc_film *)0)->estimator && strspn(name, letters) == length;
}

lc_status lc_descriptor_check(const lc_estimator *estimator, const char *path, lc_error *err)
{
    if (estimator->abi != LC_ABI)
        return lc_fail(err, LC_BAD_INPUT, "%s: written for interface %d, this program has %d", path, estimator->abi,
                       LC_ABI);
    if (!estimator->name || !is_name(estimator->name))
        return lc_fail(err, LC_BAD_INPUT, "%s: the estimator's name must be 1 to 63 letters, digits and _", path);
    if (!estimator->summary || !estimator->source)
        return lc_fail(err, LC_BAD_INPUT, "%s: %s has no %s; a line of text is expected", path, estimator->name,
                       estimator->summary ? "source" : "summary");
    if (estimator->max_bounces < 0 || estimator->max_bounces > LC_UNBOUNDED)
        return lc_fail(err, LC_BAD_INPUT, "%s: %s has max_bounces %d, expected 0 to LC_UNBOUNDED", path,
                       estimator->name, estimator->max_bounces);
    if (!estimator->radiance)
        return lc_fail(err, LC_BAD_INPUT, "%s: %s has no function `radiance`", path, estimator->name);
    return LC_OK;
}

/* dlerror's "OBJECT: undefined symbol: lc_x" tells what was meant; the object's name is nothing to a reader. */
static lc_status report_load(const char *path, lc_error *err)
{
    const char *text = dlerror(), *sign = "undefined symbol: ", *at = text ? strstr(text, sign) : NULL;
    if (at) {
        at += strlen(sign);
        return lc_fail(err, LC_BAD_INPUT, "%s: uses `%.*s`, which neither it nor lightcheck.h has", path,
                       (int)strcspn(at, " ,"), at);
    }
    return lc_fail(err, LC_BAD_INPUT, "%s: cannot load: %s", path, text ? text : "unknown reason");
}

static lc_status load(const lc_estimator **out, const char *object, const char *path, lc_error *err)
{
    void *library = dlopen(object, RTLD_NOW | RTLD_LOCAL);
    if (!library)
        return report_load(path, err);
    const lc_estimator *found = dlsym(library, "lc_plugin");
    if (!found) {
        dlclose(library);
        return lc_fail(err, LC_BAD_INPUT,
                       "%s: defines no estimator; expected LC_ESTIMATOR(name) = { LC_ABI, \"name\", ... };", path);
    }
    lc_status status = lc_descriptor_check(found, path, err);
    if (status == LC_OK)
        *out = found; /* the library stays: nobody can tell when its last estimator is gone */
    else
        dlclose(library);
    return status;
}

lc_status lc_plugin_load(const lc_estimator **out, const char *path, char *messages, size_t size, lc_error *err)
{
    char object[4096];
    lc_compiled compiled;
    if (messages && size)
        messages[0] = 0;
    if (!lc_is_source(path)) { /* dlopen looks for a name without a slash in the system's folders */
        snprintf(object, sizeof object, "%s%s", strchr(path, '/') ? "" : "./", path);
        return load(out, object, path, err);
    }
    lc_status status = lc_compile(&compiled, path, NULL, err);
    if (messages && size)
        snprintf(messages, size, "%s", compiled.messages);
    if (status != LC_OK)
        return status;
    snprintf(object, sizeof object, "/proc/self/fd/%d", compiled.image);
    status = load(out, object, path, err);
    /* The descriptor of a loaded object stays open: the next one must have another name. */
    if (status != LC_OK)
        close(compiled.image);
    return status;
}
