#include "capture/preflight/measure.h"

#include "base/numeric/statistics.h"
#include "registration/pose/pose_chain.h"

#include <stdlib.h>

/* Share of an exposure that is short enough beside it to tell whether values grow with it. */
static const double longest_brief = 0.6;

static const weft_pose_limits pose_limits = {.tolerance_mm = 20, .least_correlation = 0.5};

void weft_preflight_note(weft_preflight_check *check, weft_preflight_kind kind, double value, double limit,
                         weft_angles view)
{
    bool is_least = weft_preflight_limits_of[kind].is_least;
    weft_preflight_check *c = &check[kind];
    if (c->done && (is_least ? value >= c->value : value <= c->value))
        return;
    *c = (weft_preflight_check){true, is_least ? value >= limit : value <= limit, value, view};
}

static void note(weft_preflight_check *check, weft_preflight_kind kind, double value, weft_angles view)
{
    weft_preflight_note(check, kind, value, weft_preflight_limits_of[kind].limit, view);
}

/* ---- Values ---- */

static double share_at_full_scale(const weft_session *session, const int *pixel, int count, const uint16_t *samples)
{
    int full_scale = (1 << session->bits) - 1, clipped = 0;
    for (int i = 0; i < count; i++) {
        const uint16_t *s = samples + 3 * (size_t)pixel[i];
        clipped += s[0] >= full_scale || s[1] >= full_scale || s[2] >= full_scale;
    }
    return count ? (double)clipped / count : 0;
}

/* Mean over pixels and channels above black, of full scale. */
static double mean_level(const weft_session *session, const int *pixel, int count, const uint16_t *samples)
{
    double sum = 0;
    for (int i = 0; i < count; i++) {
        const uint16_t *s = samples + 3 * (size_t)pixel[i];
        sum += (s[0] + s[1] + s[2]) / 3.0 - session->black_level;
    }
    return count ? sum / count / ((1 << session->bits) - 1 - session->black_level) : 0;
}

/* Standard deviation of one photograph in the green channel, relative to the mean, from the difference of two: what
 * differs between pixels drops out, and so does what the lamp does to all of them. */
static double relative_noise(const weft_session *session, const int *pixel, int count, const uint16_t *a,
                             const uint16_t *b)
{
    double sum = 0, squares = 0, level = 0;
    for (int i = 0; i < count; i++) {
        size_t at = 3 * (size_t)pixel[i] + 1;
        double difference = (double)a[at] - b[at];
        sum += difference;
        squares += difference * difference;
        level += (a[at] + b[at]) / 2.0 - session->black_level;
    }
    double mean = sum / count, variance = fmax(squares / count - mean * mean, 0);
    return level > 0 ? sqrt(variance / 2) / (level / count) : INFINITY;
}

/* How far a shorter exposure of the white patches is from its share of the longer one. What is seen without the lamp is
 * taken out of both: that is no fault of the camera. */
static double departure_from_linear(const weft_session *session, const int *pixel, int count,
                                    const weft_preflight_photographs *p)
{
    double unlit = mean_level(session, pixel, count, p->unlit);
    double whole = mean_level(session, pixel, count, p->first) - unlit;
    double brief = mean_level(session, pixel, count, p->brief) - unlit * p->brief_share;
    return fabs(brief / fmax(whole * p->brief_share, 1e-6) - 1);
}

static void measure_values(const weft_session *session, const weft_meter *meter, weft_angles view,
                           const weft_preflight_photographs *p, weft_preflight_check *check)
{
    note(check, WEFT_CHECK_CLIPPING, share_at_full_scale(session, meter->opening, meter->opening_count, p->first),
         view);
    if (meter->white_count == 0)
        return;
    double white = mean_level(session, meter->white, meter->white_count, p->first);
    double unlit = fmax(mean_level(session, meter->white, meter->white_count, p->unlit),
                        mean_level(session, meter->opening, meter->opening_count, p->unlit));
    note(check, WEFT_CHECK_WHITE, white, view);
    note(check, WEFT_CHECK_WHITE_CLIPPED, share_at_full_scale(session, meter->white, meter->white_count, p->first),
         view);
    note(check, WEFT_CHECK_NOISE, relative_noise(session, meter->white, meter->white_count, p->first, p->second), view);
    if (p->brief_share < longest_brief && share_at_full_scale(session, meter->white, meter->white_count, p->first) == 0)
        note(check, WEFT_CHECK_LINEARITY, departure_from_linear(session, meter->white, meter->white_count, p), view);
    note(check, WEFT_CHECK_STRAY, unlit / fmax(white, 1e-6), view);
}

/* ---- The sensor ---- */

static double share_above(const uint16_t *samples, size_t pixels, double level)
{
    size_t above = 0;
    for (size_t i = 0; i < pixels; i++) {
        const uint16_t *s = samples + 3 * i;
        above += s[0] > level || s[1] > level || s[2] > level;
    }
    return (double)above / (double)pixels;
}

