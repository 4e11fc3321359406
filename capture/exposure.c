#include "capture/exposure.h"

#include <stdlib.h>
#include <string.h>

const double weft_opening_aim = 0.8, weft_white_aim = 0.9;

static const double percentile = 0.995;

/* ---- Where to look ---- */

static bool inside(weft_rectangle r, double margin, double x, double y)
{
    return x > r.x0 + margin && x < r.x1 - margin && y > r.y0 + margin && y < r.y1 - margin;
}

static bool on_reference(const weft_target *target, double margin, double x, double y)
{
    for (int index = 0; index < WEFT_TARGET_REFERENCE_COUNT; index++) {
        if (inside(weft_target_reference(target, index), margin, x, y))
            return true;
    }
    return false;
}

static void place_pixel(const weft_target *target, weft_pixel plate, int pixel, weft_meter *meter)
{
    double half = target->opening_mm / 2, margin = target->opening_mm / 20;
    weft_rectangle opening = {-half, -half, half, half};
    if (inside(opening, margin, plate.x, plate.y))
        meter->opening[meter->opening_count++] = pixel;
    else if (on_reference(target, margin, plate.x, plate.y))
        meter->white[meter->white_count++] = pixel;
}

weft_code weft_meter_make(const weft_session *session, weft_angles view, weft_meter *meter, weft_error *error)
{
    const weft_camera *camera = &session->camera;
    size_t pixels = (size_t)camera->width * (size_t)camera->height;
    *meter = (weft_meter){.opening = malloc(pixels * sizeof(int)), .white = malloc(pixels * sizeof(int))};
    if (!meter->opening || !meter->white)
        return weft_fail_memory(error, "light meter", 2 * pixels * sizeof(int));
    weft_pose pose = weft_session_pose(session, view);
    weft_homography to_pixels = weft_homography_of_pose(camera, &pose);
    weft_homography to_plate = weft_homography_inverse(&to_pixels);
    for (int y = 0; y < camera->height; y++) {
        for (int x = 0; x < camera->width; x++) {
            weft_pixel undistorted = weft_camera_undistort(camera, (weft_pixel){x, y});
            weft_pixel plate = weft_homography_apply(&to_plate, undistorted.x, undistorted.y);
            place_pixel(&session->target, plate, y * camera->width + x, meter);
        }
    }
    if (meter->opening_count == 0)
        return weft_fail(error, WEFT_BAD_INPUT, "the camera sees nothing of the sample at theta %.1f, phi %.1f degrees",
                         weft_deg_of_rad(view.theta_rad), weft_deg_of_rad(view.phi_rad));
    return WEFT_OK;
}

void weft_meter_free(weft_meter *meter)
{
    free(meter->opening);
    free(meter->white);
    *meter = (weft_meter){0};
}

/* ---- Reading the meter ---- */

static uint16_t brightest(const uint16_t rgb[3])
{
    uint16_t two = rgb[0] > rgb[1] ? rgb[0] : rgb[1];
    return two > rgb[2] ? two : rgb[2];
}

/* The percentile of the brightest channel over some pixels, as a fraction of full scale above black. */
static double percentile_of(const int *pixels, int count, const weft_session *session, const uint16_t *samples)
{
    static _Thread_local int histogram[1 << 16];
    int full_scale = (1 << session->bits) - 1;
    memset(histogram, 0, ((size_t)full_scale + 1) * sizeof *histogram);
    for (int i = 0; i < count; i++) {
        int value = brightest(samples + 3 * (size_t)pixels[i]);
        histogram[value < full_scale ? value : full_scale]++;
    }
    int above = (int)((1 - percentile) * count), value = full_scale;
    for (int seen = histogram[value]; value > 0 && seen <= above; seen += histogram[--value])
        ;
    return fmax((double)(value - session->black_level) / (full_scale - session->black_level), 0);
}

double weft_meter_read(const weft_meter *meter, const weft_session *session, const uint16_t *samples)
{
    double opening = percentile_of(meter->opening, meter->opening_count, session, samples) / weft_opening_aim;
    if (meter->white_count == 0)
        return opening;
    return fmax(opening, percentile_of(meter->white, meter->white_count, session, samples) / weft_white_aim);
}

