#include "registration/steps.h"

#include "base/numeric/cholesky.h"
#include "registration/pose/markers.h"
#include "registration/viewpoint_photographs.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { most_viewpoints = 16, most_photographs = 8, most_rounds = 6 };

static const size_t average_bytes = (size_t)256 << 20;

/* Before anything is seen, the rim of the plate is flat to so many mm. */
static const double prior_mm = 1;

/* A round that moves the rim by less is the last. */
static const double settled_mm = 0.01;

/* One of the viewpoints it is found from. */
typedef struct sample {
    int viewpoint;       /* index into the survey */
    weft_viewpoint some; /* of its photographs */
    int shot[most_photographs];
    float *average; /* NULL: none can be used */
    bool located;
    weft_refinement refinement;
} sample;

typedef struct calibration {
    const weft_session *session;
    const weft_sensor_defects *faults;
    weft_registration *registration;
    weft_sight *sight;
    int count;
    sample sample[most_viewpoints];
} calibration;

/* Viewpoints evenly spread over the survey, and of each some photographs evenly spread over its lights. */
static void choose_samples(calibration *c)
{
    const weft_survey *survey = &c->registration->survey;
    size_t bytes = weft_photograph_sample_count(c->session) / 3 * sizeof(float);
    int room = (int)fmin(most_viewpoints, fmax(1, (double)(average_bytes / bytes)));
    c->count = survey->viewpoint_count < room ? survey->viewpoint_count : room;
    for (int i = 0; i < c->count; i++) {
        sample *w = &c->sample[i];
        w->viewpoint = (int)((long)i * survey->viewpoint_count / c->count);
        const weft_viewpoint *all = &survey->viewpoint[w->viewpoint];
        int count = all->count < most_photographs ? all->count : most_photographs;
        for (int k = 0; k < count; k++)
            w->shot[k] = all->shot[(long)k * all->count / count];
        w->some = (weft_viewpoint){all->view, all->viewpoint, count, w->shot};
    }
}

static weft_code read_average(calibration *c, sample *w, weft_error *error)
{
    weft_viewpoint_photographs photographs;
    WEFT_TRY(
        weft_viewpoint_photographs_read(c->faults, c->sight, &w->some, c->registration->fault, &photographs, error));
    if (photographs.usable_count > 0) {
        w->average = photographs.average;
        photographs.average = NULL;
    }
    weft_viewpoint_photographs_free(&photographs);
    return WEFT_OK;
}

/* A first pose: the markers are enough. Without them, that of the chain. */
static weft_code locate(calibration *c, sample *w, weft_error *error)
{
    const weft_pose_limits *limits = &c->registration->settings.limits;
    weft_angles view = c->registration->survey.view[w->some.view];
    weft_pose predicted_pose = weft_session_pose(c->session, view);
    weft_homography predicted = weft_homography_of_pose(&c->session->camera, &predicted_pose);
    weft_marker_start markers;
    weft_view_pose pose;
    WEFT_TRY(weft_markers_locate(c->sight, &c->session->target, w->average, &predicted, &markers, error));
    w->located = weft_markers_trusted(&markers, &predicted, c->sight->opening_mm, limits);
    w->refinement.homography = markers.homography;
    if (w->located)
        return WEFT_OK;
    WEFT_TRY(weft_pose_find(c->sight, &c->session->target, w->average, &predicted, (weft_point_spread){0, 0}, limits,
                            &pose, error));
    w->refinement.homography = pose.homography;
    w->located = pose.source == WEFT_POSE_DRAWING;
    return WEFT_OK;
}

static weft_code locate_all(calibration *c, weft_error *error)
{
    for (int i = 0; i < c->count; i++) {
        sample *w = &c->sample[i];
        WEFT_TRY(read_average(c, w, error));
        if (w->average)
            WEFT_TRY(locate(c, w, error));
    }
    return WEFT_OK;
}

/* Sums what the viewpoints determine of the bend, each refined under the present one. */
static weft_code weigh_all(calibration *c, weft_bend_evidence *sum, int *used, weft_error *error)
{
    *sum = (weft_bend_evidence){0};
    *used = 0;
    for (int i = 0; i < c->count; i++) {
        sample *w = &c->sample[i];
        weft_bend_evidence own;
        if (!w->located)
            continue;
        WEFT_TRY(weft_refinement_run(c->sight, w->average, 0, &w->refinement, error));
        if (!(w->refinement.correlation >= c->registration->settings.limits.least_correlation))
            continue;
        WEFT_TRY(weft_refinement_weigh_bend(c->sight, w->average, &w->refinement, &own, error));
        for (int k = 0; k < 3; k++) {
            sum->gradient[k] += own.gradient[k];
            for (int j = 0; j < 3; j++)
                sum->information[k][j] += own.information[k][j];
        }
        (*used)++;
    }
    return WEFT_OK;
}

