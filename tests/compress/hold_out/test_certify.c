/* That the intervals of a certificate cover what they say of images that it was not made of, and what its parts are. */
#include "tests/compare/fixture.h"

#include "base/half.h"
#include "btf/dataset/write_blocks.h"
#include "compress/hold_out/certify.h"
#include "compress/hold_out/hold_out.h"
#include "evaluate/error/coverage.h"
#include "tests/support/scratch_folder.h"
#include "weft/import.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* ---- Residuals that are made up ---- */

static uint64_t random_state = 7;

/* Below 1. */
static double draw(void)
{
    random_state = random_state * 6364136223846793005u + 1442695040888963407u;
    return (double)(random_state >> 11) * 0x1p-53;
}

static double draw_normal(void)
{
    return sqrt(-2 * log(1 - draw())) * cos(2 * 3.14159265358979324 * draw());
}

enum { PIXELS = 60 };

/* An image of pixels whose errors grow with the root of what is said, with the rings, and with the image: it is good or
 * bad as a whole. */
static void put_image(weft_residuals *residuals, uint32_t image, double mean)
{
    int view = (int)(6 * draw()), light = (int)(6 * draw());
    double own = exp(0.4 * draw_normal());
    for (int i = 0; i < PIXELS; i++) {
        double prediction = mean * exp(1.2 * draw_normal());
        double deviation = 0.1 * sqrt(mean * prediction) * own * (1 + 0.3 * view) * (1 + 0.1 * light);
        residuals->value[0][residuals->count[0]++] =
            (weft_residual){.prediction = (float)prediction,
                            .error = (float)fabs(deviation * draw_normal()),
                            .moved = (float)(0.1 * deviation * fabs(draw_normal()) * sqrt(12)),
                            .image = image,
                            .view = (uint8_t)view,
                            .light = (uint8_t)light};
    }
}

static weft_residuals make_residuals(int images, double mean)
{
    weft_residuals residuals = {.level_count = 1};
    residuals.value[0] = calloc((size_t)images * PIXELS, sizeof(weft_residual));
    assert_non_null(residuals.value[0]);
    for (int i = 0; i < images; i++)
        put_image(&residuals, (uint32_t)i, mean);
    return residuals;
}

static weft_certificate certify(const weft_residuals *held, const weft_residuals *fitted)
{
    weft_certificate c;
    weft_error error = {0};
    bool found;
    expect_ok(weft_certify(held, fitted, 0.95, 1, 1, &c, &found, &error), &error);
    assert_true(found);
    return c;
}

static weft_coverage measure(const weft_certificate *c, const weft_residuals *unseen)
{
    weft_covered *covered = calloc(unseen->count[0], sizeof *covered);
    weft_coverage coverage;
    for (size_t i = 0; i < unseen->count[0]; i++) {
        const weft_residual *r = &unseen->value[0][i];
        weft_vec3 light = weft_direction_of_angles((weft_angles){weft_rad_of_deg(15 * r->light), 2}),
                  view = weft_direction_of_angles((weft_angles){weft_rad_of_deg(15 * r->view), 3});
        double half = weft_certificate_half_width(c, 0, (double)r->prediction, light, view);
        covered[i] = (weft_covered){{r->prediction + r->error, r->prediction}, (float)half, r->view, r->light};
    }
    assert_int_equal(weft_coverage_of(covered, unseen->count[0], &coverage, NULL), WEFT_OK);
    free(covered);
    return coverage;
}

/* Of all, of every ring, of dark and of bright pixels; narrower than an interval that is alike everywhere. The unit of
 * the samples does not matter. */
