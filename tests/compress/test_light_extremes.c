/* S of samples at the extremes, and of datasets with next to no directions: what comes out is finite and black where
 * nothing was seen. */
#include "tests/support/cmocka_all.h"

#include "compress/compress.h"
#include "reflectance/lafortune/lafortune.h"
#include "tests/support/synthetic_dataset.h"
#include "tests/support/synthetic_texel.h"

#include <math.h>
#include <string.h>

enum { EXTREMES = 10 };

/* Texel x of a row: dark, one spike, constant, bright, faint, half masked, one sample, none, negative, a spike a view.
 */
static void fill_extremes(const weft_dataset_layout *layout, int x, int y, float *samples, uint8_t *mask)
{
    static const float scale[EXTREMES] = {0, 0, 1, 1e4f, 1e-6f, 1, 1, 1, 1, 0};
    synthetic_texel(layout, SYNTHETIC_WARD, 1, 0.01, samples);
    for (int image = 0; image < layout->image_count; image++) {
        bool hidden = (x == 5 && image % 2) || (x == 6 && image > 0) || x == 7;
        mask[image] = hidden ? WEFT_MASK_MISSING : 0;
        for (int c = 0; c < 3; c++) {
            float *sample = samples + 3 * image + c;
            *sample = x == 2 ? 0.5f : fminf(*sample * scale[x], 6e4f);
            if ((x == 1 && image == 0) || (x == 9 && image % 81 == layout->view_of_image[image] % 81))
                *sample = 6e4f;
            if (x == 8 && image % 3 == 0)
                *sample = -1;
        }
    }
    (void)y;
}

static void expect_finite(const weft_material *material)
{
    weft_table_directions directions;
    assert_int_equal(weft_table_directions_create(material, &directions, NULL), WEFT_OK);
    for (int x = 0; x < EXTREMES; x++) {
        for (int i = 0; i < 64; i++) {
            double phi = i * 0.7;
            weft_vec3 light = weft_unit(weft_vec3_of(cos(phi), sin(phi), 0.05 + i % 8 * 0.3));
            weft_vec3 view = weft_unit(weft_vec3_of(cos(2 * phi), sin(2 * phi), 0.05 + i / 8 * 0.3));
            weft_rgba seen = weft_material_texel(material, &directions, 0, x, 0, light, view);
            if (!isfinite(seen.r) || !isfinite(seen.g) || !isfinite(seen.b))
                fail_msg("texel %d, direction %d: %g %g %g", x, i, (double)seen.r, (double)seen.g, (double)seen.b);
            if ((x == 0 || x == 7) && seen.g != 0)
                fail_msg("texel %d shows %g, seen was nothing", x, (double)seen.g);
        }
    }
    weft_table_directions_free(&directions);
}

static void expect_finite_with_light_table(weft_dataset_layout *layout, int lobe_count, int light_count)
{
    weft_compress_options options = weft_compress_default_options();
    weft_material material;
    weft_error error = {0};
    options.levels = false;
    options.light_table = true;
    options.lobe_count = lobe_count;
    synthetic_dataset_write("extremes.btf.h5", layout, fill_extremes);
    weft_dataset *dataset = synthetic_dataset_open("extremes.btf.h5");
    if (weft_compress(dataset, &options, NULL, &material, NULL, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    assert_int_equal(material.light_count, light_count);
    expect_finite(&material);
    weft_material_free(&material);
    weft_dataset_close(dataset);
}

/* The images of one view, or under one light, alone. */
static void keep_images(weft_dataset_layout *layout, bool one_view)
{
    int kept = 0;
    weft_vec3 light = layout->light[3];
    for (int image = 0; image < layout->image_count; image++) {
        weft_vec3 own = layout->light[image];
        if (one_view ? layout->view_of_image[image] != 3 : own.x != light.x || own.y != light.y || own.z != light.z)
            continue;
        layout->view_of_image[kept] = layout->view_of_image[image];
        layout->light[kept++] = own;
    }
    layout->image_count = kept;
    assert_in_range(kept, 2, 81);
}

static void extremes_stay_finite(void **state)
{
    (void)state;
    for (int lobes = 0; lobes <= 3; lobes++) {
        weft_dataset_layout layout;
        assert_int_equal(synthetic_layout(EXTREMES, 1, &layout, NULL), WEFT_OK);
        expect_finite_with_light_table(&layout, lobes, 81);
        weft_dataset_layout_free(&layout);
    }
}

/* Of one view no light repeats, and there is no S. */
static void one_view_or_one_light_is_enough(void **state)
{
    (void)state;
    for (int one_view = 0; one_view < 2; one_view++) {
        weft_dataset_layout layout;
        assert_int_equal(synthetic_layout(EXTREMES, 1, &layout, NULL), WEFT_OK);
        keep_images(&layout, one_view);
        expect_finite_with_light_table(&layout, 2, one_view ? 0 : 1);
        weft_dataset_layout_free(&layout);
    }
}

int test_light_extremes(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(extremes_stay_finite),
        cmocka_unit_test(one_view_or_one_light_is_enough),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
