#include "registration/lens/calibration.h"

#include "base/numeric/statistics.h"
#include "registration/lens/fit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Rayleigh: the median length of a residual is 1.18 standard deviations of one coordinate. */
static const double deviations_of_median = 1.1774;

static const double stray_deviations = 6, least_stray_px = 0.5, off_ratio = 3, least_off_px = 0.3, strayed_share = 0.25;

/* ---- Leaving out ---- */

static double length_of(const double residual[2])
{
    return hypot(residual[0], residual[1]);
}

static weft_code median_of(const weft_lens_fit *fit, int first, int count, double *median, weft_error *error)
{
    double *length = malloc((size_t)count * sizeof *length);
    if (!length)
        return weft_fail_memory(error, "residuals", (size_t)count * sizeof *length);
    for (int i = 0; i < count; i++)
        length[i] = length_of(fit->corners.residual_px[first + i]);
    *median = weft_quantile(length, (size_t)count, 0.5);
    free(length);
    return WEFT_OK;
}

/* The photograph whose corners are farthest off, if by three times what is usual in the others. */
static weft_code leave_out_worst(weft_board_photograph *photograph, const weft_lens_fit *fit, bool *changed,
                                 weft_error *error)
{
    double *off = calloc(2 * (size_t)fit->views, sizeof *off), *sorted = off + fit->views;
    weft_code code = off ? WEFT_OK : weft_fail_memory(error, "residuals", (size_t)fit->views * sizeof *off);
    int worst = 0, first = 0;
    for (int view = 0; code == WEFT_OK && view < fit->views; first += fit->view[view++].count) {
        code = median_of(fit, first, fit->view[view].count, &off[view], error);
        sorted[view] = off[view];
        worst = off[view] > off[worst] ? view : worst;
    }
    if (code == WEFT_OK) {
        double usual = weft_quantile(sorted, (size_t)fit->views, 0.5);
        *changed = off[worst] > least_off_px && off[worst] > off_ratio * usual;
        if (*changed)
            weft_board_leave_out(&photograph[fit->photograph[worst]],
                                 "its corners are %.2f pixels from their predicted places, %.2f in other photographs",
                                 off[worst], usual);
    }
    free(off);
    return code;
}

static weft_code mark_strays(weft_board_photograph *photograph, const weft_lens_fit *fit, bool *changed,
                             weft_error *error)
{
    double median;
    WEFT_TRY(median_of(fit, 0, fit->points, &median, error));
    double limit = fmax(least_stray_px, stray_deviations * median / deviations_of_median);
    for (int view = 0, i = 0; view < fit->views; view++) {
        weft_board_photograph *p = &photograph[fit->photograph[view]];
        int strays = 0;
        for (int end = i + fit->view[view].count; i < end; i++) {
            if (length_of(fit->corners.residual_px[i]) <= limit)
                continue;
            p->stray[fit->source[i]] = *changed = true;
            strays++;
        }
        if (strays > strayed_share * fit->view[view].count || fit->view[view].count - strays < 4)
            weft_board_leave_out(p, "%d of its %d corners are more than %.1f pixels from their predicted places",
                                 strays, fit->view[view].count, limit);
    }
    return WEFT_OK;
}

static weft_code check_count(const weft_board_photograph *photograph, int count, weft_error *error)
{
    int used = weft_board_used(photograph, count);
    if (used < WEFT_LENS_FEWEST)
        return weft_fail(error, WEFT_BAD_INPUT, "of %d photographs, %d can be used: a lens needs at least %d", count,
                         used, WEFT_LENS_FEWEST);
    return WEFT_OK;
}

/* One photograph at a time, and corners when no photograph is left to leave out. Ends at the latest when too few are
 * left. */
