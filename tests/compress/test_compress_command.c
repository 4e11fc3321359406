/* weft compress as a user runs it. */
#include "tests/support/cmocka_all.h"

#include "base/atomic_file.h"
#include "btf/direction/direction.h"
#include "btf/material/material.h"
#include "tests/support/run_weft.h"
#include "tests/support/synthetic_dataset.h"
#include "tests/support/synthetic_texel.h"

#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static void fill_yarn(const weft_dataset_layout *layout, int x, int y, float *samples, uint8_t *mask)
{
    (void)mask;
    synthetic_texel(layout, SYNTHETIC_YARN, (uint64_t)(8 * y + x), 0.01, samples);
}

static int write_dataset(void **state)
{
    (void)state;
    weft_dataset_layout layout;
    assert_int_equal(synthetic_layout(3, 2, &layout, NULL), WEFT_OK);
    synthetic_dataset_write("command.btf.h5", &layout, fill_yarn);
    weft_dataset_layout_free(&layout);
    return 0;
}

static void a_dataset_becomes_a_material_with_a_table_of_errors(void **state)
{
    (void)state;
    char said[8192];
    assert_int_equal(run_weft("", "compress command.btf.h5 -o command.weft --lobes 1 --hold-out off", said), 0);
    assert_non_null(strstr(said, "median rel."));
    assert_non_null(strstr(said, "3 x 2"));
    assert_non_null(strstr(said, "fitted in"));
    weft_material material;
    assert_int_equal(weft_material_read("command.weft", &material, NULL), WEFT_OK);
    assert_int_equal(material.lobe_count, 1);
    assert_int_equal(material.view_count, 81);
    assert_int_equal(material.level_count, 3);
    assert_true(material.level[0].error.relative_rmse > 0);
    assert_non_null(strstr(material.metadata, "lobes and view table"));
    weft_material_free(&material);
}

static void the_error_where_it_was_not_fitted_is_said_and_kept(void **state)
{
    (void)state;
    weft_material material;
    char said[8192];
    expect_weft("compress command.btf.h5 -o held.weft --lobes 1", 0,
                "on directions that were not fitted: relative RMSE ");
    assert_int_equal(weft_material_read("held.weft", &material, NULL), WEFT_OK);
    assert_non_null(strstr(material.metadata, "\"held_out\":{"));
    weft_material_free(&material);
    assert_int_equal(run_weft("", "compress command.btf.h5 -o held.weft --lobes 1 --hold-out 2 --json", said), 0);
    assert_non_null(strstr(said, "{\"event\":\"held_out\""));
    assert_non_null(strstr(said, "\"splits\":2"));
    assert_int_equal(run_weft("", "info held.weft", said), 0);
    const char *not_fitted = strstr(said, "not_fitted: 0."), *level = strstr(said, "levels 0:");
    assert_true(not_fitted && level && not_fitted < level);
    expect_weft_after("ls > listed && ! grep held-out listed &&", "info held.weft", 0, "photographs_interpolated: ");
}

static void the_fit_itself_has_all_images_with_or_without(void **state)
{
    (void)state;
    weft_material with, without;
    expect_weft("compress command.btf.h5 -o with.weft --lobes 1 --hold-out 1", 0, "not fitted");
    assert_int_equal(weft_material_read("with.weft", &with, NULL), WEFT_OK);
    char said[8192];
    assert_int_equal(run_weft("", "compress command.btf.h5 -o without.weft --lobes 1 --hold-out off", said), 0);
    assert_null(strstr(said, "not fitted"));
    assert_int_equal(weft_material_read("without.weft", &without, NULL), WEFT_OK);
    assert_null(strstr(without.metadata, "held_out"));
    assert_int_equal(with.view_count, without.view_count);
    assert_memory_equal(with.level[0].table, without.level[0].table, (size_t)with.view_count * 3 * 2 * 4);
    assert_memory_equal(with.level[0].lobe, without.level[0].lobe, (size_t)with.lobe_count * 3 * 3 * 2 * 4 * 2);
    weft_material_free(&with);
    weft_material_free(&without);
    expect_weft("compress command.btf.h5 -o with.weft --hold-out 0", 2, "--hold-out");
}

