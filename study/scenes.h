/* The same scenes drawn from the dataset, the material and the analytic cloth. */
#ifndef WEFT_STUDY_SCENES_H
#define WEFT_STUDY_SCENES_H

#include "btf/dataset.h"
#include "btf/image.h"
#include "btf/material.h"
#include "btf/progress.h"
#include "player/player.h"

enum { WEFT_SCENE_COUNT = 3 };

/* One scene: linear pictures by mode, those of absent modes empty. */
typedef struct weft_scene_pictures {
    const char *caption;
    weft_image picture[WEFT_MODE_COUNT];
} weft_scene_pictures;

/* Freed with weft_scenes_free. */
typedef struct weft_scenes {
    bool drawn; /* false where there is no OpenGL: `why_not` says so */
    char why_not[WEFT_MESSAGE_SIZE];
    char renderer[128]; /* name of the OpenGL driver's renderer */
    bool has[WEFT_MODE_COUNT];
    int width, height;                /* of the pictures, pixels */
    bool near_lights;                 /* the dataset is then drawn with the directions of its centre */
    int skipped_levels;               /* finest levels of the dataset that did not fit into graphics memory */
    double frame_ms[WEFT_MODE_COUNT]; /* of the first scene */
    weft_scene_pictures scene[WEFT_SCENE_COUNT];
} weft_scenes;

/* What to draw; `weave` may be NULL. */
typedef struct weft_scenes_request {
    weft_dataset *dataset;
    const weft_material *material;
    const char *weave;
    double tiles_u, tiles_v; /* of the weave for one material; 0 = as many as the virtual rig would lay out */
} weft_scenes_request;

/* Draws without a window. Having no OpenGL is not an error. Errors: WEFT_BAD_INPUT from reading dataset or weave;
 * WEFT_SYSTEM. */
weft_code weft_scenes_draw(const weft_scenes_request *request, const weft_progress *progress, weft_scenes *scenes,
                           weft_error *error);
void weft_scenes_free(weft_scenes *scenes);

#endif
