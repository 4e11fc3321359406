/* What OpenGL must not notice: programs that only one profile takes, objects left behind, errors passed over. */
#include "../support/keep_modules.h"
#include "player/draw/probe.h"
#include "player/draw/programs.h"
#include "player/scene/environment.h"
#include "stage.h"
#include "tests/support/suite.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static weft_headless *open_context(weft_gl_profile profile)
{
    weft_headless *headless;
    weft_error error = {0};
    if (weft_headless_create(profile, &headless, &error) != WEFT_OK) {
        printf("skipped: %s\n", error.message);
        exit(77);
    }
    keep_modules_loaded();
    return headless;
}

enum { LOBES = 64, COMPONENTS = 16, OTHERS = 32 }; /* choices of a program of each kind */

/* The bits of `choice` say what the program does; those of the compressed material beyond LOBES draw components. */
static weft_variant variant_of(weft_mode mode, int plot, int choice)
{
    bool compressed = mode == WEFT_MODE_COMPRESSED, factorised = compressed && choice >= LOBES;
    return (weft_variant){.mode = mode,
                          .plot = plot,
                          .stochastic = choice & 1,
                          .shadows = choice & 2,
                          .one_light = choice & 4,
                          .noise = mode == WEFT_MODE_ANALYTIC && choice & 16,
                          .threads = mode == WEFT_MODE_ANALYTIC && choice & 8,
                          .component_groups = factorised ? 4 : 0,
                          .drawn_groups = factorised ? 2 : 0,
                          .over_half_vector = factorised && choice & 8,
                          .kriged = factorised && choice & 2,
                          .opacity = factorised && choice & 4,
                          .lobe_count = compressed && choice & 8 ? 3 : 0,
                          .view_table = compressed && choice & 16,
                          .light_table = compressed && choice & 32};
}

/* A program that draws shadows of cloth with holes. */
static weft_variant casting_variant(int choice)
{
    bool is_raw = choice & 1, factorised = !is_raw && choice & 2;
    return (weft_variant){.mode = is_raw ? WEFT_MODE_RAW : WEFT_MODE_COMPRESSED,
                          .casts = true,
                          .opacity = true,
                          .one_light = true,
                          .stochastic = choice & 4,
                          .relief = (is_raw || factorised) && choice & 8,
                          .component_groups = factorised ? 4 : 0,
                          .drawn_groups = factorised,
                          .view_table = true};
}

/* What only pictures bind must not stand where a plot binds something else. The software rasteriser does not count such
 * a sampler in a plot; it does in the program of a picture. Returns how many there are. */
static int expect_samplers_placed(GLuint program)
{
    static const char *const name[] = {"surface_rotation", "surface_place", "surface_sides", "shadow_map"};
    int found = 0;
    for (size_t i = 0; i < sizeof name / sizeof *name; i++) {
        GLint unit = 0, location = glGetUniformLocation(program, name[i]);
        if (location < 0)
            continue;
        glGetUniformiv(program, location, &unit);
        assert_true(unit >= 12);
        found++;
    }
    return found;
}

/* Programs are built when they are first used. All of them are asked for here with the argument "every", which takes
 * half a minute where no cache has them; else every fifth, from `first` on, in which any two bits of a choice meet. */
static void build_programs(int first)
{
    bool every = suite_argument != NULL;
    int step = every ? 1 : 5, start = every ? 0 : first, built = 0;
    weft_error error = {0};
    weft_programs programs = {0};
    GLuint program;
    int placed = 0;
    for (int mode = 0; mode < WEFT_MODE_COUNT; mode++) {
        /* Each choice with one of the plots: they do not know each other. */
        for (int choice = start; choice < (mode == WEFT_MODE_COMPRESSED ? LOBES + COMPONENTS : OTHERS);
             choice += step, built++) {
            const weft_variant variant = variant_of((weft_mode)mode, (choice + choice / 3) % 3, choice);
            expect_ok(weft_programs_find(&programs, &variant, &program, &error), &error);
            placed += expect_samplers_placed(program);
        }
    }
    assert_true(placed > built / 2);
    for (int choice = start; choice < 16; choice += step) {
        const weft_variant variant = casting_variant(choice);
        expect_ok(weft_programs_find(&programs, &variant, &program, &error), &error);
    }
    for (int i = 0; i < 2; i++) {
        expect_ok(weft_programs_find_surface(&programs, i, &program, &error), &error);
        expect_ok(weft_programs_find_geometry(&programs, i, &program, &error), &error);
    }
    weft_programs_free(&programs);
}

