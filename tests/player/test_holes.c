/* Cloth with holes in front of a background. */
#include "stage.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIZE = 48, TEXELS = 8, FIELD = 2, VIEWS = 19 };

static const double cloth = 0.6;

/* Fields of grey cloth and holes by turns at level 0, half of each from there on. The reflectance is that of the whole
 * texel. */
static void make_mesh_cloth(int texels_a_field, weft_material *material)
{
    weft_error error = {0};
    expect_ok(weft_material_create(TEXELS, TEXELS, 0, VIEWS, 0, true, material, &error), &error);
    for (int v = 0; v < VIEWS; v++)
        material->view[v] = weft_direction_of_angles(weft_ubo81_angles(v));
    for (int k = 0; k < material->level_count; k++) {
        weft_material_level *level = &material->level[k];
        int texels = level->width * level->height;
        for (int i = 0; i < texels; i++) {
            bool hole = k == 0 && (i / level->width / texels_a_field + i % level->width / texels_a_field) % 2;
            double value = k > 0 ? cloth / 2 : hole ? 0 : cloth;
            weft_frame frame = weft_frame_of_normal(weft_vec3_of(0, 0, 1), 0);
            weft_frame_encode(&frame, level->frame + 3 * i);
            for (int c = 0; c < 3; c++)
                level->diffuse[4 * i + c] = weft_half_of_float((float)value);
            for (int v = 0; v < VIEWS; v++) {
                const uint8_t code[4] = {255, 255, 255, k > 0 ? 128 : hole ? 0 : 255};
                memcpy(level->table + 4 * (v * texels + i), code, sizeof code);
            }
        }
    }
}

static void set_mesh(weft_player *player, weft_code (*make)(weft_mesh *, weft_error *))
{
    weft_mesh mesh;
    weft_error error = {0};
    expect_ok(make(&mesh, &error), &error);
    expect_ok(weft_player_set_mesh(player, &mesh, &error), &error);
    weft_mesh_free(&mesh);
}

/* A triangle without area: nothing of it is seen. */
static weft_code make_nothing(weft_mesh *mesh, weft_error *error)
{
    WEFT_TRY(weft_mesh_allocate(3, 1, mesh, error));
    for (int i = 0; i < 3; i++) {
        mesh->vertex[i] = (weft_vertex){.position = {(float)i, 0, 0}, .normal = {0, 0, 1}, .tangent = {1, 0, 0, 1}};
        mesh->index[0][i] = (uint32_t)i;
    }
    return WEFT_OK;
}

static weft_scene plane_scene(double elevation_deg)
{
    weft_scene scene = weft_scene_default();
    scene.orbit = (weft_orbit){
        .azimuth_rad = weft_rad_of_deg(-90), .elevation_rad = weft_rad_of_deg(elevation_deg), .distance = 3};
    scene.light[0].direction = (weft_angles){0, 0};
    scene.repeat = 1;
    scene.labels = false;
    scene.level_choice = WEFT_LEVEL_FIXED;
    return scene;
}

static weft_image draw(weft_player *player, const weft_scene *scene, int samples)
{
    weft_image image;
    weft_error error = {0};
    expect_ok(weft_player_picture(player, scene, SIZE, SIZE, samples, NULL, &image, &error), &error);
    return image;
}

static weft_image draw_background(weft_player *player)
{
    weft_scene scene = plane_scene(90);
    set_mesh(player, make_nothing);
    return draw(player, &scene, 1);
}

static double mean_of_middle(const weft_image *image)
{
    double sum = 0;
    for (int y = SIZE / 2 - 6; y < SIZE / 2 + 6; y++)
        for (int x = SIZE / 2 - 6; x < SIZE / 2 + 6; x++)
            sum += (double)image->pixels[3 * (y * SIZE + x)] / 144;
    return sum;
}

static void set_material(weft_player *player, weft_material *material)
{
    weft_error error = {0};
    expect_ok(weft_player_set_material(player, material, &error), &error);
}

