/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What root has in a container of Docker with its default profile: 14 capabilities, and a filter of system calls. */
#ifndef LC_DOCKER_LIKE_H
#define LC_DOCKER_LIKE_H

/* Makes the calling process, which must be root's, as root is there; returns 0 when that cannot be had. For good. */
int lc_test_become_docker(void);

#endif
