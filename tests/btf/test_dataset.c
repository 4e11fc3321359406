#include "base/atomic_file.h"
#include "btf/dataset/dataset.h"
#include "btf/dataset/write_blocks.h"
#include "tests/support/cmocka_all.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/tiny_dataset.h"

#include <hdf5.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static weft_dataset *open_dataset(const char *path)
{
    weft_dataset *dataset;
    weft_error error = {0};
    if (weft_dataset_open(path, &dataset, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    return dataset;
}

static void write_dataset(const char *path, const weft_dataset_layout *layout, tiny_sample *sample)
{
    weft_error error = {0};
    if (tiny_dataset_write(path, layout, sample, &error) != WEFT_OK)
        fail_msg("%s", error.message);
}

static void assert_samples(const weft_dataset_layout *layout, int x, int y, const weft_half *samples,
                           const uint8_t *mask)
{
    for (int image = 0; image < layout->image_count; image++) {
        float rgb[3];
        uint8_t expected = tiny_distinct(layout, image, x, y, rgb);
        assert_int_equal(mask[image], expected);
        for (int channel = 0; channel < 3; channel++)
            assert_int_equal(samples[3 * image + channel],
                             expected & ~WEFT_MASK_SATURATED ? 0 : weft_half_of_float(rgb[channel]));
    }
}

static void assert_block(weft_dataset *dataset, int x0, int y0, int width, int height)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    size_t images = (size_t)layout->image_count, texels = (size_t)width * (size_t)height;
    weft_half *samples = malloc(texels * images * 3 * sizeof *samples);
    uint8_t *mask = malloc(texels * images);
    weft_error error = {0};
    assert_int_equal(weft_dataset_read_block(dataset, x0, y0, width, height, samples, mask, &error), WEFT_OK);
    for (int y = 0; y < height; y++) {
        for (int x = 0; x < width; x++) {
            size_t texel = (size_t)y * (size_t)width + (size_t)x;
            assert_samples(layout, x0 + x, y0 + y, samples + 3 * texel * images, mask + texel * images);
        }
    }
    free(samples);
    free(mask);
}

static void assert_layouts_equal(const weft_dataset_layout *a, const weft_dataset_layout *b)
{
    assert_int_equal(a->width, b->width);
    assert_int_equal(a->height, b->height);
    assert_int_equal(a->image_count, b->image_count);
    assert_int_equal(a->view_count, b->view_count);
    assert_int_equal(a->values, b->values);
    assert_int_equal(a->distance, b->distance);
    assert_true(a->texel_pitch_mm == b->texel_pitch_mm);
    for (int i = 0; i < a->image_count; i++) {
        assert_true(weft_length(weft_subtract(a->light[i], b->light[i])) < 1e-15);
        assert_int_equal(a->view_of_image[i], b->view_of_image[i]);
    }
    for (int i = 0; i < a->view_count; i++)
        assert_true(weft_length(weft_subtract(a->view[i], b->view[i])) < 1e-15);
}

static void a_dataset_of_any_shape_reads_back_as_written(void **state)
{
    (void)state;
    static const int shape[6][4] = {{1, 1, 1, 1},   {17, 5, 3, 2},  {3, 40, 1, 9},
                                    {65, 66, 2, 2}, {4, 3, 81, 81}, {9, 11, 33, 1}};
    for (int i = 0; i < 6; i++) {
        weft_dataset_layout layout = tiny_layout(shape[i][0], shape[i][1], shape[i][2], shape[i][3]);
        layout.values = i % 2 ? WEFT_REFLECTANCE : WEFT_REFLECTANCE_COSINE;
        write_dataset("shape.btf.h5", &layout, tiny_distinct);
        weft_dataset *dataset = open_dataset("shape.btf.h5");
        assert_layouts_equal(weft_dataset_get_layout(dataset), &layout);
        assert_string_equal(weft_dataset_path(dataset), "shape.btf.h5");
        assert_block(dataset, 0, 0, layout.width, layout.height);
        assert_block(dataset, layout.width / 2, layout.height / 3, (layout.width + 1) / 2, 1);
        assert_block(dataset, layout.width - 1, layout.height - 1, 1, 1);
        weft_dataset_close(dataset);
        weft_dataset_layout_free(&layout);
    }
    assert_int_equal(scratch_folder_entries(), 1);
    remove("shape.btf.h5");
}

/* One row of texels with so many images that the writer cannot gather it at once. */
static void a_row_larger_than_the_writers_memory_reads_back(void **state)
{
    (void)state;
    enum { TEXELS = 160, IMAGE_COUNT = 1 << 17 };
    weft_dataset_layout layout = {
        .width = TEXELS, .height = 1, .image_count = IMAGE_COUNT, .view_count = 1, .texel_pitch_mm = 1};
    assert_int_equal(weft_dataset_layout_allocate(&layout, NULL), WEFT_OK);
    layout.view[0] = weft_vec3_of(0, 0, 1);
    for (int image = 0; image < IMAGE_COUNT; image++)
        layout.light[image] = layout.view[0];
    weft_dataset_writer *writer;
    weft_error error = {0};
    if (weft_dataset_writer_create("row.btf.h5", &layout, &writer, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    for (int image = 0; image < IMAGE_COUNT; image++) {
        weft_half samples[TEXELS * 3];
        for (int i = 0; i < TEXELS * 3; i++)
            samples[i] = (weft_half)((image * 7 + i * 13) % 30011);
        assert_int_equal(weft_dataset_writer_put_image(writer, image, samples, NULL, NULL), WEFT_OK);
    }
    assert_int_equal(weft_dataset_writer_finish(writer, NULL, NULL), WEFT_OK);
    weft_dataset *dataset = open_dataset("row.btf.h5");
    weft_half *texel = malloc((size_t)IMAGE_COUNT * 3 * sizeof *texel);
    for (int x = 0; x < TEXELS; x += 3) {
        assert_int_equal(weft_dataset_read_block(dataset, x, 0, 1, 1, texel, NULL, NULL), WEFT_OK);
        for (int i = 0; i < 3 * IMAGE_COUNT; i++)
            assert_true(texel[i] == (i / 3 * 7 + (3 * x + i % 3) * 13) % 30011);
    }
    free(texel);
    weft_dataset_close(dataset);
    weft_dataset_layout_free(&layout);
    remove("row.btf.h5");
}

static void samples_and_mask_can_be_read_alone(void **state)
{
    (void)state;
    weft_dataset_layout layout = tiny_layout(3, 2, 2, 4);
    write_dataset("alone.btf.h5", &layout, tiny_distinct);
    weft_dataset *dataset = open_dataset("alone.btf.h5");
    weft_half samples[3 * 2 * 8 * 3];
    uint8_t mask[3 * 2 * 8];
    assert_int_equal(weft_dataset_read_block(dataset, 0, 0, 3, 2, samples, NULL, NULL), WEFT_OK);
    assert_int_equal(weft_dataset_read_block(dataset, 0, 0, 3, 2, NULL, mask, NULL), WEFT_OK);
    for (int texel = 0; texel < 6; texel++)
        assert_samples(&layout, texel % 3, texel / 3, samples + 24 * texel, mask + 8 * texel);
    weft_dataset_close(dataset);
    weft_dataset_layout_free(&layout);
    remove("alone.btf.h5");
}

/* As others write them, and as Weft did before 0.2: nobody says that what is saturated is a lower bound. */
static void saturated_samples_mean_nothing_unless_the_file_says_so(void **state)
{
    (void)state;
    weft_dataset_layout layout = tiny_layout(2, 2, 2, 20);
    weft_half samples[40 * 3];
    uint8_t mask[40];
    int saturated = 0;
    write_dataset("bounds.btf.h5", &layout, tiny_distinct);
    hid_t file = H5Fopen("bounds.btf.h5", H5F_ACC_RDWR, H5P_DEFAULT);
    assert_true(H5Adelete(file, "saturated_samples") >= 0);
    H5Fclose(file);
    weft_dataset *dataset = open_dataset("bounds.btf.h5");
    assert_int_equal(weft_dataset_read_block(dataset, 1, 1, 1, 1, samples, mask, NULL), WEFT_OK);
    for (int image = 0; image < 40; image++) {
        saturated += mask[image] == WEFT_MASK_SATURATED;
        assert_true((mask[image] == 0) == (samples[3 * image] != 0));
    }
    assert_true(saturated > 0);
    weft_dataset_close(dataset);
    weft_dataset_layout_free(&layout);
    remove("bounds.btf.h5");
}

static void images_come_in_any_order_and_absent_ones_are_missing(void **state)
{
    (void)state;
    weft_dataset_layout layout = tiny_layout(2, 2, 2, 20);
    weft_dataset_writer *writer;
    assert_int_equal(weft_dataset_writer_create("order.btf.h5", &layout, &writer, NULL), WEFT_OK);
    for (int image = layout.image_count - 1; image >= 0; image -= 3) {
        weft_half samples[12];
        uint8_t mask[4];
        tiny_image(&layout, tiny_distinct, image, samples, mask);
        assert_int_equal(weft_dataset_writer_put_image(writer, image, samples, mask, NULL), WEFT_OK);
    }
    assert_int_equal(weft_dataset_writer_finish(writer, "{\"source\": \"test\"}", NULL), WEFT_OK);
    weft_dataset *dataset = open_dataset("order.btf.h5");
    assert_string_equal(weft_dataset_get_layout(dataset)->provenance, "{\"source\": \"test\"}");
    weft_half samples[40 * 3];
    uint8_t mask[40];
    assert_int_equal(weft_dataset_read_block(dataset, 1, 1, 1, 1, samples, mask, NULL), WEFT_OK);
    for (int image = 0; image < 40; image++) {
        float rgb[3];
        bool was_put = (39 - image) % 3 == 0;
        assert_int_equal(mask[image], was_put ? tiny_distinct(&layout, image, 1, 1, rgb) : WEFT_MASK_MISSING);
        assert_true((mask[image] & ~WEFT_MASK_SATURATED) == 0 || samples[3 * image] == 0);
    }
    weft_dataset_close(dataset);
    weft_dataset_layout_free(&layout);
    remove("order.btf.h5");
}

static void frames_are_kept_and_are_those_of_the_surface_where_absent(void **state)
{
    (void)state;
    enum { WIDTH = 3, HEIGHT = 4 };
    weft_dataset_layout layout = tiny_layout(WIDTH, HEIGHT, 2, 1);
    float frames[HEIGHT * WIDTH][6], read[HEIGHT * WIDTH][6];
    for (int i = 0; i < HEIGHT * WIDTH; i++) {
        float c = cosf((float)i / 10), s = sinf((float)i / 10);
        memcpy(frames[i], (float[6]){s, 0, c, c, 0, -s}, sizeof frames[i]);
    }
    weft_dataset_writer *writer;
    assert_int_equal(weft_dataset_writer_create("tilted.btf.h5", &layout, &writer, NULL), WEFT_OK);
    assert_int_equal(weft_dataset_writer_put_frames(writer, &frames[0][0], NULL), WEFT_OK);
    assert_int_equal(weft_dataset_writer_finish(writer, NULL, NULL), WEFT_OK);
    weft_dataset *dataset = open_dataset("tilted.btf.h5");
    assert_true(weft_dataset_has_frames(dataset));
    assert_int_equal(weft_dataset_read_frames(dataset, 1, 3, &read[0][0], NULL), WEFT_OK);
    assert_memory_equal(read, frames[WIDTH], 3 * WIDTH * sizeof read[0]);
    assert_int_equal(weft_dataset_read_frames(dataset, 2, 3, &read[0][0], NULL), WEFT_BAD_USAGE);
    weft_dataset_close(dataset);

    write_dataset("tilted.btf.h5", &layout, tiny_smooth);
    dataset = open_dataset("tilted.btf.h5");
    assert_false(weft_dataset_has_frames(dataset));
    assert_int_equal(weft_dataset_read_frames(dataset, 0, HEIGHT, &read[0][0], NULL), WEFT_OK);
    for (int i = 0; i < HEIGHT * WIDTH; i++)
        assert_memory_equal(read[i], ((const float[6]){0, 0, 1, 1, 0, 0}), sizeof read[i]);
    weft_dataset_close(dataset);
    weft_dataset_layout_free(&layout);
}

/* Those of the layout by both writers, those that are put by the one that takes images. */
static void figures_of_images_are_kept_and_unknown_where_absent(void **state)
{
    (void)state;
    weft_dataset_layout layout = tiny_layout(4, 3, 2, 2);
    weft_dataset_writer *writer;
    weft_dataset_block_writer *blocks;
    weft_dataset *dataset;
    const double weight[4] = {0.25, 0, 3, 0.75}, light[4] = {0.5, 90, 0, 1e-9};
    weft_half samples[4 * 3 * 4 * 3] = {0};
    uint8_t mask[4 * 3 * 4] = {0};
    assert_int_equal(weft_dataset_layout_allocate_figure(&layout, WEFT_IMAGE_WEIGHT, NULL), WEFT_OK);
    memcpy(layout.figure[WEFT_IMAGE_WEIGHT], weight, sizeof weight);
    assert_int_equal(weft_dataset_writer_create("figures.btf.h5", &layout, &writer, NULL), WEFT_OK);
    assert_int_equal(weft_dataset_writer_put_figure(writer, WEFT_IMAGE_LIGHT_ERROR, light, NULL), WEFT_OK);
    assert_int_equal(weft_dataset_writer_finish(writer, NULL, NULL), WEFT_OK);
    assert_int_equal(weft_dataset_block_writer_create("blocks.btf.h5", &layout, &blocks, NULL), WEFT_OK);
    assert_int_equal(weft_dataset_block_writer_put(blocks, 0, 0, 4, 3, samples, mask, NULL), WEFT_OK);
    assert_int_equal(weft_dataset_block_writer_finish(blocks, "{}", NULL), WEFT_OK);
    for (int file = 0; file < 2; file++) {
        assert_int_equal(weft_dataset_open(file ? "blocks.btf.h5" : "figures.btf.h5", &dataset, NULL), WEFT_OK);
        double *const *figure = weft_dataset_get_layout(dataset)->figure;
        assert_memory_equal(figure[WEFT_IMAGE_WEIGHT], weight, sizeof weight);
        assert_null(figure[WEFT_IMAGE_VIEW_ERROR]);
        assert_null(figure[WEFT_IMAGE_VALUE_ERROR]);
        assert_int_equal(figure[WEFT_IMAGE_LIGHT_ERROR] != NULL, file == 0);
        if (file == 0)
            assert_memory_equal(figure[WEFT_IMAGE_LIGHT_ERROR], light, sizeof light);
        weft_dataset_close(dataset);
    }
    layout.figure[WEFT_IMAGE_WEIGHT][1] = -1;
    assert_int_equal(weft_dataset_writer_create("figures.btf.h5", &layout, &writer, NULL), WEFT_BAD_INPUT);
    weft_dataset_layout_free(&layout);
}

static void opacity_is_kept_and_is_one_where_absent(void **state)
{
    (void)state;
    enum { WIDTH = 3, HEIGHT = 4, VIEWS = 2 };
    weft_dataset_layout layout = tiny_layout(WIDTH, HEIGHT, VIEWS, 1);
    float opacity[HEIGHT * WIDTH * VIEWS], read[HEIGHT * WIDTH * VIEWS];
    for (int i = 0; i < HEIGHT * WIDTH * VIEWS; i++)
        opacity[i] = (float)i / 100;
    weft_dataset_writer *writer;
    assert_int_equal(weft_dataset_writer_create("holes.btf.h5", &layout, &writer, NULL), WEFT_OK);
    assert_int_equal(weft_dataset_writer_put_opacity(writer, opacity, NULL), WEFT_OK);
    assert_int_equal(weft_dataset_writer_finish(writer, NULL, NULL), WEFT_OK);
    weft_dataset *dataset = open_dataset("holes.btf.h5");
    assert_int_equal(weft_dataset_read_opacity(dataset, 1, 3, read, NULL), WEFT_OK);
    assert_memory_equal(read, opacity + WIDTH * VIEWS, 3 * WIDTH * VIEWS * sizeof *read);
    assert_int_equal(weft_dataset_read_opacity(dataset, 2, 3, read, NULL), WEFT_BAD_USAGE);
    weft_dataset_close(dataset);

    write_dataset("holes.btf.h5", &layout, tiny_smooth);
    dataset = open_dataset("holes.btf.h5");
    assert_int_equal(weft_dataset_read_opacity(dataset, 0, HEIGHT, read, NULL), WEFT_OK);
    for (int i = 0; i < HEIGHT * WIDTH * VIEWS; i++)
        assert_true(read[i] == 1);
    weft_dataset_close(dataset);
    weft_dataset_layout_free(&layout);
    remove("holes.btf.h5");
}

static void near_lights_are_seen_from_each_texel(void **state)
{
    (void)state;
    weft_dataset_layout layout = tiny_layout(4, 2, 1, 1);
    layout.distance = WEFT_NEAR;
    layout.texel_pitch_mm = 10;
    layout.light[0] = weft_vec3_of(15, 5, 20);
    layout.view[0] = weft_vec3_of(-15, -5, 30);
    write_dataset("near.btf.h5", &layout, tiny_distinct);
    weft_dataset *dataset = open_dataset("near.btf.h5");
    const weft_dataset_layout *read = weft_dataset_get_layout(dataset);
    assert_layouts_equal(read, &layout);
    assert_true(weft_dataset_light_direction(read, 0, 3, 0).z == 1);
    assert_true(weft_dataset_view_direction(read, 0, 0, 1).z == 1);
    weft_vec3 expected = weft_unit(weft_vec3_of(30, 10, 20));
    assert_true(weft_length(weft_subtract(weft_dataset_light_direction(read, 0, 0, 1), expected)) < 1e-15);
    weft_dataset_close(dataset);
    weft_dataset_layout_free(&layout);
    remove("near.btf.h5");
}

static void long_provenance_is_kept(void **state)
{
    (void)state;
    enum { LENGTH = 200000 };
    char *text = malloc(LENGTH + 16);
    assert_non_null(text);
    strcpy(text, "{\"a\": \"");
    memset(text + 7, 'x', LENGTH);
    strcpy(text + 7 + LENGTH, "\"}");
    weft_dataset_layout layout = tiny_layout(1, 1, 1, 1);
    free(layout.provenance);
    layout.provenance = text;
    write_dataset("long.btf.h5", &layout, tiny_smooth);
    weft_dataset *dataset = open_dataset("long.btf.h5");
    assert_string_equal(weft_dataset_get_layout(dataset)->provenance, text);
    weft_dataset_close(dataset);
    weft_dataset_layout_free(&layout);
    remove("long.btf.h5");
}

static void blocks_outside_the_material_are_refused(void **state)
{
    (void)state;
    static const int block[6][4] = {{-1, 0, 1, 1}, {0, -1, 1, 1}, {0, 0, 0, 1},
                                    {2, 0, 2, 1},  {0, 1, 1, 2},  {0, 0, INT32_MAX, 1}};
    weft_dataset_layout layout = tiny_layout(3, 2, 1, 1);
    write_dataset("block.btf.h5", &layout, tiny_smooth);
    weft_dataset *dataset = open_dataset("block.btf.h5");
    for (int i = 0; i < 6; i++) {
        weft_half samples[18];
        weft_error error = {0};
        assert_int_equal(
            weft_dataset_read_block(dataset, block[i][0], block[i][1], block[i][2], block[i][3], samples, NULL, &error),
            WEFT_BAD_USAGE);
        assert_non_null(strstr(error.message, "only 3 x 2"));
    }
    weft_dataset_close(dataset);
    weft_dataset_layout_free(&layout);
    remove("block.btf.h5");
}

static void an_abandoned_writer_leaves_nothing(void **state)
{
    (void)state;
    weft_dataset_layout layout = tiny_layout(3, 2, 1, 1);
    weft_dataset_writer *writer;
    int entries = scratch_folder_entries();
    assert_int_equal(weft_dataset_writer_create("none.btf.h5", &layout, &writer, NULL), WEFT_OK);
    weft_dataset_writer_abandon(writer);
    weft_dataset_writer_abandon(NULL);
    assert_int_equal(scratch_folder_entries(), entries);
    weft_dataset_layout_free(&layout);
}

/* A dataset with all that a file can hold, which then gets other heights. */
static void write_everything(const char *path)
{
    enum { WIDTH = 3, HEIGHT = 2, VIEWS = 2 };
    weft_dataset_layout layout = tiny_layout(WIDTH, HEIGHT, VIEWS, 1);
    static const double weight[VIEWS] = {0.25, 3};
    static const float opacity[HEIGHT * WIDTH * VIEWS] = {1, 0.5}, height[HEIGHT * WIDTH] = {0.25, -0.25};
    float frames[HEIGHT * WIDTH][6];
    for (int i = 0; i < HEIGHT * WIDTH; i++)
        memcpy(frames[i], (float[6]){0, 0, 1, 1, 0, 0}, sizeof frames[i]);
    weft_dataset_heights heights = {.width = WIDTH, .height = HEIGHT, .level_count = 1, .value = (float *)height};
    weft_dataset_writer *writer;
    assert_int_equal(weft_dataset_writer_create(path, &layout, &writer, NULL), WEFT_OK);
    assert_int_equal(weft_dataset_writer_put_figure(writer, WEFT_IMAGE_WEIGHT, weight, NULL), WEFT_OK);
    assert_int_equal(weft_dataset_writer_put_opacity(writer, opacity, NULL), WEFT_OK);
    assert_int_equal(weft_dataset_writer_put_frames(writer, &frames[0][0], NULL), WEFT_OK);
    assert_int_equal(weft_dataset_writer_put_heights(writer, &heights, NULL), WEFT_OK);
    assert_int_equal(weft_dataset_writer_finish(writer, NULL, NULL), WEFT_OK);
    assert_int_equal(weft_dataset_put_relief(path, path, 0.125, &heights, "{}", NULL), WEFT_OK);
    weft_dataset_layout_free(&layout);
}

static void the_same_content_gives_the_same_bytes_in_another_second(void **state)
{
    (void)state;
    char *first, *second;
    size_t first_size, second_size;
    write_everything("first.btf.h5");
    nanosleep(&(struct timespec){.tv_sec = 1, .tv_nsec = 50000000}, NULL);
    write_everything("second.btf.h5");
    assert_int_equal(weft_read_file("first.btf.h5", SIZE_MAX, &first, &first_size, NULL), WEFT_OK);
    assert_int_equal(weft_read_file("second.btf.h5", SIZE_MAX, &second, &second_size, NULL), WEFT_OK);
    assert_int_equal(first_size, second_size);
    assert_memory_equal(first, second, first_size);
    free(first);
    free(second);
    remove("first.btf.h5");
    remove("second.btf.h5");
}

int test_dataset(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_dataset_of_any_shape_reads_back_as_written),
        cmocka_unit_test(a_row_larger_than_the_writers_memory_reads_back),
        cmocka_unit_test(samples_and_mask_can_be_read_alone),
        cmocka_unit_test(saturated_samples_mean_nothing_unless_the_file_says_so),
        cmocka_unit_test(images_come_in_any_order_and_absent_ones_are_missing),
        cmocka_unit_test(figures_of_images_are_kept_and_unknown_where_absent),
        cmocka_unit_test(opacity_is_kept_and_is_one_where_absent),
        cmocka_unit_test(frames_are_kept_and_are_those_of_the_surface_where_absent),
        cmocka_unit_test(near_lights_are_seen_from_each_texel),
        cmocka_unit_test(long_provenance_is_kept),
        cmocka_unit_test(blocks_outside_the_material_are_refused),
        cmocka_unit_test(an_abandoned_writer_leaves_nothing),
        cmocka_unit_test(the_same_content_gives_the_same_bytes_in_another_second),
    };
    return cmocka_run_group_tests(tests, scratch_folder_enter, scratch_folder_leave);
}
