#include "capture/virtual/virtual_settings.h"
#include "tests/support/cmocka_all.h"
#include "tests/support/scratch_folder.h"

#include <stdlib.h>
#include <string.h>

static weft_code read_text(const char *text, weft_virtual_settings *settings, weft_error *error)
{
    *settings = weft_virtual_settings_default();
    scratch_store("rig.json", text, strlen(text));
    return weft_virtual_settings_read("rig.json", settings, error);
}

static void assert_refused(const char *text, const char *message)
{
    weft_virtual_settings settings;
    weft_error error = {0};
    assert_int_equal(read_text(text, &settings, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "rig.json"));
    assert_non_null(strstr(error.message, message));
}

static void a_rig_file_overrides_what_it_names(void **state)
{
    (void)state;
    weft_virtual_settings settings, defaults = weft_virtual_settings_default();
    assert_int_equal(read_text("{\"rig\": \"virtual\", \"k1\": -0.25, \"width_px\": 128}", &settings, NULL), WEFT_OK);
    assert_true(settings.rig.k1 == -0.25 && settings.rig.width_px == 128);
    defaults.rig.k1 = -0.25;
    defaults.rig.width_px = 128;
    assert_memory_equal(&settings, &defaults, sizeof settings);
}

static void a_bad_rig_file_is_refused_with_its_key(void **state)
{
    (void)state;
    assert_refused("{\"rig\": \"virtual\", \"shutter\": 1}", "shutter");
    assert_refused("{\"rig\": \"virtual\", \"width_px\": 12.5}", "width_px");
    assert_refused("{\"rig\": \"virtual\", \"width_px\": 1e9}", "width_px");
    assert_refused("{\"rig\": \"virtual\", \"k1\": \"much\"}", "k1");
    assert_refused("{\"rig\": \"dome\"}", "dome");
    assert_refused("{\"k1\": 0}", "rig");
    assert_refused("[1, 2]", "object");
    assert_refused("{\"rig\": \"virtual\", ", "line 1");
    assert_refused("", "line");
}

static void settings_that_contradict_each_other_are_refused(void **state)
{
    (void)state;
    assert_refused("{\"rig\": \"virtual\", \"light_distance_mm\": 400}", "light");
    assert_refused("{\"rig\": \"virtual\", \"longest_exposure_s\": 0.0001}", "exposure");
    assert_refused("{\"rig\": \"virtual\", \"opening_mm\": 300}", "plate");
}

static void the_text_of_the_settings_reads_back(void **state)
{
    (void)state;
    weft_virtual_settings settings = weft_virtual_settings_default();
    settings.aperture_mm = 2.125;
    char *text = weft_virtual_settings_text(&settings, 99, "silk.wv", 0xffffffffu);
    assert_non_null(text);
    assert_non_null(strstr(text, "\"seed\":99"));
    assert_non_null(strstr(text, "\"sample_crc32\":4294967295"));
    assert_non_null(strstr(text, "\"aperture_mm\":2.125"));
    free(text);
}

int test_settings(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_rig_file_overrides_what_it_names),
        cmocka_unit_test(a_bad_rig_file_is_refused_with_its_key),
        cmocka_unit_test(settings_that_contradict_each_other_are_refused),
        cmocka_unit_test(the_text_of_the_settings_reads_back),
    };
    return cmocka_run_group_tests(tests, scratch_folder_enter, scratch_folder_leave);
}
