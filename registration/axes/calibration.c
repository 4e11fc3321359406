#include "registration/axes/calibration.h"

#include "base/numeric/statistics.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double place_deg = 0.5;

/* Beside the home: what determines the line of a joint. */
enum { FEWEST_PLACES = 3 };

static const double far_ratio = 3, far_px = 0.3;

typedef struct work {
    weft_axes_shot *shot;
    int count;
    const weft_rig_poses *nominal;
    bool free_lens;
    weft_axes_report *report;
} work;

/* ---- Messages ---- */

static const char *const term_text[WEFT_TERM_KINDS] = {"home", "lens", "line", "scale", "unevenness", "wobble"};

/* A joint that stands in too few places. */
static weft_code report_places(weft_lines *lines, int joint, int places, weft_error *error)
{
    if (places == 1)
        return weft_lines_add(lines, error, "%s does not turn in these shots: its line is as specified",
                              weft_joint_text[joint]);
    return weft_lines_add(lines, error, "%s stands in %d places only, 3 are needed: its line is as specified",
                          weft_joint_text[joint], places);
}

/* Root mean squares over the numbers of a term, in its units: of its values, and of their standard errors. */
static void weigh(const weft_axes_fit *with, int index, double *value, double *error)
{
    int first = weft_unknown_first(&with->terms, index), count = weft_term_numbers(weft_term_of(index).kind);
    *value = *error = 0;
    for (int k = first; k < first + count; k++) {
        *value += with->unknown[k] * with->unknown[k] / count;
        *error += with->covariance[k * with->unknowns + k] / count;
    }
    *value = sqrt(*value);
    *error = sqrt(*error);
}

/* A term that is fixed; `with` is a fit in which it is free. */
static weft_code report_fixed(weft_lines *lines, const weft_axes_fit *with, const weft_camera *camera, int index,
                              weft_error *error)
{
    /* An unknown that is still half as uncertain as before was not determined. */
    const double undetermined = 0.5;
    double value, deviation;
    weft_term term = weft_term_of(index);
    weigh(with, index, &value, &deviation);
    if (term.kind == WEFT_TERM_LENS)
        return weft_lines_add(lines, error, "The lens stays as it is: fitting it does not explain these shots better.");
    const char *joint = weft_joint_text[term.joint], *text = term_text[term.kind];
    if (deviation > undetermined)
        return weft_lines_add(lines, error, "These shots cannot determine the %s of %s; fixed at 0.", text, joint);
    double unit = weft_term_unit(camera, term.kind, 0);
    if (term.kind == WEFT_TERM_SCALE)
        return weft_lines_add(lines, error, "The %s of %s, %.5f +- %.5f, is no more than chance; fixed at 0.", text,
                              joint, value * unit, deviation * unit);
    return weft_lines_add(lines, error, "The %s of %s, %.3f +- %.3f degrees, is no more than chance; fixed at 0.", text,
                          joint, weft_deg_of_rad(value * unit), weft_deg_of_rad(deviation * unit));
}

static double angle_deg(weft_vec3 a, weft_vec3 b)
{
    return weft_deg_of_rad(atan2(weft_length(weft_cross(a, b)), weft_dot(a, b)));
}

/* Between two lines that are not parallel. */
static double distance_mm(const weft_joint *a, const weft_joint *b)
{
    weft_vec3 across = weft_unit(weft_cross(a->direction, b->direction));
    return fabs(weft_dot(across, weft_subtract(a->point, b->point)));
}

static weft_code report_bearing(weft_lines *lines, const weft_joint *joint, const weft_joint_error *deviation,
                                const char *name, weft_error *error)
{
    if (deviation->scale > 0)
        WEFT_TRY(weft_lines_add(lines, error, "%s: turns %.5f +- %.5f times as far as its scale reads", name,
                                1 + joint->scale, deviation->scale));
    if (deviation->uneven_rad > 0)
        WEFT_TRY(weft_lines_add(lines, error, "%s: its scale is uneven by %.3f +- %.3f degrees, once a turn", name,
                                weft_deg_of_rad(hypot(joint->uneven[0], joint->uneven[1])),
                                weft_deg_of_rad(deviation->uneven_rad)));
    if (deviation->wobble_rad > 0)
        WEFT_TRY(weft_lines_add(lines, error, "%s: wobbles by %.3f +- %.3f degrees", name,
                                weft_deg_of_rad(hypot(hypot(joint->wobble[0], joint->wobble[1]),
                                                      hypot(joint->wobble[2], joint->wobble[3]))),
                                weft_deg_of_rad(deviation->wobble_rad)));
    return WEFT_OK;
}

