#include "player/settings/settings.h"

#include "base/atomic_file.h"
#include "player/settings/json.h"
#include "player/settings/settings.h"
#include "settings_text.h"
#include "tests/support/cmocka_all.h"
#include "tests/support/scratch_folder.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const weft_error none;

static weft_settings parsed(const char *text, const char *source)
{
    weft_settings settings;
    weft_error error = none;
    if (weft_settings_parse(text, strlen(text), source, &settings, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    return settings;
}

static char *formatted(const weft_settings *settings, const char *beside)
{
    char *text;
    weft_error error = none;
    if (weft_settings_format(settings, beside, &text, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    return text;
}

static void expect_refusal(const char *text, const char *part)
{
    weft_settings settings;
    weft_error error = none;
    assert_int_equal(weft_settings_parse(text, strlen(text), "shot.png", &settings, &error), WEFT_BAD_INPUT);
    if (!strstr(error.message, part) || !strstr(error.message, "shot.png"))
        fail_msg("'%s' does not name 'shot.png' and %s", error.message, part);
}

static void every_value_is_read(void **state)
{
    (void)state;
    weft_settings s = parsed(SETTINGS_TEXT, "folder/shot.png");
    const weft_scene *scene = &s.scene;
    assert_string_equal(s.material, "folder/a/silk.weft");
    assert_string_equal(s.dataset, "folder/../silk.btf.h5");
    assert_string_equal(s.weave, "/silk.wv");
    assert_string_equal(s.environment, "folder/sky.exr");
    assert_string_equal(s.mesh, "folder/./drape");
    assert_true(s.width == 77 && s.height == 33 && s.samples == 5);
    assert_true(!s.real_size && s.mesh_size_mm == 3.5 && s.mesh_unit_mm == 10 && s.tiles[0] == 2.5 && s.tiles[1] == 3);
    assert_true(scene->repeat == 0.1 && scene->orbit.distance == 2.3 && scene->exposure == 1.7);
    assert_true(scene->orbit.azimuth_rad == weft_rad_of_deg(-71.3) && scene->light_count == 2);
    assert_true(scene->light[1].direction.phi_rad == weft_rad_of_deg(-0.1) && scene->light[0].irradiance[2] == 0.7);
    assert_true(scene->key_size_rad == weft_rad_of_deg(3.1) && scene->ground);
    assert_true(scene->shadows && scene->environment && scene->environment_reference && scene->tone == WEFT_TONE_SOFT);
    assert_true(scene->environment_strength == 0.9 && scene->environment_turn_rad == weft_rad_of_deg(33.3));
    assert_true(scene->level_choice == WEFT_LEVEL_FIXED && scene->level == 1.1);
    assert_true(scene->filter == WEFT_FILTER_STOCHASTIC && !scene->view_table && !scene->light_table);
    assert_int_equal(s.raw_format, WEFT_RAW_BC6H);
    assert_true(scene->lobe[0] && !scene->lobe[1] && scene->lobe[2] && scene->noise_seed == 5);
    assert_true(scene->layout == WEFT_LAYOUT_WIPE && scene->divider == 0.25 && scene->pane_count == 2);
    assert_true(scene->pane[0] == WEFT_MODE_ANALYTIC && scene->pane[1] == WEFT_MODE_RAW);
    assert_true(scene->show_level && scene->show_extrapolation && !scene->labels);
    weft_settings_free(&s);
}

/* Uniform bits: numbers that no short decimal stands for. */
static double uniform(void)
{
    return (double)rand() / RAND_MAX + (double)rand() / RAND_MAX * 1e-9;
}

static void numbers_come_back_exactly_and_angles_to_an_ulp(void **state)
{
    (void)state;
    for (int i = 0; i < 2000; i++) {
        weft_settings s = parsed("{\"version\": 1}", "shot.png");
        s.scene.exposure = exp(20 * uniform() - 10);
        s.scene.repeat = uniform() * 100 + 1e-3;
        s.scene.orbit = (weft_orbit){
            .azimuth_rad = uniform() * 20 - 10, .elevation_rad = uniform() * 3 - 1.5, .distance = 1 + exp(uniform())};
        char *text = formatted(&s, "shot.png");
        weft_settings read = parsed(text, "shot.png");
        char *again = formatted(&read, "shot.png");
        assert_string_equal(text, again);
        assert_true(read.scene.exposure == s.scene.exposure && read.scene.repeat == s.scene.repeat);
        assert_true(read.scene.orbit.distance == s.scene.orbit.distance);
        double azimuth = s.scene.orbit.azimuth_rad, other = read.scene.orbit.azimuth_rad;
        assert_true(other == azimuth || other == nextafter(azimuth, 100) || other == nextafter(azimuth, -100));
        weft_settings_free(&s);
        s = parsed(again, "shot.png");
        assert_memory_equal(&s.scene.orbit, &read.scene.orbit, sizeof s.scene.orbit);
        free(text);
        free(again);
        weft_settings_free(&s);
        weft_settings_free(&read);
    }
}

static void whole_degrees_come_back_as_they_were(void **state)
{
    (void)state;
    for (int degrees = -720; degrees <= 720; degrees++) {
        weft_settings s = parsed("{\"version\": 1}", "shot.png");
        s.scene.orbit.azimuth_rad = weft_rad_of_deg(degrees);
        char *text = formatted(&s, "shot.png");
        weft_settings read = parsed(text, "shot.png");
        assert_true(read.scene.orbit.azimuth_rad == s.scene.orbit.azimuth_rad);
        free(text);
        weft_settings_free(&s);
        weft_settings_free(&read);
    }
}

static void what_is_left_out_is_the_default(void **state)
{
    (void)state;
    weft_error error = none;
    weft_settings s = parsed("{\"version\": 1, \"camera\": {\"distance\": 9}}", "shot.png"), expected;
    assert_int_equal(weft_settings_init(&expected, &error), WEFT_OK);
    expected.scene.orbit.distance = 9;
    char *a = formatted(&s, "x"), *b = formatted(&expected, "x");
    assert_string_equal(a, b);
    free(a);
    free(b);
    weft_settings_free(&s);
    weft_settings_free(&expected);
}

static void faults_are_named(void **state)
{
    (void)state;
    expect_refusal("", "line 1");
    expect_refusal("{\"version\": 1,}", "line 1");
    expect_refusal("[1]", "not a JSON object");
    expect_refusal("{\"version\": 2}", "'version' must be a whole number from 1 to 1");
    expect_refusal("{\"lamp\": 1}", "'lamp' is not known");
    expect_refusal("{\"camera.distance\": 3}", "'camera.distance' is not known");
    expect_refusal("{\"camera\": {\"\": 3}}", "'camera.' is not known");
    expect_refusal("{\"light\": {\"lights\": [{\"theta_deg\": 1, \"colour\": 3}]}}", "'light.lights[0].colour' is not");
    expect_refusal("{\"light\": {\"lights\": [{}, {}, {}, {}, {}]}}", "'light.lights' must be a list of 0 to 4");
    expect_refusal("{\"light\": {\"lights\": []}}", "gives light");
    expect_refusal("{\"light\": {\"environment\": {\"lit\": true}}}", "needs 'files.environment'");
    expect_refusal("{\"camera\": 3}", "'camera' must be an object");
    expect_refusal("{\"camera\": {\"elevation_deg\": 91}}",
                   "'camera.elevation_deg' must be an angle in degrees from -90");
    expect_refusal("{\"camera\": {\"distance\": \"far\"}}", "'camera.distance' must be a number");
    expect_refusal("{\"picture\": {\"width\": 1.5}}", "'picture.width' must be a whole number");
    expect_refusal("{\"picture\": {\"width\": 99999999999999}}", "from 1 to 16384");
    expect_refusal("{\"view\": {\"layout\": \"quilt\"}}", "one of \"panes\", \"wipe\", \"difference\"");
    expect_refusal("{\"view\": {\"modes\": [\"raw\"]}}", "'view.modes' must be a list of 3 to 3");
    expect_refusal("{\"model\": {\"lobes\": [1, 0, 1]}}", "'model.lobes[0]' must be true or false");
    expect_refusal("{\"files\": {\"mesh\": null}}", "'files.mesh'");
    expect_refusal("{\"files\": {\"mesh\": 3}}", "'files.mesh' must be a string or null");
    expect_refusal("{\"camera\": {}, \"camera\": {}}", "duplicate");
}

/* The settings that one option makes of the default ones, as text; NULL where it cannot be understood. */
static char *text_with(const weft_setting *setting, const char *text)
{
    weft_settings settings = {0};
    weft_error error = none;
    char *result = NULL;
    assert_int_equal(weft_settings_init(&settings, &error), WEFT_OK);
    if (!setting || weft_option_set(&setting->option, text, &settings, &error) == WEFT_OK)
        result = formatted(&settings, "x");
    weft_settings_free(&settings);
    return result;
}

/* But for the size of the mesh, which says 0 for what it is by default. */
static void what_the_help_calls_the_default_is_it(void **state)
{
    (void)state;
    int checked = 0;
    char *expected = text_with(NULL, NULL);
    for (const weft_setting *s = weft_settings_schema(); s->key || s->option.name; s++) {
        const char *stated = s->option.help ? strstr(s->option.help, "(default: ") : NULL;
        if (!stated || strcmp(s->option.name, "mesh-size") == 0)
            continue;
        char value[64];
        stated += strlen("(default: ");
        snprintf(value, sizeof value, "%.*s", (int)strcspn(stated, ");"), stated);
        char *text = text_with(s, value);
        if (text)
            assert_string_equal(text, expected);
        checked += text != NULL;
        free(text);
    }
    assert_int_equal(checked, 8); /* camera, light, light-size, size, samples, strength, divider, noise */
    free(expected);
}

static void a_number_that_is_not_finite_is_not_written(void **state)
{
    (void)state;
    weft_error error = none;
    weft_settings s = parsed("{\"version\": 1}", "shot.png");
    char *text = NULL;
    s.scene.exposure = NAN;
    assert_int_equal(weft_settings_format(&s, "shot.png", &text, &error), WEFT_BAD_USAGE);
    assert_null(text);
    weft_settings_free(&s);
}

static void expect_relative(const char *path, const char *from, const char *expected)
{
    char *name;
    weft_error error = none;
    assert_int_equal(weft_path_relative_to(path, from, &name, &error), WEFT_OK);
    assert_string_equal(name, expected);
    free(name);
}

static void names_are_those_seen_from_the_folder_of_the_picture(void **state)
{
    (void)state;
    weft_error error = none;
    assert_int_equal(weft_make_folder("cloth/silk/red", &error), WEFT_OK);
    assert_int_equal(weft_make_folder("cloth/silken", &error), WEFT_OK);
    expect_relative("a.weft", "b.png", "a.weft");
    expect_relative("./cloth/a.weft", "cloth/b.png", "a.weft");
    expect_relative("cloth/silk/a.weft", "b.png", "cloth/silk/a.weft");
    expect_relative("a.weft", "cloth/silk/b.png", "../../a.weft");
    expect_relative("cloth/silk/a.weft", "cloth/silken/b.png", "../silk/a.weft");
    expect_relative("cloth/silk/red/../a.weft", "cloth/silk/red/b.png", "../a.weft");
    expect_relative("/a.weft", "b.png", "/a.weft");
    expect_relative("/a.weft", "/b.png", "a.weft");
    char *name;
    assert_int_equal(weft_path_relative_to("nowhere/a.weft", "b.png", &name, &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "nowhere/a.weft"));
}

static void a_mesh_in_a_file_called_drape_is_not_the_drape(void **state)
{
    (void)state;
    weft_settings s = parsed("{\"version\": 1, \"files\": {\"mesh\": \"./drape\"}}", "shot.png");
    char *text = formatted(&s, "shot.png");
    assert_non_null(strstr(text, "\"./drape\""));
    free(text);
    weft_settings_free(&s);
}

static void a_missing_file_is_named_with_its_picture(void **state)
{
    (void)state;
    weft_error error = none;
    weft_settings s = parsed("{\"version\": 1, \"files\": {\"weave\": \"gone.wv\"}}", "cloth/shot.png");
    assert_int_equal(weft_settings_check_files(&s, "cloth/shot.png", &error), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "'cloth/shot.png' shows the weave 'cloth/gone.wv'"));
    weft_settings_free(&s);
}

/* A box of 2 x 1 units whose texture coordinates run over 0..4 and 0..2: half a unit of length for one of theirs. */
static void a_cloth_has_its_real_size(void **state)
{
    (void)state;
    weft_error error = none;
    static const char box[] = "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nvt 0 0\nvt 4 0\nvt 4 2\nvt 0 2\nf 1/1 2/2 3/3 4/4\n";
    assert_int_equal(weft_write_file("box.obj", box, strlen(box), &error), WEFT_OK);
    weft_mesh mesh;
    assert_int_equal(weft_mesh_open("box.obj", &mesh, &error), WEFT_OK);
    assert_float_equal(mesh.size, 2, 1e-12);
    assert_float_equal(mesh.coordinate_length, 0.5, 1e-12);
    weft_settings s = parsed("{\"version\": 1, \"files\": {\"mesh\": \"box.obj\"}}", "shot.png");
    s.mesh_unit_mm = 10; /* a unit of texture coordinates is 5 mm */
    assert_float_equal(weft_settings_repeat(&s, &mesh, 2.5, 2.5), 2, 1e-12);
    s.mesh_size_mm = 100; /* and now 25 */
    assert_float_equal(weft_settings_repeat(&s, &mesh, 2.5, 2.5), 10, 1e-12);
    s.real_size = false;
    s.scene.repeat = 3;
    assert_float_equal(weft_settings_repeat(&s, &mesh, 2.5, 2.5), 3, 0);
    weft_mesh_free(&mesh);
    weft_settings_free(&s);
}

/* Two as high as wide, of which the plane shows one; any other mesh, or size, is as it was. */
static void the_plane_has_the_sides_of_its_material(void **state)
{
    (void)state;
    weft_error error = none;
    for (int as = 0; as < 4; as++) {
        weft_settings s = parsed("{\"version\": 1, \"files\": {\"mesh\": \"plane\"}}", "shot.png");
        weft_mesh mesh;
        assert_int_equal(weft_mesh_open("plane", &mesh, &error), WEFT_OK);
        s.mesh_size_mm = as == 1 ? 100 : 0;
        s.real_size = as != 2;
        if (as == 3)
            strcpy(s.mesh, "quad");
        weft_settings_lay_plane(&s, 2, &mesh);
        double height = as == 0 ? 2 : 1;
        assert_float_equal(mesh.vertex[3].position[1] - mesh.vertex[0].position[1], height, 0);
        assert_float_equal(mesh.vertex[3].coordinate[1] - mesh.vertex[0].coordinate[1], height, 0);
        assert_float_equal(mesh.vertex[3].position[0] - mesh.vertex[0].position[0], 1, 0);
        weft_mesh_free(&mesh);
        weft_settings_free(&s);
    }
}

int test_settings(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_value_is_read),
        cmocka_unit_test(numbers_come_back_exactly_and_angles_to_an_ulp),
        cmocka_unit_test(whole_degrees_come_back_as_they_were),
        cmocka_unit_test(what_is_left_out_is_the_default),
        cmocka_unit_test(faults_are_named),
        cmocka_unit_test(what_the_help_calls_the_default_is_it),
        cmocka_unit_test(a_number_that_is_not_finite_is_not_written),
        cmocka_unit_test(names_are_those_seen_from_the_folder_of_the_picture),
        cmocka_unit_test(a_mesh_in_a_file_called_drape_is_not_the_drape),
        cmocka_unit_test(a_missing_file_is_named_with_its_picture),
        cmocka_unit_test(a_cloth_has_its_real_size),
        cmocka_unit_test(the_plane_has_the_sides_of_its_material),
    };
    return cmocka_run_group_tests(tests, scratch_folder_enter, scratch_folder_leave);
}
