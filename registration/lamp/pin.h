/* The shadow of the pin on the sheet. The lamp lies on the line from where the shadow of the pin's head is seen through
 * the head itself. */
#ifndef WEFT_REGISTRATION_LAMP_PIN_H
#define WEFT_REGISTRATION_LAMP_PIN_H

#include "registration/lamp/photograph.h"
#include "registration/lamp/read.h"

#ifdef __cplusplus
extern "C" {
#endif

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
weft_code weft_pin_patch(const weft_pin_area *area, const weft_camera *camera, const weft_homography *homography,
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
