/* The smallest model that meets a target error. */
#include "tests/support/cmocka_all.h"

#include "base/atomic_file.h"
#include "btf/material/models.h"
#include "compress/compress.h"
#include "compress/texel/model_ladder.h"
#include "tests/support/synthetic_dataset.h"
#include "tests/support/synthetic_texel.h"

#include <stdio.h>
#include <string.h>

static synthetic_kind filled_kind;

static void fill_kind(const weft_dataset_layout *layout, int x, int y, float *samples, uint8_t *mask)
{
    (void)mask;
    synthetic_texel(layout, filled_kind, (uint64_t)(64 * y + x), 0.01, samples);
}

/* Left to right: white, two lobes with T, Ward lobes, yarns. */
static void fill_mixture(const weft_dataset_layout *layout, int x, int y, float *samples, uint8_t *mask)
{
    (void)mask;
    if (x > 0) {
        synthetic_texel(layout, (synthetic_kind)(x - 1), (uint64_t)y, 0.01, samples);
        return;
    }
    for (int i = 0; i < 3 * layout->image_count; i++)
        samples[i] = (float)layout->light[i / 3].z;
}

static void write_fill(const char *path, int width, int height, synthetic_fill *fill)
{
    weft_dataset_layout layout;
    assert_int_equal(synthetic_layout(width, height, &layout, NULL), WEFT_OK);
    synthetic_dataset_write(path, &layout, fill);
    weft_dataset_layout_free(&layout);
}