static void a_half_covered_level_shows_half_of_the_background(void **state)
{
    weft_player *player = ((stage *)*state)->player;
    weft_material material;
    make_mesh_cloth(1, &material);
    set_material(player, &material);
    weft_image background = draw_background(player);
    set_mesh(player, weft_mesh_plane);
    weft_scene scene = plane_scene(90);
    scene.level = 1;
    weft_image half = draw(player, &scene, 1);
    assert_true(mean_of_middle(&background) > 0.05);
    assert_float_equal(mean_of_middle(&half), cloth / 2 + (1 - 128 / 255.0) * mean_of_middle(&background), 1e-3);
    weft_image_free(&background);
    weft_image_free(&half);
    weft_material_free(&material);
}

/* Two squares, one above the other; the upper one is drawn first. */
static weft_code make_two_planes(weft_mesh *mesh, weft_error *error)
{
    weft_mesh plane;
    WEFT_TRY(weft_mesh_plane(&plane, error));
    weft_code code = weft_mesh_allocate(8, 4, mesh, error);
    for (int i = 0; i < 8 && code == WEFT_OK; i++) {
        mesh->vertex[i] = plane.vertex[i % 4];
        mesh->vertex[i].position[2] = i < 4 ? 0.2f : 0;
    }
    for (int i = 0; i < 12 && code == WEFT_OK; i++)
        mesh->index[i / 3][i % 3] = plane.index[i / 3 % 2][i % 3] + (i < 6 ? 0 : 4);
    weft_mesh_free(&plane);
    return code;
}

static void holes_show_the_cloth_behind(void **state)
{
    weft_player *player = ((stage *)*state)->player;
    weft_material material;
    make_mesh_cloth(1, &material);
    set_material(player, &material);
    weft_image background = draw_background(player);
    set_mesh(player, make_two_planes);
    weft_scene scene = plane_scene(90);
    scene.level = 1;
    weft_image image = draw(player, &scene, 1);
    double through = 1 - 128 / 255.0, lower = cloth / 2 + through * mean_of_middle(&background);
    assert_float_equal(mean_of_middle(&image), cloth / 2 + through * lower, 1e-3);
    weft_image_free(&background);
    weft_image_free(&image);
    weft_material_free(&material);
}

/* ---- Shadows ---- */

/* The same, so that the cloth of the lower one lies below the holes of the upper one. */
static weft_code make_crossed_planes(weft_mesh *mesh, weft_error *error)
{
    WEFT_TRY(make_two_planes(mesh, error));
    for (int i = 4; i < 8; i++)
        mesh->vertex[i].coordinate[0] += (float)FIELD / TEXELS;
    return WEFT_OK;
}

/* Light from straight above falls on the lower cloth as far as the upper one is open, which pictures without shadows
 * tell: `one` of one cloth, `two` of both, `nothing` of none. */
static void the_lower_cloth_has_the_light_that_passes(weft_player *player, weft_mode mode, const weft_image *nothing)
{
    weft_scene scene = plane_scene(90);
    scene.pane[0] = mode;
    scene.level = 3; /* one texel */
    set_mesh(player, weft_mesh_plane);
    weft_image one = draw(player, &scene, 1);
    set_mesh(player, make_two_planes);
    weft_image two = draw(player, &scene, 1);
    scene.shadows = true;
    weft_image shadowed = draw(player, &scene, 4);
    double background = mean_of_middle(nothing), upper = mean_of_middle(&one);
    double open = (mean_of_middle(&two) - upper) / (upper - background), own = upper - open * background;
    print_message("%s: %.3f open, two %.4f, in shadow %.4f\n", weft_mode_name(mode), open, mean_of_middle(&two),
                  mean_of_middle(&shadowed));
    assert_true(open > 0.2 && open < 0.9);
    assert_float_equal(mean_of_middle(&shadowed), own + open * open * (own + background), 0.02 * own);
    weft_image_free(&one);
    weft_image_free(&two);
    weft_image_free(&shadowed);
}

