/* Whole datasets to whole materials. */
#include "tests/support/cmocka_all.h"

#include "base/atomic_file.h"
#include "compress/compress.h"
#include "reflectance/lafortune/lafortune.h"
#include "tests/support/synthetic_dataset.h"
#include "tests/support/synthetic_texel.h"

#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static weft_dataset_layout full_layout(int width, int height)
{
    weft_dataset_layout layout;
    assert_int_equal(synthetic_layout(width, height, &layout, NULL), WEFT_OK);
    return layout;
}

static void fill_ward(const weft_dataset_layout *layout, int x, int y, float *samples, uint8_t *mask)
{
    (void)mask;
    synthetic_texel(layout, SYNTHETIC_WARD, (uint64_t)(64 * (y / 4) + 8 * (y % 4) + x % 8), 0.01, samples);
}

/* The mean of the 2 x 2 texels that fill_ward puts in the place of this one. */
static void fill_mean_ward(const weft_dataset_layout *layout, int x, int y, float *samples, uint8_t *mask)
{
    float *child = calloc(3 * (size_t)layout->image_count, sizeof *child);
    assert_non_null(child);
    memset(samples, 0, 3 * (size_t)layout->image_count * sizeof *samples);
    for (int i = 0; i < 4; i++) {
        fill_ward(layout, 2 * x + i % 2, 2 * y + i / 2, child, mask);
        for (int k = 0; k < 3 * layout->image_count; k++)
            samples[k] += weft_float_of_half(weft_half_of_float(child[k])) / 4;
    }
    free(child);
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

static void write_fill(const char *path, int width, int height, synthetic_fill *fill)
{
    weft_dataset_layout layout = full_layout(width, height);
    synthetic_dataset_write(path, &layout, fill);
    weft_dataset_layout_free(&layout);
}

static void levels_report_what_the_stored_texels_leave(void **state)
{
    (void)state;
    weft_compress_options options = weft_compress_default_options();
    options.component_count = 0;
    write_fill("errors.btf.h5", 3, 2, fill_ward);
    weft_material material = compress_file("errors.btf.h5", &options, NULL);
    assert_int_equal(material.level_count, 3);
    weft_dataset_layout layout = full_layout(3, 2);
    weft_table_directions directions;
    assert_int_equal(weft_table_directions_create(&material, &directions, NULL), WEFT_OK);
    float *samples = calloc(3 * (size_t)layout.image_count, sizeof *samples);
    double square = 0, square_error = 0;
    for (int texel = 0; texel < 6; texel++) {
        fill_ward(&layout, texel % 3, texel / 3, samples, NULL);
        for (int image = 0; image < layout.image_count; image++) {
            weft_vec3 light = layout.light[image], view = layout.view[layout.view_of_image[image]];
            weft_rgba value = weft_material_texel(&material, &directions, 0, texel % 3, texel / 3, light, view);
            const double rgb[3] = {value.r, value.g, value.b};
            for (int k = 0; k < 3; k++) {
                double sample = (double)samples[3 * image + k];
                square += sample * sample;
                square_error += (rgb[k] * light.z - sample) * (rgb[k] * light.z - sample);
            }
        }
    }
    double relative = sqrt(square_error / square);
    assert_float_equal(material.level[0].error.relative_rmse / relative, 1, 2e-3);
    assert_true(material.level[0].error.relative_rmse < 0.3);
    free(samples);
    weft_table_directions_free(&directions);
    weft_dataset_layout_free(&layout);
    weft_material_free(&material);
}

static void mip_texels_are_fits_of_the_mean_of_their_children(void **state)
{
    (void)state;
    weft_compress_options options = weft_compress_default_options();
    options.component_count = 0;
    write_fill("children.btf.h5", 4, 4, fill_ward);
    write_fill("parents.btf.h5", 2, 2, fill_mean_ward);
    weft_material children = compress_file("children.btf.h5", &options, NULL);
    weft_material parents = compress_file("parents.btf.h5", &options, NULL);
    for (int level = 1; level < 3; level++) {
        const weft_error_summary *child = &children.level[level].error, *parent = &parents.level[level - 1].error;
        assert_float_equal(child->relative_rmse / parent->relative_rmse, 1, 0.01);
        assert_float_equal(child->median_relative / parent->median_relative, 1, 0.05);
    }
    weft_table_directions directions;
    assert_int_equal(weft_table_directions_create(&parents, &directions, NULL), WEFT_OK);
    uint64_t seed = 5;
    for (int i = 0; i < 100; i++) {
        weft_vec3 light = weft_unit(weft_vec3_of(synthetic_uniform(&seed) - 0.5, synthetic_uniform(&seed) - 0.5, 0.6));
        weft_vec3 view = weft_unit(weft_vec3_of(synthetic_uniform(&seed) - 0.5, synthetic_uniform(&seed) - 0.5, 0.6));
        weft_rgba a = weft_material_texel(&children, &directions, 1, i % 2, i / 2 % 2, light, view);
        weft_rgba b = weft_material_texel(&parents, &directions, 0, i % 2, i / 2 % 2, light, view);
        assert_float_equal(a.g / b.g, 1, 0.05);
    }
    weft_table_directions_free(&directions);
    weft_material_free(&children);
    weft_material_free(&parents);
}

static void assert_equal_files(const char *a, const char *b)
{
    char *left, *right;
    size_t left_size, right_size;
    assert_int_equal(weft_read_file(a, 1 << 28, &left, &left_size, NULL), WEFT_OK);
    assert_int_equal(weft_read_file(b, 1 << 28, &right, &right_size, NULL), WEFT_OK);
    assert_int_equal(left_size, right_size);
    assert_memory_equal(left, right, left_size);
    free(left);
    free(right);
}

static void number_of_threads_does_not_change_the_bytes(void **state)
{
    (void)state;
    int threads = omp_get_max_threads();
    weft_compress_options options = weft_compress_default_options();
    options.component_count = 0;
    write_fill("threads.btf.h5", 5, 3, fill_ward);
    omp_set_num_threads(1);
    weft_material one = compress_file("threads.btf.h5", &options, NULL);
    omp_set_num_threads(3);
    weft_material three = compress_file("threads.btf.h5", &options, NULL);
    omp_set_num_threads(threads);
    assert_int_equal(weft_material_write("one.weft", &one, NULL), WEFT_OK);
    assert_int_equal(weft_material_write("three.weft", &three, NULL), WEFT_OK);
    assert_equal_files("one.weft", "three.weft");
    weft_material_free(&one);
    weft_material_free(&three);
}

static void a_material_is_a_sixtieth_of_its_dataset(void **state)
{
    (void)state;
    weft_compress_options options = weft_compress_default_options();
    options.component_count = 0;
    write_fill("size.btf.h5", 8, 8, fill_ward);
    weft_material material = compress_file("size.btf.h5", &options, NULL);
    assert_int_equal(weft_material_write("size.weft", &material, NULL), WEFT_OK);
    uint64_t bytes = weft_file_bytes("size.weft");
    assert_true(bytes > 0 && bytes * 60 <= 8L * 8 * 6561 * 3 * 2);
    weft_material_free(&material);
}

static void fill_masked(const weft_dataset_layout *layout, int x, int y, float *samples, uint8_t *mask)
{
    fill_ward(layout, x, y, samples, mask);
    for (int image = 0; image < layout->image_count; image++) {
        bool view_failed = layout->view_of_image[image] == 17;
        if (view_failed || (image + x) % 10 == 0) {
            mask[image] = view_failed ? WEFT_MASK_MISSING : WEFT_MASK_SATURATED;
            samples[3 * image] = x ? 60000 : NAN;
        }
    }
    if (x == 1 && y == 1)
        memset(mask, WEFT_MASK_MISSING, (size_t)layout->image_count);
}

static void masked_samples_are_counted_and_not_used(void **state)
{
    (void)state;
    weft_compress_options options = weft_compress_default_options();
    options.component_count = 0;
    options.levels = false;
    weft_compress_report report;
    write_fill("whole.btf.h5", 2, 2, fill_ward);
    write_fill("masked.btf.h5", 2, 2, fill_masked);
    weft_material whole = compress_file("whole.btf.h5", &options, NULL);
    weft_material masked = compress_file("masked.btf.h5", &options, &report);
    assert_int_equal(report.sample_count, 4 * 6561);
    assert_int_equal(report.empty_texel_count, 1);
    assert_in_range(report.masked_count, 6561 + 3 * (656 + 72), 6561 + 3 * (657 + 81));
    assert_true(masked.level[0].error.relative_rmse < 1.1 * whole.level[0].error.relative_rmse);
    weft_table_directions directions;
    assert_int_equal(weft_table_directions_create(&whole, &directions, NULL), WEFT_OK);
    weft_vec3 light = weft_unit(weft_vec3_of(0.3, 0.1, 0.9));
    weft_rgba a = weft_material_texel(&whole, &directions, 0, 0, 0, light, whole.view[17]);
    weft_rgba b = weft_material_texel(&masked, &directions, 0, 0, 0, light, whole.view[17]);
    assert_true(b.g > 0.3 * a.g && b.g < 3 * a.g);
    weft_rgba black = weft_material_texel(&masked, &directions, 0, 1, 1, light, whole.view[3]);
    assert_true(black.r == 0 && black.g == 0 && black.b == 0);
    weft_table_directions_free(&directions);
    weft_material_free(&whole);
    weft_material_free(&masked);
}

/* As if a frame stood beside the texel: what looks from one side at a slant does not see it. */
static bool is_hidden(weft_vec3 view)
{
    return view.x > 0 && view.z < 0.8;
}

static void fill_hidden(const weft_dataset_layout *layout, int x, int y, float *samples, uint8_t *mask)
{
    fill_ward(layout, x, y, samples, mask);
    for (int image = 0; image < layout->image_count; image++) {
        weft_vec3 view = layout->view[layout->view_of_image[image]];
        if (is_hidden(view))
            mask[image] = WEFT_MASK_MISSING;
    }
}

/* Root mean square over the images of a view of what a material reflects. */
static double brightness(const weft_material *material, const weft_table_directions *directions, int x, int view,
                         const weft_dataset_layout *layout)
{
    double square = 0;
    int count = 0;
    for (int image = 0; image < layout->image_count; image++) {
        if (layout->view_of_image[image] != view)
            continue;
        weft_rgba seen = weft_material_texel(material, directions, 0, x, 0, layout->light[image], layout->view[view]);
        square += (double)(seen.g * seen.g);
        count++;
    }
    return sqrt(square / count);
}

static double brightest_neighbour(const weft_material *material, const weft_table_directions *directions, int x,
                                  int view, const weft_dataset_layout *layout)
{
    double nearest = -2, bright = 0;
    for (int other = 0; other < layout->view_count; other++) {
        double cosine = weft_dot(layout->view[view], layout->view[other]);
        if (is_hidden(layout->view[other]) || cosine < nearest - 1e-6)
            continue;
        double own = brightness(material, directions, x, other, layout);
        bright = cosine > nearest + 1e-6 ? own : fmax(bright, own);
        nearest = fmax(nearest, cosine);
    }
    return bright;
}

static void views_that_do_not_see_a_texel_do_not_glare(void **state)
{
    (void)state;
    weft_compress_options options = weft_compress_default_options();
    options.component_count = 0;
    options.levels = false;
    write_fill("hidden.btf.h5", 8, 1, fill_hidden);
    weft_material material = compress_file("hidden.btf.h5", &options, NULL);
    weft_dataset *dataset = synthetic_dataset_open("hidden.btf.h5");
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    weft_table_directions directions;
    assert_int_equal(weft_table_directions_create(&material, &directions, NULL), WEFT_OK);
    for (int x = 0; x < 8; x++) {
        for (int view = 0; view < layout->view_count; view++) {
            if (!is_hidden(layout->view[view]))
                continue;
            double bright = brightness(&material, &directions, x, view, layout);
            double near = brightest_neighbour(&material, &directions, x, view, layout);
            if (bright >= 1.6 * near)
                fail_msg("texel %d, view %d: %g beside %g", x, view, bright, near);
        }
    }
    weft_table_directions_free(&directions);
    weft_dataset_close(dataset);
    weft_material_free(&material);
}

static void fill_missing(const weft_dataset_layout *layout, int x, int y, float *samples, uint8_t *mask)
{
    fill_ward(layout, x, y, samples, mask);
    memset(mask, WEFT_MASK_MISSING, (size_t)layout->image_count);
}

static void a_dataset_without_valid_samples_is_refused_by_name(void **state)
{
    (void)state;
    write_fill("missing.btf.h5", 1, 1, fill_missing);
    weft_dataset *dataset = synthetic_dataset_open("missing.btf.h5");
    weft_compress_options options = weft_compress_default_options();
    options.component_count = 0;
    options.checkpoint_path = "missing.partial";
    weft_material material;
    weft_error error = {0};
    assert_int_equal(weft_compress(dataset, &options, NULL, &material, NULL, &error), WEFT_BAD_INPUT);
    assert_string_equal(error.message, "'missing.btf.h5' holds no valid sample");
    assert_int_not_equal(access(options.checkpoint_path, F_OK), 0); /* it would be of no use */
    weft_dataset_close(dataset);
}

static void fill_spoilt(const weft_dataset_layout *layout, int x, int y, float *samples, uint8_t *mask)
{
    fill_ward(layout, x, y, samples, mask);
    for (int image = 5; image < layout->image_count; image += 9)
        samples[3 * image + 1] = 1000;
}

static void images_held_out_have_no_influence(void **state)
{
    (void)state;
    uint8_t held_out[6561] = {0};
    for (int image = 5; image < 6561; image += 9)
        held_out[image] = 1;
    weft_compress_options options = weft_compress_default_options();
    options.component_count = 0;
    options.held_out = held_out;
    weft_compress_report report;
    write_fill("clean.btf.h5", 2, 1, fill_ward);
    write_fill("spoilt.btf.h5", 2, 1, fill_spoilt);
    weft_material clean = compress_file("clean.btf.h5", &options, &report);
    weft_material spoilt = compress_file("spoilt.btf.h5", &options, NULL);
    assert_int_equal(report.sample_count, 2 * (6561 - 729));
    assert_memory_equal(clean.level[0].table, spoilt.level[0].table, 2 * 81 * 4);
    assert_memory_equal(clean.level[1].lobe, spoilt.level[1].lobe, 2 * 3 * 4 * sizeof(weft_half));
    weft_material_free(&clean);
    weft_material_free(&spoilt);
}

static void every_model_gives_a_material_of_its_shape(void **state)
{
    (void)state;
    write_fill("models.btf.h5", 2, 1, fill_ward);
    double last = INFINITY;
    for (int lobes = 0; lobes <= 3; lobes++) {
        weft_compress_options options = weft_compress_default_options();
        options.component_count = 0;
        options.lobe_count = lobes;
        weft_material with = compress_file("models.btf.h5", &options, NULL);
        options.levels = false;
        weft_material finest = compress_file("models.btf.h5", &options, NULL);
        assert_int_equal(with.lobe_count, lobes);
        assert_int_equal(with.view_count, lobes > 0 ? 81 : 0);
        assert_int_equal(with.level_count, 2);
        assert_int_equal(finest.level_count, 1);
        assert_true(with.level[0].error.rmse < 1.02 * last);
        last = with.level[0].error.rmse;
        weft_material_free(&with);
        weft_material_free(&finest);
    }
}

static void fill_reflectance(const weft_dataset_layout *layout, int x, int y, float *samples, uint8_t *mask)
{
    fill_ward(layout, x, y, samples, mask);
    for (int image = 0; image < layout->image_count; image++) {
        for (int k = 0; k < 3; k++)
            samples[3 * image + k] /= (float)layout->light[image].z;
    }
}

static void both_conventions_of_values_give_the_same_material(void **state)
{
    (void)state;
    weft_compress_options options = weft_compress_default_options();
    options.component_count = 0;
    weft_dataset_layout layout = full_layout(1, 1);
    layout.values = WEFT_REFLECTANCE;
    synthetic_dataset_write("plain.btf.h5", &layout, fill_reflectance);
    weft_dataset_layout_free(&layout);
    write_fill("cosine.btf.h5", 1, 1, fill_ward);
    weft_material plain = compress_file("plain.btf.h5", &options, NULL);
    weft_material cosine = compress_file("cosine.btf.h5", &options, NULL);
    assert_float_equal(plain.level[0].error.rmse / cosine.level[0].error.rmse, 1, 0.01);
    weft_material_free(&plain);
    weft_material_free(&cosine);
}

static void impossible_requests_are_refused(void **state)
{
    (void)state;
    write_fill("refused.btf.h5", 1, 1, fill_ward);
    weft_dataset *dataset = synthetic_dataset_open("refused.btf.h5");
    weft_compress_options options = weft_compress_default_options();
    options.component_count = 0;
    uint8_t held_out[6561];
    weft_material material;
    weft_error error = {0};
    options.lobe_count = 4;
    assert_int_equal(weft_compress(dataset, &options, NULL, &material, NULL, &error), WEFT_BAD_USAGE);
    assert_non_null(strstr(error.message, "4 lobes"));
    options = weft_compress_default_options();
    options.component_count = 6;
    assert_int_equal(weft_compress(dataset, &options, NULL, &material, NULL, &error), WEFT_BAD_USAGE);
    assert_non_null(strstr(error.message, "a multiple of 4"));
    options = weft_compress_default_options();
    options.component_count = 0;
    memset(held_out, 1, sizeof held_out);
    options.held_out = held_out;
    assert_int_equal(weft_compress(dataset, &options, NULL, &material, NULL, &error), WEFT_BAD_USAGE);
    assert_non_null(strstr(error.message, "refused.btf.h5"));
    weft_dataset_close(dataset);
}

int test_compress(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(levels_report_what_the_stored_texels_leave),
        cmocka_unit_test(mip_texels_are_fits_of_the_mean_of_their_children),
        cmocka_unit_test(number_of_threads_does_not_change_the_bytes),
        cmocka_unit_test(a_material_is_a_sixtieth_of_its_dataset),
        cmocka_unit_test(masked_samples_are_counted_and_not_used),
        cmocka_unit_test(views_that_do_not_see_a_texel_do_not_glare),
        cmocka_unit_test(a_dataset_without_valid_samples_is_refused_by_name),
        cmocka_unit_test(images_held_out_have_no_influence),
        cmocka_unit_test(every_model_gives_a_material_of_its_shape),
        cmocka_unit_test(both_conventions_of_values_give_the_same_material),
        cmocka_unit_test(impossible_requests_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
