/* The reference vectors of whole weaves. Built twice: in double, and in single precision. */
#include "reflectance/weave/weave.h"
#include "tests/reflectance/vectors.h"

#include <omp.h>
#include <stdio.h>
#include <string.h>

enum { FABRICS = 6 };

static const char *const fabric_file[FABRICS] = {"charmeuse.wv", "denim.wv",    "gabardine.wv",
                                                 "polyester.wv", "shantung.wv", "twill.wv"};

typedef struct fabrics {
    weft_weave weave[FABRICS];
} fabrics;

static int read_fabrics(void **state)
{
    static fabrics all;
    for (int i = 0; i < FABRICS; i++) {
        char path[512], warning[WEFT_MESSAGE_SIZE];
        weft_error error = {0};
        snprintf(path, sizeof path, "%s/reference/weaves/%s", WEFT_TEST_DATA, fabric_file[i]);
        if (weft_weave_read(path, NULL, 0, &all.weave[i], warning, &error) != WEFT_OK)
            fail_msg("%s", error.message);
        assert_string_equal(warning, "");
    }
    *state = &all;
    return 0;
}

static int free_fabrics(void **state)
{
    fabrics *all = *state;
    for (int i = 0; i < FABRICS; i++)
        weft_weave_free(&all->weave[i]);
    return 0;
}

static int fabric_index(const char *file)
{
    for (int i = 0; i < FABRICS; i++)
        if (strcmp(file, fabric_file[i]) == 0)
            return i;
    fail_msg("no fabric %s", file);
    return 0;
}

static void scale_is_the_reference_s(void **state)
{
    fabrics *all = *state;
    reference_vectors v = vectors_open("weave_norm.csv", FABRICS);
    for (int row = 0; row < FABRICS; row++) {
        const weft_weave *weave = &all->weave[fabric_index(vectors_text(&v, row, "file"))];
        double s = vectors_number(&v, row, "s");
        double allowed = fmax(0.003, 3 * vectors_number(&v, row, "s_rel_uncertainty"));
        vectors_check_within(&v, row, "s", weave->specular_scale, allowed * s);
        vectors_check_within(&v, row, "tile_width", weave->tile_width, 0);
        vectors_check_within(&v, row, "tile_height", weave->tile_height, 0);
        vectors_check_within(&v, row, "n_yarns", weave->yarn_count, 0);
    }
    vectors_close(&v);
}

static void scale_does_not_depend_on_the_number_of_threads(void **state)
{
    fabrics *all = *state;
    int usual = omp_get_max_threads();
    for (int i = 0; i < 2; i++) {
        weft_real s = all->weave[i].specular_scale;
        omp_set_num_threads(1);
        assert_true(weft_weave_specular_scale(&all->weave[i]) == s);
        omp_set_num_threads(5);
        assert_true(weft_weave_specular_scale(&all->weave[i]) == s);
    }
    omp_set_num_threads(usual);
}

/* The other vectors use exactly the printed s. */
static int use_printed_scale(void **state)
{
    fabrics *all = *state;
    reference_vectors v = vectors_open("weave_norm.csv", FABRICS);
    for (int row = 0; row < FABRICS; row++)
        all->weave[fabric_index(vectors_text(&v, row, "file"))].specular_scale =
            (weft_real)vectors_number(&v, row, "s");
    weft_csv_free(&v.csv);
    return 0;
}

/* spec carries the condition of the row; the diffuse part is exact, so f cannot be worse off than spec. */
static void check_colour(reference_vectors *v, int row, weft_rgb f)
{
    vectors_check(v, row, "f_r", f.r);
    vectors_check(v, row, "f_g", f.g);
    vectors_check(v, row, "f_b", f.b);
}

static void texture_of_the_tile_matches_every_row(void **state)
{
    fabrics *all = *state;
    reference_vectors v = vectors_open("weave_eval.csv", 294);
    for (int row = 0; row < v.csv.row_count; row++) {
        const weft_weave *weave = &all->weave[fabric_index(vectors_text(&v, row, "file"))];
        weft_vec3 light = vectors_direction(&v, row, "wi"), view = vectors_direction(&v, row, "wo");
        weft_real U = (weft_real)vectors_number(&v, row, "U"), V = (weft_real)vectors_number(&v, row, "V");
        weft_weave_point point = weft_weave_locate(weave, U, V, 0);
        weft_real specular = weft_weave_specular(weave, &point, light, view);
        /* Places are differences of numbers of the size of the tile. */
        double place = 1e-6 + 40 * (double)WEFT_REAL_EPSILON * weave->tile_height;
        vectors_check_within(&v, row, "yarn", point.yarn + 1, 0);
        vectors_check_within(&v, row, "x_seg", point.x, place);
        vectors_check_within(&v, row, "y_seg", point.y, place);
        vectors_check(&v, row, "spec", specular);
        vectors_check(&v, row, "T", specular > 0 ? specular / weave->yarn[point.yarn].area_weight : 0);
        check_colour(&v, row, weft_weave_brdf(weave, &point, light, view));
    }
    vectors_close(&v);
}

static void mean_of_the_tile_matches_every_row(void **state)
{
    fabrics *all = *state;
    reference_vectors v = vectors_open("weave_mean.csv", 222);
    for (int row = 0; row < v.csv.row_count; row++) {
        const weft_weave *weave = &all->weave[fabric_index(vectors_text(&v, row, "file"))];
        weft_vec3 light = vectors_direction(&v, row, "wi"), view = vectors_direction(&v, row, "wo");
        vectors_check(&v, row, "spec", weft_weave_mean_specular(weave, light, view));
        check_colour(&v, row, weft_weave_mean_brdf(weave, light, view));
    }
    vectors_close(&v);
}

int test_weave_vectors(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(scale_is_the_reference_s),
        cmocka_unit_test(scale_does_not_depend_on_the_number_of_threads),
        cmocka_unit_test_setup(texture_of_the_tile_matches_every_row, use_printed_scale),
        cmocka_unit_test_setup(mean_of_the_tile_matches_every_row, use_printed_scale),
    };
    return cmocka_run_group_tests_name("weave vectors", tests, read_fabrics, free_fabrics);
}
