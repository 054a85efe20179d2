/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "verify/grade/symbols.h"

#include <string.h>

/* math.h; each also with f and l. */
static const char math[] =
    " acos acosh asin asinh atan atan2 atanh cbrt ceil copysign cos cosh erf erfc exp exp2 expm1 fabs fdim floor fma "
    "fmax fmin fmod frexp hypot ilogb ldexp lgamma llrint llround log log10 log1p log2 logb lrint lround modf nan "
    "nearbyint nextafter nexttoward pow remainder remquo rint round scalbln scalbn sin sinh sqrt tan tanh tgamma trunc "
    "sincos exp10 j0 j1 jn y0 y1 yn __fpclassify __isnan __isinf __finite __signbit ";

/* Their own memory, text, order, and words for a person who looks for a mistake. */
static const char others[] =
    " memchr memcmp memcpy memmove memset strcat strchr strcmp strcpy strlen strncat strncmp strncpy strrchr strstr strspn "
    "strcspn strpbrk isalnum isalpha isdigit islower isspace isupper tolower toupper __ctype_b_loc "
    "abs labs llabs div ldiv qsort bsearch malloc calloc realloc free aligned_alloc posix_memalign abort "
    "printf puts putchar fprintf fputs fputc fwrite vprintf vfprintf snprintf sprintf vsnprintf fflush stdout stderr "
    "feclearexcept fegetround fetestexcept __assert_fail ";

/* What gcc, clang and their run-time libraries bring along. */
static const char *const beginnings[] = {
    "lc_", "__stack_chk_", "__cxa_", "__gmon_start__", "_ITM_", "_GLOBAL_OFFSET_TABLE_", "_Unwind_", "__errno_location",
    "__printf_chk", "__fprintf_chk", "__snprintf_chk", "__memcpy_chk", "__memset_chk", "__memmove_chk", "__tls_get_addr",
    "_Zn", "_Zd", "_ZS", "_ZN", "_ZT", "__dso_handle", "__gxx_personality",
};

static int is_in(const char *list, const char *name, size_t length)
{
    for (const char *at = strstr(list, " "); at && at[1]; at = strchr(at + 1, ' '))
        if (strncmp(at + 1, name, length) == 0 && at[1 + length] == ' ')
            return 1;
    return 0;
}

static int is_allowed(const char *name, size_t length)
{
    for (size_t i = 0; i < sizeof beginnings / sizeof beginnings[0]; ++i)
        if (length >= strlen(beginnings[i]) && strncmp(name, beginnings[i], strlen(beginnings[i])) == 0)
            return 1;
    int has_type = length > 1 && (name[length - 1] == 'f' || name[length - 1] == 'l');
    return is_in(math, name, length) || (has_type && is_in(math, name, length - 1)) || is_in(others, name, length);
}

lc_status lc_symbols_check(const char *symbols, const char *path, lc_error *err)
{
    for (const char *at = symbols; *at; at += strcspn(at, "\n"), at += *at == '\n') {
        size_t length = strcspn(at, "\n");
        if (length == 0 || is_allowed(at, length))
            continue;
        int random = is_in(" rand srand random srandom drand48 lrand48 rand_r time clock ", at, length);
        return lc_fail(err, LC_BAD_INPUT, "%s: uses `%.*s`: %s", path, length > 100 ? 100 : (int)length, at,
                       random ? "random numbers come from lc_next() alone"
                              : "an estimator has lightcheck.h, math.h and string.h, and no need of anything else");
    }
    return LC_OK;
}