static void images_that_were_not_seen_are_covered(void **state)
{
    (void)state;
    for (double mean = 1e-3; mean < 100; mean *= 1e4) {
        weft_residuals held = make_residuals(600, mean), unseen = make_residuals(600, mean);
        weft_certificate c = certify(&held, &held);
        weft_coverage coverage = measure(&c, &unseen);
        print_message("covered %.4f, dark %.4f, bright %.4f, width %.3f, alike %.3f\n", coverage.all.covered,
                      coverage.dark.covered, coverage.bright.covered, coverage.all.width, coverage.even_width);
        assert_true(c.over_images);
        assert_int_equal(c.image_count, 600);
        assert_true(coverage.all.covered > 0.94 && coverage.all.covered < 0.965);
        assert_true(coverage.dark.covered > 0.92 && coverage.dark.covered < 0.98);
        assert_true(coverage.bright.covered > 0.92 && coverage.bright.covered < 0.98);
        for (int ring = 0; ring < WEFT_RING_COUNT; ring++) {
            assert_true(coverage.by_view[ring].covered > 0.91 && coverage.by_view[ring].covered < 0.985);
            assert_true(coverage.by_light[ring].covered > 0.91 && coverage.by_light[ring].covered < 0.985);
        }
        assert_true(coverage.all.width < 0.9 * coverage.even_width);
        weft_residuals_free(&held);
        weft_residuals_free(&unseen);
    }
}

/* With 18 images no interval of 95 % is known for another; it holds for pixels like theirs, and says so. */
static void a_few_images_promise_nothing_of_others(void **state)
{
    (void)state;
    for (int images = 18; images <= 19; images++) {
        weft_residuals held = make_residuals(images, 1);
        weft_certificate c = certify(&held, &held);
        weft_coverage coverage = measure(&c, &held);
        assert_int_equal(c.over_images, images == 19);
        if (images == 18)
            assert_true(coverage.all.covered > 0.945 && coverage.all.covered < 0.96);
        weft_residuals_free(&held);
    }
}

/* Fitted errors of half the size leave half of the width to sampling; storage is a tenth by construction. */
static void parts_are_shares_of_the_half_width(void **state)
{
    (void)state;
    weft_residuals held = make_residuals(400, 1), fitted = make_residuals(400, 1);
    for (size_t i = 0; i < fitted.count[0]; i++)
        fitted.value[0][i].error *= 0.5f;
    weft_certificate c = certify(&held, &fitted);
    for (int ring = 0; ring < WEFT_RING_COUNT; ring++) {
        weft_certificate_parts parts = weft_certificate_parts_of(&c, 0, ring);
        assert_float_equal(parts.sampling, 0.5, 0.08);
        assert_float_equal(parts.storage, 0.1, 0.02);
    }
    assert_false(c.has_registration);
    weft_residuals_free(&held);
    weft_residuals_free(&fitted);
}

static void rings_without_images_have_their_neighbours_factor(void **state)
{
    (void)state;
    weft_residuals held = make_residuals(300, 1);
    size_t kept = 0;
    for (size_t i = 0; i < held.count[0]; i++)
        if (held.value[0][i].view > 0 && held.value[0][i].view < 4)
            held.value[0][kept++] = held.value[0][i];
    held.count[0] = kept;
    weft_certificate c = certify(&held, &held);
    assert_int_equal(c.view_images[0] + c.view_images[4] + c.view_images[5], 0);
    assert_float_equal(c.view[0], c.view[1], 1e-12);
    assert_float_equal(c.view[4], c.view[3], 1e-12);
    assert_float_equal(c.view[5], c.view[3], 1e-12);
    assert_true(c.view[3] > 1.2 * c.view[1]);
    weft_residuals_free(&held);
}

/* ---- Means over squares ---- */

/* Where fewer are wanted, every texel and every image gives some. */
static void expect_third_of_everything(const weft_texel_subset *subset, const weft_asked_samples *asked)
{
    weft_residuals some = {0};
    size_t of_image[3] = {0}, most = asked->count / 3;
    const weft_residuals_taken taken = {.most = most, .last_level = WEFT_RESIDUAL_LEVELS};
    assert_int_equal(weft_residuals_add(&some, subset, asked, NULL, &taken, NULL), WEFT_OK);
    assert_int_equal(some.count[0], most);
    for (size_t i = 0; i < most; i++)
        of_image[some.value[0][i].image]++;
    for (int image = 0; image < 3; image++)
        assert_in_range(of_image[image], most / 4, most / 2);
    weft_residuals_free(&some);
}

