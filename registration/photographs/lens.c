#include "registration/photographs/lens.h"

#include "base/numeric/statistics.h"
#include "registration/pose/opencv_bridge.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* As many directions as this, 10 degrees apart and not all from above, tell focal length and distortion. */
enum { views_enough = 4 };
static const double distinct_deg = 10, steepest_at_least_deg = 25;

/* A photograph whose corners lie this many times further off than the median is of another lens, or of a sheet that was
 * bent or moved for it. */
static const double outlier_ratio = 4, outlier_floor = 4e-4; /* the latter as a share of the longer side */

/* Photographs whose corners lie this near to each other, as a share of the longer side, were taken from a tripod. */
static const double tripod_share = 5e-4;

static const double film_diagonal_mm = 43.2666;

enum { FIXED_OF_ALL = WEFT_FIX_TANGENTIAL | WEFT_FIX_K3 };

/* Terms of the lens that are not estimated, for each weft_lens_knowledge. */
static const unsigned fixed_terms[] = {
    FIXED_OF_ALL, FIXED_OF_ALL | WEFT_FIX_FOCAL_LENGTH | WEFT_FIX_MIDDLE | WEFT_FIX_K2,
    FIXED_OF_ALL | WEFT_FIX_FOCAL_LENGTH | WEFT_FIX_MIDDLE | WEFT_FIX_K2 | WEFT_FIX_K1};

/* What the bundle adjustment estimates beside the bend, for each weft_lens_knowledge. */
static const unsigned lens_terms[] = {(1 << WEFT_BUNDLE_BEND) - 1, 1 << WEFT_BUNDLE_K1, 0};
enum { BEND_TERMS = 7 << WEFT_BUNDLE_BEND };

/* A bend is kept where it lowers the squares of residuals so much, and the F statistic of its three terms over the
 * photographs is above this. */
static const double least_gain = 0.02, least_score = 25;

/* Lets the sheet bend. `lens` and `pose` are those of a flat one, and change only where it does not lie flat. */
static weft_code bend_sheet(const weft_corner_view *view, int count, weft_lens_knowledge knowledge,
                            weft_lens_estimate *lens, weft_pose *pose, double *rms_px, weft_error *error)
{
    weft_bundle bundle = {.camera = lens->camera, .pose = malloc((size_t)count * sizeof *pose)};
    if (!bundle.pose)
        return weft_fail_memory(error, "poses", (size_t)count * sizeof *pose);
    double flat = 0;
    for (int i = 0; i < count; i++)
        flat += rms_px[i] * rms_px[i] * view[i].count;
    memcpy(bundle.pose, pose, (size_t)count * sizeof *pose);
    weft_code code = weft_bundle_adjust(view, count, lens_terms[knowledge] | BEND_TERMS, &bundle, error);
    lens->bend = (weft_bend){0, 0, 0};
    lens->bend_error_mm = 0;
    if (code == WEFT_OK && bundle.squares < (1 - least_gain) * flat && bundle.bend_score > least_score) {
        const double *e = bundle.standard_error;
        lens->camera = bundle.camera;
        lens->bend = bundle.bend;
        lens->bend_error_mm = fmax(e[WEFT_BUNDLE_BEND], e[WEFT_BUNDLE_BEND + 2]);
        lens->errors = (weft_lens_errors){e[WEFT_BUNDLE_FOCAL_LENGTH], e[WEFT_BUNDLE_K1], e[WEFT_BUNDLE_K2]};
        memcpy(pose, bundle.pose, (size_t)count * sizeof *pose);
        for (int i = 0; i < count; i++)
            rms_px[i] = weft_bundle_rms_px(&bundle, i, &view[i]);
    }
    free(bundle.pose);
    return code;
}