/* Holes and grey cloth by turns, photographed. */
static void show_photographs_with_holes(weft_player *player, const char *path)
{
    enum { LIGHTS = 7, IMAGES = VIEWS * LIGHTS, PLACES = TEXELS * TEXELS };
    static weft_half samples[3 * PLACES];
    static float opacity[PLACES * VIEWS];
    static uint8_t mask[PLACES];
    weft_error error = {0};
    weft_dataset_layout layout = {
        .width = TEXELS, .height = TEXELS, .image_count = IMAGES, .view_count = VIEWS, .texel_pitch_mm = 0.5};
    expect_ok(weft_dataset_layout_allocate(&layout, &error), &error);
    weft_dataset_writer *writer;
    for (int i = 0; i < IMAGES; i++) {
        layout.view_of_image[i] = i / LIGHTS;
        layout.light[i] = weft_direction_of_angles(weft_ubo81_angles(i % LIGHTS));
        layout.view[i / LIGHTS] = weft_direction_of_angles(weft_ubo81_angles(i / LIGHTS));
    }
    for (int i = 0; i < PLACES; i++) {
        bool hole = (i / TEXELS + i % TEXELS) % 2;
        for (int v = 0; v < VIEWS; v++)
            opacity[i * VIEWS + v] = !hole;
        for (int c = 0; c < 3; c++)
            samples[3 * i + c] = weft_half_of_float(hole ? 0 : (float)cloth);
    }
    expect_ok(weft_dataset_writer_create(path, &layout, &writer, &error), &error);
    for (int i = 0; i < IMAGES; i++)
        expect_ok(weft_dataset_writer_put_image(writer, i, samples, mask, &error), &error);
    expect_ok(weft_dataset_writer_put_opacity(writer, opacity, &error), &error);
    expect_ok(weft_dataset_writer_finish(writer, NULL, &error), &error);
    weft_dataset_layout_free(&layout);
    weft_dataset *dataset;
    int skipped_levels;
    expect_ok(weft_dataset_open(path, &dataset, &error), &error);
    expect_ok(weft_player_set_dataset(player, dataset, NULL, &skipped_levels, &error), &error);
    weft_dataset_close(dataset);
    remove(path);
}

static void light_passes_as_far_as_cloth_is_open(void **state)
{
    weft_player *player = ((stage *)*state)->player;
    weft_material material;
    make_mesh_cloth(1, &material);
    set_material(player, &material);
    weft_image nothing = draw_background(player);
    the_lower_cloth_has_the_light_that_passes(player, WEFT_MODE_COMPRESSED, &nothing);
    stage_components(WEFT_COMPONENTS_OF_LIGHT, 4, &material);
    stage_heights(true, 1, &material);
    set_material(player, &material);
    the_lower_cloth_has_the_light_that_passes(player, WEFT_MODE_COMPRESSED, &nothing);
    show_photographs_with_holes(player, "holes.btf.h5");
    the_lower_cloth_has_the_light_that_passes(player, WEFT_MODE_RAW, &nothing);
    weft_image_free(&nothing);
    weft_material_free(&material);
}

/* What shadows take from the picture, as a share of it. The light falls slantwise: what passes a hole of the upper
 * cloth meets the lower one `aside` of it. */
static double lost_to_shadows(weft_player *player, double repeat, double aside)
{
    weft_scene scene = plane_scene(90);
    scene.repeat = repeat;
    scene.level = 0;
    scene.light[0].direction = (weft_angles){atan(aside / 0.2), 0};
    weft_image lit = draw(player, &scene, 4);
    scene.shadows = true;
    weft_image shadowed = draw(player, &scene, 4);
    double lost = 1 - mean_of_middle(&shadowed) / mean_of_middle(&lit);
    weft_image_free(&lit);
    weft_image_free(&shadowed);
    return lost;
}

/* Light that comes through one hole and goes to the eye through the next meets cloth; half as slanted it meets the
 * shadow of the cloth between the holes. */