/* What is said is 1 everywhere; samples are 1 + error, in columns of +0.2 and -0.2 and rows of 0.1 by pairs: means over
 * 2 x 2 texels keep the latter alone. */
static void coarser_levels_are_of_means(void **state)
{
    (void)state;
    enum { SIDE = 8, IMAGES = 3, COUNT = SIDE * SIDE * IMAGES * 3 };
    weft_texel_subset subset = {.layout = {.width = SIDE, .height = SIDE, .image_count = IMAGES, .view_count = 1}};
    assert_int_equal(weft_dataset_layout_allocate(&subset.layout, NULL), WEFT_OK);
    for (int i = 0; i < IMAGES; i++)
        subset.layout.light[i] = weft_direction_of_angles((weft_angles){weft_rad_of_deg(30 * i), 0});
    subset.layout.view[0] = weft_vec3_of(0, 0, 1);
    static weft_compared value[COUNT];
    static uint8_t group[COUNT];
    static uint32_t sample[COUNT];
    for (int i = 0; i < COUNT; i++) {
        int texel = i / (3 * IMAGES), x = texel % SIDE, y = texel / SIDE;
        double error = (x % 2 ? 0.2 : -0.2) + (y / 2 % 2 ? 0.1 : -0.1);
        value[i] = (weft_compared){.sample = (float)(1 + error), .prediction = 1};
        group[i] = 1;
        sample[i] = (uint32_t)(i / 3);
    }
    const weft_asked_samples asked = {COUNT, value, group, sample};
    weft_residuals residuals = {0};
    const weft_residuals_taken taken = {.first_image = 5, .most = 1 << 20, .last_level = WEFT_RESIDUAL_LEVELS};
    assert_int_equal(weft_residuals_add(&residuals, &subset, &asked, &asked, &taken, NULL), WEFT_OK);
    assert_int_equal(residuals.level_count, 3);
    assert_int_equal(residuals.count[0], COUNT);
    assert_int_equal(residuals.count[1], COUNT / 4);
    assert_int_equal(residuals.count[2], COUNT / 16);
    for (size_t i = 0; i < residuals.count[1]; i++)
        assert_float_equal(residuals.value[1][i].error, 0.1, 1e-6);
    for (size_t i = 0; i < residuals.count[2]; i++)
        assert_float_equal(residuals.value[2][i].error, 0, 1e-6);
    for (size_t i = 0; i < residuals.count[0]; i++) {
        const weft_residual *r = &residuals.value[0][i];
        assert_in_range(r->image, 5, 7);
        assert_int_equal(r->light, 2 * (r->image - 5));
        assert_true(r->moved == 0);
    }
    weft_residuals_free(&residuals);
    expect_third_of_everything(&subset, &asked);
    weft_dataset_layout_free(&subset.layout);
}

/* Errors of 8, 4, 2 and 1 at the levels of a subset whose texels lie 8 apart. */
static weft_certificate certify_levels(int neighbours)
{
    weft_residuals residuals = {.level_count = 4};
    for (int level = 0; level < 4; level++) {
        weft_residuals one = make_residuals(60, 1);
        residuals.value[level] = one.value[0];
        residuals.count[level] = one.count[0];
        for (size_t i = 0; i < one.count[0]; i++)
            residuals.value[level][i].error = (float)(8 >> level);
    }
    weft_certificate c;
    weft_error error = {0};
    bool found;
    expect_ok(weft_certify(&residuals, &residuals, 0.95, 8, neighbours, &c, &found, &error), &error);
    weft_residuals_free(&residuals);
    return c;
}

