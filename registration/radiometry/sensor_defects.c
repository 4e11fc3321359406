#include "registration/radiometry/sensor_defects.h"

#include "base/numeric/statistics.h"
#include "base/picture/image.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Of what is corrected. Noise below black stays above 0. */
enum { CORRECTED_BITS = 16, CORRECTED_BLACK = 2048 };

static size_t value_count(const weft_session *session)
{
    return (size_t)session->camera.width * (size_t)session->camera.height * 3;
}

/* ---- Means of frames ---- */

static weft_code add_frame(const weft_session *session, int frame, uint16_t *samples, float *sum, weft_error *error)
{
    char path[PATH_MAX];
    size_t count = value_count(session);
    weft_session_frame_path(session, frame, path, sizeof path);
    if (!session->frame[frame].taken)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' is missing: run the same weft capture again", path);
    WEFT_TRY(weft_photograph_read(path, session->camera.width, session->camera.height, session->bits, samples, error));
    for (size_t i = 0; i < count; i++)
        sum[i] += samples[i];
    return WEFT_OK;
}

static weft_code sum_frames(const weft_session *session, weft_frame_kind kind, uint16_t *samples, float *sum,
                            double *exposure_s, int *count, weft_error *error)
{
    *count = 0;
    *exposure_s = 0;
    for (int i = 0; i < weft_session_frame_count(session); i++) {
        if (weft_session_frame_kind(session, i) != kind)
            continue;
        WEFT_TRY(add_frame(session, i, samples, sum, error));
        *exposure_s += session->frame[i].exposure_s;
        (*count)++;
    }
    return WEFT_OK;
}

/* The mean of all frames of a kind, and of their exposures. The caller frees *mean. */
static weft_code mean_of_frames(const weft_session *session, weft_frame_kind kind, float **mean, double *exposure_s,
                                weft_error *error)
{
    size_t values = value_count(session);
    int count = 0;
    *mean = calloc(values, sizeof **mean);
    uint16_t *samples = malloc(values * sizeof *samples);
    weft_code code = *mean && samples ? sum_frames(session, kind, samples, *mean, exposure_s, &count, error)
                                      : weft_fail_memory(error, "frames of the sensor", values * sizeof **mean);
    free(samples);
    WEFT_TRY(code);
    *exposure_s /= count;
    for (size_t i = 0; i < values; i++)
        (*mean)[i] /= (float)count;
    return WEFT_OK;
}

/* Of the values of one channel; `scratch` holds as many. */
static double channel_quantile(const float *value, size_t count, size_t channel, double share, float *scratch)
{
    size_t taken = 0;
    for (size_t i = channel; i < count; i += 3)
        scratch[taken++] = value[i];
    return (double)weft_quantile_of_floats(scratch, taken, share);
}

/* ---- Without light ---- */

/* Two exposures of one length tell no rate: all is offset. */
static void separate(float *brief, float *lasting, double brief_s, double long_s, size_t count)
{
    const double least_ratio = 1.5;
    bool apart = long_s > least_ratio * brief_s;
    for (size_t i = 0; i < count; i++) {
        float rate = apart ? (lasting[i] - brief[i]) / (float)(long_s - brief_s) : 0;
        brief[i] = apart ? brief[i] - rate * (float)brief_s : (brief[i] + lasting[i]) / 2;
        lasting[i] = rate;
    }
}

static void mark_hot_channel(weft_sensor_defects *faults, size_t count, size_t channel, float *scratch)
{
    const double deviations = 8, normal = 1.4826, least_share = 0.001;
    double range = (1 << faults->bits) - 1 - faults->black_level;
    double median = channel_quantile(faults->dark, count, channel, 0.5, scratch);
    size_t taken = 0;
    for (size_t i = channel; i < count; i += 3)
        scratch[taken++] = fabsf(faults->dark[i] - (float)median);
    double spread = normal * (double)weft_quantile_of_floats(scratch, taken, 0.5);
    double beyond = fmax(deviations * spread, least_share * range / faults->summary.longest_s);
    for (size_t i = channel; i < count; i += 3)
        faults->blind[i / 3] |= (double)faults->dark[i] > median + beyond;
}

static weft_code find_dark(const weft_session *session, float *scratch, weft_sensor_defects *faults, weft_error *error)
{
    size_t count = value_count(session);
    double brief_s, long_s;
    if (session->dark_frames == 0)
        return WEFT_OK;
    WEFT_TRY(mean_of_frames(session, WEFT_FRAME_DARK_BRIEF, &faults->offset, &brief_s, error));
    WEFT_TRY(mean_of_frames(session, WEFT_FRAME_DARK_LONG, &faults->dark, &long_s, error));
    separate(faults->offset, faults->dark, brief_s, long_s, count);
    faults->summary.longest_s = long_s;
    for (size_t c = 0; c < 3; c++)
        mark_hot_channel(faults, count, c, scratch);
    for (size_t i = 0; i < count / 3; i++)
        faults->summary.hot += faults->blind[i];
    faults->summary.dark_rate = channel_quantile(faults->dark, count, 1, 0.5, scratch);
    return WEFT_OK;
}