/* One lens, the bend of the sheet where enough views tell it, and a pose for each of the photographs that are used. */
static weft_code fit(weft_photographs_photograph *photograph, int count, weft_lens_knowledge knowledge,
                     weft_lens_estimate *lens, weft_error *error)
{
    size_t n = (size_t)count;
    int *index = calloc(n, sizeof *index), used = 0;
    weft_corner_view *view = calloc(n, sizeof *view);
    weft_corner_fit found = {.pose = calloc(n, sizeof *found.pose), .view_rms_px = calloc(n, sizeof(double))};
    weft_code code = WEFT_OK;
    if (!index || !view || !found.pose || !found.view_rms_px)
        code = weft_fail_memory(error, "poses", n * 200);
    for (int i = 0; code == WEFT_OK && i < count; i++) {
        const weft_photographs_photograph *p = &photograph[i];
        if (!weft_photographs_used(p))
            continue;
        index[used] = i;
        view[used++] = (weft_corner_view){p->corner_count, (const double(*)[2])p->plate, (const double(*)[2])p->seen};
    }
    if (code == WEFT_OK)
        code = weft_opencv_calibrate(view, used, fixed_terms[knowledge], true, &lens->camera, &found, error);
    /* fx follows fy. */
    lens->errors = (weft_lens_errors){found.standard_error[1], found.standard_error[4], found.standard_error[5]};
    if (code == WEFT_OK && lens->distinct_views >= views_enough)
        code = bend_sheet(view, used, knowledge, lens, found.pose, found.view_rms_px, error);
    for (int i = 0; code == WEFT_OK && i < used; i++) {
        photograph[index[i]].pose = found.pose[i];
        photograph[index[i]].corner_rms_px = found.view_rms_px[i];
    }
    free(index);
    free(view);
    free(found.pose);
    free(found.view_rms_px);
    return code;
}

/* Focal length in pixels from what the camera wrote; 0 where it wrote none. */
static double written_focal_length(const weft_photographs_photograph *photograph, int count, int width, int height)
{
    for (int i = 0; i < count; i++) {
        if (weft_photographs_used(&photograph[i]) && photograph[i].exif.focal_length_35mm > 0)
            return photograph[i].exif.focal_length_35mm / film_diagonal_mm * hypot(width, height);
    }
    return 0;
}

static weft_camera ideal_camera(int width, int height, double focal_length)
{
    return (weft_camera){.width = width,
                         .height = height,
                         .fx = focal_length,
                         .fy = focal_length,
                         .cx = (width - 1) / 2.0,
                         .cy = (height - 1) / 2.0};
}

static weft_vec3 view_of(const weft_photographs_photograph *p)
{
    return weft_unit(weft_pose_camera_position(&p->pose));
}

/* Distinct views, found greedily; *steepest receives the largest angle from the normal, degrees. */
static int count_views(const weft_photographs_photograph *photograph, int count, double *steepest)
{
    int distinct = 0;
    *steepest = 0;
    for (int i = 0; i < count; i++) {
        bool is_new = weft_photographs_used(&photograph[i]);
        if (is_new)
            *steepest = fmax(*steepest, weft_deg_of_rad(acos(view_of(&photograph[i]).z)));
        for (int k = 0; is_new && k < i; k++)
            is_new = !weft_photographs_used(&photograph[k]) ||
                     weft_dot(view_of(&photograph[i]), view_of(&photograph[k])) < cos(weft_rad_of_deg(distinct_deg));
        distinct += is_new;
    }
    return distinct;
}

/* How far off the corners of a photograph are that is used: RMS, median over the photographs. */
static double median_rms(const weft_photographs_photograph *photograph, int count)
{
    double *rms = malloc((size_t)count * sizeof *rms);
    int used = 0;
    for (int i = 0; rms && i < count; i++) {
        if (weft_photographs_used(&photograph[i]))
            rms[used++] = photograph[i].corner_rms_px;
    }
    double median = rms ? weft_quantile(rms, (size_t)used, 0.5) : INFINITY;
    free(rms);
    return median;
}

/* Farther off than this is an outlier: a corner among those of its photograph, or a photograph. */
static double outlier_limit(double median, const weft_camera *camera)
{
    return fmax(outlier_ratio * median, outlier_floor * fmax(camera->width, camera->height));
}

/* Fewer corners than this, or than this share of those that were found, are no majority to trust. */
enum { fewest_corners = 12 };
static const double least_share = 0.75;

/* Distance in undistorted pixels. */
static double distance(const weft_homography *homography, const double plate[2], const double straight[2])
{
    weft_pixel put = weft_homography_apply(homography, plate[0], plate[1]);
    return hypot(put.x - straight[0], put.y - straight[1]);
}