/* Of squares of 4 x 4 neighbours levels 1 and 2 are what they are; the next ones have the last of them until the texels
 * of a level hold a whole square of such squares. Of single texels all of the first ones have the error of level 0. */
static void levels_are_measured_where_texels_lie_beside_each_other(void **state)
{
    (void)state;
    static const int of_squares[] = {0, 1, 2, 2, 2, 2, 3}, of_texels[] = {0, 0, 0, 0, 1, 2, 3};
    weft_certificate squares = certify_levels(4), texels = certify_levels(1);
    assert_int_equal(squares.level_count, 7);
    assert_int_equal(texels.level_count, 7);
    assert_int_equal(squares.measured_levels, 3);
    assert_int_equal(texels.measured_levels, 1);
    for (int k = 0; k < 7; k++) {
        assert_float_equal(squares.level[k].quantile / squares.level[0].quantile, 1.0 / (1 << of_squares[k]), 0.02);
        assert_float_equal(texels.level[k].quantile / texels.level[0].quantile, 1.0 / (1 << of_texels[k]), 0.02);
    }
}

static double of_bits(double x)
{
    double y = sin(x) * 43758.5453;
    return y - floor(y);
}

/* Another error at every texel and in every image, evenly distributed: 95 % lie within 0.95 sqrt(3) = 1.645 standard
 * deviations. Means over n of them are nearly normal: 95 % lie within 1.96 / sqrt(n). */
static weft_rgb speckled(int x, int y, weft_vec3 light, weft_vec3 view)
{
    double noise =
        of_bits(12.9898 * x + 78.233 * y + 37.719 * light.x + 53.123 * light.y + 71.31 * view.x + 9.17 * view.y);
    double value = 0.5 + 0.1 * (noise - 0.5);
    return (weft_rgb){value, value, value};
}

/* 12 x 12 texels in squares of 4 x 4. */
static void expect_squares_where_memory_is_a_limit(weft_dataset *dataset, weft_compress_options options)
{
    weft_hold_out result;
    weft_error error = {0};
    options.memory_bytes = (uint64_t)4 << 30;
    expect_ok(weft_hold_out_measure(dataset, &options, 1, "speckled-split.btf.h5", NULL, &result, &error), &error);
    const weft_certificate_level *level = result.certificate.level;
    assert_int_equal(result.texel_count, 144);
    assert_int_equal(result.certificate.measured_levels, 3);
    assert_float_equal(level[1].quantile / level[0].quantile, 1.96 / 2 / 1.645, 0.08);
    assert_float_equal(level[2].quantile / level[0].quantile, 1.96 / 4 / 1.645, 0.08);
    assert_true(level[3].quantile == level[2].quantile);
}

/* Of 40 x 40 texels some are read, and means over up to 8 x 8 neighbours elsewhere. */
static void coarser_levels_of_a_material_are_as_narrow_as_they_are(void **state)
{
    (void)state;
    static const char *const path = "speckled.btf.h5";
    weft_dataset *dataset;
    weft_hold_out result;
    weft_error error = {0};
    weft_compress_options options = weft_compress_default_options();
    options.component_count = options.lobe_count = 0;
    fixture_far_dataset(path, 40, 40, 3, speckled, FIXTURE_MASK_NONE);
    expect_ok(weft_dataset_open(path, &dataset, &error), &error);
    expect_ok(weft_hold_out_measure(dataset, &options, 1, "speckled-split.btf.h5", NULL, &result, &error), &error);
    expect_squares_where_memory_is_a_limit(dataset, options);
    weft_dataset_close(dataset);
    const weft_certificate_level *level = result.certificate.level;
    print_message("quantiles %.3f, %.3f, %.3f\n", level[0].quantile, level[1].quantile, level[2].quantile);
    assert_int_equal(result.texel_count, 256); /* spread; the coarser levels have texels of their own */
    assert_int_equal(result.certificate.measured_levels, 4);
    assert_int_equal(result.certificate.level_count, 6);
    assert_float_equal(level[1].quantile / level[0].quantile, 1.96 / 2 / 1.645, 0.08);
    assert_float_equal(level[2].quantile / level[0].quantile, 1.96 / 4 / 1.645, 0.08);
    assert_float_equal(level[3].quantile / level[0].quantile, 1.96 / 8 / 1.645, 0.03);
    assert_true(level[4].quantile == level[3].quantile);
}