static void shaders_compile_for(weft_gl_profile profile)
{
    weft_error error = {0};
    weft_headless *headless = open_context(profile);
    weft_player *player;
    weft_canvas canvas;
    weft_probe_plots plots;
    assert_int_equal(epoxy_is_desktop_gl(), profile == WEFT_GL_CORE);
    expect_ok(weft_player_create(&player, &error), &error);
    expect_ok(weft_canvas_create(16, 16, &canvas, &error), &error);
    expect_ok(weft_probe_plots_create(16, &plots, &error), &error);
    build_programs(profile == WEFT_GL_CORE ? 0 : 2);
    weft_probe_plots_free(&plots);
    weft_canvas_free(&canvas);
    weft_player_free(player);
    weft_headless_free(headless);
}

static void shaders_compile_for_opengl(void **state)
{
    (void)state;
    shaders_compile_for(WEFT_GL_CORE);
}

static void shaders_compile_for_opengl_es_too(void **state)
{
    (void)state;
    shaders_compile_for(WEFT_GL_ES);
}

static void expect_no_objects(void)
{
    for (GLuint name = 1; name < 4096; name++) {
        assert_false(glIsTexture(name));
        assert_false(glIsBuffer(name));
        assert_false(glIsProgram(name));
        assert_false(glIsShader(name));
        assert_false(glIsVertexArray(name));
        assert_false(glIsFramebuffer(name));
        assert_false(glIsRenderbuffer(name));
    }
}

static void set_everything(weft_player *player, const char *dataset_path)
{
    weft_error error = {0};
    weft_mesh mesh;
    weft_material material;
    weft_dataset *dataset;
    int skipped;
    expect_ok(weft_mesh_plane(&mesh, &error), &error);
    expect_ok(weft_player_set_mesh(player, &mesh, &error), &error);
    weft_mesh_free(&mesh);
    stage_material(8, 8, 1, 7, 0, &material);
    expect_ok(weft_player_set_material(player, &material, &error), &error);
    weft_material_free(&material);
    expect_ok(weft_dataset_open(dataset_path, &dataset, &error), &error);
    expect_ok(weft_player_set_dataset(player, dataset, NULL, &skipped, &error), &error);
    weft_dataset_close(dataset);
}

static void nothing_stays_behind_when_a_player_is_freed(void **state)
{
    (void)state;
    weft_error error = {0};
    const char *path = "test_context.btf.h5";
    weft_headless *headless = open_context(WEFT_GL_CORE);
    weft_player *player;
    weft_image image;
    weft_surface_sample *surface;
    weft_scene scene = weft_scene_default();
    scene.pane_count = 2;
    scene.pane[1] = WEFT_MODE_RAW;
    stage_dataset(path, 4, 7, 7, WEFT_REFLECTANCE_COSINE, true);
    expect_ok(weft_player_create(&player, &error), &error);
    for (int i = 0; i < 2; i++)
        set_everything(player, path);
    expect_ok(weft_player_picture(player, &scene, 64, 48, 2, NULL, &image, &error), &error);
    expect_ok(weft_player_read_surface(player, &scene, WEFT_MODE_RAW, 64, 48, &surface, &error), &error);
    free(surface);
    weft_image_free(&image);
    scene.layout = WEFT_LAYOUT_DIFFERENCE;
    scene.shadows = scene.environment = true;
    expect_ok(weft_image_create(4, 2, &image, &error), &error);
    image.pixels[0] = 1;
    expect_ok(weft_player_set_environment(player, &image, WEFT_ENVIRONMENT_REGIONS, &error), &error);
    expect_ok(weft_player_set_environment(player, &image, WEFT_ENVIRONMENT_REGIONS, &error), &error);
    weft_image_free(&image);
    expect_ok(weft_player_picture(player, &scene, 40, 30, 1, NULL, &image, &error), &error);
    weft_image_free(&image);
    weft_player_free(player);
    expect_no_objects();
    assert_int_equal(glGetError(), GL_NO_ERROR);
    weft_headless_free(headless);
    unlink(path);
}

static void an_opengl_error_comes_back_with_what_was_done(void **state)
{
    (void)state;
    weft_error error = {0};
    weft_headless *headless = open_context(WEFT_GL_CORE);
    glEnable(0xffff);
    assert_int_equal(weft_gl_check("testing", &error), WEFT_SYSTEM);
    assert_string_equal(error.message, "OpenGL: invalid enum while testing");
    assert_int_equal(weft_gl_check("testing", &error), WEFT_OK);
    weft_headless_free(headless);
}

static void a_shader_that_does_not_compile_is_an_error_with_the_reason(void **state)
{
    (void)state;
    weft_error error = {0};
    GLuint program = 1;
    const char *const bad[] = {"void main() { nonsense }\n", NULL};
    weft_headless *headless = open_context(WEFT_GL_CORE);
    assert_int_equal(weft_gl_program("test", bad, bad, &program, &error), WEFT_SYSTEM);
    assert_non_null(strstr(error.message, "vertex shader of 'test' does not compile: "));
    assert_int_equal(program, 0);
    expect_no_objects();
    weft_headless_free(headless);
}