/* Takes out of the photograph the corners that lie more than `reach_px` from where the others put them: one sheet, seen
 * through the lens. What the sheet's bend moves them by is taken away first. Something crosses them: a pin, its shadow
 * or the edge of another sheet. Where more than a quarter are off, nothing is taken out: then the photograph is wrong,
 * not a few markers. */
static weft_code drop_strays_of(const weft_lens_estimate *lens, double reach_px,
                                weft_photographs_photograph *photograph, int *dropped, weft_error *error)
{
    const weft_camera *camera = &lens->camera;
    const weft_homography flat = weft_homography_of_pose(camera, &photograph->pose);
    const weft_plate_view bent = weft_plate_view_of(camera, &flat, &lens->bend);
    const int count = photograph->corner_count, found = 4 * photograph->marker_count;
    int agreeing = 0;
    double straight[WEFT_PLATE_CORNERS][2];
    uint8_t agrees[WEFT_PLATE_CORNERS] = {0};
    weft_homography homography;
    *dropped = 0;
    if (count < fewest_corners)
        return WEFT_OK;
    for (int i = 0; i < count; i++) {
        weft_pixel pixel = weft_camera_undistort(camera, (weft_pixel){photograph->seen[i][0], photograph->seen[i][1]});
        straight[i][0] = pixel.x, straight[i][1] = pixel.y;
        weft_pixel level = weft_homography_apply(&flat, photograph->plate[i][0], photograph->plate[i][1]);
        weft_pixel raised = weft_plate_view_see(&bent, photograph->plate[i][0], photograph->plate[i][1]);
        straight[i][0] += level.x - raised.x, straight[i][1] += level.y - raised.y;
    }
    weft_code code = weft_opencv_fit_homography((const double(*)[2])photograph->plate, (const double(*)[2])straight,
                                                count, reach_px, homography.m, agrees, error);
    if (code != WEFT_OK)
        return code == WEFT_BAD_INPUT ? WEFT_OK : code;
    for (int i = 0; i < count; i++) {
        agrees[i] = distance(&homography, photograph->plate[i], straight[i]) <= reach_px;
        agreeing += agrees[i];
    }
    if (agreeing < fewest_corners || agreeing < least_share * found)
        return WEFT_OK;
    weft_photographs_keep_corners(photograph, agrees);
    *dropped = count - agreeing;
    return WEFT_OK;
}

/* Takes single corners out, first: a pin before one marker is no reason to lose a photograph. *dropped: how many. */
static weft_code drop_strays(weft_photographs_photograph *photograph, int count, const weft_lens_estimate *lens,
                             int *dropped, weft_error *error)
{
    double limit = outlier_limit(median_rms(photograph, count), &lens->camera);
    *dropped = 0;
    for (int i = 0; i < count; i++) {
        int own = 0;
        if (weft_photographs_used(&photograph[i]))
            WEFT_TRY(drop_strays_of(lens, limit, &photograph[i], &own, error));
        *dropped += own;
    }
    return WEFT_OK;
}

/* Gives photographs that do not fit a remark; returns how many. */
static int leave_out(weft_photographs_photograph *photograph, int count, const weft_camera *camera)
{
    double median = median_rms(photograph, count), limit = outlier_limit(median, camera);
    int left_out = 0;
    for (int i = 0; i < count; i++) {
        weft_photographs_photograph *p = &photograph[i];
        if (!weft_photographs_used(p) || p->corner_rms_px <= limit)
            continue;
        snprintf(p->remark, sizeof p->remark,
                 "its markers lie %.1f pixels off (median of all: %.2f): the sheet was bent or moved, or another lens "
                 "was used",
                 p->corner_rms_px, median);
        left_out++;
    }
    return left_out;
}

/* Median distance between the corners that two photographs share, pixels; infinite where they share fewer than 4. */
static double median_shift(const weft_photographs_photograph *a, const weft_photographs_photograph *b)
{
    double shift[WEFT_PLATE_CORNERS];
    int count = 0;
    for (int i = 0; i < a->corner_count; i++) {
        for (int k = 0; k < b->corner_count; k++) {
            if (a->plate[i][0] == b->plate[k][0] && a->plate[i][1] == b->plate[k][1])
                shift[count++] = hypot(a->seen[i][0] - b->seen[k][0], a->seen[i][1] - b->seen[k][1]);
        }
    }
    return count >= 4 ? weft_quantile(shift, (size_t)count, 0.5) : INFINITY;
}

