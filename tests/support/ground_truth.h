/* The ground truth that the virtual rig leaves (docs/reference/session-format.md), and how far a
 * registration is from it. */
#ifndef WEFT_TESTS_SUPPORT_GROUND_TRUTH_H
#define WEFT_TESTS_SUPPORT_GROUND_TRUTH_H

#include "btf/dataset/dataset.h"
#include "btf/session/camera.h"

typedef struct truth {
    weft_camera camera; /* without the size of its photographs */
    double opening_mm;
    int viewpoint_count, shot_count, image_count, size;
    double (*rotation)[3][3];    /* [viewpoint] */
    double (*translation_mm)[3]; /* [viewpoint] */
    double (*light_mm)[3];       /* [shot] position in the frame of the plate */
    int *image_shot;             /* [image] the shot whose reflectance is known */
    float (*reflectance)[3];     /* [image][size][size] times the cosine at each texel; row 0 is the top row */
} truth;

/* The caller frees with truth_free. Errors: WEFT_BAD_INPUT naming the file; WEFT_SYSTEM. */
weft_code truth_read(const char *path, truth *result, weft_error *error);
void truth_free(truth *t);

/* RMS over the opening, in units of a `texels`-th of its side, of where `found` (plate mm to pixels undistorted by the
 * camera as `calibrated`) puts the points that truly lie at a place. Errors of the calibration are in it. Pure. */
double truth_warp_error_texels(const truth *t, const weft_camera *calibrated, int viewpoint,
                               const weft_homography *found, int texels);

/* The relative error of every sample that is not masked and truly not dim (base/numeric/error_summary.h). */
typedef struct truth_errors {
    float dim;     /* the largest true reflectance that is dim */
    int capacity;  /* of an image: texels times channels */
    int *count;    /* [image_count] */
    double *error; /* [image_count][capacity], of which the first `count` are set */
    /* The same of the outermost texels alone, which lie beside the frame */
    int *border_count;
    double *border_error;
} truth_errors;

/* Compares the images of `t` in a dataset that was registered from the same session. The truth holds the cosine of the
 * near light at each texel, the dataset that of the far direction: the truth is converted. The caller frees with
 * truth_errors_free. Errors: WEFT_BAD_INPUT for a dataset of another size or kind; WEFT_SYSTEM. */
weft_code truth_compare_reflectance(const truth *t, weft_dataset *dataset, truth_errors *result, weft_error *error);

/* The same, where what is dim is another question than elsewhere. */
weft_code truth_compare_above(const truth *t, weft_dataset *dataset, float dim, truth_errors *result,
                              weft_error *error);
void truth_errors_free(truth_errors *errors);

#endif
