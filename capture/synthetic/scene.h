/* All that the camera can see: the sheet with its content, the table, balls, pin and hands, the lamp, and a dark room
 * with a dim window. Traced, with one bounce off each mirror and direct light elsewhere. */
#ifndef WEFT_CAPTURE_SYNTHETIC_SCENE_H
#define WEFT_CAPTURE_SYNTHETIC_SCENE_H

#include "capture/synthetic/content.h"
#include "capture/synthetic/lamp.h"
#include "capture/synthetic/sheet.h"
#include "capture/synthetic/solid.h"

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
    const weft_synthetic_content *content;
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

#endif