static weft_code report_joint(weft_axes_report *report, const weft_rig_poses *nominal, int k, weft_error *error)
{
    const weft_joint *joint = &report->file.poses.joint[k];
    const weft_joint_error *deviation = &report->file.error[k];
    if (deviation->direction_rad == 0)
        return WEFT_OK;
    WEFT_TRY(weft_lines_add(&report->found, error,
                            "%s: leans by %.3f +- %.3f degrees, and passes the middle of the target at %.2f +- %.2f mm",
                            weft_joint_text[k], angle_deg(joint->direction, nominal->joint[k].direction),
                            weft_deg_of_rad(deviation->direction_rad), weft_length(joint->point), deviation->point_mm));
    return report_bearing(&report->found, joint, deviation, weft_joint_text[k], error);
}

/* Of two axes these do not depend on how the target lies. */
static weft_code report_pair(weft_axes_report *report, int a, int b, weft_error *error)
{
    const weft_joint *joint = report->file.poses.joint;
    const weft_joint_error *deviation = report->file.error;
    if (deviation[a].direction_rad == 0 || deviation[b].direction_rad == 0)
        return WEFT_OK;
    return weft_lines_add(&report->found, error, "%s and %s: %.3f degrees from a right angle, %.2f mm from each other",
                          weft_joint_text[a], weft_joint_text[b],
                          fabs(90 - angle_deg(joint[a].direction, joint[b].direction)),
                          distance_mm(&joint[a], &joint[b]));
}

/* From report->file to report->found. */
static weft_code report_found(weft_axes_report *report, const weft_rig_poses *nominal, weft_error *error)
{
    for (int k = 0; k < WEFT_JOINTS; k++)
        WEFT_TRY(report_joint(report, nominal, k, error));
    WEFT_TRY(report_pair(report, WEFT_CAMERA_THETA, WEFT_CAMERA_PHI, error));
    WEFT_TRY(report_pair(report, WEFT_CAMERA_THETA, WEFT_SAMPLE_PHI, error));
    return weft_lines_add(&report->found, error, "from shot to shot: %.3f degrees, %.3f mm; a point: %.3f pixels",
                          weft_deg_of_rad(report->file.scatter_rad), report->file.scatter_mm, report->file.point_px);
}

/* ---- What can be determined ---- */

static int count_used(const work *w)
{
    int used = 0;
    for (int i = 0; i < w->count; i++)
        used += !w->shot[i].left_out[0];
    return used;
}

static bool is_new_place(const work *w, int joint, int index)
{
    for (int i = 0; i < index; i++) {
        if (!w->shot[i].left_out[0] && fabs(w->shot[i].turns.deg[joint] - w->shot[index].turns.deg[joint]) < place_deg)
            return false;
    }
    return !w->shot[index].left_out[0];
}

static int places_of(const work *w, int joint)
{
    int places = 0;
    for (int i = 0; i < w->count; i++)
        places += is_new_place(w, joint, i);
    return places;
}

static weft_code free_lines(work *w, weft_error *error)
{
    weft_axes_fit *fit = &w->report->fit;
    int used = count_used(w), turning = 0;
    if (used < WEFT_AXES_FEWEST)
        return weft_fail(error, WEFT_BAD_INPUT, "the target is found in %d of %d shots: at least %d are needed", used,
                         w->count, WEFT_AXES_FEWEST);
    fit->terms = (weft_free_terms){0};
    fit->terms.free[WEFT_TERM_HOME] = true;
    for (int joint = 0; joint < WEFT_JOINTS; joint++) {
        int places = places_of(w, joint);
        turning += places > 1;
        fit->terms.free[weft_term_index(WEFT_TERM_LINE, joint)] = places >= FEWEST_PLACES;
        if (places < FEWEST_PLACES)
            WEFT_TRY(report_places(&w->report->undetermined, joint, places, error));
    }
    if (turning == 0)
        return weft_fail(error, WEFT_BAD_INPUT, "all %d shots are of one pose: no axis turns", used);
    return WEFT_OK;
}

