/* The error in a material's file is the one that its reader gets, from cloth as dark as half floats can hold to cloth
 * (or units) ten thousand times as bright. The reader here is another than the fit: it samples the file in double. */
#include "tests/support/cmocka_all.h"

#include "btf/direction/direction.h"
#include "btf/material/material.h"
#include "reflectance/lafortune/lafortune.h"
#include "tests/support/run_weft.h"
#include "tests/support/synthetic_dataset.h"
#include "tests/support/synthetic_texel.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { WIDTH = 3, HEIGHT = 2, SIDE = 21 };

/* Part of the error that file and reader may differ by; 2e-7 was measured, 5e-3 is the floor. */
#define MOST_APART 1e-5

static const double gains[] = {1e-6, 1e-5, 1e-4, 1e-2, 1, 1e2, 1e4};
static double gain = 1;

static const char *const dataset_path = "gains.btf.h5", *const path = "gains.weft";

/* Each of the first views under each of the first lights of every fourth of 81 directions: at most SIDE of either. */
static void lay_out(int views, int lights, weft_dataset_layout *layout)
{
    *layout = (weft_dataset_layout){
        .width = WIDTH, .height = HEIGHT, .image_count = views * lights, .view_count = views, .texel_pitch_mm = 0.1};
    assert_int_equal(weft_dataset_layout_allocate(layout, NULL), WEFT_OK);
    for (int view = 0; view < views; view++) {
        layout->view[view] = weft_direction_of_angles(weft_ubo81_angles(4 * view));
        for (int light = 0; light < lights; light++) {
            layout->light[view * lights + light] = weft_direction_of_angles(weft_ubo81_angles(4 * light));
            layout->view_of_image[view * lights + light] = view;
        }
    }
}

static void fill_yarn(const weft_dataset_layout *layout, int x, int y, float *samples, uint8_t *mask)
{
    (void)mask;
    synthetic_texel(layout, SYNTHETIC_YARN, (uint64_t)(8 * y + x), 0.01, samples);
    for (int i = 0; i < 3 * layout->image_count; i++)
        samples[i] = (float)fmin(gain * (double)samples[i], 65504);
}

/* ---- The reader ---- */

typedef struct reader {
    weft_material material;
    weft_table_directions directions;
    weft_dataset_layout layout;
    weft_half *samples; /* [HEIGHT][WIDTH][image][3] */
} reader;

static void open_reader(reader *of)
{
    weft_dataset *dataset = synthetic_dataset_open(dataset_path);
    int views = weft_dataset_get_layout(dataset)->view_count;
    lay_out(views, weft_dataset_get_layout(dataset)->image_count / views, &of->layout);
    of->samples = calloc((size_t)(WIDTH * HEIGHT * of->layout.image_count), 3 * sizeof *of->samples);
    assert_non_null(of->samples);
    assert_int_equal(weft_dataset_read_block(dataset, 0, 0, WIDTH, HEIGHT, of->samples, NULL, NULL), WEFT_OK);
    weft_dataset_close(dataset);
    assert_int_equal(weft_material_read(path, &of->material, NULL), WEFT_OK);
    assert_int_equal(weft_table_directions_create(&of->material, &of->directions, NULL), WEFT_OK);
}

static void close_reader(reader *of)
{
    weft_table_directions_free(&of->directions);
    weft_material_free(&of->material);
    weft_dataset_layout_free(&of->layout);
    free(of->samples);
}

/* The mean samples of the texels that texel (x, y) of a level stands for. */
static void mean_of_group(const reader *of, int level, int x, int y, int image, double mean[3])
{
    int count = 0;
    mean[0] = mean[1] = mean[2] = 0;
    for (int row = y << level; row < HEIGHT && row < (y + 1) << level; row++) {
        for (int column = x << level; column < WIDTH && column < (x + 1) << level; column++, count++) {
            const weft_half *half = of->samples + 3 * ((row * WIDTH + column) * of->layout.image_count + image);
            for (int k = 0; k < 3; k++)
                mean[k] += (double)weft_float_of_half(half[k]);
        }
    }
    for (int k = 0; k < 3; k++)
        mean[k] /= count;
}

static void read_texel(const reader *of, int level, int x, int y, weft_error_sums *sums)
{
    const weft_material_level *at = &of->material.level[level];
    weft_real u = (x + 0.5) / at->width, v = 1 - (y + 0.5) / at->height;
    for (int image = 0; image < of->layout.image_count; image++) {
        weft_vec3 light = of->layout.light[image], view = of->layout.view[of->layout.view_of_image[image]];
        weft_rgba f = weft_material_sample(&of->material, &of->directions, level, u, v, light, view);
        const double value[3] = {f.r, f.g, f.b};
        double mean[3];
        mean_of_group(of, level, x, y, image, mean);
        for (int k = 0; k < 3; k++)
            weft_error_sums_add_value(sums, mean[k], value[k] * light.z);
    }
}

static void expect_the_readers_error(const char *options)
{
    reader of;
    open_reader(&of);
    for (int level = 0; level < of.material.level_count; level++) {
        const weft_material_level *at = &of.material.level[level];
        weft_error_sums sums = {0};
        for (int texel = 0; texel < at->width * at->height; texel++)
            read_texel(&of, level, texel % at->width, texel / at->width, &sums);
        double relative = weft_error_sums_relative_rmse(&sums), rmse = sqrt(sums.square_error / sums.count);
        if (fabs(at->error.relative_rmse / relative - 1) > MOST_APART || fabs(at->error.rmse / rmse - 1) > MOST_APART)
            fail_msg("gain %g, '%s', level %d: the file says %g (%g), its reader gets %g (%g)", gain, options, level,
                     at->error.relative_rmse, at->error.rmse, relative, rmse);
    }
    close_reader(&of);
}

/* ---- Tests ---- */

static void write_dataset(int views, int lights)
{
    weft_dataset_layout layout;
    lay_out(views, lights, &layout);
    synthetic_dataset_write(dataset_path, &layout, fill_yarn);
    weft_dataset_layout_free(&layout);
}

static void compress_and_read(const char *options)
{
    char arguments[256];
    snprintf(arguments, sizeof arguments, "compress %s -o %s --quiet --hold-out off %s", dataset_path, path, options);
    expect_weft(arguments, 0, "");
    expect_the_readers_error(options);
}

static void the_file_says_the_error_of_its_reader_at_every_gain(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof gains / sizeof *gains; i++) {
        gain = gains[i];
        write_dataset(SIDE, SIDE);
        compress_and_read("--lobes 2");
        compress_and_read("--lobes 3");
        compress_and_read("--weights screen --lobes 1");
        write_dataset(1, SIDE);
        compress_and_read("--lobes 2");
        write_dataset(1, SIDE / 2);
        compress_and_read("--lobes 2");
    }
}

int test_gains(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_file_says_the_error_of_its_reader_at_every_gain),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
