/* Registration of photographs from a camera in the hand: a folder of photographs of the printed target becomes a
 * dataset. Nothing is known beforehand but the target: lens, poses, lamps, tone curve and exposure are found in the
 * pictures. */
#ifndef WEFT_REGISTRATION_PHOTOGRAPHS_PHOTOGRAPHS_H
#define WEFT_REGISTRATION_PHOTOGRAPHS_PHOTOGRAPHS_H

#include "base/progress.h"
#include "btf/session/colour.h"
#include "registration/lamp/lamp.h"
#include "registration/photographs/lens.h"

typedef struct weft_photographs_settings {
    weft_target target;
    int width, height;             /* texels */
    double ball_diameter_mm;       /* 0: no balls stand on the sheet */
    double pin_height_mm;          /* to the top of its head; 0: no pin stands on the sheet */
    bool flash;                    /* the lamp is fixed to the camera */
    bool force;                    /* write a dataset although the photographs contradict each other */
    bool linear;                   /* integer files hold linear values; else a tone curve is found */
    double clipped_at;             /* encoded value of an integer file, 0..1, from which a sample counts as clipped */
    const weft_camera *lens;       /* NULL: found in the photographs */
    const weft_colour *colour;     /* of the camera under the lamp; NULL: not known */
    const weft_light_list *lights; /* what is known of lamps and views beforehand; NULL: nothing */
} weft_photographs_settings;

/* What came of it. Freed with weft_photographs_free. */
typedef struct weft_photograph_set {
    int count;
    weft_photographs_photograph *photograph; /* [count], by name */
    int used_count;
    weft_lens_estimate lens; /* with the vignetting found */
    weft_tone_curve tone;
    bool tone_found;          /* else the files are linear */
    weft_lamp_solution lamps; /* without places: those are in the photographs */
    int pair_count;
    weft_exposure_pair *pair; /* [pair_count] of photographs that differ in exposure alone */
    weft_lines notes;         /* what the user should know, a line each */
    double seconds;
} weft_photograph_set;

/* An opening of 50 mm, 256 x 256 texels, balls of 20 mm, a pin of 30 mm, a lamp that moves freely, clipped from
 * 250/255. */
weft_photographs_settings weft_photographs_defaults(void);

/* Registers the image files in `folder` into the dataset `output` (near lights and cameras, reflectance times cosine).
 * A photograph that cannot be used is left out, with the reason in its remark. The caller frees `set` with
 * weft_photographs_free on success. Errors: WEFT_BAD_INPUT where nothing can be made of the folder, saying what was
 * found and what is missing; WEFT_SYSTEM. Uses OpenMP; memory: two photographs a thread. */
weft_code weft_photographs_register(const char *folder, const char *output, const weft_photographs_settings *settings,
                                    const weft_progress *progress, weft_photograph_set *set, weft_error *error);
void weft_photographs_free(weft_photograph_set *set);

#endif
