#include "registration/photographs/steps.h"

#include "base/numeric/statistics.h"
#include "base/picture/colour.h"
#include "btf/session/rig_poses.h"
#include "registration/pose/normal_equations.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { POSE = 6 };

/* What all photographs are wrong by. */
static const double shared_error = 0.02;

/* ---- The view ---- */

/* The pose after a small turn about an axis of the camera, rad, or a small move along one, mm. */
static weft_pose moved_pose(const weft_pose *pose, int parameter, double step)
{
    weft_motion motion = {{0, 0, 0}, {0, 0, 0}};
    (parameter < 3 ? motion.rotation : motion.translation)[parameter % 3] = step;
    weft_pose moved = weft_pose_of_motion(&motion);
    return weft_pose_after(&moved, pose);
}

static weft_pixel seen_at(const weft_camera *camera, const weft_pose *pose, const double plate[2])
{
    weft_homography homography = weft_homography_of_pose(camera, pose);
    return weft_camera_distort(camera, weft_homography_apply(&homography, plate[0], plate[1]));
}

/* How corners and the direction of the camera move with a parameter of the pose. */
typedef struct pose_slopes {
    double corner[POSE][WEFT_PLATE_CORNERS][2];
    weft_vec3 view[POSE];
} pose_slopes;

static void find_slopes(const weft_camera *camera, const weft_photographs_photograph *p, pose_slopes *slopes)
{
    double distance_mm = weft_length(p->pose.translation);
    for (int k = 0; k < POSE; k++) {
        double step = 1e-4 * (k < 3 ? 1 : distance_mm);
        weft_pose less = moved_pose(&p->pose, k, -step), more = moved_pose(&p->pose, k, step);
        for (int i = 0; i < p->corner_count; i++) {
            weft_pixel a = seen_at(camera, &less, p->plate[i]), b = seen_at(camera, &more, p->plate[i]);
            slopes->corner[k][i][0] = (b.x - a.x) / (2 * step);
            slopes->corner[k][i][1] = (b.y - a.y) / (2 * step);
        }
        weft_vec3 a = weft_unit(weft_pose_camera_position(&less)), b = weft_unit(weft_pose_camera_position(&more));
        slopes->view[k] = weft_scale(weft_subtract(b, a), 1 / (2 * step));
    }
}

/* Sum of the squares of the direction's deviations where corners of unit variance determine the pose; negative where
 * they do not. */
static double view_variance(const pose_slopes *slopes, int corner_count)
{
    weft_normal_equations equations = {0};
    double row[WEFT_UNKNOWNS_LIMIT] = {0}, variance = 0;
    for (int i = 0; i < 2 * corner_count; i++) {
        for (int k = 0; k < POSE; k++)
            row[k] = slopes->corner[k][i / 2][i % 2];
        weft_normal_equations_add(&equations, row, 0, 1);
    }
    if (!weft_normal_equations_factor(&equations, POSE))
        return -1;
    for (int axis = 0; axis < 3; axis++) {
        for (int k = 0; k < POSE; k++)
            row[k] = axis == 0 ? slopes->view[k].x : axis == 1 ? slopes->view[k].y : slopes->view[k].z;
        variance += weft_normal_equations_variance(&equations, POSE, row);
    }
    return variance;
}

double weft_photographs_view_error_deg(const weft_camera *camera, const weft_photographs_photograph *photograph)
{
    pose_slopes slopes;
    int freedom = 2 * photograph->corner_count - POSE;
    if (freedom < 1)
        return 90;
    find_slopes(camera, photograph, &slopes);
    double variance = view_variance(&slopes, photograph->corner_count);
    double square = photograph->corner_rms_px * photograph->corner_rms_px * photograph->corner_count / freedom;
    return variance < 0 ? 90 : fmin(90, weft_deg_of_rad(sqrt(square * variance)));
}

/* ---- The weight ---- */

double weft_photographs_contrast(const weft_half *texel, const uint8_t *mask, size_t count)
{
    double sum = 0, squares = 0, valid = 0;
    for (size_t i = 0; i < count; i++) {
        double green = (double)weft_float_of_half(texel[3 * i + 1]);
        if (mask[i])
            continue;
        sum += green;
        squares += green * green;
        valid++;
    }
    return sum > 0 ? sqrt(fmax(0, squares * valid / (sum * sum) - 1)) : 0;
}

