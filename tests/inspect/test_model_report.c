/* The picture and the page of the models that texels have. */
#include "base/atomic_file.h"
#include "btf/material/models.h"
#include "inspect/inspect.h"
#include "tests/compare/fixture.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* 4 x 2 texels and their levels; texel i of level 0 has model i. */
static weft_material material_of_many_models(void)
{
    weft_material material;
    weft_error error = {0};
    expect_ok(weft_material_create(4, 2, 2, 3, 0, 1, &material, &error), &error);
    expect_ok(weft_material_add_models(&material, &error), &error);
    for (int i = 0; i < 8; i++)
        material.level[0].model[i] = (uint8_t)i;
    return material;
}

static void assert_colour(const weft_image *image, int x, int y, uint8_t code)
{
    float rgb[3];
    weft_model_colour(code, rgb);
    assert_memory_equal(image->pixels + 3 * (y * image->width + x), rgb, sizeof rgb);
}

static void every_texel_has_the_colour_of_its_model(void **state)
{
    (void)state;
    weft_material material = material_of_many_models();
    weft_image image;
    weft_error error = {0};
    expect_ok(weft_model_picture(&material, &image, &error), &error);
    int scale = 512 / (4 + 2);
    for (int i = 0; i < 8; i++)
        assert_colour(&image, i % 4 * scale + scale / 2, i / 4 * scale + scale / 2, (uint8_t)i);
    for (int i = 0; i < 8; i++)
        assert_colour(&image, 8, image.height - 8 * 18 + i * 18, (uint8_t)i);
    weft_image_free(&image);
    weft_material_free(&material);
}

static void models_have_colours_of_their_own(void **state)
{
    (void)state;
    for (int a = 0; a < WEFT_MODEL_CODES; a++) {
        for (int b = 0; b < a; b++) {
            float one[3], other[3], distance = 0;
            weft_model_colour((uint8_t)a, one);
            weft_model_colour((uint8_t)b, other);
            for (int c = 0; c < 3; c++)
                distance += (one[c] - other[c]) * (one[c] - other[c]);
            weft_model_parts p = weft_model_decode((uint8_t)a), q = weft_model_decode((uint8_t)b);
            bool same_kind = p.lobe_count == q.lobe_count && (p.table_bits > 0) == (q.table_bits > 0) &&
                             (p.light_table_bits > 0) == (q.light_table_bits > 0);
            assert_true(same_kind || distance > 1e-4f);
        }
    }
}

static void the_page_counts_the_texels_of_each_model(void **state)
{
    (void)state;
    weft_material material = material_of_many_models();
    weft_error error = {0};
    char *html;
    size_t size;
    material.level[1].error.relative_rmse = 0.125;
    expect_ok(weft_model_report_write("model_report", &material, &error), &error);
    expect_ok(weft_read_file("model_report/index.html", 1 << 20, &html, &size, &error), &error);
    assert_non_null(strstr(html, "<th scope=\"col\">2 lobes, T 4 bits</th>"));
    assert_non_null(strstr(html, "<td>0</td><td>4 \u00d7 2</td><td>12.5 %</td>"));
    assert_non_null(strstr(html, "<td>12.50 %</td></tr>"));
    free(html);
    weft_image image;
    expect_ok(weft_image_read("model_report/models.png", &image, NULL, &error), &error);
    weft_image_free(&image);
    weft_material_free(&material);
    unlink("model_report/index.html");
    unlink("model_report/models.png");
    rmdir("model_report");
}

static void a_material_without_maps_is_refused(void **state)
{
    (void)state;
    weft_material material;
    weft_image image;
    weft_error error = {0};
    expect_ok(weft_material_create(4, 2, 2, 3, 0, 1, &material, &error), &error);
    assert_int_equal(weft_model_picture(&material, &image, &error), WEFT_BAD_USAGE);
    weft_material_free(&material);
}

int test_model_report(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_texel_has_the_colour_of_its_model),
        cmocka_unit_test(models_have_colours_of_their_own),
        cmocka_unit_test(the_page_counts_the_texels_of_each_model),
        cmocka_unit_test(a_material_without_maps_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
