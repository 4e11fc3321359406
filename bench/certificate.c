/* Whether the certificate of a material covers what it says, on directions that neither the fit nor the certificate
 * has seen: `bench_certificate NAME.btf.h5 lobes|components [SIDE]`, of at most SIDE x SIDE texels of the middle (32).
 * A further split of the dataset is left out of both; of fewer than 24 images each in turn. Components are seen through
 * the heights of the dataset where weft compress keeps them. A level of the material is asked for the means of
 * photographs over its texels; through heights means of level 0 are. Prints one row of comma-separated values a level:
 * at its end the quantile of the certificate and the one that was needed. */
#include "base/half.h"
#include "base/numeric/statistics.h"
#include "compress/hold_out/certify.h"
#include "compress/hold_out/hold_out.h"
#include "evaluate/error/coverage.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { SIDE = 32, TEST_SPLIT = 2, SHOWN_LEVELS = 6 };

typedef struct testing {
    const char *name, *model;
    int side;
    weft_compress_options options;
    weft_texel_subset subset;
    weft_splits splits;
    bool through_heights; /* the last fit */
    size_t count[SHOWN_LEVELS];
    weft_covered *covered[SHOWN_LEVELS];
    double quantile[SHOWN_LEVELS]; /* of the last certificate */
} testing;

/* ---- What a level says ---- */

/* Residuals of level `from` of a subset, as of level `level` of the material. */
static weft_code put_level(testing *t, const weft_residuals *residuals, int from, int level,
                           const weft_certificate *certificate, weft_error *error)
{
    size_t count = residuals->count[from];
    weft_covered *grown = realloc(t->covered[level], (t->count[level] + count + 1) * sizeof *grown);
    if (!grown)
        return weft_fail_memory(error, "samples", count * sizeof *grown);
    t->covered[level] = grown;
    t->quantile[level] =
        certificate->level[level < certificate->level_count ? level : certificate->level_count - 1].quantile;
    for (size_t i = 0; i < count; i++) {
        const weft_residual *r = &residuals->value[from][i];
        weft_vec3 light = weft_direction_of_angles((weft_angles){weft_rad_of_deg(15 * r->light), 0}),
                  view = weft_direction_of_angles((weft_angles){weft_rad_of_deg(15 * r->view), 0});
        double half_width = weft_certificate_half_width(certificate, level, (double)r->prediction, light, view);
        grown[t->count[level]++] =
            (weft_covered){{r->prediction + r->error, r->prediction}, (float)half_width, r->view, r->light};
    }
    return WEFT_OK;
}

/* Levels `level` and, of means of these texels, `more` coarser ones. */
static weft_code ask_levels(testing *t, const weft_texel_subset *subset, int level, int more, const uint8_t *held,
                            const weft_material *material, const weft_certificate *certificate, weft_error *error)
{
    weft_trial trial = {0};
    weft_predictor *predictor = NULL;
    weft_asked_samples asked = {0}, none = {0};
    weft_residuals residuals = {0};
    const weft_residuals_taken taken = {.most = 1 << 22, .last_level = more};
    weft_code code = weft_trial_create(subset, held, held, &trial, error);
    if (code == WEFT_OK)
        code = weft_predictor_of_window(&subset->layout, &subset->window, material, &predictor, error);
    if (code == WEFT_OK)
        code = weft_trial_ask(&trial, predictor, &asked, &none, error);
    if (code == WEFT_OK)
        code = weft_residuals_add(&residuals, subset, &asked, NULL, &taken, error);
    for (int k = 0; code == WEFT_OK && k < residuals.level_count && level + k < SHOWN_LEVELS; k++)
        code = put_level(t, &residuals, k, level + k, certificate, error);
    weft_residuals_free(&residuals);
    weft_asked_samples_free(&asked);
    weft_asked_samples_free(&none);
    weft_predictor_free(predictor);
    weft_trial_free(&trial);
    return code;
}

