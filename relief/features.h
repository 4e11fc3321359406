/* The light vector of every view and place (its values under all lights, red, green and blue), on the eight principal
 * components of all of them: what parallax moves, in a thirtieth of the bytes. Private to this folder. */
#ifndef WEFT_RELIEF_FEATURES_H
#define WEFT_RELIEF_FEATURES_H

#include "base/processor.h"
#include "base/progress.h"
#include "btf/dataset/dataset.h"

#include <stdbool.h>

/* ---- Which photographs can be compared across views: those of the lights that the views share ---- */

enum { WEFT_MOST_LIGHTS = 128 };

typedef struct weft_relief_views {
    int view_count, light_count;
    weft_vec3 *direction; /* [view_count] */
    int *image;           /* [view_count][light_count] the lights in the same order for every view */
    float *cosine;        /* [light_count] what turns a sample into reflectance times cosine */
} weft_relief_views;

/* Takes the lights of the view that has most images (128 of them at most, evenly), and the views that have an image
 * within five degrees of each. `path` names the dataset. Errors: WEFT_BAD_INPUT for near lights and views, and where
 * fewer than eight views share their lights; WEFT_SYSTEM. The caller frees with weft_relief_views_free. */
weft_code weft_relief_views_find(const weft_dataset_layout *layout, const char *path, weft_relief_views *views,
                                 weft_error *error);
void weft_relief_views_free(weft_relief_views *views);

enum { WEFT_FEATURES = 8 };

typedef struct weft_features {
    int width, height, view_count;
    double width_mm, height_mm; /* of the material */
    const weft_vec3 *direction; /* [view_count] toward the cameras; not owned */
    float *value;               /* [view_count][height][width][WEFT_FEATURES] */
    uint8_t *known;             /* [view_count][height][width] 0 where too much is masked; NULL: all are known */
    double explained;           /* share of the energy of the light vectors that the components hold */
    bool repeats;               /* the material continues at the opposite border */
} weft_features;

/* Reads the whole dataset once. A light vector of which more than a quarter is masked is unknown; smaller gaps are
 * filled with the mean of their photograph, as bright as the rest of the vector is to its own. `views` must outlive the
 * result. Errors: those of reading; WEFT_BAD_INPUT where everything is masked or black; WEFT_SYSTEM. The caller frees
 * with weft_features_free. */
weft_code weft_features_read(weft_dataset *dataset, const weft_relief_views *views, const weft_progress *progress,
                             weft_features *features, weft_error *error);
void weft_features_free(weft_features *features);

/* Means of 2 x 2 texels: one mip level on; odd sizes lose their last row or column. `repeats` and directions are kept.
 * Errors: WEFT_SYSTEM. */
weft_code weft_features_halve(const weft_features *features, weft_features *half, weft_error *error);

/* How much a material differs across its borders, where opposite ones are joined, as a multiple of how much
 * neighbouring texels differ: about 1 where it repeats. Pure. */
double weft_features_seam(const weft_features *features);

static inline const float *weft_feature_at(const weft_features *features, int view, int x, int y)
{
    size_t texel = ((size_t)view * (size_t)features->height + (size_t)y) * (size_t)features->width + (size_t)x;
    return features->value + WEFT_FEATURES * texel;
}

/* False outside the material, too. */
static inline bool weft_feature_known(const weft_features *features, int view, int x, int y)
{
    if (x < 0 || y < 0 || x >= features->width || y >= features->height)
        return false;
    size_t texel = ((size_t)view * (size_t)features->height + (size_t)y) * (size_t)features->width + (size_t)x;
    return !features->known || features->known[texel];
}

/* Products with the components: result [WEFT_FEATURES] of `length` values, component [length][WEFT_FEATURES]. Compiled
 * for every instruction set. */
typedef void weft_feature_project(const float *value, const float *component, int length, float *result);

#define WEFT_DECLARE_FEATURE_KERNEL(set) weft_feature_project weft_feature_project_##set

WEFT_FOR_EACH_SET(WEFT_DECLARE_FEATURE_KERNEL);

#endif