static void weights_are_kept_with_the_material(void **state)
{
    (void)state;
    weft_material even, screen;
    expect_weft("compress command.btf.h5 -o even.weft --lobes 1 --weights even --hold-out off", 0, "fitted in");
    expect_weft("compress command.btf.h5 -o screen.weft --lobes 1 --weights screen --hold-out off", 0, "fitted in");
    assert_int_equal(weft_material_read("even.weft", &even, NULL), WEFT_OK);
    assert_int_equal(weft_material_read("screen.weft", &screen, NULL), WEFT_OK);
    assert_null(strstr(even.metadata, "\"weights\""));
    assert_non_null(strstr(screen.metadata, "\"weights\":\"screen\""));
    assert_true(screen.level[0].error.relative_rmse > even.level[0].error.relative_rmse);
    weft_material_free(&even);
    weft_material_free(&screen);
    expect_weft("compress command.btf.h5 -o a.weft --weights bright", 2, "'bright'");
}

/* `views` views of `lights` directions each. */
static void write_few_images(int views, int lights)
{
    weft_dataset_layout layout = {
        .width = 2, .height = 2, .image_count = views * lights, .view_count = views, .texel_pitch_mm = 0.1};
    assert_int_equal(weft_dataset_layout_allocate(&layout, NULL), WEFT_OK);
    for (int image = 0; image < layout.image_count; image++) {
        layout.view[image / lights] = weft_direction_of_angles(weft_ubo81_angles(image / lights));
        layout.light[image] = weft_direction_of_angles(weft_ubo81_angles(image % lights));
        layout.view_of_image[image] = image / lights;
    }
    synthetic_dataset_write("few.btf.h5", &layout, fill_yarn);
    weft_dataset_layout_free(&layout);
}

static int components_of(const char *path)
{
    weft_material material;
    assert_int_equal(weft_material_read(path, &material, NULL), WEFT_OK);
    int count = material.components ? material.components->component_count : 0;
    weft_material_free(&material);
    return count;
}

static void an_error_chooses_the_fewest_components_that_keep_it(void **state)
{
    (void)state;
    char said[RUN_WEFT_SAID];
    write_few_images(4, 12);
    expect_weft("compress few.btf.h5 -o error.weft --error 90 --hold-out 1", 0, "4 components: the fewest");
    assert_int_equal(components_of("error.weft"), 4);
    assert_int_equal(run_weft("", "compress few.btf.h5 -o error.weft --error 0.01 --hold-out 1 --json", said), 0);
    assert_non_null(strstr(said, "\"event\":\"chosen\""));
    assert_non_null(strstr(said, "\"met\":false"));
    assert_non_null(strstr(said, "come nearest"));
    assert_true(components_of("error.weft") >= 4);
    expect_weft("compress command.btf.h5 -o none.weft --error 5 --hold-out off", 2, "--hold-out off");
}

static void a_budget_chooses_the_most_components_that_fit(void **state)
{
    (void)state;
    write_few_images(4, 12);
    expect_weft("compress few.btf.h5 -o large.weft --budget 100 --hold-out off", 0, "64 components: the most");
    assert_int_equal(components_of("large.weft"), 64);
    expect_weft("compress few.btf.h5 -o eight.weft --components 8 --hold-out off", 0, "");
    char arguments[128];
    uint64_t bytes = weft_file_bytes("eight.weft") + 2000;
    snprintf(arguments, sizeof arguments, "compress few.btf.h5 -o budget.weft --budget %.6f --hold-out off",
             1e-6 * (double)bytes);
    expect_weft(arguments, 0, "components: the most");
    assert_in_range(weft_file_bytes("budget.weft"), 1, bytes);
    assert_in_range(components_of("budget.weft"), 8, 64);
    expect_weft("compress few.btf.h5 -o none.weft --budget 0.001", 2, "too small");
    assert_int_not_equal(access("none.weft", F_OK), 0);
}

