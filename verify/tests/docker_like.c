/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "verify/tests/docker_like.h"

#include <errno.h>
#include <linux/capability.h>
#include <linux/sched.h>
#include <seccomp.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/prctl.h>
#include <unistd.h>

/* The C library has it, and no header. */
extern int capset(cap_user_header_t header, const cap_user_data_t data);

static const int kept[] = {
    CAP_CHOWN,  CAP_DAC_OVERRIDE, CAP_FOWNER,           CAP_FSETID,  CAP_KILL,       CAP_SETGID, CAP_SETUID,
    CAP_SETPCAP, CAP_NET_BIND_SERVICE, CAP_NET_RAW, CAP_SYS_CHROOT, CAP_MKNOD, CAP_AUDIT_WRITE, CAP_SETFCAP,
};

static const int refused[] = {
    SCMP_SYS(unshare),         SCMP_SYS(setns),       SCMP_SYS(mount),         SCMP_SYS(umount2),
    SCMP_SYS(pivot_root),      SCMP_SYS(fsopen),      SCMP_SYS(fsmount),       SCMP_SYS(move_mount),
    SCMP_SYS(open_tree),       SCMP_SYS(fsconfig),    SCMP_SYS(fspick),        SCMP_SYS(mount_setattr),
    SCMP_SYS(bpf),             SCMP_SYS(perf_event_open), SCMP_SYS(keyctl),    SCMP_SYS(add_key),
    SCMP_SYS(request_key),     SCMP_SYS(userfaultfd), SCMP_SYS(fanotify_init), SCMP_SYS(init_module),
    SCMP_SYS(finit_module),    SCMP_SYS(delete_module), SCMP_SYS(kexec_load),  SCMP_SYS(reboot),
};

/* Root needs no no_new_privs for a filter, and Docker sets none. */
static int filter_calls(void)
{
    const scmp_datum_t namespaces = CLONE_NEWNS | CLONE_NEWUTS | CLONE_NEWIPC | CLONE_NEWUSER | CLONE_NEWPID |
                                    CLONE_NEWNET | CLONE_NEWCGROUP;
    scmp_filter_ctx filter = seccomp_init(SCMP_ACT_ALLOW);
    int failed = !filter || seccomp_attr_set(filter, SCMP_FLTATR_CTL_NNP, 0) != 0;
    for (size_t i = 0; !failed && i < sizeof refused / sizeof refused[0]; ++i)
        failed = seccomp_rule_add(filter, SCMP_ACT_ERRNO(EPERM), refused[i], 0) != 0;
    for (int bit = 0; !failed && bit < 32; ++bit) /* each flag alone, since a filter cannot ask for "any of" */
        if ((namespaces >> bit) & 1)
            failed = seccomp_rule_add(filter, SCMP_ACT_ERRNO(EPERM), SCMP_SYS(clone), 1,
                                      SCMP_A0(SCMP_CMP_MASKED_EQ, (scmp_datum_t)1 << bit, (scmp_datum_t)1 << bit)) != 0;
    failed = failed || seccomp_rule_add(filter, SCMP_ACT_ERRNO(ENOSYS), SCMP_SYS(clone3), 0) != 0 ||
             seccomp_load(filter) != 0;
    if (filter)
        seccomp_release(filter);
    return !failed;
}

static int drop_capabilities(void)
{
    struct __user_cap_header_struct header = {_LINUX_CAPABILITY_VERSION_3, 0};
    struct __user_cap_data_struct data[2] = {{0, 0, 0}, {0, 0, 0}};
    uint64_t mask = 0;
    for (size_t i = 0; i < sizeof kept / sizeof kept[0]; ++i)
        mask |= (uint64_t)1 << kept[i];
    for (int i = 0; i < 64; ++i)
        if (!((mask >> i) & 1) && prctl(PR_CAPBSET_READ, i, 0, 0, 0) == 1 && prctl(PR_CAPBSET_DROP, i, 0, 0, 0) != 0)
            return 0;
    for (int i = 0; i < 2; ++i)
        data[i].effective = data[i].permitted = (uint32_t)(mask >> (32 * i));
    return capset(&header, data) == 0;
}

/* In Docker itself nothing is left to be imitated, nor could it be: a filter needs what Docker takes. */
static int is_docker(void) { return prctl(PR_GET_SECCOMP, 0, 0, 0, 0) == 2 && prctl(PR_CAPBSET_READ, CAP_SYS_ADMIN, 0, 0, 0) == 0; }

int lc_test_become_docker(void) { return geteuid() == 0 && (is_docker() || (filter_calls() && drop_capabilities())); }
