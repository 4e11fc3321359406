/* Files of a scene that arrive, are dropped, are broken, and change while a player shows them. */
#include "player/gl/gl.h"
#include "player/settings/scene_loader.h"
#include "stage.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { WIDTH = 64, HEIGHT = 48 };

typedef struct fixture {
    stage *stage;
    weft_settings settings;
    weft_scene_loader *loader;
} fixture;

static fixture the_fixture;

static void write_material(const char *path, int size)
{
    weft_material material = {0};
    weft_error error = {0};
    stage_material(size, size, 2, 7, 0, &material);
    expect_ok(weft_material_write(path, &material, &error), &error);
    weft_material_free(&material);
}

/* One that says how far it is off where it was not fitted. */
static void write_measured_material(const char *path, double relative_rmse)
{
    weft_material material = {0};
    weft_error error = {0};
    weft_hold_out held_out = {.split_count = 1};
    held_out.material.all = (weft_error_summary){.relative_rmse = relative_rmse, .count = 1};
    stage_material(8, 8, 2, 7, 0, &material);
    expect_ok(weft_hold_out_store(&held_out, &material, &error), &error);
    expect_ok(weft_material_write(path, &material, &error), &error);
    weft_material_free(&material);
}

static void write_text(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

static int make_files(void **state)
{
    if (stage_open(state) != 0)
        return -1;
    the_fixture.stage = *state;
    mkdir("scene_load", 0755);
    write_material("scene_load/a.weft", 16);
    write_material("scene_load/b.weft", 8);
    write_text("scene_load/corrupt.weft", "\x89WEFT\r\n\x1a and then nothing");
    write_text("scene_load/quad.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                                      "f 1/1 2/2 3/3 4/4\n");
    write_text("scene_load/bad.obj", "v 0 0 0\nf 1 2 3\n");
    stage_dataset("scene_load/a.btf.h5", 8, 7, 7, WEFT_REFLECTANCE_COSINE, false);
    stage_dataset("scene_load/one_view.btf.h5", 8, 1, 7, WEFT_REFLECTANCE_COSINE, false);
    return 0;
}

static int close_stage(void **state)
{
    *state = the_fixture.stage;
    return stage_close(state);
}

static fixture *open_scene_as(const char *material, const char *dataset, weft_raw_format format)
{
    fixture *f = &the_fixture;
    weft_error error = {0};
    expect_ok(weft_settings_init(&f->settings, &error), &error);
    f->settings.raw_format = format;
    f->settings.has_lights = true; /* the default light: a studio takes longer to draw */
    f->settings.material = material ? strdup(material) : NULL;
    f->settings.dataset = dataset ? strdup(dataset) : NULL;
    expect_ok(weft_scene_loader_create(&f->settings, &f->loader, &error), &error);
    expect_ok(weft_scene_loader_attach(f->loader, f->stage->player, &error), &error);
    return f;
}

/* A loader for a material, perhaps with a dataset. */
static fixture *open_scene(const char *material, const char *dataset)
{
    return open_scene_as(material, dataset, WEFT_RAW_FITTING);
}

static void close_scene(fixture *f)
{
    weft_scene_loader_free(f->loader);
    weft_settings_free(&f->settings);
}

static int texels_shown(const fixture *f)
{
    return (int)weft_player_bytes(f->stage->player, WEFT_MODE_COMPRESSED);
}

static void expect_picture(const fixture *f)
{
    weft_error error = {0};
    weft_image image = {0};
    expect_ok(weft_player_picture(f->stage->player, &f->settings.scene, WIDTH, HEIGHT, 1, NULL, &image, &error),
              &error);
    weft_image_free(&image);
}

static weft_code finish(const fixture *f, weft_error *error)
{
    const weft_log silence = {0};
    return weft_scene_loader_finish(f->loader, NULL, &silence, error);
}

/* Drops a file and waits for what comes of it. */
static weft_code drop(fixture *f, const char *path, weft_error *error)
{
    WEFT_TRY(weft_scene_loader_open(f->loader, path, error));
    return finish(f, error);
}

static void everything_named_is_shown_and_named(void **state)
{
    (void)state;
    weft_error error = {0};
    fixture *f = open_scene("scene_load/a.weft", "scene_load/a.btf.h5");
    assert_null(f->settings.material);
    expect_ok(finish(f, &error), &error);
    assert_string_equal(f->settings.material, "scene_load/a.weft");
    assert_string_equal(f->settings.dataset, "scene_load/a.btf.h5");
    assert_true(weft_player_has(f->stage->player, WEFT_MODE_RAW));
    assert_float_equal(weft_scene_loader_progress(f->loader), -1, 0);
    expect_picture(f);
    close_scene(f);
}

static void weaves_and_microcylinders_replace_each_other(void **state)
{
    (void)state;
    weft_error error = {0};
    fixture *f = open_scene("scene_load/a.weft", NULL);
    weft_player *player = f->stage->player;
    expect_ok(finish(f, &error), &error);
    expect_ok(drop(f, WEFT_ASSETS "/microcylinder/satin_face.mc", &error), &error);
    assert_true(weft_player_has(player, WEFT_MODE_ANALYTIC) && weft_player_has_threads(player));
    f->settings.scene.pane[0] = WEFT_MODE_ANALYTIC;
    expect_picture(f);
    write_text("scene_load/bad.mc", "microcylinder {\n  sigmb = 1\n}\n");
    assert_int_equal(weft_class_of(drop(f, "scene_load/bad.mc", &error)), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "bad.mc:2:3: unknown key 'sigmb'"));
    assert_true(weft_player_has_threads(player));
    expect_ok(drop(f, WEFT_ASSETS "/weaves/cotton_twill.wv", &error), &error);
    assert_true(weft_player_has(player, WEFT_MODE_ANALYTIC) && !weft_player_has_threads(player));
    expect_picture(f);
    weft_player_clear(player, WEFT_MODE_ANALYTIC);
    close_scene(f);
}

/* A weave that was fitted to the material lies on it as the fit found it, else as the virtual rig lays it. */
static void a_fitted_weave_is_laid_as_its_file_says(void **state)
{
    (void)state;
    weft_error error = {0};
    weft_weave weave;
    const weft_weave_layout fitted = {2.25, 3.5, 0.3, 0.6};
    fixture *f = open_scene("scene_load/a.weft", NULL);
    expect_ok(weft_weave_read(WEFT_ASSETS "/weaves/cotton_twill.wv", NULL, 0, &weave, NULL, &error), &error);
    weave.layout = fitted;
    expect_ok(weft_weave_write("scene_load/fitted.wv", &weave, NULL, &error), &error);
    weft_weave_free(&weave);
    expect_ok(drop(f, "scene_load/fitted.wv", &error), &error);
    weft_weave_layout layout = weft_player_weave_layout(f->stage->player);
    assert_memory_equal(&layout, &fitted, sizeof fitted);
    f->settings.tiles[0] = f->settings.tiles[1] = 4;
    expect_ok(drop(f, "scene_load/fitted.wv", &error), &error);
    layout = weft_player_weave_layout(f->stage->player);
    assert_true(layout.tiles_u == 4 && layout.tiles_v == 4 && layout.corner_u == 0 && layout.corner_v == 0);
    f->settings.tiles[0] = f->settings.tiles[1] = 0;
    expect_ok(drop(f, WEFT_ASSETS "/weaves/cotton_twill.wv", &error), &error);
    layout = weft_player_weave_layout(f->stage->player);
    assert_true(layout.tiles_u == floor(layout.tiles_u) && layout.corner_u == 0 && layout.corner_v == 0);
    weft_player_clear(f->stage->player, WEFT_MODE_ANALYTIC);
    close_scene(f);
}

static void samples_are_kept_in_the_format_that_the_settings_name(void **state)
{
    (void)state;
    static const char *const name[] = {"half floats", "half floats", "RGB with a shared exponent", "BC6H"};
    for (int format = WEFT_RAW_FITTING; format <= (weft_gl_has_bc6h() ? WEFT_RAW_BC6H : WEFT_RAW_SHARED_EXPONENT);
         format++) {
        weft_error error = {0};
        fixture *f = open_scene_as(NULL, "scene_load/a.btf.h5", (weft_raw_format)format);
        bool shown, said = false;
        while (weft_scene_loader_progress(f->loader) >= 0) {
            char note[WEFT_MESSAGE_SIZE];
            expect_ok(weft_scene_loader_poll(f->loader, &shown, note, &error), &error);
            said |= strstr(note, name[format]) != NULL;
        }
        assert_string_equal(weft_player_raw_format(f->stage->player), name[format]);
        assert_int_equal(said, format > WEFT_RAW_HALF);
        close_scene(f);
    }
}

/* The loader chooses what is shown, until the user does. */
static void panes_that_were_chosen_while_files_arrive_stay(void **state)
{
    (void)state;
    weft_error error = {0};
    for (int chooses = 0; chooses < 2; chooses++) {
        fixture *f = open_scene("scene_load/a.weft", "scene_load/a.btf.h5");
        weft_scene *scene = &f->settings.scene;
        weft_player_clear(f->stage->player, WEFT_MODE_COMPRESSED);
        weft_player_clear(f->stage->player, WEFT_MODE_RAW);
        if (chooses)
            scene->pane[0] = WEFT_MODE_ANALYTIC;
        while (!weft_player_has(f->stage->player, WEFT_MODE_COMPRESSED) ||
               !weft_player_has(f->stage->player, WEFT_MODE_RAW)) {
            bool shown;
            char note[WEFT_MESSAGE_SIZE];
            expect_ok(weft_scene_loader_poll(f->loader, &shown, note, &error), &error);
            usleep(1000);
        }
        assert_int_equal(scene->pane[0], chooses ? WEFT_MODE_ANALYTIC : WEFT_MODE_COMPRESSED);
        close_scene(f);
    }
}

static void a_dropped_material_replaces_the_one_shown(void **state)
{
    (void)state;
    weft_error error = {0};
    fixture *f = open_scene("scene_load/a.weft", NULL);
    expect_ok(finish(f, &error), &error);
    int before = texels_shown(f);
    expect_ok(drop(f, "scene_load/b.weft", &error), &error);
    assert_true(texels_shown(f) < before);
    assert_string_equal(f->settings.material, "scene_load/b.weft");
    close_scene(f);
}

static void what_a_material_says_of_its_error_goes_with_it(void **state)
{
    (void)state;
    weft_error error = {0};
    write_measured_material("scene_load/fifth.weft", 0.2);
    write_measured_material("scene_load/tenth.weft", 0.1);
    fixture *f = open_scene("scene_load/fifth.weft", NULL);
    weft_player_clear(f->stage->player, WEFT_MODE_COMPRESSED);
    assert_null(weft_scene_loader_held_out(f->loader));
    expect_ok(finish(f, &error), &error);
    const weft_hold_out *held_out = weft_scene_loader_held_out(f->loader);
    assert_non_null(held_out);
    assert_float_equal(held_out->material.all.relative_rmse, 0.2, 1e-9);
    assert_int_equal(weft_class_of(drop(f, "scene_load/corrupt.weft", &error)), WEFT_BAD_INPUT);
    assert_float_equal(weft_scene_loader_held_out(f->loader)->material.all.relative_rmse, 0.2, 1e-9);
    expect_ok(drop(f, "scene_load/tenth.weft", &error), &error);
    assert_float_equal(weft_scene_loader_held_out(f->loader)->material.all.relative_rmse, 0.1, 1e-9);
    expect_ok(drop(f, "scene_load/a.weft", &error), &error);
    assert_null(weft_scene_loader_held_out(f->loader));
    close_scene(f);
}

static void a_corrupt_file_leaves_what_was_shown(void **state)
{
    (void)state;
    weft_error error = {0};
    fixture *f = open_scene("scene_load/a.weft", NULL);
    expect_ok(finish(f, &error), &error);
    int before = texels_shown(f);
    static const char *const bad[] = {"scene_load/corrupt.weft", "scene_load/bad.obj", "scene_load/none.weft"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        assert_int_equal(weft_class_of(drop(f, bad[i], &error)), WEFT_BAD_INPUT);
        assert_non_null(strstr(error.message, bad[i]));
    }
    assert_int_equal(texels_shown(f), before);
    assert_string_equal(f->settings.material, "scene_load/a.weft");
    assert_string_equal(f->settings.mesh, "drape");
    expect_picture(f);
    close_scene(f);
}

/* Whoever keeps the names of files has to take the new ones, error or not. */
static void a_file_may_arrive_while_another_fails(void **state)
{
    (void)state;
    weft_error error = {0};
    fixture *f = open_scene("scene_load/a.weft", NULL);
    expect_ok(finish(f, &error), &error);
    bool both = false;
    for (int attempt = 0; attempt < 50 && !both; attempt++) {
        char note[WEFT_MESSAGE_SIZE];
        expect_ok(weft_scene_loader_open(f->loader, "scene_load/quad.obj", &error), &error);
        expect_ok(weft_scene_loader_open(f->loader, "scene_load/corrupt.weft", &error), &error);
        while (weft_scene_loader_progress(f->loader) >= 0) {
            bool shown;
            usleep(20000);
            weft_code code = weft_scene_loader_poll(f->loader, &shown, note, &error);
            both |= shown && weft_class_of(code) == WEFT_BAD_INPUT;
        }
    }
    assert_true(both);
    assert_string_equal(f->settings.mesh, "scene_load/quad.obj");
    assert_string_equal(f->settings.material, "scene_load/a.weft");
    close_scene(f);
}

static void files_that_cannot_be_shown_are_refused(void **state)
{
    (void)state;
    weft_error error = {0};
    fixture *f = open_scene("scene_load/a.weft", NULL);
    expect_ok(finish(f, &error), &error);
    assert_int_equal(drop(f, WEFT_ASSETS "/stitches/plain_knit.stitch", &error), WEFT_BAD_INPUT);
    assert_int_equal(weft_class_of(drop(f, "scene_load", &error)), WEFT_BAD_INPUT);
    close_scene(f);
}

static void a_dropped_mesh_and_weave_are_shown(void **state)
{
    (void)state;
    weft_error error = {0};
    fixture *f = open_scene("scene_load/a.weft", NULL);
    expect_ok(finish(f, &error), &error);
    expect_ok(drop(f, "scene_load/quad.obj", &error), &error);
    assert_string_equal(f->settings.mesh, "scene_load/quad.obj");
    expect_ok(drop(f, WEFT_ASSETS "/weaves/polyester_lining.wv", &error), &error);
    assert_true(weft_player_has(f->stage->player, WEFT_MODE_ANALYTIC));
    expect_picture(f);
    close_scene(f);
}

static void a_picture_brings_its_settings_and_files_back(void **state)
{
    (void)state;
    weft_error error = {0};
    fixture *f = open_scene("scene_load/a.weft", NULL);
    expect_ok(finish(f, &error), &error);
    f->settings.scene.exposure = 2.5;
    f->settings.width = WIDTH;
    f->settings.height = HEIGHT;
    f->settings.samples = 1;
    expect_ok(weft_settings_draw("scene_load/shot.png", f->stage->player, &f->settings, NULL, &error), &error);
    expect_ok(drop(f, "scene_load/b.weft", &error), &error);
    expect_ok(drop(f, "scene_load/a.btf.h5", &error), &error);
    f->settings.scene.exposure = 1;
    int small = texels_shown(f);
    expect_ok(drop(f, "scene_load/shot.png", &error), &error);
    assert_float_equal(f->settings.scene.exposure, 2.5, 1e-9);
    assert_true(texels_shown(f) > small);
    assert_false(weft_player_has(f->stage->player, WEFT_MODE_RAW)); /* the picture knows of none */
    expect_picture(f);
    close_scene(f);
}

static void a_file_that_was_written_again_is_read_again(void **state)
{
    (void)state;
    weft_error error = {0};
    write_material("scene_load/c.weft", 16);
    fixture *f = open_scene("scene_load/c.weft", NULL);
    expect_ok(finish(f, &error), &error);
    int before = texels_shown(f);
    write_material("scene_load/c.weft", 4);
    expect_ok(weft_scene_loader_reload(f->loader, &error), &error);
    expect_ok(finish(f, &error), &error);
    assert_true(texels_shown(f) < before);
    close_scene(f);
}

static void a_scene_may_be_closed_while_it_is_read(void **state)
{
    (void)state;
    for (int pause_us = 0; pause_us < 40000; pause_us += 4000) {
        weft_error error = {0};
        bool shown;
        char note[WEFT_MESSAGE_SIZE];
        fixture *f = open_scene("scene_load/a.weft", "scene_load/a.btf.h5");
        usleep((unsigned)pause_us);
        weft_scene_loader_poll(f->loader, &shown, note, &error);
        close_scene(f);
    }
}

/* 6 cells of 0.36 mm on 300 mm of cloth; what is measured lays it by its own size. */
static void a_weave_has_its_own_size_until_it_lies_on_a_material(void **state)
{
    (void)state;
    weft_error error = {0};
    weft_settings settings;
    weft_scene_loader *loader;
    expect_ok(weft_settings_init(&settings, &error), &error);
    settings.weave = strdup(WEFT_ASSETS "/weaves/cotton_denim.wv");
    expect_ok(weft_scene_loader_create(&settings, &loader, &error), &error);
    expect_ok(weft_scene_loader_attach(loader, the_fixture.stage->player, &error), &error);
    expect_ok(weft_scene_loader_finish(loader, NULL, NULL, &error), &error);
    weft_weave_layout layout = weft_player_weave_layout(the_fixture.stage->player);
    assert_true(layout.tiles_u == 2 && layout.tiles_v == 1);
    assert_float_equal(settings.scene.repeat, 300 / (6 * 0.36), 1e-6);
    bool shown = true, some = true;
    char note[WEFT_MESSAGE_SIZE];
    expect_ok(weft_scene_loader_open(loader, "scene_load/b.weft", &error), &error);
    for (int i = 0; i < 1000 && some; i++) {
        expect_ok(weft_scene_loader_poll(loader, &shown, note, &error), &error);
        some = weft_scene_loader_progress(loader) >= 0;
        usleep(some ? 5000 : 0);
    }
    layout = weft_player_weave_layout(the_fixture.stage->player);
    assert_true(layout.tiles_u == 4 && layout.tiles_v == 2); /* about twelve cells across, as the virtual rig has it */
    assert_float_equal(settings.scene.repeat, 300 / (8 * 0.5), 1e-6);
    weft_scene_loader_free(loader);
    weft_settings_free(&settings);
}

static void what_has_one_view_is_known_before_it_is_read(void **state)
{
    (void)state;
    static const char *const path[] = {"scene_load/a.btf.h5", "scene_load/one_view.btf.h5"};
    for (int i = 0; i < 2; i++) {
        fixture *f = open_scene(NULL, path[i]);
        assert_int_equal(f->settings.is_of_one_view, i == 1);
        close_scene(f);
    }
}

int test_scene_loader(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(everything_named_is_shown_and_named),
        cmocka_unit_test(what_has_one_view_is_known_before_it_is_read),
        cmocka_unit_test(weaves_and_microcylinders_replace_each_other),
        cmocka_unit_test(a_fitted_weave_is_laid_as_its_file_says),
        cmocka_unit_test(samples_are_kept_in_the_format_that_the_settings_name),
        cmocka_unit_test(panes_that_were_chosen_while_files_arrive_stay),
        cmocka_unit_test(a_dropped_material_replaces_the_one_shown),
        cmocka_unit_test(what_a_material_says_of_its_error_goes_with_it),
        cmocka_unit_test(a_corrupt_file_leaves_what_was_shown),
        cmocka_unit_test(a_file_may_arrive_while_another_fails),
        cmocka_unit_test(files_that_cannot_be_shown_are_refused),
        cmocka_unit_test(a_dropped_mesh_and_weave_are_shown),
        cmocka_unit_test(a_picture_brings_its_settings_and_files_back),
        cmocka_unit_test(a_file_that_was_written_again_is_read_again),
        cmocka_unit_test(a_scene_may_be_closed_while_it_is_read),
        cmocka_unit_test(a_weave_has_its_own_size_until_it_lies_on_a_material),
    };
    return cmocka_run_group_tests(tests, make_files, close_stage);
}
