#include "registration/lens/fit.h"

#include <math.h>

enum { MOST_FOLDS = 10, FEW_PHOTOGRAPHS = 6 };

static const double least_tilt_deg = 25, least_reach = 0.65, poor_focal_error = 0.005;

/* ---- Leaving out photographs in turn ---- */

weft_code weft_lens_jackknife(const weft_board_photograph *photograph, int count, unsigned fixed,
                              const weft_progress *progress, weft_lens_fit *fit, weft_error *error)
{
    int folds = fit->views < MOST_FOLDS ? fit->views : MOST_FOLDS;
    double sum[WEFT_LENS_PARAMETERS] = {0}, square[WEFT_LENS_PARAMETERS] = {0};
    for (int fold = 0; fit->views > WEFT_LENS_FEWEST && fold < folds; fold++) {
        weft_lens_fit without;
        weft_progress_report(progress, "leaving out photographs", fold, folds);
        weft_code code = weft_lens_fit_run(photograph, count, fixed, fold, folds, &without, error);
        if (code == WEFT_BAD_INPUT)
            continue;
        WEFT_TRY(code);
        for (int i = 0; i < WEFT_LENS_PARAMETERS; i++) {
            double difference = weft_lens_parameter(&without.camera, i) - weft_lens_parameter(&fit->camera, i);
            sum[i] += difference;
            square[i] += difference * difference;
        }
        weft_lens_fit_free(&without);
    }
    weft_progress_report(progress, "leaving out photographs", folds, folds);
    for (int i = 0; i < WEFT_LENS_PARAMETERS; i++) {
        double spread = square[i] - sum[i] * sum[i] / folds;
        fit->corners.standard_error[i] =
            fmax(fit->corners.standard_error[i], sqrt(fmax(0, spread) * (folds - 1) / folds));
    }
    return WEFT_OK;
}

/* ---- Measures ---- */

/* Between the normals of the board in the frame of the camera, the third columns of its rotations. */
static double largest_tilt(const weft_lens_fit *fit)
{
    double least = 1;
    for (int a = 0; a < fit->views; a++) {
        for (int b = 0; b < a; b++) {
            const weft_pose *n = &fit->corners.pose[a], *m = &fit->corners.pose[b];
            double cosine = 0;
            for (int axis = 0; axis < 3; axis++)
                cosine += n->rotation[axis][2] * m->rotation[axis][2];
            least = fmin(least, fabs(cosine));
        }
    }
    return acos(least);
}

static double farthest_corner(const weft_lens_fit *fit)
{
    double x = (fit->camera.width - 1) / 2.0, y = (fit->camera.height - 1) / 2.0, farthest = 0;
    for (int i = 0; i < fit->points; i++)
        farthest = fmax(farthest, hypot(fit->pixel[i][0] - x, fit->pixel[i][1] - y));
    return farthest / hypot(x, y);
}

static int nearest_of(const weft_lens_fit *fit, int first, int end, int point)
{
    int nearest = -1;
    double least = INFINITY;
    for (int i = first; i < end; i++) {
        double d = hypot(fit->board_mm[i][0] - fit->board_mm[point][0], fit->board_mm[i][1] - fit->board_mm[point][1]);
        if (i != point && d < least) {
            least = d;
            nearest = i;
        }
    }
    return nearest;
}

/* Residuals of neighbours have in common what is no noise: their mean product is its square. */
static void split_residuals(const weft_lens_fit *fit, weft_lens_report *report)
{
    double shared = 0, whole = 0;
    int first = 0;
    for (int view = 0; view < fit->views; first += fit->view[view++].count) {
        int end = first + fit->view[view].count;
        for (int i = first; i < end; i++) {
            const double *here = fit->corners.residual_px[i],
                         *beside = fit->corners.residual_px[nearest_of(fit, first, end, i)];
            shared += here[0] * beside[0] + here[1] * beside[1];
            whole += here[0] * here[0] + here[1] * here[1];
        }
    }
    shared = fmin(whole, fmax(0, shared));
    report->pattern = sqrt(shared / fit->points);
    report->noise = sqrt((whole - shared) / fit->points);
}

/* ---- Words ---- */

static weft_code warn_of_photographs(weft_lens_report *r, weft_error *error)
{
    double tilt_deg = weft_deg_of_rad(r->tilt_rad);
    if (r->used < FEW_PHOTOGRAPHS)
        WEFT_TRY(weft_lines_add(&r->warnings, error, "%d photographs are few: take ten or more", r->used));
    if (tilt_deg < least_tilt_deg)
        WEFT_TRY(weft_lines_add(&r->warnings, error,
                                "the board is seen from nearly one side: its places differ by %.0f degrees at most; "
                                "tilt it by 30 to 45 degrees in every direction",
                                tilt_deg));
    if (r->reach < least_reach)
        WEFT_TRY(weft_lines_add(&r->warnings, error,
                                "the corners of the board reach only %.0f %% of the way to the corners of the "
                                "photograph; the lens is guessed beyond; fill the frame",
                                100 * r->reach));
    return WEFT_OK;
}

static weft_code warn_of_lens(weft_lens_report *r, weft_error *error)
{
    if (r->pattern > r->noise)
        WEFT_TRY(
            weft_lines_add(&r->warnings, error,
                           "corners stray in a pattern of %.2f pixels, far above their noise of %.2f: is the board "
                           "flat, and does it have the sizes of --board?",
                           r->pattern, r->noise));
    if (r->focal_error > poor_focal_error)
        WEFT_TRY(
            weft_lines_add(&r->warnings, error,
                           "the photographs determine the focal length to %.1f %% only: take more, from more sides",
                           100 * r->focal_error));
    return WEFT_OK;
}

weft_code weft_lens_judge(const weft_lens_fit *fit, weft_lens_report *report, weft_error *error)
{
    report->used = fit->views;
    report->point_count = fit->points;
    report->tilt_rad = largest_tilt(fit);
    report->reach = farthest_corner(fit);
    report->focal_error = fit->corners.standard_error[0] / fit->camera.fx;
    split_residuals(fit, report);
    WEFT_TRY(warn_of_photographs(report, error));
    return warn_of_lens(report, error);
}
