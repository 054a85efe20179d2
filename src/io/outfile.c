/* SPDX-License-Identifier: GPL-3.0-or-later */
/* outfile.c: see outfile.h. */
#include "io/outfile.h"

#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

struct lc_outfile {
    FILE *stream;
    char *path;   /* as the caller wrote it, for messages */
    char *target; /* what the commit replaces; NULL when written in place */
    char *temporary;
    int slot;  /* in `live`, or -1 */
    int error; /* errno of the first failed write */
};

/* ---- temporaries a signal handler must remove ------------------------------------------------------- */

/* A handler may not take locks or walk lists: a fixed table, whose `used` is set last and cleared first.
 * A file that finds no place in it merely survives a signal. */
enum { SLOTS = 16, SLOT_PATH = 4096 };
static struct {
    volatile sig_atomic_t used;
    char path[SLOT_PATH];
} live[SLOTS];
static pthread_mutex_t live_lock = PTHREAD_MUTEX_INITIALIZER;

static int live_add(const char *path)
{
    int slot = -1;
    if (strlen(path) >= SLOT_PATH)
        return -1;
    pthread_mutex_lock(&live_lock);
    for (int i = 0; i < SLOTS && slot < 0; ++i)
        if (!live[i].used)
            slot = i;
    if (slot >= 0) {
        strcpy(live[slot].path, path);
        live[slot].used = 1;
    }
    pthread_mutex_unlock(&live_lock);
    return slot;
}

static void live_remove(int slot)
{
    if (slot < 0)
        return;
    pthread_mutex_lock(&live_lock);
    live[slot].used = 0;
    pthread_mutex_unlock(&live_lock);
}

void lc_outfile_unlink_all(void)
{
    for (int i = 0; i < SLOTS; ++i)
        if (live[i].used)
            unlink(live[i].path);
}

/* ---- opening ---------------------------------------------------------------------------------------- */

static lc_status fail_write(const char *path, int error, lc_error *err)
{
    return lc_fail(err, LC_FAULT, "%s: cannot write: %s", path, strerror(error));
}

static char *copy_string(const char *text)
{
    size_t size = strlen(text) + 1;
    char *copy = malloc(size);
    return copy ? memcpy(copy, text, size) : NULL;
}

/* Where `path` leads when its last part is a symbolic link, so that the link stays one; NULL with errno. (glibc shows
 * realpath to X/Open programs only.) */
static char *follow_links(const char *path)
{
    enum { MAX_LINKS = 40 };
    char *target = copy_string(path);
    for (int i = 0; target && i < MAX_LINKS; ++i) {
        char link[SLOT_PATH];
        ssize_t size = readlink(target, link, sizeof link - 1);
        if (size < 0)
            return target; /* no link: the end */
        link[size] = 0;
        const char *slash = strrchr(target, '/');
        size_t folder = slash && link[0] != '/' ? (size_t)(slash - target) + 1 : 0;
        char *next = malloc(folder + (size_t)size + 1);
        if (next) {
            memcpy(next, target, folder);
            memcpy(next + folder, link, (size_t)size + 1);
        }
        free(target);
        target = next;
    }
    if (target) {
        free(target);
        errno = ELOOP;
    }
    return NULL;
}

/* Creates the file and lists it in `live`, with no signal between the two; returns its descriptor, or -1 with errno. */
static int create_listed(int *slot, const char *path)
{
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    int fd = open(path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666), error = errno;
    if (fd >= 0)
        *slot = live_add(path);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    errno = error;
    return fd;
}

/* Creates file->temporary beside the target; returns its descriptor, or -1 with errno. */
static int create_temporary(lc_outfile *file)
{
    enum { TRIES = 1000 };
    const char *slash = strrchr(file->target, '/');
    size_t folder = slash ? (size_t)(slash - file->target) + 1 : 0, size = folder + 64;
    file->temporary = malloc(size);
    if (!file->temporary)
        return -1;
    memcpy(file->temporary, file->target, folder);
    for (int i = 0; i < TRIES; ++i) {
        /* Not mkstemp, whose mode 0600 would become the result's: the umask decides. */
        snprintf(file->temporary + folder, size - folder, ".lightcheck-%ld-%d.tmp", (long)getpid(), i);
        int fd = create_listed(&file->slot, file->temporary);
        if (fd >= 0 || errno != EEXIST)
            return fd;
    }
    return -1;
}

