/* Dataset, material, analytic cloth and BARD side by side: one HTML page (docs/guide/compare.md). */
#ifndef WEFT_COMPARE_REPORT_COMPARE_H
#define WEFT_COMPARE_REPORT_COMPARE_H

#include "base/numeric/error_summary.h"
#include "base/picture/image.h"
#include "base/progress.h"
#include "btf/dataset/dataset.h"
#include "btf/material/held_out.h"
#include "btf/material/material.h"
#include "compare/truth/comparison.h"
#include "compress/weave_fit/fit_weave.h"
#include "evaluate/error/measurement.h"
#include "evaluate/model.h"
#include "player/draw/player.h"
#include "reflectance/microcylinder/file.h"

/* ---- Slices ---- */

/* BRDF slices as Irawan and Marschner (2012, figures 16 to 21) print them: for seven exitant directions the hemisphere
 * of incident directions in projection onto the cloth, warp upward; one row for the data, one for each model. */

/* ---- Contender ---- */

/* The data and the models that are compared with it, as mean BRDFs. */

enum { WEFT_CONTENDER_COUNT = 4 }; /* data, compressed, analytic, BARD */

typedef struct weft_contender {
    const char *name;
    weft_model *model;
    weft_real level; /* whose mean is taken: of a material the finest level of at most 1024 texels */
} weft_contender;

/* The first is the data. Freed with weft_contenders_close. */
typedef struct weft_contenders {
    int count;
    weft_contender contender[WEFT_CONTENDER_COUNT];
} weft_contenders;

/* `weave` and `bard` (a dataset as `weft bard` writes it) may be NULL. Errors: those of weft_model_open. */
weft_code weft_contenders_open(const char *dataset, const char *material_path, const weft_material *material,
                               const char *weave, const char *bard, weft_contenders *contenders, weft_error *error);
void weft_contenders_close(weft_contenders *contenders);

/* Mean BRDF over the material for one pair of directions, as `weft eval` gives it without texture coordinates. */
weft_code weft_contender_brdf(const weft_contender *contender, weft_vec3 light, weft_vec3 view, weft_rgb *brdf,
                              weft_error *error);

/* The error of each contender's mean BRDF against that of the data, error [count], over the directions of all images
 * (an even choice of at most about 7000); entry 0 is zero. Errors: those of weft_model_brdf; WEFT_SYSTEM for memory. */
weft_code weft_contenders_measure(const weft_contenders *contenders, const weft_dataset_layout *layout,
                                  const weft_progress *progress, weft_error_summary *result, weft_error *error);

enum {
    WEFT_SLICE_VIEWS = 7,
    WEFT_SLICE_RINGS = 15,
    WEFT_SLICE_AZIMUTHS = 36,
    WEFT_SLICE_LIGHTS = 1 + WEFT_SLICE_RINGS * WEFT_SLICE_AZIMUTHS
};

/* Freed with weft_slices_free. */
typedef struct weft_slices {
    int view_count;                   /* 0: the dataset has too few images */
    weft_vec3 view[WEFT_SLICE_VIEWS]; /* exitant directions */
    double largest_theta_rad;         /* of the outermost ring */
    /* Incident directions: the normal, then ring by ring outward, in each from azimuth 0 in equal steps. */
    weft_vec3 light[WEFT_SLICE_LIGHTS];
    int row_count;
    const char *name[WEFT_CONTENDER_COUNT];
    weft_rgb *brdf; /* [row_count][view_count][WEFT_SLICE_LIGHTS] mean over the material, 1/sr; NaN without data */
} weft_slices;

/* Evaluates every contender. The exitant directions are the views of the dataset nearest to the normal, 30 degrees
 * (azimuths 0 and 90) and 60 degrees (azimuths 0, 45, 90, 135), each once; the rings reach as far as the lights of the
 * dataset, at most 85 degrees. Errors: those of weft_model_brdf; WEFT_SYSTEM for memory. */
weft_code weft_slices_make(const weft_dataset_layout *layout, const weft_contenders *contenders,
                           const weft_progress *progress, weft_slices *slices, weft_error *error);
void weft_slices_free(weft_slices *slices);

/* A row's values for one view, [WEFT_SLICE_LIGHTS]. */
const weft_rgb *weft_slices_values(const weft_slices *slices, int row, int view);

/* The value at (x, y) of the projected hemisphere, |(x, y)| <= 1, bilinear in the angles; NaN outside the rings. Pure.
 */
weft_rgb weft_slices_at(const weft_slices *slices, int row, int view, double x, double y);

/* A row as a linear picture, its views side by side, `size` pixels each, times pi; `mask` [size][size view_count] (may
 * be NULL) is 1 where there is no value. The caller frees the image. Errors: WEFT_SYSTEM. */
