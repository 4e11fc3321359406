#include "registration/viewpoint_photographs.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* A photograph counts as black when fewer than this fraction of its pixels exceed this fraction of full scale. A glint
 * on the sample may leave the rest of a photograph quite dark. */
static const double lit_fraction = 0.0003, lit_level = 0.02;

/* Sums over the photographs, in integers, so that their order does not matter. */
typedef struct sums {
    int64_t *light; /* raw values above black, over the channels and the photographs where the pixel is not saturated */
    int64_t *brightness; /* of those photographs */
} sums;

enum { brightness_scale = 16 };

size_t weft_photograph_sample_count(const weft_session *session)
{
    return (size_t)session->camera.width * (size_t)session->camera.height * 3;
}

/* Mean over the pixels of the sum of the channels above black, times brightness_scale; 0 for a black photograph. */
static int64_t brightness_of(const weft_session *session, const uint16_t *samples)
{
    size_t pixels = weft_photograph_sample_count(session) / 3, lit = 0;
    int full = (1 << session->bits) - 1;
    int64_t sum = 0;
    int threshold = 3 * session->black_level + (int)(3 * lit_level * (full - session->black_level));
    for (size_t i = 0; i < pixels; i++) {
        int value = samples[3 * i] + samples[3 * i + 1] + samples[3 * i + 2];
        lit += value > threshold;
        sum += value;
    }
    sum -= (int64_t)pixels * 3 * session->black_level;
    return (double)lit < lit_fraction * (double)pixels || sum <= 0 ? 0 : brightness_scale * sum / (int64_t)pixels;
}

static void add_photograph(const weft_session *session, const uint16_t *samples, int64_t brightness, sums *sum)
{
    size_t pixels = weft_photograph_sample_count(session) / 3;
    int full = (1 << session->bits) - 1, black = 3 * session->black_level;
    for (size_t i = 0; i < pixels; i++) {
        const uint16_t *s = samples + 3 * i;
        if (s[0] < full && s[1] < full && s[2] < full) {
            sum->light[i] += s[0] + s[1] + s[2] - black;
            sum->brightness[i] += brightness;
        }
    }
}

static weft_code read_one(const weft_sensor_defects *faults, int shot, uint16_t *samples, int64_t *brightness,
                          weft_fault *fault)
{
    const weft_session *session = &faults->seen;
    char path[PATH_MAX];
    weft_error error = {0};
    weft_session_photograph_path(session, shot, path, sizeof path);
    weft_code code = weft_sensor_read(faults, path, session->record[shot].exposure_s, samples, &error);
    *brightness = code == WEFT_OK ? brightness_of(session, samples) : 0;
    if (code != WEFT_OK)
        snprintf(fault->reason, sizeof fault->reason, "%.*s", (int)sizeof fault->reason - 1, error.message);
    else if (*brightness == 0)
        snprintf(fault->reason, sizeof fault->reason, "'%.150s' is black", path);
    return code != WEFT_OK || *brightness > 0 ? code : WEFT_BAD_INPUT;
}

static void finish_average(const weft_sight *sight, const sums *sum, float *average)
{
    size_t pixels = (size_t)sight->camera.width * (size_t)sight->camera.height;
    for (size_t i = 0; i < pixels; i++) {
        double mean = sum->brightness[i] > 0
                          ? (double)brightness_scale * (double)sum->light[i] / (double)sum->brightness[i]
                          : NAN;
        bool is_blind = sight->inverse_vignetting[i] == 0;
        average[i] = is_blind ? NAN : (float)(mean * sight->inverse_vignetting[i]);
    }
}

/* Reads, judges and sums all photographs. */
static weft_code read_all(weft_viewpoint_photographs *photographs, sums *sum, weft_fault *fault, weft_error *error)
{
    const weft_session *session = &photographs->faults->seen;
    size_t bytes = weft_photograph_sample_count(session) * sizeof(uint16_t);
    bool short_of_memory = false;
#pragma omp parallel reduction(|| : short_of_memory)
    {
        uint16_t *samples = malloc(bytes);
        short_of_memory = !samples;
#pragma omp for schedule(dynamic, 1)
        for (int i = 0; i < photographs->count; i++) {
            int shot = photographs->shot[i];
            int64_t brightness;
            if (short_of_memory || read_one(photographs->faults, shot, samples, &brightness, &fault[shot]) != WEFT_OK)
                continue;
            photographs->usable[i] = 1;
#pragma omp critical(weft_viewpoint_photographs_sum)
            add_photograph(session, samples, brightness, sum);
        }
        free(samples);
    }
    return short_of_memory ? weft_fail_memory(error, "the photographs of a viewpoint", bytes) : WEFT_OK;
}

weft_code weft_viewpoint_photographs_read(const weft_sensor_defects *faults, const weft_sight *sight,
                                          const weft_viewpoint *viewpoint, weft_fault *fault,
                                          weft_viewpoint_photographs *photographs, weft_error *error)
{
    const weft_session *session = &faults->seen;
    size_t count = (size_t)viewpoint->count, pixels = weft_photograph_sample_count(session) / 3;
    *photographs = (weft_viewpoint_photographs){.faults = faults, .count = viewpoint->count, .shot = viewpoint->shot};
    photographs->usable = calloc(count, 1);
    photographs->average = malloc(pixels * sizeof(float));
    sums sum = {calloc(pixels, sizeof *sum.light), calloc(pixels, sizeof *sum.brightness)};
    weft_code code = WEFT_OK;
    if (!photographs->usable || !photographs->average || !sum.light || !sum.brightness)
        code = weft_fail_memory(error, "the average of a viewpoint", pixels * 20);
    if (code == WEFT_OK)
        code = read_all(photographs, &sum, fault, error);
    if (code == WEFT_OK) {
        finish_average(sight, &sum, photographs->average);
        for (int i = 0; i < viewpoint->count; i++)
            photographs->usable_count += photographs->usable[i];
    }
    free(sum.light);
    free(sum.brightness);
    if (code != WEFT_OK)
        weft_viewpoint_photographs_free(photographs);
    return code;
}

void weft_viewpoint_photographs_free(weft_viewpoint_photographs *photographs)
{
    free(photographs->usable);
    free(photographs->average);
    *photographs = (weft_viewpoint_photographs){0};
}

bool weft_viewpoint_photographs_samples(const weft_viewpoint_photographs *photographs, int index, uint16_t *samples)
{
    const weft_session *session = &photographs->faults->seen;
    int shot = photographs->shot[index];
    char path[PATH_MAX];
    weft_session_photograph_path(session, shot, path, sizeof path);
    return weft_sensor_read(photographs->faults, path, session->record[shot].exposure_s, samples, NULL) == WEFT_OK;
}