static void light_passes_the_holes_that_the_light_sees(void **state)
{
    weft_player *player = ((stage *)*state)->player;
    weft_material material;
    make_mesh_cloth(FIELD, &material);
    set_material(player, &material);
    set_mesh(player, make_crossed_planes);
    double through = lost_to_shadows(player, 1, 2.0 * FIELD / TEXELS),
           between = lost_to_shadows(player, 1, 1.0 * FIELD / TEXELS);
    print_message("shadows take %.3f where holes line up, %.3f where they do not\n", through, between);
    assert_true(between > 0.2 && through < between / 3);
    /* The holes are three times as close, and line up under the same light under which they did not. */
    double aside = 2.0 * FIELD / TEXELS / 3, wide = lost_to_shadows(player, 1, aside);
    double close = lost_to_shadows(player, 3, aside);
    print_message("and %.3f of wide holes, %.3f of close ones\n", wide, close);
    assert_true(wide > 0.15 && close < wide / 2);
    weft_material_free(&material);
}

/* ---- Shadows while the light moves ---- */

/* The mean of frames between which the light turns by a thousandth of a degree: each has a rough map of its own. */
static weft_image draw_under_moving_light(weft_player *player, const weft_scene *scene, int frames)
{
    weft_error error = {0};
    weft_canvas canvas;
    weft_image image;
    weft_scene moved = *scene;
    expect_ok(weft_canvas_create(SIZE, SIZE, &canvas, &error), &error);
    for (int i = 0; i < frames; i++) {
        moved.light[0].direction.theta_rad = scene->light[0].direction.theta_rad + (i % 2 ? 0 : weft_rad_of_deg(1e-3));
        weft_canvas_begin_frame(&canvas);
        expect_ok(weft_player_draw(player, &moved, SIZE, SIZE, (weft_sampling){.frame = -1}, &error), &error);
        weft_canvas_end_frame(&canvas);
    }
    expect_ok(weft_canvas_read(&canvas, &image, &error), &error);
    weft_canvas_free(&canvas);
    return image;
}

/* How much of the light that passes the upper cloth a picture lacks against one at rest. */
static double lacks(weft_player *player, const weft_scene *scene)
{
    weft_image moving = draw_under_moving_light(player, scene, 16), resting = draw(player, scene, 4);
    double share = 1 - mean_of_middle(&moving) / mean_of_middle(&resting);
    weft_image_free(&moving);
    weft_image_free(&resting);
    return share;
}

/* Rough maps are half as fine. Half open cloth lets half of the light pass; through fields of holes it passes where the
 * light sees them, one direction after the other. */
static void moving_light_passes_the_same_holes(void **state)
{
    weft_player *player = ((stage *)*state)->player;
    weft_material material;
    make_mesh_cloth(FIELD, &material);
    set_material(player, &material);
    set_mesh(player, make_crossed_planes);
    weft_scene scene = plane_scene(90);
    scene.shadows = true;
    for (int aside = 0; aside < 4; aside++) {
        scene.light[0].direction = (weft_angles){atan(0.5 * aside * FIELD / TEXELS / 0.2), 0};
        scene.level = 0;
        double fields = lacks(player, &scene);
        scene.level = 3; /* one texel */
        double half = lacks(player, &scene);
        print_message("light aside by %d halves of a field: %.4f through fields, %.4f through half open cloth\n", aside,
                      fields, half);
        assert_true(fabs(fields) < 0.04 && fabs(half) < 0.02);
    }
    weft_material_free(&material);
}

static void a_picture_at_rest_has_nothing_of_the_rough_shadows_before(void **state)
{
    weft_player *player = ((stage *)*state)->player;
    weft_material material;
    make_mesh_cloth(FIELD, &material);
    set_material(player, &material);
    set_mesh(player, make_crossed_planes);
    weft_scene scene = plane_scene(90);
    scene.shadows = true;
    scene.light[0].direction = (weft_angles){atan(1.3 * FIELD / TEXELS / 0.2), 0};
    scene.level = 0;
    weft_image at_once = draw(player, &scene, 1), again;
    weft_scene other = scene;
    other.light[0].direction.phi_rad = 1;
    weft_image before = draw_under_moving_light(player, &other, 1);
    weft_image_free(&before);
    /* The last rough map is of the very light that then rests. */
    before = draw_under_moving_light(player, &scene, 2);
    again = draw(player, &scene, 1);
    double differs = 0;
    for (int i = 0; i < 3 * SIZE * SIZE; i++) {
        assert_float_equal(again.pixels[i], at_once.pixels[i], 0);
        differs = fmax(differs, fabs((double)(before.pixels[i] - again.pixels[i])));
    }
    assert_true(differs > 0.01);
    weft_image_free(&at_once);
    weft_image_free(&before);
    weft_image_free(&again);
    weft_material_free(&material);
}

