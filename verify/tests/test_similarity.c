/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "verify/tests/tests.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "verify/grade/similarity.h"
#include "verify/grade/texts.h"

/* The prints of a file less the template's; the caller releases them. */
static lc_prints prints_of(const char *path)
{
    lc_prints known, out;
    lc_error err;
    ck_assert_int_eq(lc_prints_make_known(&known, (const char *)lc_text_template_c, &err), LC_OK);
    ck_assert_msg(lc_prints_read(&out, path, &known, &err) == LC_OK, "%s", err.text);
    lc_prints_release(&known);
    return out;
}

static double overlap_of(const char *a, const char *b)
{
    lc_prints x = prints_of(a), y = prints_of(b);
    double there = lc_prints_overlap(&x, &y), back = lc_prints_overlap(&y, &x);
    ck_assert_double_eq(there, back);
    lc_prints_release(&x);
    lc_prints_release(&y);
    return there;
}

/* Other names, other comments, functions in another order. */
START_TEST(test_similarity_disguised)
{
    double same = overlap_of("estimators/light_direct.c", "estimators/light_direct.c");
    double disguised = overlap_of("verify/tests/handins/renamed.c", "estimators/light_direct.c");
    ck_assert_double_eq(same, 1);
    ck_assert_msg(disguised > 0.8, "%.2f", disguised);
}
END_TEST

/* Right solutions of the same task, by people who did not see each other's. */
START_TEST(test_similarity_independent)
{
    static const char *const files[] = {"verify/tests/handins/all_lights.c", "verify/tests/handins/by_channel.c",
                                        "estimators/light_direct.c"};
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < i; ++k)
            ck_assert_msg(overlap_of(files[i], files[k]) < 0.2, "%s %s %.2f", files[i], files[k],
                          overlap_of(files[i], files[k]));
}
END_TEST

/* Dead code beside a copy hides nothing: the share is the smaller file's. */
START_TEST(test_similarity_padded)
{
    static char text[1 << 16];
    lc_prints copy, whole = prints_of("estimators/light_direct.c");
    lc_error err;
    size_t size = 0;
    FILE *file = fopen("estimators/light_direct.c", "r");
    ck_assert_ptr_nonnull(file);
    size = fread(text, 1, sizeof text / 2, file);
    fclose(file);
    for (int i = 0; i < 300; ++i)
        size += (size_t)snprintf(text + size, sizeof text - size, "int f%d(int a) { return a * %d + a / (a | %d); }\n", i, i, i);
    ck_assert_int_eq(lc_prints_make(&copy, text, NULL, &err), LC_OK);
    ck_assert_int_gt(copy.count, whole.count);
    ck_assert_double_eq(lc_prints_overlap(&copy, &whole), 1);
    lc_prints_release(&copy);
    lc_prints_release(&whole);
}
END_TEST

/* What everybody was given is nobody's copy. */
START_TEST(test_similarity_template)
{
    lc_prints a = prints_of("estimators/template.c");
    ck_assert_int_eq(a.count, 0);
    ck_assert_double_eq(lc_prints_overlap(&a, &a), 0);
    lc_prints_release(&a);
}
END_TEST

/* Of any bytes: fingerprints do not depend on what is no code, and broken code does no harm. */
START_TEST(test_similarity_any_text)
{
    static const char *const texts[] = {"", "/* no end", "\"no end", "'", "\\", "a \"b\\", "#include", "// x", "1.e+5f .5 0x1p-3", "\xff\xfe"};
    static const char plain[] = "int f(int a){return lc_next(a)*a+1.5e3;} int g(int b){return lc_next(b)-b/2;}"
                                "int h(int a,int b){while(a<b){a=f(b);b=g(a);a=a*b;}return a+b;}";
    static const char odd[] = "#include <math.h>\nstatic int one(const int z) /* ; */ {\n return lc_next(z) * z + 7; } // \"\n"
                              "int two(int w) { return lc_next(w) - w / 11; }\n"
                              "inline int three(int p, int q) { while (p < q) { p = one(q); q = two(p); p = p * q; } return p + q; }";
    lc_prints a, b;
    lc_error err;
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; ++i) {
        ck_assert_int_eq(lc_prints_make(&a, texts[i], NULL, &err), LC_OK);
        ck_assert_int_eq(a.count, 0);
        lc_prints_release(&a);
    }
    ck_assert_int_eq(lc_prints_make(&a, plain, NULL, &err), LC_OK);
    ck_assert_int_eq(lc_prints_make(&b, odd, NULL, &err), LC_OK);
    ck_assert_int_ge(a.count, 8);
    ck_assert_double_eq(lc_prints_overlap(&a, &b), 1);
    lc_prints_release(&a);
    lc_prints_release(&b);
    ck_assert_int_eq(lc_prints_read(&a, "absent.c", NULL, &err), LC_BAD_INPUT);
    ck_assert_ptr_nonnull(strstr(err.text, "absent.c: cannot read"));
}
END_TEST

Suite *lc_suite_similarity(void)
{
    Suite *suite = suite_create("similarity");
    TCase *tests = tcase_create("similarity");
    tcase_add_test(tests, test_similarity_disguised);
    tcase_add_test(tests, test_similarity_independent);
    tcase_add_test(tests, test_similarity_padded);
    tcase_add_test(tests, test_similarity_template);
    tcase_add_test(tests, test_similarity_any_text);
    suite_add_tcase(suite, tests);
    return suite;
}