weft_code weft_preflight_measure_dark(const weft_session *session, weft_angles view, const uint16_t *samples,
                                      weft_preflight_check *check, weft_error *error)
{
    const double glow = 0.01;
    size_t pixels = (size_t)session->camera.width * (size_t)session->camera.height;
    double range = (1 << session->bits) - 1 - session->black_level;
    float *values = malloc(3 * pixels * sizeof *values);
    if (!values)
        return weft_fail_memory(error, "photograph", 3 * pixels * sizeof *values);
    for (size_t i = 0; i < 3 * pixels; i++)
        values[i] = samples[i];
    double median = (double)weft_quantile_of_floats(values, 3 * pixels, 0.5);
    free(values);
    note(check, WEFT_CHECK_DARK, (median - session->black_level) / range, view);
    note(check, WEFT_CHECK_HOT, share_above(samples, pixels, median + glow * range), view);
    return WEFT_OK;
}

/* ---- The plate ---- */

static void grey_of(const weft_session *session, const weft_sight *sight, const uint16_t *samples, float *grey)
{
    size_t pixels = (size_t)session->camera.width * (size_t)session->camera.height;
    for (size_t i = 0; i < pixels; i++) {
        const uint16_t *s = samples + 3 * i;
        grey[i] = (float)((s[0] + s[1] + s[2]) / 3.0 - session->black_level) * sight->inverse_vignetting[i] /
                  (float)((1 << session->bits) - 1);
    }
}

static weft_code find_plate(const weft_session *session, const weft_sight *sight, weft_angles view,
                            const uint16_t *samples, weft_view_pose *pose, weft_error *error)
{
    size_t bytes = (size_t)session->camera.width * (size_t)session->camera.height * sizeof(float);
    float *grey = malloc(bytes);
    if (!grey)
        return weft_fail_memory(error, "photograph", bytes);
    weft_pose predicted = weft_session_pose(session, view);
    weft_homography homography = weft_homography_of_pose(&session->camera, &predicted);
    grey_of(session, sight, samples, grey);
    weft_code code = weft_pose_find(sight, &session->target, grey, &homography, (weft_point_spread){0, 0}, &pose_limits,
                                    pose, error);
    free(grey);
    return code;
}

/* The widest point spread in the corners of the opening. */
static double widest_spread(const weft_sight *sight, const weft_view_pose *pose)
{
    const weft_plate_view view = weft_plate_view_of(&sight->camera, &pose->homography, &sight->bend);
    double widest = 0;
    for (int corner = 0; corner < 4; corner++) {
        double x = (corner & 1 ? 0.5 : -0.5) * sight->opening_mm, y = (corner & 2 ? 0.5 : -0.5) * sight->opening_mm;
        double out = 1 - 1 / weft_plate_view_depth(&view, x, y);
        widest = fmax(widest, pose->point_spread.constant + pose->point_spread.depth * out * out);
    }
    return sqrt(fmax(widest, 0));
}

/* RMS over the corners of the opening, pixels. */
static double moved_between(const weft_sight *sight, const weft_view_pose *a, const weft_view_pose *b)
{
    double squares = 0;
    for (int corner = 0; corner < 4; corner++) {
        double x = (corner & 1 ? 0.5 : -0.5) * sight->opening_mm, y = (corner & 2 ? 0.5 : -0.5) * sight->opening_mm;
        weft_pixel p = weft_homography_apply(&a->homography, x, y), q = weft_homography_apply(&b->homography, x, y);
        squares += (p.x - q.x) * (p.x - q.x) + (p.y - q.y) * (p.y - q.y);
    }
    return sqrt(squares / 4);
}

static weft_code measure_plate(const weft_session *session, const weft_sight *sight, weft_angles view, bool is_frontal,
                               const weft_preflight_photographs *p, weft_preflight_check *check, weft_error *error)
{
    weft_view_pose first, second;
    WEFT_TRY(find_plate(session, sight, view, p->first, &first, error));
    WEFT_TRY(find_plate(session, sight, view, p->second, &second, error));
    bool found = first.source == WEFT_POSE_DRAWING && second.source == WEFT_POSE_DRAWING;
    note(check, WEFT_CHECK_TARGET, found ? first.marker_count : 0, view);
    if (!found)
        return WEFT_OK;
    note(check, WEFT_CHECK_PLACE, first.shift_mm, view);
    note(check, is_frontal ? WEFT_CHECK_FOCUS : WEFT_CHECK_FOCUS_GRAZING, widest_spread(sight, &first), view);
    note(check, WEFT_CHECK_VIBRATION, moved_between(sight, &first, &second), view);
    return WEFT_OK;
}

weft_code weft_preflight_measure(const weft_session *session, const weft_sight *sight, int shot, bool is_frontal,
                                 const weft_preflight_photographs *photographs, weft_preflight_check *check,
                                 weft_error *error)
{
    weft_angles view = session->shot[shot].view;
    weft_meter meter;
    weft_code code = weft_meter_make(session, view, &meter, error);
    if (code == WEFT_OK) {
        measure_values(session, &meter, view, photographs, check);
        code = measure_plate(session, sight, view, is_frontal, photographs, check, error);
    }
    weft_meter_free(&meter);
    return code;
}