static void a_uniform_that_no_shader_declares_is_an_error_with_its_name(void **state)
{
    (void)state;
    weft_error error = {0};
    GLuint program;
    const char *const vertex[] = {"void main() { gl_Position = vec4(0.0); }\n", NULL};
    const char *const fragment[] = {"uniform float used, removed;\nuniform vec3 list[2];\nout vec4 colour;\n"
                                    "void main() { colour = vec4(used); }\n",
                                    NULL};
    weft_headless *headless = open_context(WEFT_GL_CORE);
    expect_ok(weft_gl_program("test", vertex, fragment, &program, &error), &error);
    glUseProgram(program);
    weft_gl_set_float(program, "used", 1);
    weft_gl_set_float(program, "removed", 1);
    weft_gl_set_vec3(program, "list[1]", 1, 1, 1);
    expect_ok(weft_gl_check("testing", &error), &error);
    weft_gl_set_float(program, "remove", 1);
    assert_int_equal(weft_gl_check("testing", &error), WEFT_SYSTEM);
    assert_string_equal(error.message, "no shader declares the uniform 'remove', which is set while testing");
    expect_ok(weft_gl_check("testing", &error), &error);
    glUseProgram(0);
    glDeleteProgram(program);
    weft_headless_free(headless);
}

static void a_shader_of_too_many_parts_is_an_error(void **state)
{
    (void)state;
    weft_error error = {0};
    GLuint program = 1;
    const char *parts[17] = {"void main() { gl_Position = vec4(0.0); }\n"};
    for (int i = 1; i < 16; i++)
        parts[i] = "\n";
    weft_headless *headless = open_context(WEFT_GL_CORE);
    assert_int_equal(weft_gl_program("test", parts, parts, &program, &error), WEFT_SYSTEM);
    assert_string_equal(error.message, "the vertex shader of 'test' has more than 15 parts");
    assert_int_equal(program, 0);
    weft_headless_free(headless);
}

static void drawing_without_a_mesh_or_a_model_is_bad_usage(void **state)
{
    (void)state;
    weft_error error = {0};
    weft_headless *headless = open_context(WEFT_GL_CORE);
    weft_player *player;
    weft_image image;
    weft_mesh mesh;
    weft_scene scene = weft_scene_default();
    expect_ok(weft_player_create(&player, &error), &error);
    assert_int_equal(weft_player_picture(player, &scene, 8, 8, 1, NULL, &image, &error), WEFT_BAD_USAGE);
    assert_non_null(strstr(error.message, "mesh"));
    expect_ok(weft_mesh_plane(&mesh, &error), &error);
    expect_ok(weft_player_set_mesh(player, &mesh, &error), &error);
    weft_mesh_free(&mesh);
    assert_int_equal(weft_player_picture(player, &scene, 8, 8, 1, NULL, &image, &error), WEFT_BAD_USAGE);
    assert_non_null(strstr(error.message, "'compressed' needs a material"));
    assert_int_equal(weft_player_picture(player, &scene, 0, 8, 1, NULL, &image, &error), WEFT_BAD_USAGE);
    assert_int_equal(weft_player_picture(player, &scene, 8, 8, 65, NULL, &image, &error), WEFT_BAD_USAGE);
    weft_player_free(player);
    weft_headless_free(headless);
}

static void without_egl_devices_the_cause_is_said(void **state)
{
    (void)state;
    weft_error error = {0};
    weft_headless *headless;
    /* No driver can be loaded from here. */
    setenv("__EGL_VENDOR_LIBRARY_DIRS", "/nonexistent", 1);
    weft_code code = weft_headless_create(WEFT_GL_CORE, &headless, &error);
    unsetenv("__EGL_VENDOR_LIBRARY_DIRS");
    assert_int_equal(code, WEFT_SYSTEM);
    assert_non_null(strstr(error.message, "no OpenGL 3.3 without a display"));
    assert_null(headless);
}

int test_context(void)
{
    /* Vendors are looked up once in a process: this one test runs in its own. */
    if (suite_argument && strcmp(suite_argument, "without-drivers") == 0) {
        const struct CMUnitTest tests[] = {cmocka_unit_test(without_egl_devices_the_cause_is_said)};
        return cmocka_run_group_tests(tests, NULL, NULL);
    }
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shaders_compile_for_opengl),
        cmocka_unit_test(shaders_compile_for_opengl_es_too),
        cmocka_unit_test(nothing_stays_behind_when_a_player_is_freed),
        cmocka_unit_test(an_opengl_error_comes_back_with_what_was_done),
        cmocka_unit_test(a_shader_that_does_not_compile_is_an_error_with_the_reason),
        cmocka_unit_test(a_uniform_that_no_shader_declares_is_an_error_with_its_name),
        cmocka_unit_test(a_shader_of_too_many_parts_is_an_error),
        cmocka_unit_test(drawing_without_a_mesh_or_a_model_is_bad_usage),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
