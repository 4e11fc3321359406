/* The light on the sheet: brightness of bare paper and of ink at places of the plate. */
#ifndef WEFT_REGISTRATION_LAMP_PAPER_H
#define WEFT_REGISTRATION_LAMP_PAPER_H

#include "base/status.h"
#include "registration/lamp/photograph.h"
#include "registration/lamp/read.h"

/* Places of the plate with nothing but paper, or nothing but ink, within reach; mm. */
typedef struct weft_paper_places {
    int count;
    double (*place)[2]; /* [count] */
    bool *is_ink;       /* [count] */
    double reach_mm;    /* half the side of the square that is averaged */
} weft_paper_places;

/* What one photograph shows at one of them. */
typedef struct weft_paper_sample {
    int place;
    float light[3];       /* mean over the square, 1 at full scale */
    float radius_squared; /* from the axis of the lens, in focal lengths, undistorted */
} weft_paper_sample;

typedef struct weft_paper_samples {
    int count;
    weft_paper_sample *sample; /* [count] */
} weft_paper_samples;

/* Places on a grid. The caller frees with weft_paper_places_free. Errors: WEFT_SYSTEM for memory. */
weft_code weft_paper_places_create(const weft_target *target, weft_paper_places *places, weft_error *error);
void weft_paper_places_free(weft_paper_places *places);

/* Looks at every place that the photograph shows large enough, without a clipped value and not too dark to be read. The
 * caller frees samples->sample. Errors: WEFT_SYSTEM for memory. Thread-safe. */
weft_code weft_paper_sample_all(const weft_paper_places *places, const weft_camera *camera,
                                const weft_homography *homography, const weft_light_values *values,
                                weft_paper_samples *samples, weft_error *error);

#endif