/* ---- Shots that do not fit ---- */

static double rms_px(const weft_rig_poses *poses, const weft_axes_shot *shot)
{
    return sqrt(weft_axes_squares(poses, shot) / WEFT_AXES_POINTS);
}

/* Leaves out the shot that is the farthest from its place, where that is too far. `sorted` has room for all. */
static bool leave_one_out(work *w, const double *apart, double *sorted)
{
    int used = 0, worst = 0;
    for (int i = 0; i < w->count; i++) {
        if (!w->shot[i].left_out[0])
            sorted[used++] = apart[i];
        worst = apart[i] > apart[worst] ? i : worst;
    }
    double usual = weft_quantile(sorted, (size_t)used, 0.5), off_px = rms_px(&w->report->fit.poses, &w->shot[worst]);
    if (!(apart[worst] > far_ratio * usual && off_px > far_px) || used <= WEFT_AXES_FEWEST)
        return false;
    snprintf(w->shot[worst].left_out, sizeof w->shot[worst].left_out,
             "the target is %.1f pixels from where the axes put it, %.1f times as far as is usual: it was moved, or an "
             "axis was",
             off_px, apart[worst] / usual);
    return true;
}

/* Fits until no shot is far off. */
static weft_code fit_sound_shots(work *w, weft_error *error)
{
    double *apart = calloc(2 * (size_t)w->count, sizeof *apart);
    if (!apart)
        return weft_fail_memory(error, "shots", 2 * (size_t)w->count * sizeof *apart);
    weft_code code = WEFT_OK;
    bool again = true;
    while (code == WEFT_OK && again) {
        const weft_axes_choice all = {w->shot, w->count, 0, 0};
        code = weft_axes_fit_run(&all, w->nominal, true, &w->report->fit, apart, error);
        again = code == WEFT_OK && leave_one_out(w, apart, apart + w->count);
    }
    free(apart);
    return code;
}

/* ---- What more there is ---- */

static bool may_be_free(const work *w, int index)
{
    const weft_free_terms *terms = &w->report->fit.terms;
    weft_term term = weft_term_of(index);
    if (terms->free[index] || term.kind == WEFT_TERM_HOME || term.kind == WEFT_TERM_LINE)
        return false;
    if (term.kind == WEFT_TERM_LENS)
        return w->free_lens;
    return terms->free[weft_term_index(WEFT_TERM_LINE, term.joint)];
}

/* By how much a term makes the shots more probable, in units of what is asked of it; and what it would be. */
static weft_code try_term(const work *w, int index, double *gain, weft_axes_fit *with, weft_error *error)
{
    const weft_axes_choice all = {w->shot, w->count, 0, 0};
    *with = w->report->fit;
    with->terms.free[index] = true;
    WEFT_TRY(weft_axes_fit_run(&all, w->nominal, false, with, NULL, error));
    double asked = weft_term_numbers(weft_term_of(index).kind) * log(6.0 * count_used(w));
    *gain = (w->report->fit.squares - with->squares) / asked;
    return WEFT_OK;
}

static weft_code take_best_term(work *w, bool *taken, weft_error *error)
{
    weft_axes_fit with;
    double most = 1;
    int best = -1;
    for (int index = 0; index < WEFT_TERMS; index++) {
        double gain = 0;
        if (!may_be_free(w, index))
            continue;
        WEFT_TRY(try_term(w, index, &gain, &with, error));
        best = gain > most ? index : best;
        most = fmax(most, gain);
    }
    *taken = best >= 0;
    if (*taken)
        w->report->fit.terms.free[best] = true;
    return WEFT_OK;
}

static weft_code take_terms(work *w, weft_error *error)
{
    bool taken = true;
    while (taken) {
        WEFT_TRY(fit_sound_shots(w, error));
        WEFT_TRY(take_best_term(w, &taken, error));
    }
    return WEFT_OK;
}

static weft_code report_fixed_terms(work *w, weft_error *error)
{
    weft_axes_fit with;
    for (int index = 0; index < WEFT_TERMS; index++) {
        double gain;
        if (!may_be_free(w, index))
            continue;
        WEFT_TRY(try_term(w, index, &gain, &with, error));
        WEFT_TRY(report_fixed(&w->report->undetermined, &with, &w->nominal->camera, index, error));
    }
    return WEFT_OK;
}