static weft_material compress_file(const char *path, const weft_compress_options *options, weft_compress_report *report)
{
    weft_dataset *dataset = synthetic_dataset_open(path);
    weft_material material;
    weft_error error = {0};
    if (weft_compress(dataset, options, NULL, &material, report, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    weft_dataset_close(dataset);
    return material;
}

/* What is stored of the model of a texel of level 0. */
static weft_texel_model stored_model(const weft_material *material, int texel)
{
    const weft_material_level *level = &material->level[0];
    int texels = level->width * level->height;
    weft_texel_model model = {0};
    for (int lobe = 0; lobe < material->lobe_count; lobe++) {
        for (int i = 0; i < 9; i++) {
            const weft_half *code = level->lobe + 4 * ((3 * lobe + i / 3) * texels + texel);
            if (code[i % 3] & 0x7fff)
                model.lobe_count = lobe + 1;
        }
    }
    for (int view = 0; view < material->view_count; view++) {
        for (int i = 0; i < 3; i++)
            model.table = model.table || level->table[4 * (view * texels + texel) + i] != 255;
    }
    return model;
}

/* The error of one model for the only texel of a dataset. */
static double error_of_model(const char *path, weft_texel_model model)
{
    weft_compress_options options = weft_compress_default_options();
    options.component_count = 0;
    options.lobe_count = model.lobe_count;
    options.table = model.table;
    weft_material material = compress_file(path, &options, NULL);
    double error = material.level[0].error.relative_rmse;
    weft_material_free(&material);
    return error;
}

static int spared; /* texels whose T has fewer bits than 8 */

static void check_smallest(double target)
{
    weft_compress_options options = weft_compress_default_options();
    options.component_count = 0;
    weft_fit_options whole = weft_fit_default_options();
    weft_compress_report report;
    options.target_error = target;
    weft_material material = compress_file("target.btf.h5", &options, &report);
    weft_texel_model chosen = stored_model(&material, 0);
    weft_model_ladder ladder = weft_model_ladder_make(&whole, 81);
    double error = material.level[0].error.relative_rmse;
    double whole_tables = error_of_model("target.btf.h5", chosen);
    weft_model_parts parts = weft_model_decode(material.level[0].model[0]);
    assert_true(parts.lobe_count == chosen.lobe_count && (parts.table_bits > 0) == chosen.table);
    if (parts.table_bits == 0 || parts.table_bits == 8)
        assert_float_equal(error, whole_tables, 1e-12);
    spared += parts.table_bits == 4 || parts.table_bits == 6;
    assert_true(error <= target || report.missed_texel_count == 1);
    assert_true(report.missed_texel_count == 0 || (chosen.table && chosen.lobe_count == 2));
    for (int i = 0; i < ladder.count; i++) {
        if (weft_texel_model_bytes(ladder.model[i], 81) < weft_texel_model_bytes(chosen, 81))
            assert_true(error_of_model("target.btf.h5", ladder.model[i]) > target);
    }
    weft_material_free(&material);
}

static void a_texel_has_the_smallest_model_that_meets_the_target(void **state)
{
    (void)state;
    static const double target[5] = {0.9, 0.35, 0.22, 0.16, 0.005};
    for (int kind = 0; kind < SYNTHETIC_KINDS; kind++) {
        filled_kind = (synthetic_kind)kind;
        write_fill("target.btf.h5", 1, 1, fill_kind);
        for (int i = 0; i < 5; i++)
            check_smallest(target[i]);
    }
    assert_true(spared > 0);
}

static void a_white_texel_is_diffuse_among_others(void **state)
{
    (void)state;
    weft_compress_options options = weft_compress_default_options();
    options.component_count = 0;
    options.target_error = 0.02;
    write_fill("mixture.btf.h5", 4, 2, fill_mixture);
    weft_material material = compress_file("mixture.btf.h5", &options, NULL);
    for (int y = 0; y < 2; y++) {
        weft_texel_model white = stored_model(&material, 4 * y), own = stored_model(&material, 4 * y + 1);
        assert_true(white.lobe_count == 0 && !white.table);
        assert_true(own.lobe_count > 0 && own.table);
    }
    weft_material_free(&material);
}

static void a_smaller_target_leaves_less_error_in_a_larger_file(void **state)
{
    (void)state;
    static const double target[5] = {0.6, 0.3, 0.2, 0.1, 0};
    off_t size = 0;
    double error = INFINITY;
    write_fill("mixture.btf.h5", 4, 4, fill_mixture);
    for (int i = 0; i < 5; i++) {
        weft_compress_options options = weft_compress_default_options();
        options.component_count = 0;
        options.target_error = target[i];
        weft_material material = compress_file("mixture.btf.h5", &options, NULL);
        assert_int_equal(weft_material_write("mixture.weft", &material, NULL), WEFT_OK);
        long bytes = (long)weft_file_bytes("mixture.weft");
        printf("target %.2f: relative RMSE %.4f, %ld bytes\n", target[i], material.level[0].error.relative_rmse, bytes);
        assert_true(bytes > 0 && bytes >= size);
        /* A larger model is no better than a smaller one that fits exactly: 8 bits of T cost it a little. */
        assert_true(material.level[0].error.relative_rmse <= 1.001 * error);
        size = bytes;
        error = material.level[0].error.relative_rmse;
        weft_material_free(&material);
    }
}

static void a_ladder_holds_every_model_once_by_rising_size(void **state)
{
    (void)state;
    weft_fit_options whole = weft_fit_default_options();
    whole.lobe_count = 3;
    for (int views = 1; views <= 81; views += 40) {
        weft_model_ladder ladder = weft_model_ladder_make(&whole, views);
        unsigned seen = 0;
        for (int i = 0; i < ladder.count; i++) {
            seen |= 1u << (ladder.model[i].lobe_count + 4 * ladder.model[i].table);
            assert_true(i == 0 || weft_texel_model_bytes(ladder.model[i - 1], views) <=
                                      weft_texel_model_bytes(ladder.model[i], views));
        }
        assert_int_equal(ladder.count, 8);
        assert_int_equal(seen, 255);
        assert_true(ladder.model[7].lobe_count == 3 && ladder.model[7].table);
    }
}

static void targets_that_mean_nothing_are_refused(void **state)
{
    (void)state;
    static const double target[3] = {-0.1, 1.1, NAN};
    weft_dataset *dataset = synthetic_dataset_open("target.btf.h5");
    for (int i = 0; i < 3; i++) {
        weft_compress_options options = weft_compress_default_options();
        options.component_count = 0;
        weft_material material;
        weft_error error = {0};
        options.target_error = target[i];
        assert_int_equal(weft_compress(dataset, &options, NULL, &material, NULL, &error), WEFT_BAD_USAGE);
        assert_non_null(strstr(error.message, "target error"));
    }
    weft_dataset_close(dataset);
}

int test_target(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_texel_has_the_smallest_model_that_meets_the_target),
        cmocka_unit_test(a_white_texel_is_diffuse_among_others),
        cmocka_unit_test(a_smaller_target_leaves_less_error_in_a_larger_file),
        cmocka_unit_test(a_ladder_holds_every_model_once_by_rising_size),
        cmocka_unit_test(targets_that_mean_nothing_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
