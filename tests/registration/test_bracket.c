/* Brackets against light that is known: the sensor of the virtual rig photographs it, the camera's meter chooses the
 * exposures, registration merges them. The sensor's noise and that of the merge are both shot noise and read noise: no
 * camera has others. They share no code, and the merge is told the sensor's figures as a data sheet would. */
#include "btf/dataset/dataset.h"
#include "capture/exposure.h"
#include "capture/virtual/random.h"
#include "capture/virtual/sensor.h"
#include "registration/radiometry/bracket.h"
#include "registration/resample/resample.h"
#include "tests/support/cmocka_all.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SIZE = 160, SAMPLES = SIZE * SIZE * 3, FRAMES = 1 + WEFT_SESSION_MAX_BRACKETS };

static const weft_exposure_limits limits = {1.0 / 4000, 2};
static const double contrast = 1e4, sensitivity = 2e7;

typedef struct scene {
    weft_session session;
    weft_virtual_sensor sensor;
    weft_meter meter;
    float *radiance; /* [SAMPLES] */
    uint16_t *samples;
    weft_shot_record record;
    weft_bracket_frame frame[FRAMES];
    int count;
    float *value, *variance;
} scene;

/* Light over `contrast`, each sample its own, evenly in its logarithm. */
static void make_scene(scene *s, double read_noise_electrons)
{
    weft_virtual_settings settings = weft_virtual_settings_default();
    settings.read_noise_electrons = read_noise_electrons;
    *s = (scene){
        .session = {
            .camera =
                {.width = SIZE, .height = SIZE, .fx = 2200, .fy = 2200, .cx = (SIZE - 1) / 2.0, .cy = (SIZE - 1) / 2.0},
            .camera_distance_mm = 500,
            .bits = (int)settings.rig.bits,
            .black_level = (int)settings.rig.black_level,
            .target = weft_target_for_opening(32)}};
    assert_int_equal(weft_virtual_sensor_make(&settings, 0, &s->sensor, NULL), WEFT_OK);
    s->session.noise = (weft_sensor_noise){s->sensor.electrons_per_step, s->sensor.read_noise};
    assert_int_equal(weft_meter_make(&s->session, (weft_angles){0, 0}, &s->meter, NULL), WEFT_OK);
    s->radiance = malloc(SAMPLES * sizeof *s->radiance);
    s->samples = malloc((size_t)FRAMES * SAMPLES * sizeof *s->samples);
    s->value = malloc(SAMPLES * sizeof *s->value);
    s->variance = malloc(SAMPLES * sizeof *s->variance);
    assert_true(s->radiance && s->samples && s->value && s->variance);
    for (uint64_t i = 0; i < SAMPLES; i++)
        s->radiance[i] = (float)(pow(contrast, weft_random_uniform(3, WEFT_RANDOM_CLOTH, i)) / contrast);
}

static void free_scene(scene *s)
{
    weft_virtual_sensor_free(&s->sensor);
    weft_meter_free(&s->meter);
    free(s->radiance);
    free(s->samples);
    free(s->value);
    free(s->variance);
}

static void expose(const scene *s, int index, double exposure_s, double lamp)
{
    weft_virtual_sensor_read(&s->sensor, s->radiance, SAMPLES, sensitivity * exposure_s * lamp, exposure_s,
                             weft_random_bits(5, WEFT_RANDOM_NOISE, (uint64_t)index),
                             s->samples + (size_t)index * SAMPLES);
}

static void expose_first(scene *s)
{
    double exposure_s = 1.0 / 60, next_s = 0;
    for (int i = 0; i < 20 && next_s != exposure_s; i++) {
        exposure_s = next_s > 0 ? next_s : exposure_s;
        expose(s, 0, exposure_s, 1);
        next_s = weft_exposure_after(exposure_s, weft_meter_read(&s->meter, &s->session, s->samples), limits);
    }
    s->record.exposure_s = exposure_s;
}

/* The whole bracket, under a lamp that drifts by a factor from photograph to photograph. */
static void photograph(scene *s, int brackets, double drift)
{
    double lamp = 1, exposure_s;
    s->record = (weft_shot_record){0};
    expose_first(s);
    while (s->record.bracket_count < brackets &&
           (exposure_s = weft_exposure_of_bracket(&s->meter, &s->session, s->samples, &s->record, limits)) > 0) {
        lamp *= drift;
        s->record.bracket[s->record.bracket_count++].exposure_s = exposure_s;
        expose(s, s->record.bracket_count, exposure_s, lamp);
    }
    s->count = 1 + s->record.bracket_count;
    for (int i = 0; i < s->count; i++)
        s->frame[i] = (weft_bracket_frame){s->samples + (size_t)i * SAMPLES,
                                           i ? s->record.bracket[i - 1].exposure_s : s->record.exposure_s, 1};
    weft_bracket_compare(&s->session, s->frame, s->count, SAMPLES);
    weft_bracket_merge(&s->session, s->frame, s->count, SAMPLES, s->value, s->variance);
}

