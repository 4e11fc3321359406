#include "capture/virtual/random.h"
#include "capture/virtual/sensor.h"
#include "tests/support/cmocka_all.h"

#include <omp.h>
#include <stdlib.h>
#include <string.h>

enum { COUNT = 1 << 19 };

static weft_virtual_sensor make_sensor(double full_well, double read_noise)
{
    weft_virtual_settings settings = weft_virtual_settings_default();
    settings.full_well_electrons = full_well;
    settings.read_noise_electrons = read_noise;
    weft_virtual_sensor sensor;
    assert_int_equal(weft_virtual_sensor_make(&settings, 0, &sensor, NULL), WEFT_OK);
    return sensor;
}

/* Mean and variance, in electrons, of what the sensor makes of uniform light; and the variance of rounding removed. */
static void read_uniform(const weft_virtual_sensor *sensor, double electrons, double *mean, double *variance)
{
    float *radiance = malloc(COUNT * sizeof *radiance);
    uint16_t *samples = malloc(COUNT * sizeof *samples);
    assert_true(radiance && samples);
    for (int i = 0; i < COUNT; i++)
        radiance[i] = (float)electrons;
    weft_virtual_sensor_read(sensor, radiance, COUNT, 1, 0, weft_random_bits(7, WEFT_RANDOM_NOISE, 1), samples);
    double sum = 0, squares = 0, step = sensor->electrons_per_step;
    for (int i = 0; i < COUNT; i++) {
        double value = (samples[i] - sensor->black_level) * step;
        sum += value;
        squares += value * value;
    }
    *mean = sum / COUNT;
    *variance = squares / COUNT - *mean * *mean - step * step / 12;
    free(radiance);
    free(samples);
}

static void variance_is_the_mean_plus_the_read_noise(void **state)
{
    (void)state;
    weft_virtual_sensor sensor = make_sensor(20000, 4);
    const double levels[] = {0, 100, 1000, 5000, 15000};
    for (int i = 0; i < 5; i++) {
        double mean, variance;
        read_uniform(&sensor, levels[i], &mean, &variance);
        assert_true(fabs(mean - levels[i]) < 0.3 + 0.001 * levels[i]);
        assert_true(fabs(variance / (levels[i] + 16) - 1) < 0.02);
    }
    weft_virtual_sensor_free(&sensor);
}

static void light_beyond_the_well_saturates_every_sample(void **state)
{
    (void)state;
    weft_virtual_sensor sensor = make_sensor(20000, 4);
    double mean, variance;
    read_uniform(&sensor, 25000, &mean, &variance);
    assert_true(fabs(mean - 20000) < 0.1);
    weft_virtual_sensor_free(&sensor);
}

static void noise_differs_from_frame_to_frame_and_sample_to_sample(void **state)
{
    (void)state;
    weft_virtual_sensor sensor = make_sensor(20000, 4);
    float *radiance = malloc(COUNT * sizeof *radiance);
    uint16_t *first = malloc(COUNT * sizeof *first), *second = malloc(COUNT * sizeof *second);
    assert_true(radiance && first && second);
    for (int i = 0; i < COUNT; i++)
        radiance[i] = 10000;
    weft_virtual_sensor_read(&sensor, radiance, COUNT, 1, 0, weft_random_bits(7, WEFT_RANDOM_NOISE, 1), first);
    weft_virtual_sensor_read(&sensor, radiance, COUNT, 1, 0, weft_random_bits(7, WEFT_RANDOM_NOISE, 2), second);
    double mean = 0, variance = 0, across_frames = 0, across_samples = 0;
    for (int i = 0; i < COUNT; i++)
        mean += (double)first[i] / COUNT;
    for (int i = 0; i < COUNT - 1; i++) {
        double a = first[i] - mean;
        variance += a * a;
        across_frames += a * (second[i] - mean);
        across_samples += a * (first[i + 1] - mean);
    }
    /* Three standard deviations of a correlation of independent samples. */
    assert_true(fabs(across_frames / variance) < 3 / sqrt(COUNT));
    assert_true(fabs(across_samples / variance) < 3 / sqrt(COUNT));
    free(radiance);
    free(first);
    free(second);
    weft_virtual_sensor_free(&sensor);
}

static void bytes_do_not_depend_on_the_number_of_threads(void **state)
{
    (void)state;
    weft_virtual_sensor sensor = make_sensor(20000, 4);
    float *radiance = malloc(COUNT * sizeof *radiance);
    uint16_t *one = malloc(COUNT * sizeof *one), *three = malloc(COUNT * sizeof *three);
    assert_true(radiance && one && three);
    for (int i = 0; i < COUNT; i++)
        radiance[i] = (float)(i % 30000);
    omp_set_num_threads(1);
    weft_virtual_sensor_read(&sensor, radiance, COUNT, 0.5, 0, 42, one);
    omp_set_num_threads(3);
    weft_virtual_sensor_read(&sensor, radiance, COUNT, 0.5, 0, 42, three);
    assert_memory_equal(one, three, COUNT * sizeof *one);
    free(radiance);
    free(one);
    free(three);
    weft_virtual_sensor_free(&sensor);
}

int test_sensor(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(variance_is_the_mean_plus_the_read_noise),
        cmocka_unit_test(light_beyond_the_well_saturates_every_sample),
        cmocka_unit_test(noise_differs_from_frame_to_frame_and_sample_to_sample),
        cmocka_unit_test(bytes_do_not_depend_on_the_number_of_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