double weft_meter_white(const weft_meter *meter, const weft_session *session, const uint16_t *samples)
{
    double sum = 0;
    for (int i = 0; i < meter->white_count; i++)
        sum += samples[3 * (size_t)meter->white[i] + 1] - session->black_level;
    return meter->white_count ? sum / meter->white_count : 0;
}

/* ---- Choosing the exposure ---- */

double weft_exposure_in_thirds(double exposure_s, weft_exposure_limits limits)
{
    double limited = weft_clamp(exposure_s, limits.shortest_s, limits.longest_s);
    double series = exp2(floor(3 * log2(limited) + 1e-6) / 3);
    return fmax(series, limits.shortest_s);
}

double weft_exposure_after(double exposure_s, double level, weft_exposure_limits limits)
{
    const double tolerance = 1.03; /* of noise and drift of the light */
    if (level <= tolerance && level * exp2(1 / 3.0) * tolerance >= 1)
        return exposure_s;
    /* A clipped reading says only that the exposure is far too long; a black one that it is far too short. */
    double clipped = 0.99 / fmax(weft_opening_aim, weft_white_aim);
    double factor = level >= clipped ? 0.125 : 1 / fmax(level, 1 / 64.0);
    return weft_exposure_in_thirds(exposure_s * factor, limits);
}

double weft_exposure_taken(double asked_s, double read_back_s)
{
    const double rounding = 0.01;
    return fabs(read_back_s / asked_s - 1) < rounding ? asked_s : read_back_s;
}

/* ---- Brackets ---- */

static uint16_t darkest(const uint16_t rgb[3])
{
    uint16_t two = rgb[0] < rgb[1] ? rgb[0] : rgb[1];
    return two < rgb[2] ? two : rgb[2];
}

static bool clips(const weft_meter *meter, int full_scale, const uint16_t *samples)
{
    for (int i = 0; i < meter->opening_count; i++) {
        if (brightest(samples + 3 * (size_t)meter->opening[i]) >= full_scale)
            return true;
    }
    return false;
}

/* The 0.5th percentile of the darkest channel of the opening, above black. */
static int dark_value(const weft_meter *meter, const weft_session *session, const uint16_t *samples)
{
    static _Thread_local int histogram[1 << 16];
    int full_scale = (1 << session->bits) - 1, below = (int)((1 - percentile) * meter->opening_count), value = 0;
    memset(histogram, 0, ((size_t)full_scale + 1) * sizeof *histogram);
    for (int i = 0; i < meter->opening_count; i++)
        histogram[darkest(samples + 3 * (size_t)meter->opening[i])]++;
    for (int seen = histogram[0]; value < full_scale && seen <= below; seen += histogram[++value])
        ;
    return value - session->black_level;
}

/* The longest exposure of a shot, and which of its photographs that is. */
static double longest_of(const weft_shot_record *record, int *index)
{
    double longest_s = record->exposure_s;
    *index = 0;
    for (int i = 0; i < record->bracket_count; i++) {
        if (record->bracket[i].exposure_s > longest_s) {
            longest_s = record->bracket[i].exposure_s;
            *index = i + 1;
        }
    }
    return longest_s;
}

double weft_exposure_of_bracket(const weft_meter *meter, const weft_session *session, const uint16_t *samples,
                                const weft_shot_record *record, weft_exposure_limits limits)
{
    const double largest_step = 16, least_step = 1.5;
    int full_scale = (1 << session->bits) - 1, index;
    double aim = (full_scale - session->black_level) / 32.0, longest_s = longest_of(record, &index);
    if (record->bracket_count == 0 && clips(meter, full_scale, samples)) {
        double shorter_s = weft_exposure_in_thirds(record->exposure_s / 8, limits);
        if (shorter_s < record->exposure_s)
            return shorter_s;
    }
    size_t size = (size_t)session->camera.width * (size_t)session->camera.height * 3;
    double dark = fmax(dark_value(meter, session, samples + (size_t)index * size), 1);
    double longer_s = weft_exposure_in_thirds(longest_s * fmin(1.3 * aim / dark, largest_step), limits);
    return dark >= aim || longer_s < least_step * longest_s ? 0 : longer_s;
}
