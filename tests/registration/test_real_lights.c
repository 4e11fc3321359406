/* Highlights on real balls under known lamps: a mirror ball (Seitz, University of Washington) and a glossy one
 * (DiLiGenT, Shi et al. 2016); the tone curve of a phone. Skipped without them. */
#include "base/picture/colour.h"
#include "base/picture/exif.h"
#include "base/picture/image.h"
#include "base/text/csv.h"
#include "registration/lamp/lamp.h"

#include "tests/support/cmocka_all.h"
#include "tests/support/expect_ok.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char *const real = WEFT_SHARED "/real";

/* A ball of 20 mm, as an orthographic camera straight above shows it: one that is very far. */
typedef struct ball {
    weft_camera camera;
    weft_pose pose;
} ball;

static ball ball_of(int width, int height, double x, double y, double radius_px)
{
    const double far_mm = 1e5, focal = radius_px / 10 * (far_mm - 10);
    return (ball){.camera = {.width = width, .height = height, .fx = focal, .fy = focal, .cx = x, .cy = y},
                  .pose = {{{1, 0, 0}, {0, -1, 0}, {0, 0, -1}}, {0, 0, far_mm}}};
}

/* Angle between the lamp that the highlight tells and the true one, degrees; NaN where none is found. */
static double error_deg(const ball *b, const char *path, bool linear, weft_vec3 truth)
{
    weft_tone_curve tone = linear ? weft_tone_linear() : weft_tone_srgb();
    weft_light_values values;
    weft_error error = {0};
    assert_int_equal(weft_light_values_read(path, b->camera.width, b->camera.height, &tone,
                                            (weft_file_range){250.0f / 255, 5.0f / 255}, &values, &error),
                     WEFT_OK);
    const double place[2] = {0, 0};
    weft_highlight seen = weft_ball_highlight(&b->camera, &b->pose, &values, weft_vec3_of(place[0], place[1], 0), 20);
    weft_light_values_free(&values);
    if (!seen.found)
        return NAN;
    weft_vec3 eye = weft_pose_camera_position(&b->pose), offset = weft_subtract(eye, weft_vec3_of(0, 0, 10));
    double half = weft_dot(offset, seen.ray), root = half * half - weft_dot(offset, offset) + 100;
    weft_vec3 normal = weft_scale(weft_add(offset, weft_scale(seen.ray, -half - sqrt(root))), 0.1);
    weft_vec3 light = weft_subtract(seen.ray, weft_scale(normal, 2 * weft_dot(seen.ray, normal)));
    return weft_deg_of_rad(acos(fmin(1, weft_dot(weft_unit(light), weft_unit(truth)))));
}

static void highlights_on_a_mirror_ball_tell_the_lamps(void **state)
{
    (void)state;
    enum { COUNT = 12 };
    char path[256];
    snprintf(path, sizeof path, "%s/lights-chrome-ball/lights.txt", real);
    FILE *lights = fopen(path, "r");
    int count;
    assert_true(lights && fscanf(lights, "%d", &count) == 1 && count == COUNT);
    ball b = ball_of(512, 340, 253.5, 191.0, 119.25);
    double sum = 0, most = 0;
    for (int i = 0; i < COUNT; i++) {
        double x, y, z;
        assert_int_equal(fscanf(lights, "%lf %lf %lf", &x, &y, &z), 3);
        snprintf(path, sizeof path, "%s/lights-chrome-ball/chrome.%d.png", real, i);
        double off = error_deg(&b, path, false, weft_vec3_of(x, -y, z)); /* the file's y points down */
        printf("chrome.%d: %.2f degrees\n", i, off);
        assert_true(isfinite(off));
        sum += off, most = fmax(most, off);
    }
    fclose(lights);
    printf("mirror ball: mean %.2f, largest %.2f degrees\n", sum / COUNT, most);
    assert_true(sum / COUNT < 4 && most < 9); /* the list is an estimate from these photographs itself */
}

