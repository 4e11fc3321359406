/* Files of components over the half vector that another program wrote (tests/data/generate/component_files.py): both
 * kinds of maps are read, and say what the document says of them. */
#include "tests/support/cmocka_all.h"

#include "btf/direction/direction.h"
#include "btf/material/material.h"
#include "reflectance/components/components.h"
#include "tests/support/expect_ok.h"

#include <math.h>

typedef struct opened {
    weft_material material;
    weft_component_maps maps;
} opened;

static const char *const plain_path = WEFT_TEST_DATA "/reference/incidence.weft", *const squared_path = WEFT_TEST_DATA
                                                                                  "/reference/squared.weft";

static opened open_file(const char *path)
{
    weft_error error = {0};
    opened file;
    expect_ok(weft_material_read(path, &file.material, &error), &error);
    assert_non_null(file.material.components);
    expect_ok(weft_component_maps_create(file.material.components, &file.maps, &error), &error);
    return file;
}

static void close_file(opened *file)
{
    weft_component_maps_free(&file->maps);
    weft_material_free(&file->material);
}

static weft_rgb ask(const opened *file, weft_vec3 light, weft_vec3 view)
{
    float factor[3 * WEFT_COMPONENTS_GROUP];
    weft_component_factors(&file->maps, light, view, factor);
    return weft_components_texel(file->material.components, WEFT_COMPONENTS_GROUP, factor, 0, 0, 0, light.z);
}

static void kinds_are_those_of_the_files(void **state)
{
    (void)state;
    opened plain = open_file(plain_path), squared = open_file(squared_path);
    assert_int_equal(plain.material.components->kind, WEFT_COMPONENTS_OF_HALF_VECTOR);
    assert_int_equal(squared.material.components->kind, WEFT_COMPONENTS_OF_HALF_VECTOR_SQUARED);
    assert_int_equal(squared.material.components->image_count, 21);
    assert_int_equal(squared.material.components->first[2], 14);
    assert_float_equal(squared.material.components->view_variance_threshold, 10, 0);
    close_file(&plain);
    close_file(&squared);
}

/* The maps of both are the same, so that they differ by l . h. Values are half floats, which smooth maps continue. */
static void the_square_is_divided_out(void **state)
{
    (void)state;
    opened plain = open_file(plain_path), squared = open_file(squared_path);
    double least = 1;
    int compared = 0;
    for (int i = 0; i < 200; i++) {
        weft_vec3 light = weft_direction_of_angles((weft_angles){1.2 * fmod(0.618 * i, 1), 2.4 * i}),
                  view = weft_direction_of_angles((weft_angles){1.2 * fmod(0.755 * i, 1), 1.7 * i});
        double incidence = weft_dot(light, weft_unit(weft_add(light, view)));
        weft_rgb once = ask(&plain, light, view), twice = ask(&squared, light, view);
        if (fmin((double)once.r, fmin((double)once.g, (double)once.b)) < 0.1)
            continue; /* the maps end at the horizon */
        compared++;
        least = fmin(least, incidence);
        assert_float_equal(incidence * twice.r / once.r, 1, 0.01);
        assert_float_equal(incidence * twice.g / once.g, 1, 0.01);
        assert_float_equal(incidence * twice.b / once.b, 1, 0.01);
    }
    assert_true(compared > 100);
    assert_true(least < 0.7); /* where the power makes a difference */
    close_file(&plain);
    close_file(&squared);
}

/* At an image, next to its own value: 0.5 + cos(..) / 4, times coefficient and scale of each layer. */
static void images_have_their_values(void **state)
{
    (void)state;
    static const double coefficient[] = {100, 50, 20, 127};
    opened squared = open_file(squared_path);
    weft_vec3 light = weft_direction_of_angles((weft_angles){weft_rad_of_deg(35), weft_rad_of_deg(140)}),
              view = weft_direction_of_angles((weft_angles){weft_rad_of_deg(40), weft_rad_of_deg(100)});
    double incidence = weft_dot(light, weft_unit(weft_add(light, view))), expected = 0;
    for (int layer = 0; layer < WEFT_COMPONENTS_GROUP; layer++)
        expected += coefficient[layer] / 127 / (layer + 1) * (0.5 + 0.25 * cos(1.3 * 2 + 0.7 + layer)) / incidence;
    weft_rgb is = ask(&squared, light, view);
    print_message("%.4f, expected %.4f\n", is.r, expected);
    assert_float_equal(is.r / expected, 1, 0.05);
    close_file(&squared);
}

int test_component_files(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(kinds_are_those_of_the_files),
        cmocka_unit_test(the_square_is_divided_out),
        cmocka_unit_test(images_have_their_values),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
