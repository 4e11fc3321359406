/* Cloth with holes through the whole fit: opacity and reflectance of every level. */
#include "tests/support/cmocka_all.h"

#include "btf/direction/direction.h"
#include "compress/compress.h"
#include "reflectance/lafortune/lafortune.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* No powers of two, so that the last texel of a level covers fewer than the others. */
enum { WIDTH = 11, HEIGHT = 5, VIEWS = 7, LIGHTS = 37 };

static const double cloth = 0.6;

static weft_vec3 direction(int index)
{
    return weft_direction_of_angles(weft_ubo81_angles(index));
}

/* Which part of a texel is cloth, seen from a view: anything. */
static double covered(int x, int y, int view)
{
    return (x * 7 + y * 5 + view * 3) % 5 / 4.0;
}

static weft_half whole_texel(int x, int y, int image)
{
    double light_z = direction(image % LIGHTS).z;
    return weft_half_of_float((float)(cloth * covered(x, y, image / LIGHTS) * light_z));
}

static void write_holes(const char *path)
{
    weft_error error = {0};
    weft_dataset_layout layout = {.width = WIDTH,
                                  .height = HEIGHT,
                                  .image_count = VIEWS * LIGHTS,
                                  .view_count = VIEWS,
                                  .values = WEFT_REFLECTANCE_COSINE,
                                  .texel_pitch_mm = 0.5};
    weft_dataset_writer *writer;
    weft_half image[HEIGHT * WIDTH][3];
    float opacity[HEIGHT * WIDTH * VIEWS];
    assert_int_equal(weft_dataset_layout_allocate(&layout, &error), WEFT_OK);
    for (int i = 0; i < VIEWS * LIGHTS; i++) {
        layout.light[i] = direction(i % LIGHTS);
        layout.view[i / LIGHTS] = direction(i / LIGHTS);
        layout.view_of_image[i] = i / LIGHTS;
    }
    for (int i = 0; i < HEIGHT * WIDTH * VIEWS; i++)
        opacity[i] = (float)covered(i / VIEWS % WIDTH, i / VIEWS / WIDTH, i % VIEWS);
    assert_int_equal(weft_dataset_writer_create(path, &layout, &writer, &error), WEFT_OK);
    for (int i = 0; i < VIEWS * LIGHTS; i++) {
        for (int t = 0; t < 3 * HEIGHT * WIDTH; t++)
            image[t / 3][t % 3] = whole_texel(t / 3 % WIDTH, t / 3 / WIDTH, i);
        assert_int_equal(weft_dataset_writer_put_image(writer, i, &image[0][0], NULL, &error), WEFT_OK);
    }
    assert_int_equal(weft_dataset_writer_put_opacity(writer, opacity, &error), WEFT_OK);
    assert_int_equal(weft_dataset_writer_finish(writer, NULL, &error), WEFT_OK);
    weft_dataset_layout_free(&layout);
}

/* Mean over the texels of level 0 below texel (x, y) of level k. */
static double mean_covered(int k, int x, int y, int view)
{
    double sum = 0;
    int count = 0;
    for (int row = 0; row < HEIGHT; row++) {
        for (int column = 0; column < WIDTH; column++) {
            if (row >> k != y || column >> k != x)
                continue;
            sum += covered(column, row, view);
            count++;
        }
    }
    return sum / count;
}

/* The same of the codes of level 0, which are whole numbers. */
static double mean_code(int k, int x, int y, int view)
{
    double sum = 0;
    int count = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        if (i % WIDTH >> k != x || i / WIDTH >> k != y)
            continue;
        sum += floor(255 * covered(i % WIDTH, i / WIDTH, view) + 0.5);
        count++;
    }
    return sum / count;
}

/* Every level of a material of the dataset, with one lobe or with components alone. */
static void check_levels(const weft_compress_options *options)
{
    weft_dataset *dataset;
    weft_material material;
    weft_table_directions directions;
    weft_error error = {0};
    assert_int_equal(weft_dataset_open("holes.btf.h5", &dataset, &error), WEFT_OK);
    assert_int_equal(weft_compress(dataset, options, NULL, &material, NULL, &error), WEFT_OK);
    assert_int_equal(weft_table_directions_create(&material, &directions, &error), WEFT_OK);
    assert_int_equal(material.level_count, 5);
    for (int k = 0; k < material.level_count; k++) {
        const weft_material_level *level = &material.level[k];
        for (int i = 0; i < level->width * level->height * VIEWS; i++) {
            int view = i % VIEWS, x = i / VIEWS % level->width, y = i / VIEWS / level->width;
            double expected = mean_covered(k, x, y, view);
            weft_rgba value =
                weft_material_texel(&material, &directions, k, x, y, weft_vec3_of(0, 0, 1), material.view[view]);
            assert_float_equal(value.a, expected, 1 / 255.0);
            assert_float_equal(255 * value.a, mean_code(k, x, y, view), 0.5 + 1e-6);
            if (options->component_count == 0)
                assert_float_equal(value.g, cloth * expected, 0.01);
        }
    }
    weft_table_directions_free(&directions);
    weft_material_free(&material);
    weft_dataset_close(dataset);
}

static void reflectance_and_opacity_of_a_level_are_means_of_the_same_texels(void **state)
{
    (void)state;
    weft_compress_options options = weft_compress_default_options();
    options.component_count = 0;
    options.lobe_count = 1;
    write_holes("holes.btf.h5");
    check_levels(&options);
}

static void components_keep_the_opacity(void **state)
{
    (void)state;
    weft_compress_options options = weft_compress_default_options();
    options.component_count = 4;
    write_holes("holes.btf.h5");
    check_levels(&options);
}

int test_opacity(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reflectance_and_opacity_of_a_level_are_means_of_the_same_texels),
        cmocka_unit_test(components_keep_the_opacity),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