static void wrong_usage_is_2(void **state)
{
    (void)state;
    expect_weft("compress command.btf.h5", 2, "-o NAME.weft");
    expect_weft("compress command.btf.h5 -o a.weft --lobes 4", 2, "'4'");
    expect_weft("compress command.btf.h5 -o a.weft --lobes 0", 2, "'0'");
    expect_weft("compress command.btf.h5 -o a.weft --components 6", 2, "a multiple of 4");
    expect_weft("compress command.btf.h5 -o a.weft --error 0", 2, "'0'");
    expect_weft("compress command.btf.h5 other.btf.h5 -o a.weft", 2, "other.btf.h5");
    expect_weft("compress --help", 0, "Example: weft compress");
    expect_weft("compress --help", 0, "default of components");
}

/* One choice of a model, and no two. */
static void choices_of_a_model_exclude_each_other(void **state)
{
    (void)state;
    static const char *const choice[] = {"--components 8", "--lobes 2", "--error 5", "--budget 1", "--preset small"};
    for (int i = 0; i < 5; i++) {
        for (int j = i + 1; j < 5; j++) {
            char arguments[128];
            snprintf(arguments, sizeof arguments, "compress command.btf.h5 -o a.weft %s %s", choice[i], choice[j]);
            expect_weft(arguments, 2, "give one of them");
        }
    }
    assert_int_not_equal(access("a.weft", F_OK), 0);
}

static void removed_options_say_what_to_do_instead(void **state)
{
    (void)state;
    static const char *const gone[] = {"--table off",  "--light-table on", "--tables pca:4",     "--tables=8bit",
                                       "--levels off", "--heights off",    "--rounding on",      "--frames off",
                                       "--report r",   "--max-exponent 9", "--max-exponent=512", "--table"};
    for (size_t i = 0; i < sizeof gone / sizeof *gone; i++) {
        char arguments[128];
        snprintf(arguments, sizeof arguments, "compress command.btf.h5 -o a.weft %s", gone[i]);
        expect_weft(arguments, 2, "is gone since 0.2: ");
    }
    char said[RUN_WEFT_SAID];
    assert_int_equal(run_weft("", "compress --help", said), 0);
    assert_null(strstr(said, "--rounding"));
    assert_null(strstr(said, "--layers"));
    expect_weft("compress command.btf.h5 -o former.weft --layers 4 --hold-out off", 0, "--layers is now --components");
    assert_int_equal(components_of("former.weft"), 4);
}

/* What the images cannot carry is said, and all else is done. */
static void what_the_images_do_not_suffice_for_is_named(void **state)
{
    (void)state;
    char said[RUN_WEFT_SAID];
    write_few_images(1, 81);
    expect_weft("compress few.btf.h5 -o few.weft --lobes 2 --hold-out off", 0, "no view table");
    assert_int_equal(run_weft("", "compress few.btf.h5 -o few.weft --lobes 2 --weights screen --hold-out off", said),
                     0);
    assert_null(strstr(said, "changes nothing"));
    write_few_images(1, 12);
    expect_weft("compress few.btf.h5 -o few.weft", 0, "too few were left for the whole model");
    write_few_images(1, 11);
    expect_weft("compress few.btf.h5 -o few.weft --lobes 2 --weights screen", 0, "--weights changes nothing");
    assert_int_equal(run_weft("", "compress few.btf.h5 -o few.weft --weights screen --hold-out off", said), 0);
    assert_null(strstr(said, "changes nothing"));
    assert_non_null(strstr(said, "scattered photographs"));
    expect_weft("info few.weft", 0, "kriging");
}

/* How many components and lobes a material has that is made of `views` views of `lights` lights each. */
static void expect_model(int views, int lights, const char *options, int components, int lobes)
{
    char arguments[256];
    weft_material material;
    write_few_images(views, lights);
    snprintf(arguments, sizeof arguments, "compress few.btf.h5 -o few.weft --hold-out off --quiet %s", options);
    expect_weft(arguments, 0, "");
    assert_int_equal(weft_material_read("few.weft", &material, NULL), WEFT_OK);
    int found = material.components ? material.components->component_count : 0;
    if (found != components || material.lobe_count != lobes)
        fail_msg("%d x %d images, '%s': %d components, %d lobes", views, lights, options, found, material.lobe_count);
    weft_material_free(&material);
}

