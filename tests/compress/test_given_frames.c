/* Frames that a dataset gives: where they go, and what they are good for. */
#include "btf/dataset/dataset.h"
#include "compress/compress.h"
#include "compress/run/frames_and_opacity.h"
#include "tests/support/cmocka_all.h"
#include "tests/support/synthetic_texel.h"

#include <stdio.h>
#include <string.h>

enum { SIZE = 4 };

static weft_frame true_frame(int x, int y)
{
    double tilt_rad = 0.15 + 0.02 * x, azimuth_rad = 0.9 * y;
    weft_vec3 normal = {sin(tilt_rad) * cos(azimuth_rad), sin(tilt_rad) * sin(azimuth_rad), cos(tilt_rad)};
    return weft_frame_of_normal(normal, 0.2 * x);
}

static weft_vec3 in_frame(const weft_frame *frame, weft_vec3 v)
{
    return weft_vec3_of(weft_dot(v, frame->tangent), weft_dot(v, frame->bitangent), weft_dot(v, frame->normal));
}

/* One sharp lobe, anisotropic and mirrored about the true normal: no diagonal C of another frame makes it. */
static double tilted_lobe(const weft_frame *frame, weft_vec3 light, weft_vec3 view)
{
    weft_vec3 l = in_frame(frame, light), v = in_frame(frame, view);
    double cosine = -0.7 * l.x * v.x - l.y * v.y + l.z * v.z;
    return light.z * (0.05 + pow(fmax(cosine, 0), 30));
}

static void write_tilted(const char *path)
{
    weft_dataset_layout layout;
    weft_dataset_writer *writer;
    weft_half image[SIZE * SIZE][3];
    float frames[SIZE * SIZE][2][3];
    assert_int_equal(synthetic_layout(SIZE, SIZE, &layout, NULL), WEFT_OK);
    assert_int_equal(weft_dataset_writer_create(path, &layout, &writer, NULL), WEFT_OK);
    for (int i = 0; i < layout.image_count; i++) {
        for (int texel = 0; texel < SIZE * SIZE; texel++) {
            weft_frame frame = true_frame(texel % SIZE, texel / SIZE);
            double value = tilted_lobe(&frame, layout.light[i], layout.view[layout.view_of_image[i]]);
            for (int k = 0; k < 3; k++)
                image[texel][k] = weft_half_of_float((float)value);
            for (int k = 0; k < 2; k++) {
                weft_vec3 axis = k ? frame.tangent : frame.normal;
                memcpy(frames[texel][k], (float[3]){(float)axis.x, (float)axis.y, (float)axis.z}, 3 * sizeof(float));
            }
        }
        assert_int_equal(weft_dataset_writer_put_image(writer, i, &image[0][0], NULL, NULL), WEFT_OK);
    }
    assert_int_equal(weft_dataset_writer_put_frames(writer, &frames[0][0][0], NULL), WEFT_OK);
    assert_int_equal(weft_dataset_writer_finish(writer, NULL, NULL), WEFT_OK);
    weft_dataset_layout_free(&layout);
}

static weft_material compress_one_lobe(void)
{
    weft_compress_options options = weft_compress_default_options();
    options.component_count = 0;
    weft_dataset *dataset;
    weft_material material;
    options.lobe_count = 1;
    assert_int_equal(weft_dataset_open("tilted.btf.h5", &dataset, NULL), WEFT_OK);
    assert_int_equal(weft_compress(dataset, &options, NULL, &material, NULL, NULL), WEFT_OK);
    weft_dataset_close(dataset);
    return material;
}

static double angle_between(weft_vec3 a, weft_vec3 b)
{
    return 2 * asin(fmin(1, weft_length(weft_subtract(a, b)) / 2));
}

static void given_frames_are_averaged_upward(void **state)
{
    (void)state;
    weft_dataset *dataset;
    weft_material material;
    assert_int_equal(weft_dataset_open("tilted.btf.h5", &dataset, NULL), WEFT_OK);
    assert_int_equal(weft_material_create(SIZE, SIZE, 1, 0, 0, true, &material, NULL), WEFT_OK);
    assert_int_equal(weft_given_frames_store(dataset, &material, NULL), WEFT_OK);
    weft_dataset_close(dataset);
    for (int i = 0; i < SIZE * SIZE; i++) {
        weft_frame expected = true_frame(i % SIZE, i / SIZE),
                   found = weft_frame_decode(material.level[0].frame + 3 * i);
        assert_true(angle_between(found.normal, expected.normal) < 1e-3);
        assert_true(fabs(weft_dot(found.tangent, expected.tangent)) > 0.9999);
    }
    weft_vec3 sum = {0};
    for (int i = 0; i < 4; i++)
        sum = weft_add(sum, true_frame(2 + i % 2, i / 2).normal);
    weft_frame parent = weft_frame_decode(material.level[1].frame + 3);
    assert_true(angle_between(parent.normal, weft_unit(sum)) < 1e-3);
    weft_material_free(&material);
}

static void given_frames_fit_what_the_surface_cannot(void **state)
{
    (void)state;
    weft_material material = compress_one_lobe();
    print_message("relative RMSE: %.4f\n", material.level[0].error.relative_rmse);
    assert_true(material.level[0].error.relative_rmse < 0.011);
    weft_material_free(&material);
}

static int write_dataset(void **state)
{
    (void)state;
    write_tilted("tilted.btf.h5");
    return 0;
}

static int remove_dataset(void **state)
{
    (void)state;
    return remove("tilted.btf.h5");
}

int test_given_frames(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(given_frames_are_averaged_upward),
        cmocka_unit_test(given_frames_fit_what_the_surface_cannot),
    };
    return cmocka_run_group_tests(tests, write_dataset, remove_dataset);
}