/* ---- Under even light ---- */

static double dark_value(const weft_sensor_defects *faults, size_t i, double exposure_s)
{
    return faults->offset ? (double)faults->offset[i] + (double)faults->dark[i] * exposure_s : faults->black_level;
}

/* What is left of the field without its dark value and the declared vignetting. */
static void take_out_known(const weft_session *session, const weft_sensor_defects *faults, double exposure_s,
                           float *flat)
{
    const weft_camera *camera = &session->camera;
#pragma omp parallel for schedule(static)
    for (int y = 0; y < camera->height; y++) {
        for (int x = 0; x < camera->width; x++) {
            double vignetting = weft_camera_vignetting(camera, (weft_pixel){x, y});
            for (size_t c = 0; c < 3; c++) {
                size_t i = 3 * ((size_t)y * (size_t)camera->width + (size_t)x) + c;
                flat[i] = (float)(((double)flat[i] - dark_value(faults, i, exposure_s)) / vignetting);
            }
        }
    }
}

/* Frames that are clipped, or next to black, tell nothing of the response, and would spoil all photographs. */
static weft_code check_field(const weft_session *session, const float *flat, size_t count, float *scratch,
                             weft_error *error)
{
    const double clipped = 0.98, least = 0.05, most_clipped = 0.001;
    double range = (1 << session->bits) - 1 - session->black_level;
    for (size_t c = 0; c < 3; c++) {
        double median = (channel_quantile(flat, count, c, 0.5, scratch) - session->black_level) / range;
        double high = (channel_quantile(flat, count, c, 1 - most_clipped, scratch) - session->black_level) / range;
        if (high >= clipped || median < least)
            return weft_fail(
                error, WEFT_BAD_INPUT,
                "the flat frames of '%s' are too %s: half of channel %zu lies below %.1f %% of full scale, and "
                "99.9 %% below %.1f %%",
                session->folder, high >= clipped ? "bright" : "dark", c, 100 * median, 100 * high);
    }
    return WEFT_OK;
}

/* Makes a channel relative to its median, and marks what is dead. */
static weft_code relate(float *flat, size_t count, size_t channel, float *scratch, weft_sensor_defects *faults,
                        weft_error *error)
{
    const float least = 0.5f, most = 4;
    double median = channel_quantile(flat, count, channel, 0.5, scratch);
    if (!(median >= 1))
        return weft_fail(error, WEFT_BAD_INPUT, "the flat frames of '%s' are as dark as its dark frames",
                         faults->seen.folder);
    for (size_t i = channel; i < count; i += 3) {
        flat[i] = (float)((double)flat[i] / median);
        bool dead = !(flat[i] >= least && flat[i] <= most);
        faults->summary.dead += dead && !faults->blind[i / 3];
        faults->blind[i / 3] |= dead;
    }
    return WEFT_OK;
}

/* Means over the middle, a fifth of the picture wide, and over its outer tenth. */
static double fall_off_of(const weft_session *session, const weft_sensor_defects *faults, const float *flat)
{
    int width = session->camera.width, height = session->camera.height;
    double sum[2] = {0, 0};
    long count[2] = {0, 0};
    for (int y = 0; y < height; y++) {
        for (int x = 0; x < width; x++) {
            double u = fabs((x + 0.5) / width - 0.5), v = fabs((y + 0.5) / height - 0.5);
            size_t pixel = (size_t)y * (size_t)width + (size_t)x;
            int part = fmax(u, v) < 0.1 ? 0 : fmax(u, v) > 0.45 ? 1 : -1;
            if (part < 0 || faults->blind[pixel])
                continue;
            sum[part] += (double)flat[3 * pixel + 1];
            count[part]++;
        }
    }
    return count[0] > 0 && count[1] > 0 ? sum[1] / (double)count[1] / (sum[0] / (double)count[0]) - 1 : 0;
}

/* Of the green of the pixels that see. */
static void summarise(weft_sensor_defects *faults, const float *flat, size_t count, float *scratch)
{
    size_t taken = 0;
    for (size_t i = 0; i < count / 3; i++) {
        if (!faults->blind[i])
            scratch[taken++] = flat[3 * i + 1];
    }
    faults->summary.least = (double)weft_quantile_of_floats(scratch, taken, 0.001);
    faults->summary.most = (double)weft_quantile_of_floats(scratch, taken, 0.999);
}

