/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _GNU_SOURCE
#include "verify/grade/confine.h"

#include <errno.h>
#include <fcntl.h>
#include <grp.h>
#include <linux/landlock.h>
#include <math.h>
#include <seccomp.h>
#include <signal.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

/* ---- limits ------------------------------------------------------------------------------------------------------ */

static int limit_twice(int what, uint64_t soft, uint64_t hard)
{
    struct rlimit now, wanted = {(rlim_t)soft, (rlim_t)hard};
    if (getrlimit((__rlimit_resource_t)what, &now) != 0)
        return 0;
    if (now.rlim_max != RLIM_INFINITY && wanted.rlim_max > now.rlim_max) /* a stricter one stands already */
        wanted.rlim_max = now.rlim_max;
    if (wanted.rlim_cur > wanted.rlim_max)
        wanted.rlim_cur = wanted.rlim_max;
    return setrlimit((__rlimit_resource_t)what, &wanted) == 0;
}

static int limit(int what, uint64_t value) { return limit_twice(what, value, value); }

/* Address space in use [bytes]. */
static uint64_t used_memory(void)
{
    unsigned long pages = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    if (file && fscanf(file, "%lu", &pages) != 1)
        pages = 0;
    if (file)
        fclose(file);
    return (uint64_t)pages * (uint64_t)sysconf(_SC_PAGESIZE);
}

static int set_limits(const lc_confinement *c, uint64_t processes, uint64_t descriptors)
{
    uint64_t seconds = (uint64_t)ceil(c->cpu_seconds);
    int ok = limit_twice(RLIMIT_CPU, seconds, seconds + 1); /* SIGXCPU, by which it is known; who catches that is killed */
#ifndef __SANITIZE_ADDRESS__ /* whose shadow has the size of the address space */
    ok &= limit(RLIMIT_AS, used_memory() + c->memory);
#endif
    ok &= limit(RLIMIT_STACK, 8 << 20);
    ok &= limit(RLIMIT_FSIZE, c->file_size);
    ok &= limit(RLIMIT_CORE, 0);
    ok &= limit(RLIMIT_MEMLOCK, 0);
    ok &= limit(RLIMIT_MSGQUEUE, 0);
    ok &= limit(RLIMIT_NOFILE, descriptors);
    if (processes != UINT64_MAX)
        ok &= limit(RLIMIT_NPROC, processes);
    return ok;
}

/* ---- another user ------------------------------------------------------------------------------------------------ */

static int change_user(void)
{
    if (geteuid() != 0)
        return 0;
    return setgroups(0, NULL) == 0 && setresgid(LC_JAIL_UID, LC_JAIL_UID, LC_JAIL_UID) == 0 &&
           setresuid(LC_JAIL_UID, LC_JAIL_UID, LC_JAIL_UID) == 0 && setuid(0) != 0;
}

int lc_confine_follow(int parent)
{
    return prctl(PR_SET_PDEATHSIG, SIGKILL) == 0 && getppid() == parent;
}

/* ---- Landlock ---------------------------------------------------------------------------------------------------- */

/* As in the kernel's documentation; the header of an older system does not know the later ones. */
enum { TRUNCATE = 14, IOCTL_DEV = 15, TCP = 3, SCOPES = 3 };

typedef struct ruleset {
    uint64_t files, net, scoped;
} ruleset;

static const uint64_t READ = LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_READ_DIR;

static int open_ruleset(uint64_t *files)
{
    long abi = syscall(SYS_landlock_create_ruleset, NULL, 0, 1 /* LANDLOCK_CREATE_RULESET_VERSION */);
    if (abi < 1)
        return -1;
    int bits = abi >= 5 ? IOCTL_DEV + 1 : abi >= 3 ? TRUNCATE + 1 : abi >= 2 ? TRUNCATE : TRUNCATE - 1;
    ruleset all = {(1ULL << bits) - 1, abi >= 4 ? TCP : 0, abi >= 6 ? SCOPES : 0};
    *files = all.files;
    size_t size = abi >= 6 ? sizeof all : abi >= 4 ? offsetof(ruleset, scoped) : offsetof(ruleset, net);
    return (int)syscall(SYS_landlock_create_ruleset, &all, size, 0);
}