void weft_photographs_mask_dark(const float *texel, float darkest, size_t count, uint8_t *mask,
                                weft_photographs_photograph *photograph)
{
    photograph->clipped_texels = photograph->dark_texels = 0;
    for (size_t i = 0; i < count; i++) {
        const float *rgb = texel + 3 * i;
        photograph->clipped_texels += mask[i] == WEFT_MASK_SATURATED;
        if (mask[i] || !(fmaxf(rgb[0], fmaxf(rgb[1], rgb[2])) < darkest))
            continue;
        mask[i] = WEFT_MASK_DARK;
        photograph->dark_texels++;
    }
}

double weft_photographs_variance(const weft_photograph_set *set, const weft_photographs_photograph *photograph,
                                 double contrast, double pitch_mm)
{
    weft_vec3 lamp = weft_unit(photograph->lamp.position_mm);
    double slope_squared = (1 - lamp.z * lamp.z) / (lamp.z * lamp.z);
    double turn = weft_rad_of_deg(photograph->lamp.uncertainty_deg), turn_squared = turn * turn;
    double mm_per_px = weft_length(photograph->pose.translation) / set->lens.camera.fx;
    double blur = 12 * fmax(0, photograph->point_spread.constant) * mm_per_px * mm_per_px;
    double lost = contrast * blur / (blur + pitch_mm * pitch_mm);
    return shared_error * shared_error + photograph->lamp.residual * photograph->lamp.residual +
           turn_squared * slope_squared / 2 + turn_squared * turn_squared / 4 + lost * lost;
}

static double median_contrast(const weft_photograph_set *set, const int *index, int count, double *scratch)
{
    for (int i = 0; i < count; i++)
        scratch[i] = set->photograph[index[i]].contrast;
    return weft_quantile(scratch, (size_t)count, 0.5);
}

/* value [WEFT_IMAGE_FIGURES][count]; weights with mean 1. */
static void fill_figures(const weft_photograph_set *set, const int *index, int count, double pitch_mm, double *value)
{
    double contrast = median_contrast(set, index, count, value), sum = 0;
    double *weight = value + WEFT_IMAGE_WEIGHT * count;
    for (int i = 0; i < count; i++) {
        const weft_photographs_photograph *p = &set->photograph[index[i]];
        sum += weight[i] = 1 / weft_photographs_variance(set, p, contrast, pitch_mm);
        value[WEFT_IMAGE_VIEW_ERROR * count + i] = p->view_uncertainty_deg;
        value[WEFT_IMAGE_LIGHT_ERROR * count + i] = p->lamp.uncertainty_deg;
        value[WEFT_IMAGE_VALUE_ERROR * count + i] = hypot(hypot(shared_error, p->lamp.residual), set->lamps.dark_error);
    }
    for (int i = 0; i < count; i++)
        weight[i] *= count / sum;
}

weft_code weft_photographs_put_figures(const weft_photograph_set *set, const int *index, int count, double pitch_mm,
                                       weft_dataset_writer *writer, weft_error *error)
{
    double *value = malloc((size_t)(WEFT_IMAGE_FIGURES * count) * sizeof *value);
    if (!value)
        return weft_fail_memory(error, "figures of images", (size_t)(WEFT_IMAGE_FIGURES * count) * sizeof *value);
    fill_figures(set, index, count, pitch_mm, value);
    weft_code code = WEFT_OK;
    for (int figure = 0; code == WEFT_OK && figure < WEFT_IMAGE_FIGURES; figure++)
        code = weft_dataset_writer_put_figure(writer, (weft_image_figure)figure, value + figure * count, error);
    free(value);
    return code;
}

/* ---- What the user should know ---- */

static double median_residual(const weft_photograph_set *set)
{
    double *residual = malloc(((size_t)set->count + 1) * sizeof *residual);
    size_t count = 0;
    for (int i = 0; residual && i < set->count; i++) {
        if (weft_photographs_used(&set->photograph[i]))
            residual[count++] = set->photograph[i].lamp.residual;
    }
    double median = residual && count > 0 ? weft_quantile(residual, count, 0.5) : 0;
    free(residual);
    return median;
}