/* Mean of what is not masked of four texels, into the sample `at` of the coarser subset. */
static void average(const weft_texel_subset *fine, const size_t texel[4], size_t image, weft_texel_subset *coarse,
                    size_t at)
{
    double sum[3] = {0};
    int count = 0;
    for (int i = 0; i < 4; i++) {
        size_t from = texel[i] * (size_t)fine->layout.image_count + image;
        for (size_t c = 0; c < 3 && !fine->mask[from]; c++)
            sum[c] += (double)weft_float_of_half(fine->samples[3 * from + c]);
        count += !fine->mask[from];
    }
    coarse->mask[at] = count == 0;
    for (size_t c = 0; c < 3; c++)
        coarse->samples[3 * at + c] = weft_half_of_float((float)(sum[c] / fmax(1, count)));
}

/* Texels of the next level, of an even number of texels along each side. */
static weft_code halve(const weft_texel_subset *fine, weft_texel_subset *coarse, weft_error *error)
{
    const weft_dataset_layout *from = &fine->layout;
    size_t width = (size_t)from->width / 2, height = (size_t)from->height / 2, images = (size_t)from->image_count;
    *coarse = (weft_texel_subset){.layout = {.width = (int)width,
                                             .height = (int)height,
                                             .image_count = from->image_count,
                                             .view_count = from->view_count,
                                             .values = from->values,
                                             .distance = from->distance,
                                             .texel_pitch_mm = 2 * from->texel_pitch_mm,
                                             .texel_aspect = from->texel_aspect},
                                  .window = {0, 0, (int)width, (int)height},
                                  .neighbours = 1,
                                  .samples = malloc(3 * width * height * images * sizeof(weft_half)),
                                  .mask = malloc(width * height * images)};
    WEFT_TRY(weft_dataset_layout_allocate(&coarse->layout, error));
    if (!coarse->samples || !coarse->mask)
        return weft_fail_memory(error, "samples", 7 * width * height * images);
    memcpy(coarse->layout.light, from->light, images * sizeof *from->light);
    memcpy(coarse->layout.view_of_image, from->view_of_image, images * sizeof *from->view_of_image);
    memcpy(coarse->layout.view, from->view, (size_t)from->view_count * sizeof *from->view);
    for (size_t texel = 0; texel < width * height; texel++) {
        size_t first = 4 * width * (texel / width) + 2 * (texel % width);
        const size_t four[4] = {first, first + 1, first + 2 * width, first + 2 * width + 1};
        for (size_t image = 0; image < images; image++)
            average(fine, four, image, coarse, texel * images + image);
    }
    return WEFT_OK;
}

static weft_code ask_coarser(testing *t, weft_texel_subset *subset, int level, const uint8_t *held,
                             weft_material *material, const weft_certificate *certificate, weft_error *error)
{
    weft_texel_subset coarse = {0};
    bool has_coarser = subset->layout.width >= 4 && subset->layout.width % 2 == 0 && subset->layout.height >= 4 &&
                       subset->layout.height % 2 == 0;
    WEFT_TRY(ask_levels(t, subset, level, 0, held, material, certificate, error));
    if (level + 1 == SHOWN_LEVELS || !has_coarser)
        return WEFT_OK;
    weft_material_drop_finest(material);
    weft_code code = halve(subset, &coarse, error);
    if (code == WEFT_OK)
        code = ask_coarser(t, &coarse, level + 1, held, material, certificate, error);
    weft_texel_subset_free(&coarse);
    return code;
}

/* The material loses its levels. */
static weft_code ask(testing *t, const uint8_t *held, weft_material *material, const weft_certificate *certificate,
                     weft_error *error)
{
    return t->through_heights ? ask_levels(t, &t->subset, 0, SHOWN_LEVELS - 1, held, material, certificate, error)
                              : ask_coarser(t, &t->subset, 0, held, material, certificate, error);
}

/* ---- The test ---- */