/* Decides what is written, and opens it; returns a descriptor, or -1 with errno. */
static int open_target(lc_outfile *file)
{
    struct stat st;
    int exists = stat(file->path, &st) == 0;
    if (!exists && errno != ENOENT)
        return -1;
    if (exists && !S_ISREG(st.st_mode)) /* a directory fails here with EISDIR */
        return open(file->path, O_WRONLY | O_CLOEXEC);
    if (!exists && (file->path[0] == 0 || file->path[strlen(file->path) - 1] == '/')) {
        errno = ENOENT;
        return -1;
    }
    if (exists && faccessat(AT_FDCWD, file->path, W_OK, AT_EACCESS) != 0)
        return -1; /* rename alone would replace what was write-protected */
    file->target = follow_links(file->path);
    if (!file->target)
        return -1;
    int fd = create_temporary(file);
    if (fd >= 0 && exists)
        (void)fchmod(fd, st.st_mode & 0777); /* may be another's file: then the mode is merely the umask's */
    return fd;
}

static void discard(lc_outfile *file)
{
    if (file->stream)
        fclose(file->stream);
    if (file->temporary)
        unlink(file->temporary);
    live_remove(file->slot);
    free(file->temporary);
    free(file->target);
    free(file->path);
    free(file);
}

lc_status lc_outfile_open(lc_outfile **out, const char *path, lc_error *err)
{
    *out = NULL;
    lc_outfile *file = calloc(1, sizeof *file);
    if (!file)
        return fail_write(path, ENOMEM, err);
    file->slot = -1;
    file->path = copy_string(path);
    int fd = file->path ? open_target(file) : -1;
    int error = errno;
    if (fd >= 0) {
        file->stream = fdopen(fd, "wb");
        error = errno;
    }
    if (!file->stream) {
        if (fd >= 0)
            close(fd);
        else if (file->temporary) { /* never created: not ours to unlink */
            free(file->temporary);
            file->temporary = NULL;
        }
        discard(file);
        return fail_write(path, error, err);
    }
    *out = file;
    return LC_OK;
}

/* ---- writing ---------------------------------------------------------------------------------------- */

FILE *lc_outfile_stream(lc_outfile *file) { return file->stream; }

lc_status lc_outfile_write(lc_outfile *file, const void *data, size_t size, lc_error *err)
{
    if (!file->error && fwrite(data, 1, size, file->stream) != size)
        file->error = errno ? errno : EIO;
    return file->error ? fail_write(file->path, file->error, err) : LC_OK;
}

lc_status lc_outfile_write_at(lc_outfile *file, uint64_t offset, const void *data, size_t size, lc_error *err)
{
    off_t at = (off_t)offset;
    if (!file->error && ftello(file->stream) != at && fseeko(file->stream, at, SEEK_SET) != 0)
        file->error = errno;
    return lc_outfile_write(file, data, size, err);
}

lc_status lc_outfile_commit(lc_outfile *file, lc_error *err)
{
    int error = file->error;
    errno = 0;
    if (!error && (fflush(file->stream) != 0 || ferror(file->stream)))
        error = errno ? errno : EIO;
    /* Some file systems cannot sync and say EINVAL. */
    if (!error && file->temporary && fsync(fileno(file->stream)) != 0 && errno != EINVAL)
        error = errno;
    if (fclose(file->stream) != 0 && !error)
        error = errno;
    file->stream = NULL;
    if (!error && file->temporary && rename(file->temporary, file->target) != 0)
        error = errno;
    if (!error && file->temporary) { /* it has its name now */
        free(file->temporary);
        file->temporary = NULL;
    }
    lc_status status = error ? fail_write(file->path, error, err) : LC_OK;
    discard(file);
    return status;
}

void lc_outfile_abort(lc_outfile *file)
{
    if (file)
        discard(file);
}
