/* Ten exposures of a palette of 300 colours on a monitor, by a phone (svbrdf-pipeline). The tone curve that two pairs
 * of them tell predicts the ratios of the others. Skipped without them. */
#include "base/picture/colour.h"
#include "base/picture/exif.h"
#include "registration/lamp/lamp.h"

#include "tests/support/cmocka_all.h"
#include "tests/support/expect_ok.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char *const folder = WEFT_SHARED "/real/phone-towel/colourcard";

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
    snprintf(path, sizeof path, "%s/%02d.jpg", folder, number);
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

int test_real_palette(void)
{
    if (access(folder, R_OK) != 0) {
        printf("skipped: no photographs in %s\n", folder);
        return 77;
    }
    const struct CMUnitTest tests[] = {cmocka_unit_test(two_pairs_of_exposures_predict_the_others)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