static double truth_of(const scene *s, int sample)
{
    return (double)s->radiance[sample] * sensitivity * s->record.exposure_s / (double)s->sensor.electrons_per_step;
}

static int compare_doubles(const void *a, const void *b)
{
    double p = *(const double *)a, q = *(const double *)b;
    return (p > q) - (p < q);
}

/* Relative errors of the samples that are not clipped, sorted; returns their number. */
static int errors_of(const scene *s, double *error)
{
    int count = 0;
    for (int i = 0; i < SAMPLES; i++) {
        if (isfinite(s->value[i]))
            error[count++] = fabs((double)s->value[i] / truth_of(s, i) - 1);
    }
    qsort(error, (size_t)count, sizeof *error, compare_doubles);
    return count;
}

static void a_bracket_shows_a_contrast_of_ten_thousand(void **state)
{
    (void)state;
    static double error[SAMPLES];
    scene s;
    make_scene(&s, 10);
    photograph(&s, WEFT_SESSION_MAX_BRACKETS, 1.02);
    int count = errors_of(&s, error);
    print_message("%d photographs: median error %.3f %%, 99th percentile %.3f %%, %d of %d samples clipped\n", s.count,
                  100 * error[count / 2], 100 * error[count * 99 / 100], SAMPLES - count, SAMPLES);
    assert_int_equal(count, SAMPLES);
    assert_true(error[count / 2] < 0.01);
    assert_true(error[count * 99 / 100] < 0.05);
    /* One photograph alone does not. */
    photograph(&s, 0, 1);
    count = errors_of(&s, error);
    assert_true(error[count / 2] > 0.01 && error[count * 99 / 100] > 0.3);
    free_scene(&s);
}

static void errors_are_as_large_as_the_variance_says(void **state)
{
    (void)state;
    scene s;
    make_scene(&s, 100);
    photograph(&s, WEFT_SESSION_MAX_BRACKETS, 1);
    for (int i = 0; i < s.count; i++) {
        assert_true(fabs(s.frame[i].gain - 1) < 0.003);
        s.frame[i].gain = 1;
    }
    weft_bracket_merge(&s.session, s.frame, s.count, SAMPLES, s.value, s.variance);
    double sum = 0, squares = 0;
    for (int i = 0; i < SAMPLES; i++) {
        double deviation = ((double)s.value[i] - truth_of(&s, i)) / sqrt((double)s.variance[i]);
        sum += deviation;
        squares += deviation * deviation;
    }
    assert_true(fabs(sum / SAMPLES) < 0.03);
    assert_true(fabs(squares / SAMPLES - 1) < 0.05);
    free_scene(&s);
}

static void a_photograph_that_is_not_of_its_exposure_is_left_out(void **state)
{
    (void)state;
    static double error[SAMPLES];
    scene s;
    make_scene(&s, 10);
    photograph(&s, WEFT_SESSION_MAX_BRACKETS, 1);
    int last = s.count - 1;
    assert_true(last > 1);
    s.frame[last].exposure_s *= 1.2;
    weft_bracket_compare(&s.session, s.frame, s.count, SAMPLES);
    assert_true(s.frame[last].gain == 0);
    weft_bracket_merge(&s.session, s.frame, s.count, SAMPLES, s.value, s.variance);
    assert_true(error[errors_of(&s, error) / 2] < 0.02);
    free_scene(&s);
}

/* One texel that is seen, of the whole photograph, and one that is not. */
static void what_clips_in_all_or_drowns_in_noise_is_masked(void **state)
{
    (void)state;
    int32_t pixel[2] = {0, 1};
    float weight[2] = {0.5f, 0.5f}, sum[2] = {1, 0}, texel[6];
    long first[3] = {0, 2, 2};
    uint8_t mask[2];
    const weft_resampler resampler = {
        .width = 2, .height = 1, .first = first, .pixel = pixel, .weight = weight, .sum = sum};
    float variance[6] = {4, 4, 4, 4, 4, 4}, bright[6] = {2, 2, 2, 2, 2, 2};
    const float clipped[6] = {2, 2, 2, 2, INFINITY, 2}, dark[6] = {0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f};
    weft_resampler_apply_merged(&resampler, bright, variance, texel, mask);
    assert_int_equal(mask[0], 0);
    assert_int_equal(mask[1], WEFT_MASK_MISSING);
    assert_true(texel[0] == 2);
    weft_resampler_apply_merged(&resampler, clipped, variance, texel, mask);
    assert_int_equal(mask[0], WEFT_MASK_SATURATED);
    /* The mean of six samples of variance 4 has the standard error 0.8. */
    weft_resampler_apply_merged(&resampler, dark, variance, texel, mask);
    assert_int_equal(mask[0], WEFT_MASK_DARK);
}

int test_bracket(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_bracket_shows_a_contrast_of_ten_thousand),
        cmocka_unit_test(errors_are_as_large_as_the_variance_says),
        cmocka_unit_test(a_photograph_that_is_not_of_its_exposure_is_left_out),
        cmocka_unit_test(what_clips_in_all_or_drowns_in_noise_is_masked),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