static int allow_path(int rules, const char *path, uint64_t access)
{
    struct stat info;
    struct landlock_path_beneath_attr rule = {.parent_fd = open(path, O_PATH | O_CLOEXEC)};
    if (rule.parent_fd < 0)
        return errno == ENOENT;
    if (fstat(rule.parent_fd, &info) != 0 || !S_ISDIR(info.st_mode))
        access &= LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_WRITE_FILE | LANDLOCK_ACCESS_FS_EXECUTE;
    rule.allowed_access = access;
    long result = syscall(SYS_landlock_add_rule, rules, LANDLOCK_RULE_PATH_BENEATH, &rule, 0);
    close(rule.parent_fd);
    return result == 0;
}

static int enforce(int rules)
{
    long result = syscall(SYS_landlock_restrict_self, rules, 0);
    close(rules);
    return result == 0;
}

static int hide_files(void)
{
    uint64_t all;
    int rules = open_ruleset(&all);
    return rules >= 0 && enforce(rules);
}

static int show_compiler_its_files(void)
{
    /* What the compiler is made of and what it reads: nothing below /usr/share, /etc or a home. */
    static const char *const system_files[] = {
        "/usr/bin",       "/usr/lib",           "/usr/lib32",         "/usr/lib64", "/usr/libx32", "/usr/libexec",
        "/usr/include",   "/usr/local/bin",     "/usr/local/include", "/usr/local/lib", "/bin",    "/lib",
        "/lib64",         "/etc/ld.so.cache",   "/etc/alternatives",  NULL,
    };
    uint64_t all;
    int rules = open_ruleset(&all);
    if (rules < 0)
        return 0;
    int ok = allow_path(rules, ".", all & ~(uint64_t)LANDLOCK_ACCESS_FS_EXECUTE) &&
             allow_path(rules, "/dev/null", READ | LANDLOCK_ACCESS_FS_WRITE_FILE);
    for (const char *const *path = system_files; *path; ++path)
        ok &= allow_path(rules, *path, READ | LANDLOCK_ACCESS_FS_EXECUTE);
    return enforce(rules) && ok;
}

/* ---- seccomp ----------------------------------------------------------------------------------------------------- */

/* All that a computation needs: its own memory, its own clock, its end. */
static const int computing[] = {
    SCMP_SYS(read),          SCMP_SYS(pread64),       SCMP_SYS(close),          SCMP_SYS(fstat),
    SCMP_SYS(lseek),         SCMP_SYS(mmap),          SCMP_SYS(munmap),         SCMP_SYS(mremap),
    SCMP_SYS(mprotect),      SCMP_SYS(madvise),       SCMP_SYS(brk),            SCMP_SYS(rt_sigaction),
    SCMP_SYS(rt_sigreturn),  SCMP_SYS(rt_sigprocmask), SCMP_SYS(sigaltstack),   SCMP_SYS(clock_gettime),
    SCMP_SYS(gettimeofday),  SCMP_SYS(time),          SCMP_SYS(getpid),         SCMP_SYS(gettid),
    SCMP_SYS(getrandom),     SCMP_SYS(exit),          SCMP_SYS(exit_group),
};

enum { COMPUTING = sizeof computing / sizeof computing[0] };

static int allow_computing(scmp_filter_ctx filter, int samples)
{
    const int outputs[] = {1, 2, samples};
    int failed = 0;
    for (int i = 0; i < COMPUTING; ++i)
        failed |= seccomp_rule_add(filter, SCMP_ACT_ALLOW, computing[i], 0);
    for (int i = 0; i < 3; ++i)
        failed |= seccomp_rule_add(filter, SCMP_ACT_ALLOW, SCMP_SYS(write), 1,
                                   SCMP_A0(SCMP_CMP_EQ, (scmp_datum_t)outputs[i], 0));
    /* dlopen's way, which Landlock restricts further; fstat of the C library; the question whether stdout is a terminal. */
    failed |= seccomp_rule_add(filter, SCMP_ACT_ALLOW, SCMP_SYS(openat), 1,
                               SCMP_A2(SCMP_CMP_EQ, O_RDONLY | O_CLOEXEC, 0));
    failed |= seccomp_rule_add(filter, SCMP_ACT_ERRNO(EACCES), SCMP_SYS(openat), 1,
                               SCMP_A2(SCMP_CMP_NE, O_RDONLY | O_CLOEXEC, 0));
    failed |= seccomp_rule_add(filter, SCMP_ACT_ALLOW, SCMP_SYS(newfstatat), 1, SCMP_A3(SCMP_CMP_EQ, AT_EMPTY_PATH, 0));
    failed |= seccomp_rule_add(filter, SCMP_ACT_ERRNO(ENOTTY), SCMP_SYS(ioctl), 0);
    /* abort(), that is assert(); waking nobody. */
    failed |= seccomp_rule_add(filter, SCMP_ACT_ALLOW, SCMP_SYS(tgkill), 2,
                               SCMP_A0(SCMP_CMP_EQ, (scmp_datum_t)getpid(), 0), SCMP_A2(SCMP_CMP_EQ, SIGABRT, 0));
    failed |= seccomp_rule_add(filter, SCMP_ACT_ALLOW, SCMP_SYS(futex), 1, SCMP_A1(SCMP_CMP_MASKED_EQ, 0x7f, 1));
    return failed == 0;
}

