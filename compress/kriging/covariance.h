/* How alike the reflectance of a texel is under two pairs of light and view: the prior of kriging, as Gaussian process
 * regression is called where it comes from (Krige 1951; Rasmussen and Williams 2006).
 *
 * For the reflectance times cosine r at the pairs a and b
 *
 *     cov(r_a, r_b) = s_0 l_z l'_z
 *                   + s_1 M(|l - l'|^2 / p_1^2 + |v - v'|^2 / q_1^2)
 *                   + g g' (s_2 M(|h - h'|^2 / p_2^2 + |v - v'|^2 / q_2^2) + s_3 M(|h - h'|^2 / p_3^2))
 *     g = (l.h)^a l_z^b v_z^c
 *
 * with h the unit half vector and M(x) = (1 + sqrt(3 x)) exp(-sqrt(3 x)), the Matern covariance of smoothness 3/2. The
 * terms are: a diffuse term; what changes smoothly with light and view, such as shadows; highlights, which stay at
 * their half vector and change slowly with the view; and highlights that do not change with the view. How a highlight
 * grows towards the horizon depends on the cloth, by Fresnel's law, by what yarns hide and by foreshortening: g. Noise
 * comes on top. Only ratios of the variances matter: s_1 is 1.
 *
 * The mean over many texels is smoother than they are: it is reciprocal (Helmholtz), and most cloths look the same
 * after half a turn. Where x = (l, v), x^ = (v, l) and x~ is x after half a turn about the normal, its covariance is
 *
 *     c(x, x') + t c(x, x'~)
 *     c(x, x') = (1 - r) cov(x, x') + r / 2 (cov(x, x') + u cov(x^, x') + u' cov(x, x'^) + u u' cov(x^, x'^))
 *     u = l_z / v_z
 *
 * with 0 < r, t < 1 as far as it is so. All functions are pure. */
#ifndef WEFT_COMPRESS_KRIGING_COVARIANCE_H
#define WEFT_COMPRESS_KRIGING_COVARIANCE_H

#include "base/vector.h"

#include <stdbool.h>

/* A light and a view above the horizon, and what covariances need of them. */
typedef struct weft_direction_pair {
    double light[3], view[3], half_vector[3];
    double log_incidence, log_light, log_view; /* logarithms of l.h, l_z, v_z */
    double cosine_ratio;                       /* u = l_z / v_z */
} weft_direction_pair;

weft_direction_pair weft_direction_pair_of(weft_vec3 light, weft_vec3 view);

typedef enum weft_covariance_number {
    WEFT_NOISE, /* variance of the noise as a share of the mean variance of what is measured */
    WEFT_DIFFUSE_VARIANCE,
    WEFT_SMOOTH_LIGHT_LENGTH,
    WEFT_SMOOTH_VIEW_LENGTH,
    WEFT_HIGHLIGHT_VARIANCE,
    WEFT_HIGHLIGHT_LENGTH,
    WEFT_HIGHLIGHT_VIEW_LENGTH,
    WEFT_FIXED_HIGHLIGHT_VARIANCE,
    WEFT_FIXED_HIGHLIGHT_LENGTH,
    WEFT_INCIDENCE_POWER, /* a; b and c follow */
    WEFT_LIGHT_POWER,
    WEFT_VIEW_POWER,
    WEFT_RECIPROCITY, /* r / (1 - r); t / (1 - t) follows */
    WEFT_HALF_TURN,
    WEFT_COVARIANCE_NUMBERS
} weft_covariance_number;

/* Base 2 logarithms of variances, of lengths (of chords of the unit sphere) and of odds; twice the powers. A step of 1
 * changes each of them about as much. */
typedef struct weft_covariance {
    double number[WEFT_COVARIANCE_NUMBERS];
    bool is_of_mean; /* r and t count; else they are 0 */
} weft_covariance;

/* What is assumed before any sample is seen: of texels, and of the mean over them. */
weft_covariance weft_covariance_usual(void);
weft_covariance weft_covariance_usual_of_mean(void);

/* A diffuse term and hardly anything besides: for a number of images that decides nothing else. */
weft_covariance weft_covariance_diffuse(void);

/* The same with exponentials taken, for many pairs. */
typedef struct weft_covariance_terms {
    double diffuse, highlight, fixed;                                             /* variances */
    double smooth_light, smooth_view, highlight_half, highlight_view, fixed_half; /* 3 / length^2 */
    double incidence_power, light_power, view_power;
    bool is_of_mean;
    double reciprocity, half_turn; /* r, t */
} weft_covariance_terms;

weft_covariance_terms weft_covariance_terms_of(const weft_covariance *covariance);
double weft_covariance_between(const weft_covariance_terms *terms, const weft_direction_pair *a,
                               const weft_direction_pair *b);

#endif