static void components_are_the_default_and_their_number_is_that_of_the_photographs(void **state)
{
    (void)state;
    expect_model(1, 19, "", 8, 0);
    expect_model(1, 20, "", 16, 0);
    expect_model(8, 12, "", 16, 0);
    expect_model(5, 20, "", 32, 0);
    expect_model(50, 2, "", 32, 0);
    expect_model(4, 12, "--weights screen", 16, 0);
}

static void the_model_is_the_one_that_was_asked_for(void **state)
{
    (void)state;
    expect_model(4, 12, "--lobes 2", 0, 2);
    expect_model(4, 12, "--components 4", 4, 0);
}

/* Programs that read the file are told what the material is. */
static void a_material_says_what_model_it_has(void **state)
{
    (void)state;
    static const char *const expected[][2] = {{"--components 4", "\"model\":\"components\""},
                                              {"--lobes 1", "\"model\":\"lobes and view table\""}};
    write_few_images(4, 12);
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
        char arguments[256];
        weft_material material;
        snprintf(arguments, sizeof arguments, "compress few.btf.h5 -o few.weft --hold-out off --quiet %s",
                 expected[i][0]);
        expect_weft(arguments, 0, "");
        assert_int_equal(weft_material_read("few.weft", &material, NULL), WEFT_OK);
        if (!strstr(material.metadata, expected[i][1]))
            fail_msg("no %s in %s", expected[i][1], material.metadata);
        weft_material_free(&material);
    }
}

static void bad_input_is_1_and_leaves_nothing(void **state)
{
    (void)state;
    expect_weft("compress none.btf.h5 -o none.weft", 1, "none.btf.h5");
    assert_int_equal(symlink("/dev/null", "null.btf.h5") == 0 || access("null.btf.h5", F_OK) == 0, 1);
    expect_weft("compress null.btf.h5 -o none.weft", 1, "null.btf.h5");
    int whole = open("command.btf.h5", O_RDONLY), cut = open("cut.btf.h5", O_RDWR | O_CREAT | O_TRUNC, 0644);
    char bytes[65536];
    ssize_t size = read(whole, bytes, sizeof bytes);
    assert_int_equal(write(cut, bytes, (size_t)size), size);
    close(whole);
    close(cut);
    expect_weft("compress cut.btf.h5 -o none.weft", 1, "cut.btf.h5");
    assert_int_not_equal(access("none.weft", F_OK), 0);
}

static void a_full_disk_is_3_and_leaves_nothing(void **state)
{
    (void)state;
    char said[8192];
    unlink("full.weft");
    assert_int_equal(
        run_weft("ulimit -f 1; trap '' XFSZ;", "compress command.btf.h5 -o full.weft --lobes 1 --hold-out off", said),
        3);
    assert_int_not_equal(access("full.weft", F_OK), 0);
    expect_weft("compress command.btf.h5 -o nowhere/full.weft --lobes 2", 3, "nowhere");
}

int test_compress_command(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_dataset_becomes_a_material_with_a_table_of_errors),
        cmocka_unit_test(the_error_where_it_was_not_fitted_is_said_and_kept),
        cmocka_unit_test(the_fit_itself_has_all_images_with_or_without),
        cmocka_unit_test(weights_are_kept_with_the_material),
        cmocka_unit_test(an_error_chooses_the_fewest_components_that_keep_it),
        cmocka_unit_test(a_budget_chooses_the_most_components_that_fit),
        cmocka_unit_test(wrong_usage_is_2),
        cmocka_unit_test(choices_of_a_model_exclude_each_other),
        cmocka_unit_test(removed_options_say_what_to_do_instead),
        cmocka_unit_test(what_the_images_do_not_suffice_for_is_named),
        cmocka_unit_test(components_are_the_default_and_their_number_is_that_of_the_photographs),
        cmocka_unit_test(the_model_is_the_one_that_was_asked_for),
        cmocka_unit_test(a_material_says_what_model_it_has),
        cmocka_unit_test(bad_input_is_1_and_leaves_nothing),
        cmocka_unit_test(a_full_disk_is_3_and_leaves_nothing),
    };
    return cmocka_run_group_tests(tests, write_dataset, NULL);
}