weft_code weft_slices_picture(const weft_slices *slices, int row, int size, weft_image *image, uint8_t *mask,
                              weft_error *error);

/* The numbers: lx, ly, lz, vx, vy, vz and NAME_r, NAME_g, NAME_b of each row, a table that `weft eval` takes. Errors:
 * WEFT_SYSTEM. */
weft_code weft_slices_write(const weft_slices *slices, const char *path, weft_error *error);

/* ---- Scenes ---- */

/* The same scenes drawn from the dataset, the material and the analytic cloth. */

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

typedef struct weft_compare_options {
    const char *dataset;     /* NAME.btf.h5 */
    const char *material;    /* NAME.weft, fitted to it */
    const char *weave;       /* CLOTH.wv or CLOTH.mc, or NULL */
    bool fit;                /* the weave to the dataset first, with CLOTH.wv as the start */
    const char *bard;        /* NAME.bard.h5 as `weft bard` writes it, or NULL */
    const char *truth;       /* FILE.stitch from which the dataset was simulated, or NULL */
    int truth_paths;         /* of a pixel */
    int picture_side;        /* of the scenes, pixels; 0 = WEFT_COMPARE_PICTURE_SIDE */
    double tiles_u, tiles_v; /* of the weave for one material; 0 = as many as the virtual rig would lay out */
    const char *folder;      /* for the page and its pictures */
} weft_compare_options;

enum { WEFT_COMPARE_PICTURE_SIDE = 400 };

/* Of a dataset of fewer images than these, interpolated, pictures of a scene are nothing to measure by. */
enum { WEFT_COMPARE_FEW_IMAGES = 30 };

/* A model against the data. */
typedef struct weft_compared_model {
    const char *name;         /* "compressed", "analytic", "BARD" */
    weft_measurement texture; /* sample by sample */
    weft_error_summary mean;  /* of the mean BRDF over the directions of the images */
} weft_compared_model;

/* What was measured. Freed with weft_comparison_free. */
typedef struct weft_comparison {
    int model_count;
    weft_compared_model model[WEFT_CONTENDER_COUNT - 1]; /* the first is the material */
    char weave_name[128];                                /* of the analytic cloth, empty without one */
    char weave_origin[WEFT_MESSAGE_SIZE];                /* what it was fitted to, if anything */
    bool weave_is_threads;                               /* microcylinder cloth, which has neither fit nor layout */
    weft_fit_weave_report fit;                           /* where it was fitted here: image_count > 0 */
    weft_weave_layout weave_layout;                      /* of it on the material */
    bool weave_on_yarns;                                 /* laid by the tiles that a fit found */
    weft_slices slices;
    bool has_few_images; /* of WEFT_COMPARE_FEW_IMAGES */
    bool has_held_out;
    weft_hold_out held_out; /* what the material says of its error where it was not fitted, if it does */
    double dataset_bytes, half_float_bytes, material_bytes;
    weft_scenes scenes;
    weft_traced_truth truth;         /* nothing drawn without a stitch */
    char warning[WEFT_MESSAGE_SIZE]; /* that the material was made from another dataset, or "" */
} weft_comparison;

/* Measures, renders, and writes folder/index.html with its pictures; the page appears when it is complete. Without
 * OpenGL the page says that the pictures of the scenes are missing, and why. Errors: WEFT_BAD_INPUT for files that
 * cannot be read or do not belong together; WEFT_SYSTEM from writing. */
weft_code weft_compare(const weft_compare_options *options, const weft_progress *progress, weft_comparison *comparison,
                       weft_error *error);
void weft_comparison_free(weft_comparison *comparison);

/* ---- Analytic ---- */

/* The analytic cloth of weft_compare. Private to the room. */

/* Empty without a weave. Freed with weft_compare_weave_close, also after failure. */
typedef struct weft_compared_weave {
    char *path; /* of the file that is compared: the given or the fitted one */
    bool is_threads;
    weft_weave weave;                       /* a weave */
    weft_microcylinder_description threads; /* or microcylinder cloth */
} weft_compared_weave;

/* Reads options->weave, a weave fitted to the dataset first where options->fit; then folder/fitted.wv is written. Fills
 * what the comparison tells of it: weave_name to weave_on_yarns. Errors: those of reading, fitting and writing;
 * WEFT_BAD_USAGE for microcylinder cloth to be fitted. */
weft_code weft_compare_weave_open(const weft_compare_options *options, weft_dataset *dataset,
                                  const weft_progress *progress, weft_compared_weave *weave,
                                  weft_comparison *comparison, weft_error *error);
void weft_compare_weave_close(weft_compared_weave *weave);

#endif
