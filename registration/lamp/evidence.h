/* What one photograph shows of the lamp: light on paper and ink, highlights on mirror balls, the shadow of the pin. */
#ifndef WEFT_REGISTRATION_LAMP_EVIDENCE_H
#define WEFT_REGISTRATION_LAMP_EVIDENCE_H

#include "base/status.h"
#include "registration/lamp/photograph.h"
#include "registration/lamp/read.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Places of the plate with nothing but paper, or nothing but ink, within reach; mm. */
typedef struct weft_paper_places {
    int count;
    double (*place)[2]; /* [count] */
    bool *is_ink;       /* [count] */
    double reach_mm;    /* half the side of the square that is averaged, at most */
} weft_paper_places;

/* What one photograph shows at one of them. */
typedef struct weft_paper_sample {
    int place;
    float light[3];       /* mean over the square, 1 at full scale */
    float radius_squared; /* from the axis of the lens, in focal lengths, undistorted */
} weft_paper_sample;

/* What becomes of a place in a photograph. */
typedef enum weft_paper_fate {
    WEFT_PAPER_SEEN,
    WEFT_PAPER_OUTSIDE, /* it is not in the picture */
    WEFT_PAPER_SMALL,   /* so small, or so slanted, that what is beside it shows in it */
    WEFT_PAPER_CLIPPED,
    WEFT_PAPER_DARK, /* too dark to be read */
    WEFT_PAPER_FATES
} weft_paper_fate;

typedef struct weft_paper_samples {
    int count;
    weft_paper_sample *sample;  /* [count] */
    int fate[WEFT_PAPER_FATES]; /* of how many places */
} weft_paper_samples;

/* Places on a grid. The caller frees with weft_paper_places_free. Errors: WEFT_SYSTEM for memory. */
weft_code weft_paper_places_create(const weft_target *target, weft_paper_places *places, weft_error *error);
void weft_paper_places_free(weft_paper_places *places);

/* Looks at every place that the photograph shows large enough, without a clipped value and not too dark to be read. In
 * a photograph from the side a smaller square is averaged, so that the same places show to 65 degrees and more. The
 * caller frees samples->sample. Errors: WEFT_SYSTEM for memory. Thread-safe. */
weft_code weft_paper_sample_all(const weft_paper_places *places, const weft_camera *camera, const weft_plate_view *view,
                                const weft_light_values *values, weft_paper_samples *samples, weft_error *error);

/* ---- Mirror balls ---- */

/* Where a highlight is seen. */
typedef struct weft_highlight {
    bool found;
    weft_vec3 ray;        /* unit, plate frame, from the camera toward the highlight */
    double deviation_rad; /* standard error of the direction that it mirrors: what a fraction of a pixel makes */
} weft_highlight;

/* Looks for the brightest small spot within the outline of the ball that touches the sheet at `place`, mm, where it
 * mirrors what is above the sheet. A ball that is hidden, or out of the picture, or without a bright spot has none.
 * Pure. */
weft_highlight weft_ball_highlight(const weft_camera *camera, const weft_pose *pose, const weft_light_values *values,
                                   weft_vec3 place, double diameter_mm);

/* Where the ray from `eye` along the unit vector `ray` meets a mirror ball, and the unit direction in which it goes on.
 * False where it passes. Pure. */
bool weft_ball_mirror(weft_vec3 eye, weft_vec3 ray, weft_vec3 centre, double radius_mm, weft_vec3 *from,
                      weft_vec3 *mirrored);

/* The shadow of the pin on the sheet. The lamp lies on the line from where the shadow of the pin's head is seen through
 * the head itself. */

/* The round head of a pin for cloth; the height of a pin counts to its top. */
extern const double weft_pin_head_radius_mm;

/* The part of the sheet where a shadow is looked for, in texels of `step_mm`; texel (column, row) has its centre at
 * (x0 + column step, y0 + row step). */
typedef struct weft_pin_area {
    double foot[2], height_mm, x0, y0, step_mm;
    int columns, rows;
} weft_pin_area;

/* The sheet within 70 mm of the pin. Pure. */
weft_pin_area weft_pin_area_of(const weft_target *target, double height_mm);

/* Light of the area in one photograph, [rows][columns] in new memory; NaN where it is not seen, or clipped. Errors:
 * WEFT_SYSTEM for memory. Thread-safe. */
weft_code weft_pin_patch(const weft_pin_area *area, const weft_camera *camera, const weft_plate_view *view,
                         const weft_light_values *values, float **patch, weft_error *error);

/* Where the centre of the head's shadow lies, and how well that is known: along the shadow and across it, standard
 * errors. One that leaves the sheet has no end: it is known across alone, and `along_mm` is infinite. */
typedef struct weft_pin_shadow {
    bool found;
    double place[2]; /* mm */
    double along_mm, across_mm;
} weft_pin_shadow;

/* Looks for the shadow in every patch (NULL: none). What is printed shows in all photographs, a shadow in few: each
 * texel is held against its median over the photographs. The pin's own image, seen from `eye`, hides what is behind.
 * The shadow begins as the dark line and head that stand out most from what is beside them; it is refined by least
 * squares. One that does not stand out is not found. Errors: WEFT_SYSTEM for memory. Uses OpenMP. */
weft_code weft_pin_find(const weft_pin_area *area, const weft_target *target, const weft_vec3 *eye, float *const *patch,
                        int count, weft_pin_shadow *shadow, weft_error *error);

/* Least squares of the shadow's picture: a line from the foot that grows soft, and a disc at its end. darkness
 * [rows][columns] is 1 in full shadow, 0 beside, NaN where unknown. In: place, the first guess, and along_mm: infinite
 * for a line without an end. Leaves found false
 * where it does not settle near. Errors: WEFT_SYSTEM. */
weft_code weft_pin_refine(const weft_pin_area *area, const float *darkness, weft_pin_shadow *shadow, weft_error *error);

#ifdef __cplusplus
}
#endif
#endif