static int only_compute(int samples)
{
    scmp_filter_ctx filter = seccomp_init(SCMP_ACT_KILL_PROCESS);
    int ok = filter && allow_computing(filter, samples) && seccomp_load(filter) == 0;
    if (filter)
        seccomp_release(filter);
    return ok;
}

/* A compiler is an honest program with a dubious input: what it never does is refused. */
static const int foreign_to_compilers[] = {
    SCMP_SYS(socket),          SCMP_SYS(socketpair),        SCMP_SYS(connect),      SCMP_SYS(bind),
    SCMP_SYS(ptrace),          SCMP_SYS(process_vm_readv),  SCMP_SYS(process_vm_writev), SCMP_SYS(mount),
    SCMP_SYS(umount2),         SCMP_SYS(unshare),           SCMP_SYS(setns),        SCMP_SYS(bpf),
    SCMP_SYS(perf_event_open), SCMP_SYS(keyctl),            SCMP_SYS(add_key),      SCMP_SYS(request_key),
    SCMP_SYS(userfaultfd),     SCMP_SYS(io_uring_setup),    SCMP_SYS(pidfd_open),   SCMP_SYS(pidfd_getfd),
    SCMP_SYS(shmget),          SCMP_SYS(msgget),            SCMP_SYS(semget),       SCMP_SYS(mq_open),
    SCMP_SYS(chroot),          SCMP_SYS(pivot_root),        SCMP_SYS(setsid),
};

static int only_compile(void)
{
    scmp_filter_ctx filter = seccomp_init(SCMP_ACT_ALLOW);
    int failed = !filter;
    for (size_t i = 0; !failed && i < sizeof foreign_to_compilers / sizeof foreign_to_compilers[0]; ++i)
        failed = seccomp_rule_add(filter, SCMP_ACT_ERRNO(EPERM), foreign_to_compilers[i], 0) != 0;
    failed = failed || seccomp_load(filter) != 0;
    if (filter)
        seccomp_release(filter);
    return !failed;
}

/* ---- all of it --------------------------------------------------------------------------------------------------- */

/* The order matters: root may still raise limits, and needs no privileges afterwards; seccomp comes last since it
 * forbids the rest. */
static unsigned begin(const lc_confinement *c, uint64_t processes, uint64_t descriptors)
{
    unsigned reached = 0;
    int parent = getppid();
    if ((c->parts & LC_JAIL_LIMITS) && set_limits(c, processes, descriptors))
        reached |= LC_JAIL_LIMITS;
    if ((c->parts & LC_JAIL_USER) && change_user())
        reached |= LC_JAIL_USER;
    lc_confine_follow(parent); /* a change of user has undone it */
    prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
    return reached;
}

unsigned lc_confine_worker(const lc_confinement *c, int samples)
{
    unsigned reached = begin(c, 0, 16);
    if ((c->parts & LC_JAIL_LANDLOCK) && hide_files())
        reached |= LC_JAIL_LANDLOCK;
    if ((c->parts & LC_JAIL_SECCOMP) && only_compute(samples))
        reached |= LC_JAIL_SECCOMP;
    return reached;
}

unsigned lc_confine_compiler(const lc_confinement *c)
{
    unsigned reached = begin(c, UINT64_MAX, 256);
    if ((c->parts & LC_JAIL_LANDLOCK) && show_compiler_its_files())
        reached |= LC_JAIL_LANDLOCK;
    if ((c->parts & LC_JAIL_SECCOMP) && only_compile())
        reached |= LC_JAIL_SECCOMP;
    return reached;
}