static void levels_of_holes_have_one_mean(void **state)
{
    weft_player *player = ((stage *)*state)->player;
    weft_material material;
    make_mesh_cloth(1, &material);
    set_material(player, &material);
    set_mesh(player, weft_mesh_plane);
    weft_scene scene = plane_scene(90);
    scene.repeat = 24; /* many texels in a pixel: their mean is what counts */
    weft_image fine = draw(player, &scene, 16);
    for (int level = 1; level < material.level_count; level++) {
        scene.level = level;
        weft_image coarse = draw(player, &scene, 1);
        assert_float_equal(mean_of_middle(&coarse), mean_of_middle(&fine), 4e-3);
        weft_image_free(&coarse);
    }
    weft_image_free(&fine);
    weft_material_free(&material);
}

/* How many pixels show something of the background. */
static int compare_with_evaluator(weft_player *player, const weft_material *material, const weft_image *background,
                                  const weft_scene *scene)
{
    weft_table_directions directions;
    weft_surface_sample *surface;
    weft_error error = {0};
    expect_ok(weft_table_directions_create(material, &directions, &error), &error);
    weft_image image = draw(player, scene, 1);
    expect_ok(weft_player_read_surface(player, scene, WEFT_MODE_COMPRESSED, SIZE, SIZE, &surface, &error), &error);
    int open = 0;
    for (int i = 0; i < SIZE * SIZE; i++) {
        const weft_surface_sample *at = &surface[i];
        if (at->covered == 0)
            continue;
        weft_vec3 light = weft_vec3_of((weft_real)at->light[0], (weft_real)at->light[1], (weft_real)at->light[2]);
        weft_vec3 view = weft_vec3_of((weft_real)at->view[0], (weft_real)at->view[1], (weft_real)at->view[2]);
        weft_rgba f = weft_material_sample(material, &directions, (weft_real)at->level, (weft_real)at->u,
                                           (weft_real)at->v, light, view);
        double behind = (1 - f.a) * (double)background->pixels[3 * i];
        assert_float_equal((double)image.pixels[3 * i], f.r * fmax(light.z, 0) + behind, 2e-3);
        open += f.a < 0.9;
    }
    free(surface);
    weft_image_free(&image);
    weft_table_directions_free(&directions);
    return open;
}

static void evaluator_and_shader_agree_where_there_are_holes(void **state)
{
    weft_player *player = ((stage *)*state)->player;
    weft_material material;
    stage_material(TEXELS, TEXELS, 2, VIEWS, 0, &material);
    set_material(player, &material);
    weft_image background = draw_background(player);
    set_mesh(player, weft_mesh_plane);
    weft_scene scene = plane_scene(50);
    int open = 0;
    for (int level = 0; level < 4; level++) {
        scene.level = 0.4 * level;
        scene.light[0].direction.theta_rad = weft_rad_of_deg(40);
        open += compare_with_evaluator(player, &material, &background, &scene);
        scene.light[0].direction.theta_rad = weft_rad_of_deg(140);
        open += compare_with_evaluator(player, &material, &background, &scene);
    }
    assert_true(open > 100);
    weft_image_free(&background);
    weft_material_free(&material);
}

int test_holes(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_half_covered_level_shows_half_of_the_background),
        cmocka_unit_test(holes_show_the_cloth_behind),
        cmocka_unit_test(light_passes_as_far_as_cloth_is_open),
        cmocka_unit_test(light_passes_the_holes_that_the_light_sees),
        cmocka_unit_test(moving_light_passes_the_same_holes),
        cmocka_unit_test(a_picture_at_rest_has_nothing_of_the_rough_shadows_before),
        cmocka_unit_test(levels_of_holes_have_one_mean),
        cmocka_unit_test(evaluator_and_shader_agree_where_there_are_holes),
    };
    return cmocka_run_group_tests(tests, stage_open, stage_close);
}