/* Moves the bend to where evidence and prior meet. Returns by how much, mm at the unit; negative where it cannot. */
static double move_bend(calibration *c, const weft_bend_evidence *evidence)
{
    double unit = weft_bend_unit_mm(c->sight), square = unit * unit, matrix[3][3], change[3], largest = 0;
    weft_bend *bend = &c->sight->bend;
    weft_bend_found *found = &c->registration->found.bend;
    const double now[3] = {bend->xx * square, bend->xy * square, bend->yy * square};
    memcpy(matrix, evidence->information, sizeof matrix);
    for (int k = 0; k < 3; k++) {
        matrix[k][k] += 1 / (prior_mm * prior_mm);
        change[k] = evidence->gradient[k] - now[k] / (prior_mm * prior_mm);
    }
    if (!weft_cholesky_factor(3, 3, matrix[0]))
        return -1;
    weft_cholesky_solve(3, 3, matrix[0], change);
    bend->xx += change[0] / square;
    bend->xy += change[1] / square;
    bend->yy += change[2] / square;
    found->standard_error_mm = 0;
    for (int k = 0; k < 3; k++) {
        double axis[3] = {k == 0, k == 1, k == 2};
        weft_cholesky_solve(3, 3, matrix[0], axis);
        found->standard_error_mm = fmax(found->standard_error_mm, sqrt(axis[k]));
        largest = fmax(largest, fabs(change[k]));
    }
    return largest;
}

static weft_code find_bend(calibration *c, weft_error *error)
{
    weft_bend_found *found = &c->registration->found.bend;
    double change = INFINITY;
    for (int round = 0; round < most_rounds && change > settled_mm; round++) {
        weft_bend_evidence evidence;
        WEFT_TRY(weigh_all(c, &evidence, &found->viewpoints, error));
        if (found->viewpoints == 0)
            return WEFT_OK;
        change = move_bend(c, &evidence);
    }
    found->bend = c->sight->bend;
    found->unit_mm = weft_bend_unit_mm(c->sight);
    return WEFT_OK;
}

static weft_code add_vignetting(const calibration *c, const sample *w, const weft_reference_pixels *reference,
                                weft_vignetting_sums *sums, weft_error *error)
{
    weft_viewpoint_photographs photographs;
    uint16_t *scratch = malloc(weft_photograph_sample_count(c->session) * sizeof *scratch);
    if (!scratch)
        return weft_fail_memory(error, "a photograph", weft_photograph_sample_count(c->session) * sizeof *scratch);
    weft_code code =
        weft_viewpoint_photographs_read(c->faults, c->sight, &w->some, c->registration->fault, &photographs, error);
    for (int i = 0; code == WEFT_OK && i < w->some.count; i++) {
        weft_exposure exposure = weft_exposure_of(c->session, w->shot[i]);
        if (photographs.usable[i] && weft_viewpoint_photographs_samples(&photographs, i, scratch))
            weft_vignetting_add(c->sight, &c->session->target, reference, scratch, &exposure, sums);
    }
    if (code == WEFT_OK)
        weft_viewpoint_photographs_free(&photographs);
    free(scratch);
    return code;
}

static weft_code find_vignetting(calibration *c, weft_error *error)
{
    weft_vignetting_sums sums = {0};
    for (int i = 0; i < c->count; i++) {
        const sample *w = &c->sample[i];
        weft_reference_pixels reference;
        if (!w->located)
            continue;
        WEFT_TRY(weft_reference_pixels_find(c->sight, &c->session->target, &w->refinement.homography,
                                            w->refinement.point_spread, &reference, error));
        weft_code code = add_vignetting(c, w, &reference, &sums, error);
        weft_reference_pixels_free(&reference);
        WEFT_TRY(code);
    }
    c->registration->found.vignetting = weft_vignetting_solve(&sums);
    weft_vignetting_apply(&c->registration->found.vignetting, c->sight);
    return WEFT_OK;
}

weft_code weft_calibrate(const weft_sensor_defects *faults, weft_registration *registration, weft_sight *sight,
                         weft_error *error)
{
    calibration *c = calloc(1, sizeof *c);
    if (!c)
        return weft_fail_memory(error, "a calibration", sizeof *c);
    *c = (calibration){.session = &faults->seen, .faults = faults, .registration = registration, .sight = sight};
    choose_samples(c);
    weft_code code = locate_all(c, error);
    if (code == WEFT_OK)
        code = find_bend(c, error);
    if (code == WEFT_OK)
        code = find_vignetting(c, error);
    for (int i = 0; i < c->count; i++)
        free(c->sample[i].average);
    free(c);
    return code;
}