/* A pose for photographs [index] that were taken from one place: that of all their corners together. */
static weft_code share_pose(weft_photographs_photograph *photograph, const int *index, int count,
                            const weft_lens_estimate *lens, weft_error *error)
{
    size_t limit = (size_t)count * WEFT_PLATE_CORNERS;
    double(*corner)[2] = malloc(2 * limit * sizeof *corner);
    if (!corner)
        return weft_fail_memory(error, "corners of a viewpoint", 2 * limit * sizeof *corner);
    double(*plate)[2] = corner, (*seen)[2] = corner + limit;
    weft_corner_view all = {0, (const double(*)[2])plate, (const double(*)[2])seen};
    for (int i = 0; i < count; i++) {
        const weft_photographs_photograph *p = &photograph[index[i]];
        memcpy(plate + all.count, p->plate, (size_t)p->corner_count * sizeof *plate);
        memcpy(seen + all.count, p->seen, (size_t)p->corner_count * sizeof *seen);
        all.count += p->corner_count;
    }
    weft_pose pose = photograph[index[0]].pose;
    weft_bundle shared = {.camera = lens->camera, .bend = lens->bend, .pose = &pose};
    weft_code code = weft_bundle_adjust(&all, 1, lens_terms[WEFT_LENS_KNOWN], &shared, error);
    for (int i = 0; code == WEFT_OK && i < count; i++)
        photograph[index[i]].pose = pose;
    free(corner);
    return code;
}

/* Photographs from a tripod share a pose. */
static weft_code share_poses(weft_photographs_photograph *photograph, int count, const weft_lens_estimate *lens,
                             weft_error *error)
{
    double limit = tripod_share * fmax(lens->camera.width, lens->camera.height);
    int *index = malloc(((size_t)count + 1) * sizeof *index);
    bool *done = calloc((size_t)count + 1, sizeof *done);
    weft_code code = index && done ? WEFT_OK : weft_fail_memory(error, "viewpoints", (size_t)count * 5);
    for (int first = 0; code == WEFT_OK && first < count; first++) {
        int together = 0;
        for (int i = first; i < count && weft_photographs_used(&photograph[first]) && !done[first]; i++) {
            if (!done[i] && weft_photographs_used(&photograph[i]) &&
                median_shift(&photograph[first], &photograph[i]) < limit)
                index[together++] = i;
        }
        for (int i = 0; i < together; i++)
            done[index[i]] = true;
        if (together > 1)
            code = share_pose(photograph, index, together, lens, error);
    }
    free(index);
    free(done);
    return code;
}

static double rms_of(const weft_photographs_photograph *photograph, int count)
{
    double squares = 0, corners = 0;
    for (int i = 0; i < count; i++) {
        if (!weft_photographs_used(&photograph[i]))
            continue;
        squares += photograph[i].corner_rms_px * photograph[i].corner_rms_px * photograph[i].corner_count;
        corners += photograph[i].corner_count;
    }
    return corners > 0 ? sqrt(squares / corners) : 0;
}

/* Fits with ideal optics first, to see how many distinct views there are. */
static weft_code fit_unknown(weft_photographs_photograph *photograph, int count, int width, int height,
                             weft_lens_estimate *lens, weft_error *error)
{
    double written = written_focal_length(photograph, count, width, height), steepest;
    double guess = written > 0 ? written : 1.2 * fmax(width, height);
    lens->camera = ideal_camera(width, height, guess);
    WEFT_TRY(fit(photograph, count, WEFT_LENS_FOCAL_ONLY, lens, error));
    lens->distinct_views = count_views(photograph, count, &steepest);
    lens->knowledge = lens->distinct_views >= views_enough && steepest >= steepest_at_least_deg ? WEFT_LENS_UNKNOWN
                                                                                                : WEFT_LENS_FOCAL_ONLY;
    if (lens->knowledge == WEFT_LENS_FOCAL_ONLY && !(written > 0))
        return weft_fail(error, WEFT_BAD_INPUT,
                         "the target is seen from %d directions only, and the photographs do not say their focal "
                         "length: take some from other sides, or give a lens file (--lens)",
                         lens->distinct_views);
    return WEFT_OK;
}

