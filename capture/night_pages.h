/* What the status pages tell of a night: a page of each camera, and where there are several, one over them. */
#ifndef WEFT_CAPTURE_NIGHT_PAGES_H
#define WEFT_CAPTURE_NIGHT_PAGES_H

#include "capture/camera_at_work.h"
#include "capture/night.h"

/* Why a night ended in which nothing failed. */
extern const char weft_night_stopped[];

/* Begins the page of a camera, in a folder of its name where there are several. Nothing where the night has no page.
 * Errors: WEFT_SYSTEM. */
weft_code weft_night_page_begin(const weft_night *night, weft_camera_at_work *camera, weft_error *error);

/* What a camera has done since `start_s` of weft_now_s. */
weft_status_counts weft_night_counts(const weft_camera_at_work *camera, double start_s);

/* Why a camera ended early: its own failure, else `failure` of the night, else that it was stopped. NULL: it has all
 * that it was to take. Pure. */
const char *weft_night_why_early(const weft_camera_at_work *camera, const char *failure);

/* Writes the page over those of several cameras, of which `count` have begun. Nothing where the night has no page, or
 * one camera. `why` tells why it ended; NULL: it goes on, or took all. Errors: WEFT_SYSTEM. */
weft_code weft_night_overview_write(const weft_night *night, const weft_camera_at_work *camera, int count,
                                    double start_s, const char *why, weft_error *error);

#endif
