/* All that the camera can see: the sheet with its content, the table, balls, pin and hands, the lamp, and a dark room
 * with a dim window. Traced, with one bounce off each mirror and direct light elsewhere. */
#ifndef WEFT_CAPTURE_SYNTHETIC_SCENE_H
#define WEFT_CAPTURE_SYNTHETIC_SCENE_H

#include "base/vector.h"
#include "btf/session/camera.h"
#include "btf/session/target.h"
#include "capture/virtual/sample.h"

#include <stdbool.h>
#include <stdint.h>

/* ---- The lens of the camera in the hand, by the rays it lets through. Nothing here is a formula that registration uses:
 * its distortion is a division model, its light falls off by geometry, and its blur comes from a sampled pupil.
 *
 * Pixels and camera frame as in btf/session/camera.h. All functions but weft_synthetic_lens_prepare are pure. */

enum { WEFT_SYNTHETIC_FIELD_COUNT = 128 };

typedef struct weft_synthetic_lens {
    int width, height;            /* pixels */
    double sensor_width_mm;       /* of square pixels */
    double focal_length_mm;       /* as engraved, and in the EXIF */
    double image_distance_mm;     /* from the pupil to the sensor: what a pinhole's focal length would be */
    double axis_x, axis_y;        /* the pixel that the optical axis meets */
    double division[2];           /* undistorted = distorted / (1 + a q^2 + b q^4), q = 1 at half the sensor's diagonal
                                     (Fitzgibbon 2001) */
    double pupil_radius_mm;       /* the aperture, as seen from the scene */
    double focus_mm;              /* depth of the plane in focus */
    double rim_mm, rim_radius_mm; /* a ring before the pupil, which cuts off slanted rays */
    float open[WEFT_SYNTHETIC_FIELD_COUNT + 1]; /* part of the pupil that a pixel sees, by q from 0 to 1.1 */
} weft_synthetic_lens;

typedef struct weft_synthetic_ray {
    weft_vec3 from, along; /* mm; a unit vector */
} weft_synthetic_ray;

/* Fills `open` by counting rays. */
void weft_synthetic_lens_prepare(weft_synthetic_lens *lens);

/* Slopes x/z and y/z in the camera frame of the ray through a place on the sensor and the middle of the pupil. */
void weft_synthetic_lens_slopes(const weft_synthetic_lens *lens, double x, double y, double slope[2]);

/* The ray through a place on the sensor and a place in the pupil (a unit disc), in the camera frame. false where the
 * rim stops it. */
bool weft_synthetic_lens_ray(const weft_synthetic_lens *lens, double x, double y, const double pupil[2],
                             weft_synthetic_ray *ray);

/* Light that a pixel gets of a scene of uniform radiance, 1 on the axis: cos^4, times the part of the pupil that it
 * sees. weft_synthetic_lens_obliquity is the first factor. */
double weft_synthetic_lens_obliquity(const weft_synthetic_lens *lens, double x, double y);
double weft_synthetic_lens_vignetting(const weft_synthetic_lens *lens, double x, double y);

/* Where a point of the camera frame is pictured through the middle of the pupil, by bisection. false behind the camera.
 */
bool weft_synthetic_lens_project(const weft_synthetic_lens *lens, weft_vec3 point, double pixel[2]);

/* A unit square onto the unit disc, area for area (Shirley and Chiu 1997). */
void weft_synthetic_disc(double u, double v, double disc[2]);

/* ---- What stands on the sheet or over it: balls, a pin, fingers. All are capsules: what lies within a radius of a line
 * between two points. Pure functions. Lengths in mm. */

typedef struct weft_synthetic_solid {
    weft_vec3 a, b; /* equal: a ball */
    double radius_mm;
    bool is_mirror;
    weft_rgb reflectance; /* of a mirror, else diffuse */
} weft_synthetic_solid;

/* The distance along a ray to where it enters a solid, and the unit normal there; negative where it does not. */
double weft_synthetic_solid_meet(const weft_synthetic_solid *solid, weft_vec3 from, weft_vec3 along, weft_vec3 *normal);

/* The distance between the lines from p to q and from the solid's a to its b (Ericson 2005, section 5.1.9). */
double weft_synthetic_solid_distance(const weft_synthetic_solid *solid, weft_vec3 p, weft_vec3 q);

/* Whether it hides p from q. */
static inline bool weft_synthetic_solid_hides(const weft_synthetic_solid *solid, weft_vec3 p, weft_vec3 q)
{
    return weft_synthetic_solid_distance(solid, p, q) < solid->radius_mm;
}

/* ---- The lamp in the hand: a bright ball or a bright disc, so that its shadows are soft and its mirror image has a size.
 * Pure functions. Lengths in mm. */

typedef struct weft_synthetic_lamp {
    weft_vec3 at;
    weft_vec3 axis; /* unit; where a disc faces. It shines as paper does, with the cosine to its axis */
    bool is_disc;   /* else a ball, which shines alike all round */
    double radius_mm;
    double intensity_cd; /* along the axis */
    weft_rgb colour;     /* 1, 1, 1: white */
} weft_synthetic_lamp;

/* Illuminance in lux of a level plane at a point, as if nothing stood between. The lamp is small against its distance.
 */
double weft_synthetic_lamp_illuminance(const weft_synthetic_lamp *lamp, weft_vec3 point);

/* The candelas that it sends toward a point. */
double weft_synthetic_lamp_toward(const weft_synthetic_lamp *lamp, weft_vec3 point);