static weft_code fit_robustly(weft_board_photograph *photograph, int count, unsigned fixed, weft_lens_fit *fit,
                              weft_error *error)
{
    for (;;) {
        bool changed = false;
        WEFT_TRY(check_count(photograph, count, error));
        WEFT_TRY(weft_lens_fit_run(photograph, count, fixed, 0, 0, fit, error));
        weft_code code = leave_out_worst(photograph, fit, &changed, error);
        if (code == WEFT_OK && !changed)
            code = mark_strays(photograph, fit, &changed, error);
        if (code == WEFT_OK && !changed)
            return WEFT_OK;
        weft_lens_fit_free(fit);
        WEFT_TRY(code);
    }
}

/* ---- The model ---- */

static weft_lens lens_of(const weft_lens_fit *fit)
{
    weft_lens lens = {.camera = fit->camera, .rms_px = fit->corners.rms_px};
    memcpy(lens.standard_error, fit->corners.standard_error, sizeof lens.standard_error);
    return lens;
}

enum { MODELS = 6, BORDER_STEPS = 16, SIMPLEST = WEFT_FIX_K2 | WEFT_FIX_TANGENTIAL | WEFT_FIX_K3 };

/* What is fixed at 0, from nothing to all but the radial term that every lens has. */
static const unsigned models[MODELS] = {
    0, WEFT_FIX_TANGENTIAL, WEFT_FIX_K3, WEFT_FIX_TANGENTIAL | WEFT_FIX_K3, WEFT_FIX_K2 | WEFT_FIX_K3, SIMPLEST};

/* Akaike's criterion for few residuals (Hurvich and Tsai 1989): they are Gaussian noise of unknown width, and poses are
 * parameters, too. */
static double criterion(const weft_lens_fit *fit, unsigned fixed)
{
    int terms = 5 + !(fixed & WEFT_FIX_K2) + 2 * !(fixed & WEFT_FIX_TANGENTIAL) + !(fixed & WEFT_FIX_K3);
    double values = 2.0 * fit->points, parameters = terms + 6 * fit->views;
    double spare = values - parameters - 1;
    if (spare <= 0)
        return INFINITY;
    return values * log(fit->corners.rms_px * fit->corners.rms_px) + 2 * parameters +
           2 * parameters * (parameters + 1) / spare;
}

/* Whether a lens can be so: a polynomial may turn back, or run away, where there were no corners. Every pixel of the
 * border of a photograph has a point of the world, at half to twice the distance from the axis. */
static bool is_plausible(const weft_camera *c)
{
    for (int i = 0; i < 4 * BORDER_STEPS; i++) {
        double along = i % BORDER_STEPS / (double)BORDER_STEPS;
        bool upright = i / BORDER_STEPS % 2, far = i / BORDER_STEPS / 2;
        weft_pixel at = {(upright ? far : along) * (c->width - 1), (upright ? along : far) * (c->height - 1)};
        weft_pixel in = weft_camera_undistort(c, at), back = weft_camera_distort(c, in);
        double away = hypot(at.x - c->cx, at.y - c->cy), undistorted = hypot(in.x - c->cx, in.y - c->cy);
        if (!(hypot(back.x - at.x, back.y - at.y) < 1e-3 && undistorted >= away / 2 && undistorted <= 2 * away))
            return false;
    }
    return true;
}

static weft_code note_fixed(unsigned fixed, weft_lens_report *report, weft_error *error)
{
    static const struct term {
        unsigned fixed;
        const char *name;
    } terms[] = {{WEFT_FIX_K2, "k2"}, {WEFT_FIX_TANGENTIAL, "p1 and p2"}, {WEFT_FIX_K3, "k3"}};
    for (size_t i = 0; i < sizeof terms / sizeof *terms; i++) {
        if (fixed & terms[i].fixed)
            WEFT_TRY(weft_lines_add(&report->fixed, error, "These photographs cannot determine %s; fixed at 0.",
                                    terms[i].name));
    }
    return WEFT_OK;
}

