/* What the panel says of the pixel under the pointer. */
#include "player/draw/probe.h"
#include "stage.h"

#include <math.h>
#include <stdlib.h>

enum { WIDTH = 160, HEIGHT = 120, SIZE = 256 };

typedef struct drawn {
    weft_canvas canvas;
    weft_scene scene;
    weft_surface_sample *surface;
    weft_image image;
} drawn;

static drawn draw(weft_player *player)
{
    drawn d = {.scene = weft_scene_default()};
    weft_error error = {0};
    weft_material material;
    stage_material(20, 13, 2, 81, 0, &material);
    expect_ok(weft_player_set_material(player, &material, &error), &error);
    weft_material_free(&material);
    d.scene.labels = false;
    d.scene.filter = WEFT_FILTER_EXACT;
    expect_ok(weft_player_read_surface(player, &d.scene, WEFT_MODE_COMPRESSED, WIDTH, HEIGHT, &d.surface, &error),
              &error);
    expect_ok(weft_canvas_create(WIDTH, HEIGHT, &d.canvas, &error), &error);
    weft_canvas_begin_frame(&d.canvas);
    expect_ok(weft_player_draw(player, &d.scene, WIDTH, HEIGHT, (weft_sampling){.frame = 0}, &error), &error);
    weft_canvas_end_frame(&d.canvas);
    expect_ok(weft_canvas_read(&d.canvas, &d.image, &error), &error);
    return d;
}

static void release(drawn *d)
{
    weft_canvas_free(&d->canvas);
    weft_image_free(&d->image);
    free(d->surface);
}

static weft_probe probe_at(weft_player *player, const drawn *d, int x, int y)
{
    weft_probe probe;
    weft_error error = {0};
    expect_ok(weft_probe_read(player, &d->scene, &d->canvas, x, y, &probe, &error), &error);
    return probe;
}

static void a_probe_says_what_the_shader_saw(void **state)
{
    stage *s = *state;
    drawn d = draw(s->player);
    int on_mesh = 0;
    for (int y = 3; y < HEIGHT; y += 7) {
        for (int x = 3; x < WIDTH; x += 7) {
            const weft_surface_sample *seen = &d.surface[y * WIDTH + x];
            weft_probe probe = probe_at(s->player, &d, x, y);
            assert_int_equal(probe.on_mesh, seen->covered > 0);
            for (int c = 0; c < 3; c++)
                assert_float_equal(probe.radiance[c], d.image.pixels[3 * (y * WIDTH + x) + c], 1e-6);
            if (!probe.on_mesh)
                continue;
            on_mesh++;
            const double pairs[][2] = {{(double)probe.light.x, (double)seen->light[0]},
                                       {(double)probe.light.z, (double)seen->light[2]},
                                       {(double)probe.view.y, (double)seen->view[1]},
                                       {(double)probe.view.z, (double)seen->view[2]},
                                       {probe.u, (double)seen->u},
                                       {probe.v, (double)seen->v},
                                       {probe.level, (double)seen->level}};
            for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++)
                assert_float_equal(pairs[i][0], pairs[i][1], 1e-4);
            assert_in_range(probe.texel_x, 0, 19);
            assert_in_range(probe.texel_y, 0, 12);
        }
    }
    assert_true(on_mesh > 50);
    weft_probe beside = probe_at(s->player, &d, -1, 5);
    assert_false(beside.on_mesh);
    release(&d);
}

/* Bilinear between the pixels of a disc, at a direction. */
static double plotted(const float *pixels, int disc, int channel, weft_vec3 direction)
{
    double across = hypot((double)direction.x, (double)direction.y), r = sqrt(fmax(0, 1 - (double)direction.z));
    double scale = across > 0 ? r / across : 0;
    double x = (0.5 + 0.5 * (double)direction.x * scale) * SIZE - 0.5 + disc * SIZE;
    double y = (0.5 + 0.5 * (double)direction.y * scale) * SIZE - 0.5, sum = 0;
    for (int i = 0; i < 4; i++) {
        int column = (int)floor(x) + i % 2, row = (int)floor(y) + i / 2;
        double weight = (1 - fabs(x - column)) * (1 - fabs(y - row));
        sum += weight * (double)pixels[4 * (row * 2 * SIZE + column) + channel];
    }
    return sum;
}