/* Fit and certificate of what is left. */
static weft_code test_split(testing *t, int split, weft_error *error)
{
    const uint8_t *held = weft_splits_held(&t->splits, split);
    weft_dataset *others;
    weft_hold_out result;
    weft_material material = {0};
    int splits;
    WEFT_TRY(weft_texel_subset_write_with_surface(&t->subset, held, "bench-certificate.btf.h5", &others, error));
    weft_compress_options options = weft_compress_settle(&t->options, others);
    weft_code code = weft_hold_out_enough_splits(weft_dataset_get_layout(others), &splits, error);
    if (code == WEFT_OK)
        code = weft_hold_out_measure(others, &options, splits, "bench-certificate-split.btf.h5", NULL, &result, error);
    if (code == WEFT_OK)
        code = weft_compress(others, &options, NULL, &material, NULL, error);
    t->through_heights = code == WEFT_OK && result.heights.used;
    if (t->through_heights)
        code = weft_texel_subset_give_heights(&t->subset, &material, error);
    else
        weft_material_take_heights(&material, NULL);
    if (code == WEFT_OK)
        code = ask(t, held, &material, &result.certificate, error);
    weft_material_free(&material);
    weft_dataset_close(others);
    return code;
}

static void say_shares(const weft_coverage_share share[WEFT_RING_COUNT])
{
    for (int ring = 0; ring < WEFT_RING_COUNT; ring++) {
        if (share[ring].count > 0)
            printf(",%.1f", 100 * share[ring].covered);
        else
            printf(",");
    }
}

/* By what the interval of a level is too wide: the quantile of the errors in half widths. */
static double needed_share(const testing *t, int level)
{
    size_t count = t->count[level];
    float *share = malloc(count * sizeof *share);
    for (size_t i = 0; share && i < count; i++) {
        const weft_covered *c = &t->covered[level][i];
        share[i] = fabsf(c->value.sample - c->value.prediction) / fmaxf(c->half_width, 1e-20f);
    }
    double needed = share ? (double)weft_quantile_of_floats(share, count, 0.95) : 0;
    free(share);
    return needed;
}

static weft_code say(const testing *t, weft_error *error)
{
    for (int level = 0; level < SHOWN_LEVELS && t->count[level] > 0; level++) {
        weft_coverage coverage;
        WEFT_TRY(weft_coverage_of(t->covered[level], t->count[level], &coverage, error));
        printf("%s,%s%s,%d,%ld,%.2f,%.1f,%.1f,%.3f,%.3f", t->name, t->model,
               t->through_heights ? " through heights" : "", level, coverage.all.count, 100 * coverage.all.covered,
               100 * coverage.dark.covered, 100 * coverage.bright.covered, coverage.all.width, coverage.even_width);
        say_shares(coverage.by_view);
        say_shares(coverage.by_light);
        printf(",%.3f,%.3f\n", t->quantile[level], needed_share(t, level) * t->quantile[level]);
    }
    return WEFT_OK;
}

static weft_code test(testing *t, weft_error *error)
{
    weft_dataset *dataset;
    WEFT_TRY(weft_dataset_open(t->name, &dataset, error));
    weft_code code = weft_splits_create(weft_dataset_get_layout(dataset), 0, TEST_SPLIT + 1, &t->splits, error);
    if (code == WEFT_OK)
        code = weft_texel_subset_read(dataset, WEFT_TEXEL_SUBSET_BLOCK, t->side, &t->subset, error);
    weft_dataset_close(dataset);
    bool each = t->splits.kind == WEFT_SPLIT_EACH;
    int first = each ? 0 : TEST_SPLIT;
    for (int split = first; code == WEFT_OK && split < t->splits.count; split++)
        code = test_split(t, split, error);
    return code == WEFT_OK ? say(t, error) : code;
}

int main(int argc, char **argv)
{
    bool has_model = argc == 3 || argc == 4, is_components = has_model && strcmp(argv[2], "components") == 0;
    int side = argc == 4 ? atoi(argv[3]) : SIDE;
    if (!has_model || side < 1 || (!is_components && strcmp(argv[2], "lobes") != 0)) {
        fprintf(stderr, "usage: bench_certificate NAME.btf.h5 lobes|components [SIDE]\n");
        return 2;
    }
    testing t = {.name = argv[1], .model = argv[2], .side = side, .options = weft_compress_default_options()};
    weft_error error = {0};
    t.options.component_count = is_components ? 16 : 0;
    weft_code code = test(&t, &error);
    if (code != WEFT_OK)
        fprintf(stderr, "%s\n", error.message);
    for (int level = 0; level < SHOWN_LEVELS; level++)
        free(t.covered[level]);
    weft_texel_subset_free(&t.subset);
    weft_splits_free(&t.splits);
    return (int)code;
}