weft_code weft_photographs_check_light(const char *folder, const weft_photographs_settings *settings,
                                       weft_photograph_set *set, weft_error *error)
{
    /* Printers' ink reflects 0.05 of 0.85, within a factor of 2. Paper is smooth to a hundredth. */
    const double most_factor = 2, most_residual = 0.04, most_misfit = 4, least_scale = 0.02;
    const weft_target *target = &settings->target;
    double usual = target->ink_reflectance / target->paper_reflectance, off = median_residual(set);
    if (set->lamps.ink > most_factor * usual || set->lamps.ink < usual / most_factor)
        WEFT_TRY(weft_photographs_contradict(
            folder, settings, set, error,
            "the ink comes out as %.3f of the paper, but ink reflects %.2f to %.2f of it: %s", set->lamps.ink,
            usual / most_factor, usual * most_factor,
            set->tone_found ? "the tone curve is wrong. Use raw files, or take four photographs twice, the second "
                              "two stops darker"
                            : "the files are not linear, or light from elsewhere falls on the sheet"));
    if (off > most_residual)
        WEFT_TRY(weft_photographs_contradict(
            folder, settings, set, error,
            "the light on the bare paper is %.0f %% off that of a lamp (median): one small lamp must "
            "light the sheet in a dark room, and --flash says that it is fixed to the camera",
            100 * off));
    if (set->lamps.size_error > 0 &&
        fabs(log(set->lamps.size)) > fmax(least_scale, most_misfit * set->lamps.size_error))
        WEFT_TRY(weft_photographs_contradict(folder, settings, set, error,
                                             "balls and pin come out as %.3f of the size that is told: the sheet was "
                                             "not printed at 100 %%, and --opening "
                                             "is %.4g, or --balls or --pin is wrong",
                                             set->lamps.size, target->opening_mm / set->lamps.size));
    if (set->lamps.ball_misfit > most_misfit)
        WEFT_TRY(weft_photographs_contradict(
            folder, settings, set, error,
            "the highlights on the balls lie %.0f standard errors off, median: the sheet was printed at another scale "
            "than 100 %%, or --opening or --balls is wrong",
            set->lamps.ball_misfit));
    if (set->lamps.pin_misfit > most_misfit)
        return weft_photographs_contradict(
            folder, settings, set, error,
            "the shadows of the pin lie %.0f standard errors off, median: the sheet was printed at another scale than "
            "100 %%, or --opening or --pin is wrong",
            set->lamps.pin_misfit);
    return WEFT_OK;
}

weft_code weft_photographs_note(const weft_target *target, weft_photograph_set *set, weft_error *error)
{
    const double most = 0.05, bow_mm = weft_lens_bow_mm(&set->lens.bend, target);
    if (bow_mm > 0)
        WEFT_TRY(weft_lines_add(
            &set->notes, error,
            "the sheet is not flat: its print rises and falls by %.1f mm. Lens, poses and lamps were found "
            "with this bow; a flat sheet does better",
            bow_mm));
    if (set->lens.knowledge == WEFT_LENS_FOCAL_ONLY)
        WEFT_TRY(weft_lines_add(&set->notes, error,
                                "the target is seen from %d %s, too few to find the lens: the focal length is as the "
                                "camera wrote it, and the middle of the picture is taken as its axis. Views, and lamps "
                                "that balls show, may be off by %.1f degrees (standard error). A lens file (--lens, "
                                "made by weft lens) makes that smaller",
                                set->lens.distinct_views, set->lens.distinct_views == 1 ? "direction" : "directions",
                                set->lens.assumed_error_deg));
    if (!(set->lamps.dark_error > most))
        return WEFT_OK;
    return weft_lines_add(&set->notes, error,
                          "the tone curve is uncertain: cloth a tenth as bright as the paper may be off by %.0f %% "
                          "(standard error), brighter cloth by less. Next time take four photographs twice, the "
                          "second two stops darker, or use raw files",
                          100 * set->lamps.dark_error);
}

/* ---- Whether they differ ---- */

static bool is_near(weft_vec3 a, weft_vec3 b)
{
    const double near_rad = weft_rad_of_deg(3);
    return weft_dot(weft_unit(a), weft_unit(b)) > cos(near_rad);
}

weft_code weft_photographs_check_variety(const char *folder, const weft_photograph_set *set, weft_error *error)
{
    const weft_photographs_photograph *first = NULL;
    int used = 0;
    for (int i = 0; i < set->count; i++) {
        const weft_photographs_photograph *p = &set->photograph[i];
        if (!weft_photographs_used(p))
            continue;
        used++;
        if (!first)
            first = p;
        if (!is_near(p->lamp.position_mm, first->lamp.position_mm) ||
            !is_near(weft_pose_camera_position(&p->pose), weft_pose_camera_position(&first->pose)))
            return WEFT_OK;
    }
    return weft_fail(error, WEFT_BAD_INPUT,
                     "'%s': all %d photographs that can be used show one view under one light: move the camera, or "
                     "the lamp, from each to the next",
                     folder, used);
}
