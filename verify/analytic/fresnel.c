/* SPDX-License-Identifier: GPL-3.0-or-later */
/* fresnel.c: smooth dielectrics; see analytic.h for formulas and sources. */
#include "verify/analytic/analytic.h"

double lc_fresnel_dielectric(double cos_i, double eta)
{
    /* 1 - sin^2 t, without the loss of digits at grazing angles that would let an index of 1 reflect 5e-10. */
    double cos2_t = (cos_i * cos_i + (eta - 1) * (eta + 1)) / (eta * eta);
    if (cos2_t <= 0)
        return 1;
    double cos_t = sqrt(cos2_t);
    double s = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    double p = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    return (s * s + p * p) / 2;
}

double lc_slab_transmittance(double face, int internal)
{
    if (internal < 0)
        return (1 - face) / (1 + face);
    /* (1-R)^2 (1 - R^(2k)) / (1 - R^2), k = m/2 + 1 terms */
    return (1 - face) / (1 + face) * (1 - pow(face, 2 * (internal / 2 + 1)));
}

double lc_slab_reflectance(double face, int internal)
{
    if (internal < 0)
        return 2 * face / (1 + face);
    double terms = (internal + 1) / 2;
    return face + face * (1 - face) / (1 + face) * (1 - pow(face, 2 * terms));
}