/* The response of nearly the least that sees: what is corrected by it keeps within full scale. The few that respond
 * less count as clipped there a little early; by the very least, one speck of dust would dim all photographs. */
static float common_response(const weft_sensor_defects *faults)
{
    return faults->summary.flat_frames > 0 ? (float)fmin(faults->summary.least, 1) : 1;
}

static void invert(const weft_sensor_defects *faults, float *flat, size_t count)
{
    float least = common_response(faults);
    for (size_t i = 0; i < count; i++)
        flat[i] = faults->blind[i / 3] ? 1 : least / flat[i];
}

static weft_code find_response(const weft_session *session, float *scratch, weft_sensor_defects *faults,
                               weft_error *error)
{
    size_t count = value_count(session);
    double exposure_s;
    if (session->flat_frames == 0)
        return WEFT_OK;
    WEFT_TRY(mean_of_frames(session, WEFT_FRAME_FLAT, &faults->inverse, &exposure_s, error));
    WEFT_TRY(check_field(session, faults->inverse, count, scratch, error));
    take_out_known(session, faults, exposure_s, faults->inverse);
    for (size_t c = 0; c < 3; c++)
        WEFT_TRY(relate(faults->inverse, count, c, scratch, faults, error));
    summarise(faults, faults->inverse, count, scratch);
    faults->summary.fall_off = fall_off_of(session, faults, faults->inverse);
    invert(faults, faults->inverse, count);
    return WEFT_OK;
}

/* ---- All ---- */

static double scale_of(const weft_sensor_defects *faults)
{
    int full_scale = (1 << faults->bits) - 1, corrected = (1 << CORRECTED_BITS) - 2;
    return (double)(corrected - CORRECTED_BLACK) / (full_scale - faults->black_level);
}

static weft_code find_all(const weft_session *session, weft_sensor_defects *faults, weft_error *error)
{
    size_t count = value_count(session);
    faults->summary.dark_frames = session->dark_frames;
    faults->summary.flat_frames = session->flat_frames;
    faults->blind = calloc(count / 3, 1);
    float *scratch = malloc(count / 3 * sizeof *scratch);
    weft_code code = faults->blind && scratch ? find_dark(session, scratch, faults, error)
                                              : weft_fail_memory(error, "faults of the sensor", count * 2);
    if (code == WEFT_OK)
        code = find_response(session, scratch, faults, error);
    free(scratch);
    faults->seen.bits = CORRECTED_BITS;
    faults->seen.black_level = CORRECTED_BLACK;
    faults->seen.noise.electrons_per_value /= scale_of(faults) * (double)common_response(faults);
    return code;
}

weft_code weft_sensor_defects_find(const weft_session *session, weft_sensor_defects *faults, weft_error *error)
{
    *faults = (weft_sensor_defects){.seen = *session, .bits = session->bits, .black_level = session->black_level};
    return weft_session_frame_count(session) > 0 ? find_all(session, faults, error) : WEFT_OK;
}

void weft_sensor_defects_free(weft_sensor_defects *faults)
{
    free(faults->offset);
    free(faults->dark);
    free(faults->inverse);
    free(faults->blind);
    *faults = (weft_sensor_defects){0};
}

/* ---- Taking them out ---- */

static void correct(const weft_sensor_defects *faults, double exposure_s, size_t count, uint16_t *samples)
{
    const double scale = scale_of(faults), highest = (1 << CORRECTED_BITS) - 2;
    int full_scale = (1 << faults->bits) - 1;
    for (size_t i = 0; i < count; i++) {
        double inverse = faults->inverse ? (double)faults->inverse[i] : 1;
        double value = CORRECTED_BLACK + scale * inverse * (samples[i] - dark_value(faults, i, exposure_s));
        samples[i] = samples[i] >= full_scale || value > highest ? (uint16_t)((1 << CORRECTED_BITS) - 1)
                                                                 : (uint16_t)lrint(fmax(value, 0));
    }
}

weft_code weft_sensor_read(const weft_sensor_defects *faults, const char *path, double exposure_s, uint16_t *samples,
                           weft_error *error)
{
    const weft_camera *camera = &faults->seen.camera;
    WEFT_TRY(weft_photograph_read(path, camera->width, camera->height, faults->bits, samples, error));
    if (faults->blind)
        correct(faults, exposure_s, value_count(&faults->seen), samples);
    return WEFT_OK;
}

void weft_sensor_blind(const weft_sensor_defects *faults, weft_sight *sight)
{
    size_t pixels = (size_t)sight->camera.width * (size_t)sight->camera.height;
    for (size_t i = 0; faults->blind && i < pixels; i++) {
        if (faults->blind[i])
            sight->inverse_vignetting[i] = 0;
    }
}