static void highlights_on_a_glossy_ball_tell_the_lamps(void **state)
{
    (void)state;
    char path[256];
    snprintf(path, sizeof path, "%s/lights-diligent-ball/lights.csv", real);
    weft_csv table;
    assert_int_equal(weft_csv_read(path, true, &table, NULL), WEFT_OK);
    ball b = ball_of(152, 152, 75.86, 75.88, 70.9);
    double most = 0, sum = 0;
    int found = 0;
    for (int row = 0; row < table.row_count; row++) {
        double l[3];
        for (int i = 0; i < 3; i++)
            assert_int_equal(weft_csv_number(&table, row, 1 + i, &l[i], NULL), WEFT_OK);
        snprintf(path, sizeof path, "%s/lights-diligent-ball/%s", real, weft_csv_text(&table, row, 0));
        double off = error_deg(&b, path, true, weft_vec3_of(l[0], l[1], l[2]));
        if (isfinite(off))
            found++, sum += off, most = fmax(most, off);
    }
    printf("glossy ball: %d of %d found, mean %.2f, largest %.2f degrees\n", found, table.row_count, sum / found, most);
    assert_true(found > 0 && sum / found < 1.5);
    weft_csv_free(&table);
}

/* ---- Ten exposures of a palette of 300 colours on a monitor, by a phone (svbrdf-pipeline) ---- */

/* 20 x 15 patches of 40 x 40 pixels, of which the middle counts. From 1/6 s on the monitor dazzles the phone. */
enum { EXPOSURES = 7, COLUMNS = 20, ROWS = 15, PATCH = 40, MIDDLE = 10, PATCHES = COLUMNS * ROWS };

static bool is_read(const weft_light_values *values, int patch, float light[3])
{
    int x0 = patch % COLUMNS * PATCH + (PATCH - MIDDLE) / 2, y0 = patch / COLUMNS * PATCH + (PATCH - MIDDLE) / 2;
    double sum[3] = {0, 0, 0};
    for (int i = 0; i < MIDDLE * MIDDLE; i++) {
        const uint16_t *s = values->samples + 3 * ((long)(y0 + i / MIDDLE) * values->width + x0 + i % MIDDLE);
        for (int c = 0; c < 3; c++) {
            if (s[c] == WEFT_PHOTOGRAPHS_FULL_SCALE)
                return false;
            sum[c] += s[c];
        }
    }
    bool bright = true;
    for (int c = 0; c < 3; c++) {
        light[c] = (float)(sum[c] / (MIDDLE * MIDDLE * (double)WEFT_PHOTOGRAPHS_FULL_SCALE));
        bright = bright && light[c] >= values->dark;
    }
    return bright;
}

/* What photograph `number` from 1 shows of the patches, decoded as sRGB, and the logarithm of its exposure. */
static double photograph(int number, weft_paper_samples *samples)
{
    char path[512];
    weft_exif exif;
    weft_light_values values;
    weft_error error = {0};
    weft_tone_curve tone = weft_tone_srgb();
    snprintf(path, sizeof path, "%s/phone-towel/colourcard/%02d.jpg", real, number);
    expect_ok(weft_exif_read(path, &exif, &error), &error);
    expect_ok(weft_light_values_read(path, exif.width, exif.height, &tone, weft_file_range_of(&exif, 250.0 / 255),
                                     &values, &error),
              &error);
    assert_int_equal(values.width, COLUMNS * PATCH);
    *samples = (weft_paper_samples){.sample = calloc(PATCHES, sizeof *samples->sample)};
    for (int patch = 0; patch < PATCHES; patch++) {
        samples->sample[samples->count].place = patch;
        samples->count += is_read(&values, patch, samples->sample[samples->count].light);
    }
    weft_light_values_free(&values);
    return log(weft_exif_exposure(&exif));
}

