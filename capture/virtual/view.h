/* What the virtual camera sees from one place: everything about its photographs that does not depend on the light. Made
 * once for every viewpoint, used for all its lights. */
#ifndef WEFT_CAPTURE_VIRTUAL_VIEW_H
#define WEFT_CAPTURE_VIRTUAL_VIEW_H

#include "capture/virtual/sample.h"
#include "capture/virtual/world.h"

/* ---- The optics of the virtual camera: for every point of a photograph, the rays that reach it through the thin lens. ---- */

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

/* A pixel that sees cloth with `count` of its samples. */
typedef struct weft_cloth_pixel {
    int pixel, count;
    size_t first; /* index of its first point */
} weft_cloth_pixel;

typedef struct weft_virtual_view {
    int width, height, sample_count;
    weft_vec3 camera;        /* position, plate frame */
    const float *vignetting; /* [height][width], of the optics */
    float *x_mm, *y_mm;      /* [height][width] what the centre of the pixel sees */
    float *print;            /* [height][width] printed reflectance, mean over the samples */
    int *row;                /* [height + 1] first cloth pixel of every row */
    weft_cloth_pixel *cloth;
    weft_weave_point *point; /* of a flat sample; NULL otherwise */
    /* Of a sample with depth: [point][path_vertices], of which the first vertex_count[point]. */
    weft_seen_vertex *vertex;
    uint8_t *vertex_count; /* 0 where the point looks through a hole */
    int path_vertices;
} weft_virtual_view;

/* `target` is the plate, `sample` fills its opening. The view borrows the optics. The caller frees with
 * weft_virtual_view_free, also after a failure. Parallel. Errors: WEFT_SYSTEM. */
weft_code weft_virtual_view_make(const weft_virtual_optics *optics, const weft_target *target,
                                 const weft_virtual_sample *sample, const weft_pose *pose, weft_virtual_view *view,
                                 weft_error *error);
void weft_virtual_view_free(weft_virtual_view *view);

/* Radiance times vignetting, [height][width][3], under a point light at `light` (plate frame, mm) that gives irradiance
 * `power` at `reference_mm` along the normal: E = power reference^2 cos(theta) / distance^2 at every pixel. Parallel.
 */
void weft_virtual_view_light(const weft_virtual_view *view, const weft_virtual_sample *sample, weft_vec3 light,
                             double reference_mm, double power, float *radiance);

#endif