weft_code weft_lens_estimate_from(weft_photographs_photograph *photograph, int count, int width, int height,
                                  const weft_camera *known, weft_lens_estimate *lens, weft_error *error)
{
    *lens = (weft_lens_estimate){.knowledge = WEFT_LENS_KNOWN};
    if (known && (known->width != width || known->height != height))
        return weft_fail(error, WEFT_BAD_INPUT, "the lens is of photographs of %d x %d pixels, these have %d x %d",
                         known->width, known->height, width, height);
    if (known) {
        double steepest;
        lens->camera = *known;
        WEFT_TRY(fit(photograph, count, WEFT_LENS_KNOWN, lens, error));
        lens->distinct_views = count_views(photograph, count, &steepest);
    } else {
        WEFT_TRY(fit_unknown(photograph, count, width, height, lens, error));
    }
    int wrong;
    do {
        wrong = 0;
        WEFT_TRY(fit(photograph, count, lens->knowledge, lens, error));
        if (lens->knowledge == WEFT_LENS_UNKNOWN)
            WEFT_TRY(weft_lens_leave_out_second(lens, photograph, count, &wrong, error));
        if (!wrong)
            WEFT_TRY(drop_strays(photograph, count, lens, &wrong, error));
        if (!wrong)
            wrong = leave_out(photograph, count, &lens->camera);
    } while (wrong > 0);
    lens->rms_px = rms_of(photograph, count);
    return share_poses(photograph, count, lens, error);
}

weft_code weft_lens_assumed_error(const weft_lens_estimate *lens, const weft_photographs_photograph *photograph,
                                  double *deg, weft_error *error)
{
    const double focal_error = 0.015, axis_error = 0.007 * fmax(lens->camera.width, lens->camera.height);
    const weft_corner_view view = {photograph->corner_count, (const double(*)[2])photograph->plate,
                                   (const double(*)[2])photograph->seen};
    double squares = 0;
    *deg = 0;
    for (int term = 0; term < 3 && lens->knowledge == WEFT_LENS_FOCAL_ONLY; term++) {
        weft_pose pose = photograph->pose;
        weft_bundle other = {.camera = lens->camera, .bend = lens->bend, .pose = &pose};
        other.camera.fx *= term == 0 ? 1 + focal_error : 1;
        other.camera.fy *= term == 0 ? 1 + focal_error : 1;
        other.camera.cx += term == 1 ? axis_error : 0;
        other.camera.cy += term == 2 ? axis_error : 0;
        WEFT_TRY(weft_bundle_adjust(&view, 1, lens_terms[WEFT_LENS_KNOWN], &other, error));
        double cosine = weft_dot(view_of(photograph), weft_unit(weft_pose_camera_position(&pose)));
        squares += pow(weft_deg_of_rad(acos(fmin(1, cosine))), 2);
    }
    *deg = fmin(90, sqrt(squares));
    return WEFT_OK;
}

double weft_lens_bow_mm(const weft_bend *bend, const weft_target *target)
{
    enum { grid = 9 };
    weft_rectangle sheet = weft_target_sheet(target);
    double least = 0, most = 0;
    for (int i = 0; i < grid * grid; i++) {
        double x = sheet.x0 + (sheet.x1 - sheet.x0) * (i % grid) / (grid - 1.0);
        double y = sheet.y0 + (sheet.y1 - sheet.y0) * (i / grid) / (grid - 1.0);
        double height = weft_bend_height(bend, x, y);
        least = fmin(least, height), most = fmax(most, height);
    }
    return most - least;
}

double weft_lens_corner_radius_squared(const weft_camera *camera)
{
    double x = fmax(camera->cx, camera->width - 1 - camera->cx) / camera->fx;
    double y = fmax(camera->cy, camera->height - 1 - camera->cy) / camera->fy;
    return x * x + y * y;
}