/* ---- Storage ---- */

/* Numbers that are rounded to half floats, and the same moved by a step: the errors of both, root mean square, are as 1
 * to sqrt(12). */
static void a_step_is_the_root_of_twelve_times_rounding(void **state)
{
    (void)state;
    enum { SIDE = 32 };
    weft_material material;
    weft_error error = {0};
    double exact[SIDE * SIDE], rounded = 0, moved = 0;
    expect_ok(weft_material_create(SIDE, SIDE, 0, 0, 0, 0, &material, &error), &error);
    for (size_t i = 0; i < SIDE * SIDE; i++) {
        exact[i] = 0.5 + 0.5 * draw();
        material.level[0].diffuse[4 * i] = weft_half_of_float((float)exact[i]);
    }
    weft_half before[SIDE * SIDE];
    for (size_t i = 0; i < SIDE * SIDE; i++)
        before[i] = material.level[0].diffuse[4 * i];
    weft_material_move_by_steps(&material);
    for (size_t i = 0; i < SIDE * SIDE; i++) {
        double value = (double)weft_float_of_half(before[i]);
        rounded += (value - exact[i]) * (value - exact[i]);
        moved += pow(value - (double)weft_float_of_half(material.level[0].diffuse[4 * i]), 2);
        assert_int_equal(material.level[0].diffuse[4 * i + 3], 0);
    }
    assert_float_equal(sqrt(moved / rounded), sqrt(12), 0.15);
    weft_material_free(&material);
}

/* Codes that were rounded to every eighth lie eight apart: that is their step. */
static void coefficients_are_moved_by_what_they_lie_apart(void **state)
{
    (void)state;
    enum { SIDE = 6, COMPONENTS = 4, APART = 8 };
    const weft_components shape = {.component_count = COMPONENTS,
                                   .view_count = 1,
                                   .image_count = 1,
                                   .light_side = 4,
                                   .view_side = 4,
                                   .light_smoothness = 1,
                                   .view_smoothness = 1,
                                   .least_cosine = 1};
    weft_material material;
    weft_error error = {0};
    expect_ok(weft_material_create(SIDE, SIDE, 0, 0, 0, false, &material, &error), &error);
    expect_ok(weft_components_create(&shape, SIDE, SIDE, 1, &material.components, &error), &error);
    int8_t *code = material.components->level[0].coefficient, before[COMPONENTS * SIDE * SIDE];
    for (int i = 0; i < COMPONENTS * SIDE * SIDE; i++)
        before[i] = code[i] = (int8_t)(i % COMPONENTS == 1 ? i % 100 : APART * (i % 13));
    weft_material_move_by_steps(&material);
    for (int i = 0; i < COMPONENTS * SIDE * SIDE; i++)
        assert_int_equal(abs(code[i] - before[i]), i % COMPONENTS == 1 ? 4 : APART);
    weft_material_free(&material);
}

/* ---- Registration ---- */

static weft_rgb sloping(int x, int y, weft_vec3 light, weft_vec3 view)
{
    (void)light, (void)view;
    double value = 0.5 + 0.01 * x + 0.02 * y;
    return (weft_rgb){value, value, value};
}

