/* Truth: a drape with the geometry of a stitch on it, traced, beside the same drape with the dataset that was simulated
 * from the stitch, and with the material made of that. */
#ifndef WEFT_COMPARE_TRUTH_COMPARISON_H
#define WEFT_COMPARE_TRUTH_COMPARISON_H

#include "base/picture/image.h"
#include "base/progress.h"
#include "btf/dataset/dataset.h"
#include "btf/material/material.h"
#include "compare/truth/picture_error.h"

#include <stdbool.h>

/* Which light there is: all of it, the player casting shadows of the mesh; or that of the cloth near by alone, without
 * what distant parts of the cloth do to each other. */
typedef enum weft_truth_light { WEFT_TRUTH_ALL, WEFT_TRUTH_NEAR, WEFT_TRUTH_LIGHTS } weft_truth_light;

/* What is drawn: by the player, and traced. */
typedef enum weft_truth_model {
    WEFT_TRUTH_RAW,
    WEFT_TRUTH_COMPRESSED,
    WEFT_TRUTH_TRACED,
    WEFT_TRUTH_MODELS
} weft_truth_model;

/* "raw", "compressed", "truth". Pure. */
const char *weft_truth_model_name(weft_truth_model model);

enum { WEFT_TRUTH_REPEAT = 24 }; /* tiles along the drape's side */
enum { WEFT_TRUTH_SCENE_COUNT = 3, WEFT_TRUTH_DEFAULT_PATHS = 64 };

/* Linear pictures of a drape under one light, and the errors of the first two against the third; `flat`: of the same
 * two without the heights of dataset and material. */
typedef struct weft_truth_pictures {
    weft_image picture[WEFT_TRUTH_MODELS];
    weft_truth_error error[WEFT_TRUTH_TRACED], flat[WEFT_TRUTH_TRACED];
} weft_truth_pictures;

typedef struct weft_truth_scene {
    const char *caption;
    weft_truth_pictures under[WEFT_TRUTH_LIGHTS];
    double noise; /* of the truth itself, weft_traced */
} weft_truth_scene;

/* Freed with weft_traced_truth_free. */
typedef struct weft_traced_truth {
    bool drawn;                          /* false where there is no OpenGL: `why_not` says so */
    bool has_heights[WEFT_TRUTH_TRACED]; /* raw, compressed: the pictures are through heights */
    char why_not[WEFT_MESSAGE_SIZE];
    char warning[WEFT_MESSAGE_SIZE]; /* that the dataset was made of another geometry, or "" */
    char stitch[128];
    int width, height;       /* of the pictures, pixels */
    int cells, finest_cells; /* of the grid across a tile: traced; as the stitch asks for */
    int triangles, bounces, paths;
    double cloth_mm, reach_mm; /* side of the cloth; how far "near by" reaches */
    weft_truth_scene scene[WEFT_TRUTH_SCENE_COUNT];
} weft_traced_truth;

typedef struct weft_traced_request {
    weft_dataset *dataset;
    const weft_material *material;
    const char *stitch; /* its file */
    int side;           /* of the pictures, pixels */
    int paths;          /* of a pixel */
    uint64_t seed;
} weft_traced_request;

/* Lays the cloth over the player's drape, WEFT_TRUTH_REPEAT tiles across it and at its true proportions, and draws it
 * in a few views and lights. Light bounces as often as it did in the dataset. Having no OpenGL is not an error. Errors:
 * WEFT_BAD_INPUT for a stitch or dataset that cannot be read, WEFT_SYSTEM. */
weft_code weft_traced_truth_measure(const weft_traced_request *request, const weft_progress *progress,
                                    weft_traced_truth *truth, weft_error *error);
void weft_traced_truth_free(weft_traced_truth *truth);

#endif
