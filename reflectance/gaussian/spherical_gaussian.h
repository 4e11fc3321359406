/* Spherical and circular Gaussians, the basis of lights and lobes for microcylinder cloth under environment light
 * (Iwasaki, Mizutani, Dobashi and Nishita 2014, section 4). Pure functions, angles in radians. Widths are positive;
 * one below 1e-9 counts as 1e-9, an infinite one gives the constant 1. */
#ifndef WEFT_REFLECTANCE_GAUSSIAN_SPHERICAL_GAUSSIAN_H
#define WEFT_REFLECTANCE_GAUSSIAN_SPHERICAL_GAUSSIAN_H

#include "base/vector.h"

/* G = exp(2/width^2 (direction.centre - 1)) = exp(-|direction - centre|^2 / width^2), for unit vectors. */
weft_real weft_spherical_gaussian(weft_vec3 direction, weft_vec3 centre, weft_real width);

/* gc = exp(2/width^2 (cos(x - mean) - 1)) = exp(-4/width^2 sin^2((x - mean)/2)). */
weft_real weft_circular_gaussian(weft_real x, weft_real mean, weft_real width);

typedef struct weft_circular_lobe {
    weft_real mean; /* -pi..pi */
    weft_real width;
    weft_real scale;
} weft_circular_lobe;

/* The product of two circular Gaussians, which is one again times `scale`. Two that cancel (equal widths, opposite
 * means) give width = infinity and mean = 0. */
weft_circular_lobe weft_circular_product(weft_real mean1, weft_real width1, weft_real mean2, weft_real width2);

/* A spherical Gaussian about the x axis: G = gc(theta; theta_centre, width) gc(phi; phi_centre, phi_width), exactly,
 * with theta = asin x and phi = atan2(z, y). */
typedef struct weft_gaussian_split {
    weft_real theta, theta_centre;
    weft_real phi, phi_centre;
    weft_real phi_width; /* width / sqrt(cos theta cos theta_centre); infinite at the poles */
} weft_gaussian_split;
weft_gaussian_split weft_spherical_gaussian_split(weft_vec3 direction, weft_vec3 centre, weft_real width);

/* Integral over -pi/2 <= theta, phi <= pi/2 of exp(-(theta - theta_mean)^2 / theta_width^2) times the same in phi; its
 * relative accuracy holds for means far outside the box, too. */
weft_real weft_gaussian_box(weft_real theta_mean, weft_real theta_width, weft_real phi_mean, weft_real phi_width);

/* The share of gc(theta; 0, theta_width) gc(phi; 0, phi_width) in that box that lies in the half-plane
 * cos(gamma) theta + sin(gamma) phi + distance > 0; by quadrature, to about 1e-9 (double). Widths below 1e-6 count as
 * that. */
weft_real weft_gaussian_half_plane(weft_real theta_width, weft_real phi_width, weft_real distance, weft_real gamma);

/* 1 / (1 + exp(-gain distance)) without overflow: what stands for the half-plane share. */
weft_real weft_sigmoid(weft_real gain, weft_real distance);

typedef struct weft_sigmoid_fit {
    weft_real gain;
    weft_real largest_error; /* at the distances of the fit */
} weft_sigmoid_fit;

/* The sigmoid nearest to the half-plane share by least squares over 65 equally spaced distances in +-pi/2. */
weft_sigmoid_fit weft_gaussian_half_plane_fit(weft_real theta_width, weft_real phi_width, weft_real gamma);

#endif
