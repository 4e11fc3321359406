#include "registration/steps.h"

#include "registration/radiometry/bracket.h"
#include "registration/resample/resample.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

/* One viewpoint at work. */
typedef struct job {
    const weft_rectifier *rectifier;
    const weft_viewpoint_photographs *photographs;
    const weft_white *estimated;
    weft_resampler resampler;
    weft_reference_pixels reference;
    float *shown;   /* NULL: nobody wants to see */
    int shown_shot; /* the shot in it, -1: none yet */
} job;

/* Memory of one thread. */
typedef struct bench {
    uint16_t *samples;
    uint16_t *bracket;       /* [WEFT_SESSION_MAX_BRACKETS] photographs; NULL until there is one */
    float *value, *variance; /* of a merged bracket, the same */
    float *texel;
    weft_half *half;
    uint8_t *mask;
} bench;

static size_t texel_count(const job *j)
{
    return (size_t)j->resampler.width * (size_t)j->resampler.height;
}

static bool bench_create(const job *j, bench *b)
{
    *b = (bench){0};
    b->samples = malloc(weft_photograph_sample_count(j->rectifier->session) * sizeof *b->samples);
    b->texel = malloc(texel_count(j) * 3 * sizeof *b->texel);
    b->half = malloc(texel_count(j) * 3 * sizeof *b->half);
    b->mask = malloc(texel_count(j));
    return b->samples && b->texel && b->half && b->mask;
}

static void bench_free(bench *b)
{
    free(b->samples);
    free(b->bracket);
    free(b->value);
    free(b->variance);
    free(b->texel);
    free(b->half);
    free(b->mask);
}

/* Keeps the photograph under the highest light; of equal ones the first, so that threads do not matter. */
static void show(job *j, int shot, const float *texel)
{
#pragma omp critical(weft_rectify_show)
    {
        const weft_shot *shots = j->rectifier->session->shot;
        double light = shots[shot].light.theta_rad;
        double best = j->shown_shot < 0 ? INFINITY : shots[j->shown_shot].light.theta_rad;
        if (light < best || (light == best && shot < j->shown_shot)) {
            memcpy(j->shown, texel, texel_count(j) * 3 * sizeof *texel);
            j->shown_shot = shot;
        }
    }
}

/* False where a value is beyond what half floats hold. */
static bool store_texel(const float *texel, weft_half *half)
{
    bool held = true;
    for (int c = 0; c < 3; c++) {
        half[c] = weft_half_of_float(texel[c]);
        held = held && isfinite(weft_float_of_half(half[c]));
    }
    return held;
}

static weft_code put(job *j, int shot, bench *b, weft_error *error)
{
    size_t texels = texel_count(j), saturated = 0;
    for (size_t i = 0; i < texels; i++) {
        if (!store_texel(b->texel + 3 * i, b->half + 3 * i))
            b->mask[i] |= WEFT_MASK_MISSING;
        saturated += b->mask[i] == WEFT_MASK_SATURATED;
    }
    j->rectifier->registration->saturated[shot] = (float)saturated / (float)texels;
    if (j->shown)
        show(j, shot, b->texel);
    return weft_dataset_writer_put_image(j->rectifier->writer, j->rectifier->first_image + shot, b->half, b->mask,
                                         error);
}

/* ---- Brackets ---- */

static weft_code provide_for_brackets(const weft_session *session, bench *b, weft_error *error)
{
    size_t samples = weft_photograph_sample_count(session);
    if (b->bracket)
        return WEFT_OK;
    b->bracket = malloc(WEFT_SESSION_MAX_BRACKETS * samples * sizeof *b->bracket);
    b->value = malloc(samples * sizeof *b->value);
    b->variance = malloc(samples * sizeof *b->variance);
    return b->bracket && b->value && b->variance ? WEFT_OK : weft_fail_memory(error, "brackets", samples * 16);
}

static weft_code read_brackets(const weft_sensor_defects *faults, int shot, const bench *b, weft_bracket_frame *frame,
                               weft_error *error)
{
    const weft_session *session = &faults->seen;
    const weft_shot_record *record = &session->record[shot];
    size_t samples = weft_photograph_sample_count(session);
    for (int i = 0; i < record->bracket_count; i++) {
        char path[PATH_MAX];
        uint16_t *to = b->bracket + (size_t)i * samples;
        weft_session_bracket_path(session, shot, i, path, sizeof path);
        WEFT_TRY(weft_sensor_read(faults, path, record->bracket[i].exposure_s, to, error));
        frame[i + 1] = (weft_bracket_frame){to, record->bracket[i].exposure_s, 1};
    }
    return WEFT_OK;
}

static weft_code resample_bracket(const job *j, int shot, const uint16_t *samples, bench *b, weft_error *error)
{
    const weft_session *session = j->rectifier->session;
    const weft_shot_record *record = &session->record[shot];
    size_t sample_count = weft_photograph_sample_count(session);
    weft_bracket_frame frame[1 + WEFT_SESSION_MAX_BRACKETS] = {{samples, record->exposure_s, 1}};
    WEFT_TRY(provide_for_brackets(session, b, error));
    WEFT_TRY(read_brackets(j->rectifier->faults, shot, b, frame, error));
    weft_bracket_compare(session, frame, 1 + record->bracket_count, sample_count);
    weft_bracket_merge(session, frame, 1 + record->bracket_count, sample_count, b->value, b->variance);
    weft_resampler_apply_merged(&j->resampler, b->value, b->variance, b->texel, b->mask);
    return WEFT_OK;
}