static void both_plots_pass_through_the_value_of_the_pixel(void **state)
{
    stage *s = *state;
    weft_error error = {0};
    weft_probe_plots plots;
    drawn d = draw(s->player);
    expect_ok(weft_probe_plots_create(SIZE, &plots, &error), &error);
    float *pixels = malloc(2 * SIZE * SIZE * 4 * sizeof *pixels);
    int compared = 0;
    for (int y = 20; y < HEIGHT; y += 17) {
        for (int x = 20; x < WIDTH; x += 17) {
            weft_probe probe = probe_at(s->player, &d, x, y);
            if (!probe.on_mesh || probe.light.z < 0.3 || probe.view.z < 0.3)
                continue;
            expect_ok(weft_probe_plots_draw(&plots, s->player, &d.scene, &probe, &error), &error);
            glBindTexture(GL_TEXTURE_2D, plots.linear);
            glGetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_FLOAT, pixels);
            /* Where the cloth is not opaque the picture shows what is behind, too. */
            if (plotted(pixels, 0, 3, probe.light) < 1)
                continue;
            double expected = probe.radiance[1] / (double)probe.light.z;
            assert_float_equal(plotted(pixels, 0, 1, probe.light), expected, 2e-3 * expected);
            assert_float_equal(plotted(pixels, 1, 1, probe.view), expected, 2e-3 * expected);
            assert_float_equal(pixels[3], 0, 0); /* nothing in the corner */
            double value[3];
            expect_ok(weft_probe_value(&plots, s->player, &d.scene, &probe, value, &error), &error);
            for (int c = 0; c < 3; c++)
                assert_float_equal(value[c], probe.radiance[c] / d.scene.exposure / (double)probe.light.z,
                                   1e-4 * fabs(value[c]));
            compared++;
        }
    }
    assert_true(compared > 5);
    free(pixels);
    weft_probe_plots_free(&plots);
    release(&d);
}

/* Directions of the frame are packed in 16 bits; everything else comes back as it was coded. */
static void a_texel_that_is_read_evaluates_to_the_materials_value(void **state)
{
    stage *s = *state;
    weft_error error = {0};
    weft_material material;
    weft_table_directions directions;
    stage_material(20, 13, 2, 81, 30, &material);
    expect_ok(weft_player_set_material(s->player, &material, &error), &error);
    expect_ok(weft_table_directions_create(&material, &directions, &error), &error);
    const weft_vec3 light = weft_unit((weft_vec3){0.3, -0.5, 0.8}), view = weft_unit((weft_vec3){-0.4, 0.2, 0.7});
    for (int level = 0; level < 3; level++) {
        int x = material.level[level].width - 1, y = material.level[level].height / 2;
        weft_texel texel;
        expect_ok(weft_texel_read(s->player, level, x, y, light, view, &texel, &error), &error);
        weft_rgba expected = weft_material_texel(&material, &directions, level, x, y, light, view);
        const double channel[] = {(double)expected.r, (double)expected.g, (double)expected.b};
        for (int c = 0; c < 3; c++) {
            const weft_lobe lobes[] = {texel.lobe[0][c], texel.lobe[1][c]};
            weft_real sum = weft_lafortune((weft_real)texel.diffuse[c], lobes, 2, weft_frame_local(&texel.frame, light),
                                           weft_frame_local(&texel.frame, view));
            double value = (double)sum * texel.view_table[c] * texel.light_table[c];
            assert_float_equal(value / channel[c], 1, 2e-3);
        }
    }
    weft_texel texel;
    assert_int_equal(weft_texel_read(s->player, 0, 20, 0, light, view, &texel, &error), WEFT_BAD_USAGE);
    weft_table_directions_free(&directions);
    weft_material_free(&material);
}

/* (l . d)^1 about the normal: the integral of cos^2 over the hemisphere is 2 pi / 3. Half of cos^N at 10 degrees. */
static void the_shape_of_a_lobe_follows_its_parameters(void **state)
{
    (void)state;
    const weft_frame frame = {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}};
    const double table[] = {0.5, 0.5, 0.5};
    const weft_lobe broad[] = {{0, 0, 1, 1}, {0, 0, 1, 1}, {0, 0, 1, 1}};
    weft_lobe_shape shape = weft_lobe_shape_of(broad, &frame, (weft_vec3){0, 0, 1}, table);
    assert_float_equal(shape.albedo, 0.5 * 2 / 3.0, 1e-3);
    assert_float_equal(shape.half_width_rad, WEFT_PI / 3, 1e-9);
    double n = log(0.5) / log(cos(WEFT_PI / 18));
    const weft_lobe mirror = {-1, -1, 1, (weft_real)n}, mirrors[] = {mirror, mirror, mirror};
    shape = weft_lobe_shape_of(mirrors, &frame, weft_unit((weft_vec3){0.6, 0, 0.8}), table);
    assert_float_equal(shape.half_width_rad, WEFT_PI / 18, 1e-4);
    assert_float_equal(shape.direction.x, -0.6, 1e-6);
    assert_float_equal(shape.direction.z, 0.8, 1e-6);
}

int test_probe(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_probe_says_what_the_shader_saw),
        cmocka_unit_test(both_plots_pass_through_the_value_of_the_pixel),
        cmocka_unit_test(a_texel_that_is_read_evaluates_to_the_materials_value),
        cmocka_unit_test(the_shape_of_a_lobe_follows_its_parameters),
    };
    return cmocka_run_group_tests(tests, stage_open, stage_close);
}