/* A place on the face that a point sees, `disc` in the unit disc. */
weft_vec3 weft_synthetic_lamp_place(const weft_synthetic_lamp *lamp, weft_vec3 point, const double disc[2]);

/* The distance along a ray to the lamp; negative where it does not lie on the ray. Its luminance is that of
 * weft_synthetic_lamp_luminance, cd/m^2. */
double weft_synthetic_lamp_meet(const weft_synthetic_lamp *lamp, weft_vec3 from, weft_vec3 along);
double weft_synthetic_lamp_luminance(const weft_synthetic_lamp *lamp);

/* ---- The plane z = 0 but for the opening: the printed sheet and the table round it. ---- */

enum { WEFT_SYNTHETIC_CELLS_X = 124, WEFT_SYNTHETIC_CELLS_Y = 168 };

/* Every edge of the print lies on a line between two cells of a 32nd of the opening. */
typedef struct weft_synthetic_sheet {
    weft_target target;
    bool is_there; /* else a table with a checked cloth on it */
    double cell_mm;
    double margin_mm;                                           /* of bare paper round the print */
    uint64_t seed;                                              /* of the table's texture */
    float cell[WEFT_SYNTHETIC_CELLS_Y][WEFT_SYNTHETIC_CELLS_X]; /* reflectance; negative in the opening */
} weft_synthetic_sheet;

weft_synthetic_sheet weft_synthetic_sheet_of(double opening_mm, bool is_there, uint64_t seed);

/* Diffuse reflectance at a point; negative in the opening. Pure. */
double weft_synthetic_sheet_reflectance(const weft_synthetic_sheet *sheet, double x_mm, double y_mm);

/* Whether no edge crosses the square of points within `reach_mm` in x and y. Pure. */
bool weft_synthetic_sheet_is_even(const weft_synthetic_sheet *sheet, double x_mm, double y_mm, double reach_mm);

enum { WEFT_SYNTHETIC_SOLIDS = 24 };

/* A rectangle upright on a far wall. */
typedef struct weft_synthetic_window {
    weft_vec3 middle, across; /* unit, level */
    weft_vec3 normal;         /* unit, level, into the room */
    double half_width_mm, half_height_mm;
    double luminance; /* cd/m^2; 0: no window */
} weft_synthetic_window;

typedef struct weft_synthetic_scene {
    const weft_synthetic_sheet *sheet;
    const weft_virtual_sample *content;
    weft_synthetic_lamp lamp;
    weft_synthetic_window window;
    double wall_luminance;
    double gloss; /* of paper and ink: a highlight over the diffuse reflection, 0 = none */
    weft_synthetic_solid solid[WEFT_SYNTHETIC_SOLIDS];
    int solid_count;
} weft_synthetic_scene;

/* Some of the solids of a scene: bit i is solid i. */
typedef uint32_t weft_synthetic_solids;

#define WEFT_SYNTHETIC_ALL_SOLIDS (~(weft_synthetic_solids)0)

/* Random numbers of a sample: where on the lamp it looks, and the path that it follows in a stitch. */
typedef struct weft_synthetic_chance {
    double lamp[2]; /* unit square */
    uint64_t key;
    uint32_t index;
} weft_synthetic_chance;

/* Radiance (luminance, cd/m^2, times a colour) along a ray, `along` a unit vector away from the eye. No solid but those
 * of `met` is met by the ray itself, and none but those of `shading` hides the lamp from the plane where that ray meets
 * it: who knows no better names all. Pure. */
weft_rgb weft_synthetic_scene_look(const weft_synthetic_scene *scene, weft_vec3 from, weft_vec3 along,
                                   const weft_synthetic_chance *chance, weft_synthetic_solids met,
                                   weft_synthetic_solids shading);

/* The same for a point of the plane z = 0 that nothing hides from the eye. */
weft_rgb weft_synthetic_scene_shade(const weft_synthetic_scene *scene, weft_vec3 point, weft_vec3 toward_eye,
                                    const weft_synthetic_chance *chance, weft_synthetic_solids shading);

/* Illuminance of the plane at a point, unshaded: lamp, window, and the lamp's mirror images in the balls, by colour. */
weft_rgb weft_synthetic_scene_illuminance(const weft_synthetic_scene *scene, weft_vec3 point);

/* The solids that may stand between a place within `reach` of `p` and one within `q_reach` of `q`, and some more. */
weft_synthetic_solids weft_synthetic_scene_between(const weft_synthetic_scene *scene, weft_vec3 p, double reach,
                                                   weft_vec3 q, double q_reach);

/* Adds the balls and the pin of the sheet at their places. */
void weft_synthetic_scene_put_balls(weft_synthetic_scene *scene);
void weft_synthetic_scene_put_pin(weft_synthetic_scene *scene);

/* Adds a hand: its fingers point along `along` (unit), its palm is at `middle`. */
void weft_synthetic_scene_put_hand(weft_synthetic_scene *scene, weft_vec3 middle, weft_vec3 along);

/* ---- Light on the sensor: every pixel is the mean over its area and over the pupil, by as many rays as it needs. ---- */

/* radiance [height][width][3]: cd/m^2 times colour, times the vignetting of the lens. `seed` scatters the rays. Where
 * the picture of the plane is even over what a pixel sees, one evaluation is its mean; elsewhere rays are traced. The
 * same for any number of threads. Parallel. */
void weft_synthetic_render(const weft_synthetic_lens *lens, const weft_pose *pose, const weft_synthetic_scene *scene,
                           uint64_t seed, float *radiance);

#endif