/* ---- Photographs ---- */

/* Rectifies photograph `index`; *done says whether it is in the dataset. */
static weft_code rectify_photograph(job *j, int index, bench *b, bool *done, weft_error *error)
{
    const weft_session *session = j->rectifier->session;
    int shot = j->photographs->shot[index];
    weft_white *white = &j->rectifier->registration->white[shot];
    weft_exposure exposure = weft_exposure_of(session, shot);
    *done = false;
    if (!j->photographs->usable[index] || white->patches > 0) /* the latter is in the dataset already */
        return WEFT_OK;
    const uint16_t *samples = b->samples;
    if (!weft_viewpoint_photographs_samples(j->photographs, index, b->samples))
        return WEFT_OK;
    *white = weft_white_measure(j->rectifier->sight, &session->target, &j->reference, samples, &exposure);
    if (white->patches == 0) {
        if (!j->estimated)
            return WEFT_OK;
        *white = j->estimated[shot];
    }
    if (session->record[shot].bracket_count > 0)
        WEFT_TRY(resample_bracket(j, shot, samples, b, error));
    else
        weft_resampler_apply(&j->resampler, samples, exposure.black_level, exposure.full_scale, b->texel, b->mask);
    weft_reflectance_of_raw(white, &exposure, &j->rectifier->sight->bend, session->target.opening_mm,
                            j->resampler.width, j->resampler.height, b->texel);
    weft_colour_apply(&session->colour, b->texel, (long)texel_count(j));
    *done = true;
    return put(j, shot, b, error);
}

static weft_code rectify_all(job *j, int *used, weft_error *error)
{
    weft_code result = WEFT_OK;
    int count = 0;
#pragma omp parallel reduction(+ : count)
    {
        bench b;
        weft_error own = {0};
        weft_code code = bench_create(j, &b) ? WEFT_OK : weft_fail_memory(&own, "resampling", texel_count(j) * 19);
#pragma omp for schedule(dynamic, 1)
        for (int i = 0; i < j->photographs->count; i++) {
            bool done = false;
            if (code == WEFT_OK)
                code = rectify_photograph(j, i, &b, &done, &own);
            count += done;
        }
        bench_free(&b);
        if (code != WEFT_OK) {
#pragma omp critical(weft_rectify_failure)
            {
                result = code;
                if (error)
                    *error = own;
            }
        }
    }
    *used += count;
    return result;
}

/* Two standard deviations of the point spread of the lens at the corner of the opening where it is widest, pixels. */
static double point_spread_reach(const weft_sight *sight, const weft_view_pose *pose)
{
    const weft_plate_view view = weft_plate_view_of(&sight->camera, &pose->homography, &sight->bend);
    double widest = 0;
    for (int corner = 0; corner < 4; corner++) {
        double x = sight->opening_mm * (corner % 2 - 0.5), y = sight->opening_mm * (corner / 2 - 0.5);
        double z = weft_plate_view_depth(&view, x, y);
        widest = fmax(widest, pose->point_spread.constant + pose->point_spread.depth * (1 - 1 / z) * (1 - 1 / z));
    }
    return 2 * sqrt(widest);
}

/* Its texels beside the frame are filled, so that each has a sample in one view at least: there it needs least. */
static bool is_most_frontal(const weft_survey *survey, int viewpoint)
{
    double theta_rad = fabs(survey->view[survey->viewpoint[viewpoint].view].theta_rad);
    for (int view = 0; view < survey->view_count; view++) {
        if (fabs(survey->view[view].theta_rad) < theta_rad)
            return false;
    }
    return true;
}

weft_code weft_rectify_viewpoint(const weft_rectifier *rectifier, int viewpoint,
                                 const weft_viewpoint_photographs *photographs, const weft_white *estimated,
                                 float *shown, weft_error *error)
{
    weft_registration *registration = rectifier->registration;
    const weft_view_pose *pose = &registration->pose[viewpoint];
    const weft_target *target = &rectifier->session->target;
    job j = {
        .rectifier = rectifier, .photographs = photographs, .estimated = estimated, .shown = shown, .shown_shot = -1};
    weft_resampling resampling = {&rectifier->sight->camera,
                                  rectifier->sight->inverse_vignetting,
                                  pose->homography,
                                  rectifier->sight->bend,
                                  target->opening_mm,
                                  point_spread_reach(rectifier->sight, pose),
                                  is_most_frontal(&registration->survey, viewpoint)};
    WEFT_TRY(weft_resampler_create(&resampling, registration->settings.width, registration->settings.height,
                                   &j.resampler, error));
    weft_code code = weft_reference_pixels_find(rectifier->sight, target, &pose->homography, pose->point_spread,
                                                &j.reference, error);
    if (code == WEFT_OK)
        code = rectify_all(&j, &registration->used[viewpoint], error);
    weft_reference_pixels_free(&j.reference);
    weft_resampler_free(&j.resampler);
    return code;
}
