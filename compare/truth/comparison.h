/* Truth: a drape with the geometry of a stitch on it, traced, beside the same drape with the dataset that was simulated
 * from the stitch, and with the material made of that. */
#ifndef WEFT_COMPARE_TRUTH_COMPARISON_H
#define WEFT_COMPARE_TRUTH_COMPARISON_H

#include "base/numeric/error_summary.h"
#include "base/picture/image.h"
#include "base/progress.h"
#include "btf/dataset/dataset.h"
#include "btf/material/material.h"
#include "geometry/drape/draped_cloth.h"
#include "player/draw/player.h"
#include "player/mesh/mesh.h"
#include "player/scene/scene.h"

#include <stdbool.h>

/* ---- Picture error ---- */

/* How far a picture is from a traced one. */

/* Pixels along a side of the blocks whose means say how right the tone is, wherever the yarns lie. */
enum { WEFT_TRUTH_BLOCK = 8 };

typedef struct weft_truth_error {
    weft_error_summary error;   /* over the lit pixels of the mesh */
    double block_relative_rmse; /* of means over blocks all of whose pixels are lit; 0 where there is none */
} weft_truth_error;

/* `surface` [height][width] as weft_player_read_surface gives it; both pictures linear. Errors: WEFT_SYSTEM for
 * memory. */
weft_code weft_truth_error_of(const weft_image *truth, const weft_image *picture, const weft_surface_sample *surface,
                              weft_truth_error *result, weft_error *error);

/* ---- Trace ---- */

/* Pictures of draped cloth from geometry, traced through the player's camera. */

/* A mesh as a surface for cloth of which `repeat` tiles, each tile_width mm wide, lie along one unit of its texture
 * coordinate u; its unit of length, which is that of its coordinates, becomes repeat x tile_width mm. */
typedef struct weft_truth_base {
    weft_base_surface surface;
    weft_base_vertex *vertex; /* [surface.vertex_count] */
    double mm_per_unit;
} weft_truth_base;

/* The triangles stay those of `mesh`. The caller frees with weft_truth_base_free. Errors: WEFT_SYSTEM. */
weft_code weft_truth_base_create(const weft_mesh *mesh, double repeat, double tile_width_mm, weft_truth_base *base,
                                 weft_error *error);
void weft_truth_base_free(weft_truth_base *base);

typedef struct weft_trace_options {
    int width, height, paths; /* of a pixel, rounded up to whole batches */
    int bounces;
    double reach_mm; /* of the picture `near` */
    uint64_t seed;
} weft_trace_options;

/* Linear pictures, see weft_draped_radiance. */
typedef struct weft_traced {
    weft_image all, near;
    double noise; /* standard error of the pixels that show cloth, RMS, relative to their RMS; of `all` */
} weft_traced;

/* What the camera and the first light of `scene` make of the cloth, the mean over square pixels as the player's is;
 * open places show `background`, of the size asked for. `mesh` is what the cloth was laid over. The same for any number
 * of threads. The caller frees with weft_traced_free. Errors: WEFT_SYSTEM for memory. */
weft_code weft_trace(const weft_draped_cloth *cloth, const weft_mesh *mesh, double mm_per_unit, const weft_scene *scene,
                     const weft_trace_options *options, const weft_image *background, const weft_progress *progress,
                     weft_traced *traced, weft_error *error);
void weft_traced_free(weft_traced *traced);

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