/* All rings and values are alike: half a width is 0.1. */
static weft_certificate even_certificate(void)
{
    weft_certificate c = {.probability = 0.95, .over_images = true, .mean = 1, .level_count = 2};
    for (int k = 0; k < WEFT_CERTIFICATE_KNOTS; k++) {
        c.value[k] = k + 1;
        c.spread[k] = 0.1;
    }
    for (int ring = 0; ring < WEFT_RING_COUNT; ring++)
        c.view[ring] = c.light[ring] = 1;
    c.level[0].quantile = c.level[1].quantile = 1;
    return c;
}

/* A copy of the dataset's file would do; it is written again with what `weft register` says of one view. */
static void put_provenance(const char *path, const char *provenance)
{
    weft_dataset *dataset;
    weft_dataset_writer *writer;
    weft_error error = {0};
    weft_texel_subset subset;
    expect_ok(weft_dataset_open(path, &dataset, &error), &error);
    expect_ok(weft_texel_subset_read(dataset, WEFT_TEXEL_SUBSET_BLOCK, 64, &subset, &error), &error);
    weft_dataset_close(dataset);
    free(subset.layout.provenance);
    subset.layout.provenance = strdup(provenance);
    size_t texels = (size_t)subset.layout.width * (size_t)subset.layout.height;
    size_t images = (size_t)subset.layout.image_count;
    weft_half *samples = malloc(3 * texels * sizeof *samples);
    uint8_t *mask = calloc(texels, 1);
    expect_ok(weft_dataset_writer_create(path, &subset.layout, &writer, &error), &error);
    for (size_t image = 0; image < images; image++) {
        for (size_t texel = 0; texel < texels; texel++)
            memcpy(samples + 3 * texel, subset.samples + 3 * (texel * images + image), 3 * sizeof *samples);
        expect_ok(weft_dataset_writer_put_image(writer, (int)image, samples, mask, &error), &error);
    }
    expect_ok(weft_dataset_writer_finish(writer, NULL, &error), &error);
    free(samples);
    free(mask);
    weft_texel_subset_free(&subset);
}

/* 0.3 texels times a slope of hypot(0.01, 0.02) cos(theta), 1.96 times, over 0.1; of means over 2 x 2 texels the same,
 * for the slope is twice as large and the displacement half. */
static void a_displacement_costs_the_slope(void **state)
{
    (void)state;
    static const char *const path = "sloping.btf.h5";
    weft_dataset *dataset;
    weft_error error = {0};
    weft_certificate c = even_certificate();
    fixture_far_dataset(path, 24, 24, 1, sloping, FIXTURE_MASK_NONE);
    expect_ok(weft_dataset_open(path, &dataset, &error), &error);
    expect_ok(weft_certify_registration(dataset, &c, &error), &error);
    weft_dataset_close(dataset);
    assert_false(c.has_registration);
    put_provenance(path, "{\"stays\":[{\"view\":0,\"used\":1,\"standard_error_texels\":0.3},"
                         "{\"view\":0,\"used\":0,\"standard_error_texels\":9},{\"view\":7,\"used\":1}]}");
    expect_ok(weft_dataset_open(path, &dataset, &error), &error);
    expect_ok(weft_certify_registration(dataset, &c, &error), &error);
    weft_dataset_close(dataset);
    assert_true(c.has_registration);
    double expected = 1.96 * 0.3 * hypot(0.01, 0.02) / 0.1;
    assert_float_equal(c.level[0].registration[0], expected, 0.002);
    assert_float_equal(c.level[1].registration[0], expected, 0.002);
}

/* ---- Real photographs ---- */

enum { CARDS = 9 };

