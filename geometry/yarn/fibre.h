/* How the surface of a yarn reflects: a diffuse term, and the highlight of the fibres that lie in it.
 *
 *     f(l, v) = diffuse / pi + specular f_rs / (4 max(cos theta_l, cos theta_v)^2)
 *
 * f_rs is the surface reflection of a microcylinder thread (weft_thread_surface; Sadeghi et al. 2013), theta the
 * inclinations to the plane across the fibre. The factor 1/4 and the larger of the two cosines in place of
 * cos((theta_l - theta_v) / 2) keep what the highlight reflects below 0.943 of what arrives, for a fibre in the
 * surface, so that diffuse + specular <= 1 cannot make light; f stays symmetric in light and view. */
#ifndef WEFT_GEOMETRY_YARN_FIBRE_H
#define WEFT_GEOMETRY_YARN_FIBRE_H

#include "geometry/stitch/stitch.h"

/* A fibre seen from one side. */
typedef struct weft_fibre_view {
    const weft_fibre *fibre;      /* not owned */
    weft_vec3 along, across, out; /* frame: the fibre, and the surface's normal made perpendicular to it */
    weft_vec3 view;               /* in that frame */
} weft_fibre_view;

/* `tangent` and `normal` unit, not parallel. Pure. */
weft_fibre_view weft_fibre_seen_from(const weft_fibre *fibre, weft_vec3 tangent, weft_vec3 normal, weft_vec3 view);

/* f in 1/sr for directions on the outer side of the surface. Pure. */
weft_rgb weft_fibre_brdf(const weft_fibre_view *seen, weft_vec3 light);

#endif
