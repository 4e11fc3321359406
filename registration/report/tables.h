/* The tables of the quality report, and the numbers in them. */
#ifndef WEFT_REGISTRATION_REPORT_TABLES_H
#define WEFT_REGISTRATION_REPORT_TABLES_H

#include "base/text/html_page.h"
#include "registration/outcome/outcome.h"

/* The viewpoints of one ring of views (as in ubo81: 0, 15 .. 75 degrees; the nearest counts). */
typedef struct weft_ring_summary {
    int viewpoints, failed;
    double median_uncertainty, worst_uncertainty; /* texels, over the viewpoints that did not fail */
    double median_correlation, worst_correlation;
    double median_shift_mm, worst_shift_mm;
    double saturated; /* fraction of the samples */
} weft_ring_summary;

/* ring in [0, WEFT_RING_COUNT), or -1 for all. Errors: WEFT_SYSTEM where memory is short. */
weft_code weft_ring_summarise(const weft_session *session, const weft_registration *registration, int ring,
                              weft_ring_summary *summary, weft_error *error);

/* How deep the plate is bent between its middle and its rim along the direction where that is most, mm. Pure. */
double weft_bend_depth_mm(const weft_bend_found *found);

/* Share of the light that the vignetting takes at its reach. Pure. */
double weft_vignetting_loss(const weft_vignetting *vignetting);

/* Sections of the page, each with its heading; nothing where there is nothing to say. Errors: WEFT_SYSTEM where memory
 * is short. */
void weft_write_faults(weft_page *page, const weft_session *session, const weft_registration *registration);
weft_code weft_write_rings(weft_page *page, const weft_session *session, const weft_registration *registration,
                           weft_error *error);
weft_code weft_write_whites(weft_page *page, const weft_session *session, const weft_registration *registration,
                            weft_error *error);
void weft_write_rig(weft_page *page, const weft_session *session, const weft_registration *registration);
void weft_write_viewpoints(weft_page *page, const weft_session *session, const weft_registration *registration);

#endif
