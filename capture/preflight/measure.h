/* What the photographs of one pose say. */
#ifndef WEFT_CAPTURE_PREFLIGHT_MEASURE_H
#define WEFT_CAPTURE_PREFLIGHT_MEASURE_H

#include "btf/session/session.h"
#include "capture/exposure.h"
#include "capture/preflight/preflight.h"
#include "registration/pose/prediction.h"

/* Photographs of a pose, [height][width][3] raw. */
typedef struct weft_preflight_photographs {
    const uint16_t *first, *second, *unlit; /* the same exposure, the last one without the lamp */
    const uint16_t *brief;
    double brief_share; /* exposure of `brief` over that of the others; 1: the camera has no shorter one */
} weft_preflight_photographs;

/* Measures the pose of `shot` and keeps in `check` what is worse than what is there. Errors: WEFT_SYSTEM;
 * WEFT_BAD_INPUT where the camera sees nothing of the sample. */
weft_code weft_preflight_measure(const weft_session *session, const weft_sight *sight, int shot, bool is_frontal,
                                 const weft_preflight_photographs *photographs, weft_preflight_check *check,
                                 weft_error *error);

/* Measures the sensor, in a photograph without light. Errors: WEFT_SYSTEM. */
weft_code weft_preflight_measure_dark(const weft_session *session, weft_angles view, const uint16_t *samples,
                                      weft_preflight_check *check, weft_error *error);

/* Keeps `value` where nothing or something better is known. Pure. */
void weft_preflight_note(weft_preflight_check *check, weft_preflight_kind kind, double value, double limit,
                         weft_angles view);

/* ---- Which poses of a plan show first what goes wrong ---- */

enum { WEFT_PREFLIGHT_POSES = 5 };

/* Numbers of shots: of the view nearest the zenith, then of up to four of the lowest ring of views, as far round from
 * each other as there are; each with the highest light that its view has. Returns how many there are. Pure. */
int weft_preflight_poses(const weft_session *session, int shot[WEFT_PREFLIGHT_POSES]);

/* ---- The contact sheet: what a pre-flight saw, on one picture ---- */

/* A black sheet for so many poses. Errors: WEFT_SYSTEM. */
weft_code weft_sheet_create(const weft_session *session, int poses, weft_image *sheet, weft_error *error);

/* Puts the photographs of a pose into its row. Pure. */
void weft_sheet_put(const weft_session *session, int row, const weft_preflight_photographs *photographs,
                    weft_image *sheet);

#endif