/* Each photograph in turn is left out of fit and certificate, and then asked for. */
static void put_card(const weft_texel_subset *subset, int card, weft_residuals *unseen, double *covered)
{
    uint8_t held[CARDS] = {0};
    weft_dataset *others;
    weft_hold_out measured;
    weft_material material;
    weft_predictor *predictor;
    weft_trial trial;
    weft_asked_samples asked, none;
    weft_error error = {0};
    held[card] = WEFT_HELD_IMAGE;
    expect_ok(weft_texel_subset_write(subset, held, "others.btf.h5", &others, &error), &error);
    weft_compress_options options = weft_compress_default_options();
    options = weft_compress_settle(&options, others);
    expect_ok(weft_hold_out_measure(others, &options, 1, "split.btf.h5", NULL, &measured, &error), &error);
    assert_true(measured.has_certificate && !measured.certificate.over_images);
    assert_int_equal(measured.certificate.image_count, CARDS - 1);
    expect_ok(weft_compress(others, &options, NULL, &material, NULL, &error), &error);
    expect_ok(weft_predictor_of_material(&subset->layout, &material, &predictor, &error), &error);
    expect_ok(weft_trial_create(subset, held, held, &trial, &error), &error);
    expect_ok(weft_trial_ask(&trial, predictor, &asked, &none, &error), &error);
    unseen->count[0] = 0;
    const weft_residuals_taken taken = {.most = 1 << 20};
    expect_ok(weft_residuals_add(unseen, subset, &asked, NULL, &taken, &error), &error);
    covered[0] += measure(&measured.certificate, unseen).all.covered * (double)unseen->count[0];
    covered[1] += (double)unseen->count[0];
    weft_asked_samples_free(&asked);
    weft_asked_samples_free(&none);
    weft_trial_free(&trial);
    weft_predictor_free(predictor);
    weft_material_free(&material);
    weft_dataset_close(others);
}

/* The flash photographs of a card are too few for a promise about others; the intervals hold for them all the same. */
static void flash_photographs_of_a_card_are_covered(void **state)
{
    (void)state;
    if (access(WEFT_SHARED "/real/cards-blue/00.png", R_OK) != 0) {
        print_message("no " WEFT_SHARED "/real/cards-blue: skipped\n");
        skip();
    }
    weft_import_options options = weft_import_defaults();
    weft_import_report report;
    weft_dataset *dataset;
    weft_texel_subset subset;
    weft_residuals unseen = {0};
    weft_error error = {0};
    double covered[2] = {0};
    options.width = 12;
    expect_ok(weft_import(WEFT_SHARED "/real/cards-blue", "cards.btf.h5", &options, NULL, &report, &error), &error);
    weft_import_report_free(&report);
    expect_ok(weft_dataset_open("cards.btf.h5", &dataset, &error), &error);
    expect_ok(weft_texel_subset_read(dataset, WEFT_TEXEL_SUBSET_BLOCK, 12, &subset, &error), &error);
    weft_dataset_close(dataset);
    for (int card = 0; card < CARDS; card++)
        put_card(&subset, card, &unseen, covered);
    print_message("12 x 12, %.0f values: covered %.4f\n", covered[1], covered[0] / covered[1]);
    assert_true(covered[0] / covered[1] > 0.93 && covered[0] / covered[1] < 0.97);
    weft_residuals_free(&unseen);
    weft_texel_subset_free(&subset);
}

int test_certify(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(images_that_were_not_seen_are_covered),
        cmocka_unit_test(a_few_images_promise_nothing_of_others),
        cmocka_unit_test(parts_are_shares_of_the_half_width),
        cmocka_unit_test(rings_without_images_have_their_neighbours_factor),
        cmocka_unit_test(coarser_levels_are_of_means),
        cmocka_unit_test(levels_are_measured_where_texels_lie_beside_each_other),
        cmocka_unit_test(coarser_levels_of_a_material_are_as_narrow_as_they_are),
        cmocka_unit_test(a_step_is_the_root_of_twelve_times_rounding),
        cmocka_unit_test(coefficients_are_moved_by_what_they_lie_apart),
        cmocka_unit_test(a_displacement_costs_the_slope),
        cmocka_unit_test(flash_photographs_of_a_card_are_covered),
    };
    return cmocka_run_group_tests(tests, scratch_folder_enter, scratch_folder_leave);
}
