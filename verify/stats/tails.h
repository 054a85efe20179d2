/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * tails.h: tails of the normal, t, F, beta and chi-square distributions, far out, and their inverses.
 *
 * Survival functions, never 1 - cdf, and as logarithms, so that p = 1e-300 and far beyond are numbers like others. GSL
 * gives the special functions and the normal quantile; its own inverses of t, F and beta are not used, because they
 * abort the program where they do not converge, which they do for common arguments (beta(1, 1e7) at 5e-7).
 *
 * All: NaN in, or a parameter out of range, gives NaN. Any thread, no globals.
 */
#ifndef LC_TAILS_H
#define LC_TAILS_H

/* ln P(Z >= z) for a standard normal Z; any z. */
double lc_normal_log_sf(double z);
/* z with P(Z >= z) = alpha, alpha in (0, 1), down to 1e-300. Wichura, AS 241 (GSL). */
double lc_normal_quantile(double alpha);

/* ln P(T >= t) for Student's t with df > 0 degrees of freedom (INFINITY: normal); DLMF 8.17.22 for I_x(df / 2, 1 / 2).
 */
double lc_t_log_sf(double t, double df);
/* t with P(T >= t) = alpha, alpha in (0, 1); relative error about 1e-12. Newton's method on ln P over ln t from
 * sqrt(df expm1(z^2 / df)), Hill, CACM 13(10), 1970. */
double lc_t_quantile(double alpha, double df);

/* ln I_x(a, b), x + y = 1 given both, so that neither loses digits; a, b > 0. */
double lc_beta_log_cdf(double x, double y, double a, double b);
/* ln(x / (1 - x)) with I_x(a, b) = alpha, alpha in (0, 1): a logit, for the same reason. Bisection. */
double lc_beta_quantile_logit(double alpha, double a, double b);

/* ln P(F >= f), and f with P(F >= f) = alpha in (0, 1), for Fisher's F with d1, d2 > 0 degrees of freedom; f >= 0. */
double lc_f_log_sf(double f, double d1, double d2);
double lc_f_quantile(double alpha, double d1, double d2);

/* ln P(X >= x) for chi-square with df > 0 degrees of freedom, x >= 0; DLMF 8.9.2 in the tail. */
double lc_chi_square_log_sf(double x, double df);

/* Level of each of m >= 1 independent tests that gives alpha in all, 1 - (1 - alpha)^(1/m); Sidak, JASA 62, 1967. */
double lc_sidak_level(double alpha, double m);
/* The smallest of m p values, as a p value of all: 1 - (1 - p)^m. */
double lc_sidak_combine(double p, double m);
/* The same without independence: min(1, m p). */
double lc_bonferroni_combine(double p, double m);

#endif
