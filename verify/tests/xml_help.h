/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A small reader of the XML that JUnit reports may contain. */
#ifndef LC_XML_HELP_H
#define LC_XML_HELP_H

#include <check.h>
#include <string.h>

/* Tags nest, attributes are quoted, '&' starts one of five entities, and no control character occurs. Counts the tags
 * of that name. */
static int count_tags(const char *xml, const char *name)
{
    const char *open[16];
    size_t length[16];
    int depth = 0, count = 0;
    for (const char *c = xml; *c; ++c) {
        ck_assert_msg((unsigned char)*c >= 0x20 || *c == '\n', "control character %d", *c);
        if (*c == '&')
            ck_assert_msg(strncmp(c, "&amp;", 5) == 0 || strncmp(c, "&lt;", 4) == 0 || strncmp(c, "&gt;", 4) == 0 ||
                              strncmp(c, "&quot;", 6) == 0 || strncmp(c, "&apos;", 6) == 0,
                          "a bare &: %.20s", c);
        if (*c != '<')
            continue;
        const char *tag = c + 1;
        int quoted = 0;
        for (++c; *c && (*c != '>' || quoted); ++c) {
            quoted ^= *c == '"';
            ck_assert_msg(*c != '<', "a bare < in a tag: %.20s", c);
        }
        ck_assert_msg(*c == '>', "a tag without end");
        size_t n = strcspn(tag + (*tag == '/'), " />?");
        if (*tag == '?')
            continue;
        if (*tag == '/') {
            ck_assert_int_gt(depth, 0);
            --depth;
            ck_assert_msg(n == length[depth] && strncmp(tag + 1, open[depth], n) == 0, "</%.*s> closes nothing", (int)n,
                          tag + 1);
            continue;
        }
        count += strlen(name) == n && strncmp(tag, name, n) == 0;
        if (c[-1] != '/') {
            ck_assert_int_lt(depth, 16);
            open[depth] = tag;
            length[depth++] = n;
        }
    }
    ck_assert_int_eq(depth, 0);
    return count;
}

#endif
