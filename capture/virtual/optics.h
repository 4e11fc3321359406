/* The optics of the virtual camera: for every point of a photograph, the rays that reach it through the thin lens. */
#ifndef WEFT_CAPTURE_VIRTUAL_OPTICS_H
#define WEFT_CAPTURE_VIRTUAL_OPTICS_H

#include "capture/virtual/world.h"

/* What does not depend on the pose. Immutable once made. */
typedef struct weft_virtual_optics {
    int width, height;
    int sample_count;
    double focus_mm;      /* distance of the plane in focus */
    float *ray_x, *ray_y; /* [height + 1][width + 1] undistorted normalised coordinates of the corners of the pixels */
    float *vignetting;    /* [height][width] at the centres */
    float *pixel_x, *pixel_y; /* [sample_count] places of the samples in a pixel, 0..1 */
    float *lens_x, *lens_y;   /* [sample_count] places of the samples in the pupil, mm */
} weft_virtual_optics;

/* The caller frees with weft_virtual_optics_free, also after a failure. Errors: WEFT_SYSTEM. */
weft_code weft_virtual_optics_make(const weft_virtual_world *world, weft_virtual_optics *optics, weft_error *error);
void weft_virtual_optics_free(weft_virtual_optics *optics);

/* A camera at a place: its centre and its axes in the plate frame. */
typedef struct weft_virtual_eye {
    weft_vec3 centre, right, down, forward;
} weft_virtual_eye;

weft_virtual_eye weft_virtual_eye_of_pose(const weft_pose *pose);

/* Where sample `index` of a pixel meets the plate, mm. Sample positions differ from pixel to pixel and cover pixel and
 * pupil together. false where the ray misses the plane. Pure. */
bool weft_virtual_optics_meet(const weft_virtual_optics *optics, const weft_virtual_eye *eye, int x, int y, int index,
                              double *x_mm, double *y_mm);

/* The same for the centre of the pixel and of the pupil. */
bool weft_virtual_optics_meet_centre(const weft_virtual_optics *optics, const weft_virtual_eye *eye, int x, int y,
                                     double *x_mm, double *y_mm);

#endif
