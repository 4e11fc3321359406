/* The same scenes drawn from the dataset, the material and the analytic cloth. */
#ifndef WEFT_COMPARE_REPORT_SCENES_H
#define WEFT_COMPARE_REPORT_SCENES_H

#include "base/numeric/error_summary.h"
#include "base/picture/image.h"
#include "base/progress.h"
#include "btf/dataset/dataset.h"
#include "btf/material/material.h"
#include "player/draw/player.h"

/* What is drawn: the modes of the player, and BARD as a dataset in mode raw. */
enum { WEFT_SCENE_COUNT = 3, WEFT_SCENE_BARD = WEFT_MODE_COUNT, WEFT_SCENE_MODELS };

/* "raw", "compressed", "analytic", "BARD". Pure. */
const char *weft_scenes_model_name(int model);

/* One scene: linear pictures by model, those of absent models empty. */
typedef struct weft_scene_pictures {
    const char *caption;
    weft_image picture[WEFT_SCENE_MODELS];
    weft_error_summary error[WEFT_SCENE_MODELS]; /* against raw, over the lit pixels of the mesh */
} weft_scene_pictures;

/* Freed with weft_scenes_free. */
typedef struct weft_scenes {
    bool drawn; /* false where there is no OpenGL: `why_not` says so */
    char why_not[WEFT_MESSAGE_SIZE];
    char renderer[128]; /* name of the OpenGL driver's renderer */
    bool has[WEFT_SCENE_MODELS];
    int width, height;                  /* of the pictures, pixels */
    bool has_heights;                   /* the dataset is drawn through its heights */
    bool near_lights;                   /* the dataset is then drawn with the directions of its centre */
    int skipped_levels;                 /* finest levels of the dataset that did not fit into graphics memory */
    double frame_ms[WEFT_SCENE_MODELS]; /* of the first scene; 0 for BARD, which is drawn as raw is */
    weft_scene_pictures scene[WEFT_SCENE_COUNT];
} weft_scenes;

/* What to draw; `weave`, `threads` (one of them at most) and `bard` may be NULL. */
typedef struct weft_scenes_request {
    weft_dataset *dataset;
    const weft_material *material;
    const weft_weave *weave;
    const weft_weave_layout *layout; /* of the weave on the material */
    const weft_microcylinder_cloth *threads;
    const char *bard; /* a dataset as `weft bard` writes it */
    int side;         /* of the pictures, pixels */
} weft_scenes_request;

/* Draws without a window. Having no OpenGL is not an error. Errors: WEFT_BAD_INPUT from reading a dataset;
 * WEFT_SYSTEM. */
weft_code weft_scenes_draw(const weft_scenes_request *request, const weft_progress *progress, weft_scenes *scenes,
                           weft_error *error);
void weft_scenes_free(weft_scenes *scenes);

#endif