static double log_light(float light, const double tone[WEFT_TONE_TERMS])
{
    double basis[WEFT_TONE_TERMS], slope[WEFT_TONE_TERMS], sum = log((double)light);
    weft_tone_basis((double)weft_srgb_of_linear(light), basis, slope);
    for (int k = 0; k < WEFT_TONE_TERMS; k++)
        sum += tone[k] * basis[k];
    return sum;
}

static int by_value(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Median over patches and channels of the logarithm of their ratio under a tone curve; *count of how many. */
static double log_ratio(const weft_paper_samples *dark, const weft_paper_samples *bright,
                        const double tone[WEFT_TONE_TERMS], int *count)
{
    double ratio[3 * PATCHES];
    *count = 0;
    for (int i = 0, k = 0; i < dark->count && k < bright->count;) {
        const weft_paper_sample *a = &dark->sample[i], *b = &bright->sample[k];
        i += a->place <= b->place;
        k += b->place <= a->place;
        for (int c = 0; c < 3 && a->place == b->place; c++)
            ratio[(*count)++] = log_light(b->light[c], tone) - log_light(a->light[c], tone);
    }
    qsort(ratio, (size_t)*count, sizeof *ratio, by_value);
    return *count ? ratio[*count / 2] : 0;
}

static void two_pairs_of_exposures_predict_the_others(void **state)
{
    (void)state;
    char path[512];
    snprintf(path, sizeof path, "%s/phone-towel", real);
    if (access(path, R_OK) != 0)
        skip();
    weft_lamp_evidence evidence[EXPOSURES];
    double exposure[EXPOSURES], tone[WEFT_TONE_TERMS], flat[WEFT_TONE_TERMS] = {0}, worst = 0, worst_srgb = 0;
    weft_error error = {0};
    int compared = 0;
    memset(evidence, 0, sizeof evidence);
    for (int i = 0; i < EXPOSURES; i++)
        exposure[i] = photograph(i + 1, &evidence[i].paper);
    const weft_exposure_pair pair[2] = {{4, 3, exposure[4] - exposure[3]}, {5, 4, exposure[5] - exposure[4]}};
    const weft_lamp_problem problem = {.count = EXPOSURES, .evidence = evidence, .pair_count = 2, .pair = pair};
    expect_ok(weft_tone_of_pairs(&problem, tone, &error), &error);
    for (int a = 0; a < EXPOSURES; a++) {
        for (int b = a + 1; b < EXPOSURES; b++) {
            int count;
            double written = exposure[b] - exposure[a];
            double found = log_ratio(&evidence[a].paper, &evidence[b].paper, tone, &count);
            double srgb = log_ratio(&evidence[a].paper, &evidence[b].paper, flat, &count);
            if (count < 60)
                continue;
            print_message("%d and %d, %d values: %.2f stops, %.2f as sRGB, %.2f written\n", a + 1, b + 1, count,
                          found / log(2), srgb / log(2), written / log(2));
            worst = fmax(worst, fabs(found - written)), worst_srgb = fmax(worst_srgb, fabs(srgb - written));
            compared++;
        }
    }
    for (int i = 0; i < EXPOSURES; i++)
        free(evidence[i].paper.sample);
    print_message("%d ratios: at most %.0f %% off, %.0f %% as sRGB\n", compared, 100 * worst, 100 * worst_srgb);
    assert_true(compared >= 12);
    assert_true(worst < 0.25 && worst_srgb > 1);
}

int test_real_lights(void)
{
    char path[256];
    snprintf(path, sizeof path, "%s/lights-chrome-ball", real);
    if (access(path, R_OK) != 0) {
        puts("skipped: the photographs of balls are not there");
        return 77;
    }
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(highlights_on_a_mirror_ball_tell_the_lamps),
        cmocka_unit_test(highlights_on_a_glossy_ball_tell_the_lamps),
        cmocka_unit_test(two_pairs_of_exposures_predict_the_others),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
