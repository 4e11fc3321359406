/* Integration over the upper hemisphere in the angles of a tangent; there the azimuth of a kink of M is constant.
 */
#ifndef WEFT_TESTS_REFLECTANCE_TANGENT_QUADRATURE_H
#define WEFT_TESTS_REFLECTANCE_TANGENT_QUADRATURE_H

#include "reflectance/microcylinder/microcylinder.h"

/* Called for every node with the solid angle it stands for. */
typedef void (*direction_visitor)(void *context, weft_vec3 direction, double solid_angle);

/* Visits nodes of a Gauss-Legendre rule of 8 points in each panel of theta and of |phi| < azimuth_rad round the
 * tangent; panels end at the horizon and at the kinks of M and P for `view`, and are no wider than `step_rad`. */
void tangent_quadrature(const weft_thread_tangent *tangent, weft_vec3 view, double azimuth_rad, double step_rad,
                        direction_visitor visit, void *context);

#endif