/* Takes a fit in the place of the best, if it is better. */
static void keep_better(unsigned fixed, weft_lens_fit *fit, unsigned *best_fixed, weft_lens_fit *best, double *least)
{
    double here = is_plausible(&fit->camera) ? criterion(fit, fixed) : INFINITY;
    if (here < *least || (fixed == SIMPLEST && *least == INFINITY)) {
        weft_lens_fit_free(best);
        *best = *fit;
        *best_fixed = fixed;
        *least = here;
    } else {
        weft_lens_fit_free(fit);
    }
}

/* `best` is the fit of the first model, and becomes that of the best. */
static weft_code choose_model(const weft_board_photograph *photograph, int count, unsigned *best_fixed,
                              weft_lens_fit *best, weft_lens_report *report, weft_error *error)
{
    double least = INFINITY;
    for (int i = 0; i < MODELS; i++) {
        weft_lens_fit fit;
        weft_code code = weft_lens_fit_run(photograph, count, models[i], 0, 0, &fit, error);
        if (code == WEFT_BAD_INPUT)
            continue; /* none fits: another may */
        WEFT_TRY(code);
        keep_better(models[i], &fit, best_fixed, best, &least);
    }
    return note_fixed(*best_fixed, report, error);
}

/* ---- The report ---- */

static weft_code report_photographs(const weft_board_photograph *photograph, int count, weft_lens_report *report,
                                    weft_error *error)
{
    report->photograph = calloc((size_t)count + 1, sizeof *report->photograph);
    if (!report->photograph)
        return weft_fail_memory(error, "photographs", (size_t)count * sizeof *report->photograph);
    for (int i = 0; i < count; i++) {
        report->photograph[i].name = photograph[i].name;
        report->count = i + 1;
        if (weft_board_is_used(&photograph[i])) {
            for (int k = 0; k < photograph[i].count; k++)
                report->stray_count += photograph[i].stray[k];
            continue;
        }
        WEFT_TRY(weft_lines_add(&report->reasons, error, "%s", photograph[i].left_out));
        report->photograph[i].left_out = report->reasons.line[report->reasons.count - 1];
    }
    return WEFT_OK;
}

static weft_code judge_fit(weft_board_photograph *photograph, int count, unsigned fixed, const weft_progress *progress,
                           weft_lens_fit *fit, weft_lens_report *report, weft_error *error)
{
    WEFT_TRY(weft_lens_jackknife(photograph, count, fixed, progress, fit, error));
    report->lens = lens_of(fit);
    return weft_lens_judge(fit, report, error);
}

static weft_code calibrate(const weft_lens_settings *settings, weft_board_photograph *photograph, int count,
                           const weft_progress *progress, weft_lens_report *report, weft_error *error)
{
    unsigned fixed = 0;
    weft_lens_fit fit = {0};
    weft_code code = fit_robustly(photograph, count, fixed, &fit, error);
    if (code == WEFT_OK && !settings->full_model)
        code = choose_model(photograph, count, &fixed, &fit, report, error);
    if (code == WEFT_OK)
        code = judge_fit(photograph, count, fixed, progress, &fit, report, error);
    weft_lens_fit_free(&fit);
    return code;
}

weft_code weft_lens_calibrate(const weft_lens_settings *settings, const weft_lines *names,
                              const weft_progress *progress, weft_lens_report *report, weft_error *error)
{
    weft_board_photograph *photograph;
    *report = (weft_lens_report){0};
    WEFT_TRY(weft_board_photographs_read(&settings->board, names, progress, &photograph, error));
    weft_code code = calibrate(settings, photograph, names->count, progress, report, error);
    weft_code reported = report_photographs(photograph, names->count, report, code == WEFT_OK ? error : NULL);
    weft_board_photographs_free(photograph, names->count);
    return code == WEFT_OK ? reported : code;
}

void weft_lens_report_free(weft_lens_report *report)
{
    weft_lines_free(&report->fixed);
    weft_lines_free(&report->warnings);
    weft_lines_free(&report->reasons);
    free(report->photograph);
    *report = (weft_lens_report){0};
}