/* ---- How good it is ---- */

static weft_code hold_out(work *w, weft_error *error)
{
    weft_poses_file *file = &w->report->file;
    double fitted = 0, held_out = 0, points = 0;
    for (int fold = 0; fold < WEFT_AXES_FOLDS; fold++) {
        const weft_axes_choice others = {w->shot, w->count, fold, WEFT_AXES_FOLDS};
        weft_axes_fit fit = w->report->fit;
        WEFT_TRY(weft_axes_fit_run(&others, w->nominal, false, &fit, NULL, error));
        for (int i = 0; i < w->count; i++) {
            if (!weft_axes_held_out(&others, i))
                continue;
            held_out += weft_axes_squares(&fit.poses, &w->shot[i]);
            fitted += weft_axes_squares(&w->report->fit.poses, &w->shot[i]);
            points += WEFT_AXES_POINTS;
        }
    }
    file->rms_px = sqrt(fitted / points);
    file->held_out_rms_px = sqrt(held_out / points);
    return WEFT_OK;
}

/* Root mean square of the standard errors of some numbers of a term; 0 where it is held. */
static double error_of(const weft_axes_fit *fit, const weft_camera *camera, weft_term term, int first, int count)
{
    int index = weft_term_index(term.kind, term.joint);
    double sum = 0;
    if (!fit->terms.free[index])
        return 0;
    for (int i = first; i < first + count; i++) {
        int k = weft_unknown_first(&fit->terms, index) + i;
        double unit = weft_term_unit(camera, term.kind, i);
        sum += fit->covariance[k * fit->unknowns + k] * unit * unit;
    }
    return sqrt(sum / count);
}

static void fill_file(work *w)
{
    const weft_axes_fit *fit = &w->report->fit;
    const weft_camera *camera = &w->nominal->camera;
    weft_poses_file *file = &w->report->file;
    file->poses = fit->poses;
    file->scatter_rad = fit->scatter.rotation_rad;
    file->scatter_mm = fit->scatter.translation_mm;
    file->point_px = fit->scatter.point_px;
    file->home_rotation_rad = error_of(fit, camera, (weft_term){WEFT_TERM_HOME, -1}, 0, 3);
    file->home_translation_mm = error_of(fit, camera, (weft_term){WEFT_TERM_HOME, -1}, 3, 3);
    for (int i = 0; i < 4; i++)
        file->lens_error[i] = error_of(fit, camera, (weft_term){WEFT_TERM_LENS, -1}, i, 1);
    for (int k = 0; k < WEFT_JOINTS; k++)
        file->error[k] =
            (weft_joint_error){.direction_rad = error_of(fit, camera, (weft_term){WEFT_TERM_LINE, k}, 0, 2),
                               .point_mm = error_of(fit, camera, (weft_term){WEFT_TERM_LINE, k}, 2, 2),
                               .scale = error_of(fit, camera, (weft_term){WEFT_TERM_SCALE, k}, 0, 1),
                               .uneven_rad = error_of(fit, camera, (weft_term){WEFT_TERM_UNEVEN, k}, 0, 2),
                               .wobble_rad = error_of(fit, camera, (weft_term){WEFT_TERM_WOBBLE, k}, 0, 4)};
}

weft_code weft_axes_calibrate(weft_axes_shot *shot, int count, const weft_rig_poses *nominal, bool free_lens,
                              weft_axes_report *report, weft_error *error)
{
    work w = {shot, count, nominal, free_lens, report};
    *report = (weft_axes_report){.fit.scatter = {0.002, 0.5, 0.1}};
    WEFT_TRY(free_lines(&w, error));
    WEFT_TRY(take_terms(&w, error));
    WEFT_TRY(report_fixed_terms(&w, error));
    WEFT_TRY(hold_out(&w, error));
    report->used = count_used(&w);
    fill_file(&w);
    return report_found(report, nominal, error);
}

void weft_axes_report_free(weft_axes_report *report)
{
    weft_lines_free(&report->found);
    weft_lines_free(&report->undetermined);
}
