#include "stage.h"

#include "../support/keep_modules.h"
#include "base/picture/colour.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int stage_open(void **state)
{
    weft_error error = {0};
    stage *s = calloc(1, sizeof *s);
    if (weft_headless_create(WEFT_GL_CORE, &s->headless, &error) != WEFT_OK) {
        printf("skipped: %s\n", error.message);
        exit(77);
    }
    keep_modules_loaded();
    expect_ok(weft_player_create(&s->player, &error), &error);
    weft_mesh mesh;
    expect_ok(weft_mesh_drape(&mesh, &error), &error);
    expect_ok(weft_player_set_mesh(s->player, &mesh, &error), &error);
    weft_mesh_free(&mesh);
    *state = s;
    return 0;
}

int stage_close(void **state)
{
    stage *s = *state;
    weft_player_free(s->player);
    weft_headless_free(s->headless);
    free(s);
    return 0;
}

double stage_uniform(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) * 0x1p-53;
}

/* ---- Materials ---- */

static void set_half(weft_half *to, double value)
{
    *to = weft_half_of_float((float)value);
}

static void set_stripe_texel(weft_material *m, int k, int x, int y, uint64_t *random)
{
    weft_material_level *level = &m->level[k];
    size_t texels = (size_t)level->width * (size_t)level->height, at = (size_t)y * (size_t)level->width + (size_t)x;
    double slope = 0.4 * sin(2 * WEFT_PI * (x + 0.5) / level->width * 3), twist = 2 * stage_uniform(random) - 1;
    weft_frame frame = weft_frame_of_normal(weft_unit(weft_vec3_of(slope, 0.2 * twist, 1)), twist);
    weft_frame_encode(&frame, level->frame + 3 * at);
    for (int c = 0; c < 3; c++) {
        set_half(&level->diffuse[4 * at + (size_t)c], 0.05 + 0.3 * stage_uniform(random));
        for (int lobe = 0; lobe < m->lobe_count; lobe++) {
            weft_half *code = level->lobe + 4 * ((size_t)(3 * lobe + c) * texels + at);
            double exponent = lobe == 0 ? 2 + 10 * stage_uniform(random) : 30 + 60 * stage_uniform(random);
            double size = 0.9 + 0.1 * stage_uniform(random);
            set_half(&code[0], -size);
            set_half(&code[1], -size * (0.7 + 0.3 * stage_uniform(random)));
            set_half(&code[2], size);
            set_half(&code[3], exponent);
        }
    }
    for (int view = 0; view < m->view_count; view++) {
        uint8_t *code = level->table + 4 * ((size_t)view * texels + at);
        for (int c = 0; c < 3; c++)
            code[c] = (uint8_t)(140 + 115 * stage_uniform(random));
        code[3] = stage_uniform(random) < 0.02 ? 128 : 255;
    }
    for (int light = 0; light < m->light_count; light++) {
        uint8_t *code = level->light_table + 4 * ((size_t)light * texels + at);
        for (int c = 0; c < 3; c++)
            code[c] = (uint8_t)(140 + 115 * stage_uniform(random));
    }
}

void stage_material(int width, int height, int lobes, int views, int lights, weft_material *material)
{
    weft_error error = {0};
    uint64_t random = 7;
    expect_ok(weft_material_create(width, height, lobes, views, lights, true, material, &error), &error);
    material->texel_pitch_mm = 0.5;
    for (int v = 0; v < views; v++)
        material->view[v] = weft_direction_of_angles(weft_ubo81_angles(v));
    for (int l = 0; l < lights; l++)
        material->light[l] = weft_direction_of_angles(weft_ubo81_angles(WEFT_UBO81_COUNT - 1 - l));
    for (int k = 0; k < material->level_count; k++) {
        for (int y = 0; y < material->level[k].height; y++) {
            for (int x = 0; x < material->level[k].width; x++)
                set_stripe_texel(material, k, x, y, &random);
        }
    }
}

/* `share` of the texel is bright. Amplitudes are means; a lobe of amplitude A is stored with C = A^(1/N) c. */
static void set_checker_texel(weft_material_level *level, size_t at, double share)
{
    const double exponent = 12, dark[2] = {0.02, 0.05}, bright[2] = {0.6, 1.4};
    size_t texels = (size_t)level->width * (size_t)level->height;
    weft_frame frame = weft_frame_of_normal(weft_vec3_of(0, 0, 1), 0);
    weft_frame_encode(&frame, level->frame + 3 * at);
    double scale = pow(dark[1] + share * (bright[1] - dark[1]), 1 / exponent);
    for (int c = 0; c < 3; c++) {
        set_half(&level->diffuse[4 * at + (size_t)c], dark[0] + share * (bright[0] - dark[0]));
        weft_half *code = level->lobe + 4 * ((size_t)c * texels + at);
        set_half(&code[0], -scale);
        set_half(&code[1], -scale);
        set_half(&code[2], scale);
        set_half(&code[3], exponent);
    }
}

void stage_checker(int size, weft_material *material)
{
    weft_error error = {0};
    expect_ok(weft_material_create(size, size, 1, 0, 0, true, material, &error), &error);
    material->texel_pitch_mm = 0.5;
    for (int k = 0; k < material->level_count; k++) {
        weft_material_level *level = &material->level[k];
        for (int i = 0; i < level->width * level->height; i++)
            set_checker_texel(level, (size_t)i, k > 0 ? 0.5 : (i / level->width + i % level->width) % 2);
    }
}

/* ---- Datasets ---- */

static double stage_sample(const weft_dataset_layout *layout, int image, int x, int y, int channel)
{
    weft_vec3 l = layout->light[image], v = layout->view[layout->view_of_image[image]];
    double texture = 0.3 + 0.2 * sin(x * 1.3 + channel) * cos(y * 0.9 + 0.5 * channel);
    double gloss = fmax(0, l.z * v.z - l.x * v.x - l.y * v.y);
    double brdf_pi = texture * (1 + 0.3 * v.x) + 0.4 * pow(gloss, 6);
    return layout->values == WEFT_REFLECTANCE_COSINE ? brdf_pi * l.z : brdf_pi;
}

static weft_code put_image(weft_dataset_writer *writer, const weft_dataset_layout *layout, int image, bool holes,
                           weft_half *samples, uint8_t *mask, weft_error *error)
{
    for (int i = 0; i < layout->width * layout->height; i++) {
        for (int c = 0; c < 3; c++)
            set_half(&samples[3 * i + c], stage_sample(layout, image, i % layout->width, i / layout->width, c));
        mask[i] = holes && (image * 31 + i) % 11 == 0 ? WEFT_MASK_SATURATED : 0;
        if (mask[i])
            set_half(&samples[3 * i], NAN);
    }
    return weft_dataset_writer_put_image(writer, image, samples, mask, error);
}

void stage_dataset(const char *path, int size, int views, int lights, weft_values values, bool holes)
{
    weft_error error = {0};
    weft_dataset_layout layout = {.width = size,
                                  .height = size,
                                  .image_count = views * lights,
                                  .view_count = views,
                                  .values = values,
                                  .texel_pitch_mm = 0.5};
    expect_ok(weft_dataset_layout_allocate(&layout, &error), &error);
    for (int i = 0; i < views * lights; i++) {
        layout.light[i] = weft_direction_of_angles(weft_ubo81_angles(i % lights));
        layout.view[i / lights] = weft_direction_of_angles(weft_ubo81_angles(i / lights));
        layout.view_of_image[i] = i / lights;
    }
    weft_half *samples = calloc((size_t)size * (size_t)size, 3 * sizeof *samples);
    uint8_t *mask = calloc((size_t)size * (size_t)size, 1);
    weft_dataset_writer *writer;
    expect_ok(weft_dataset_writer_create(path, &layout, &writer, &error), &error);
    for (int i = 0; i < layout.image_count; i++)
        expect_ok(put_image(writer, &layout, i, holes, samples, mask, &error), &error);
    expect_ok(weft_dataset_writer_finish(writer, NULL, &error), &error);
    free(samples);
    free(mask);
    weft_dataset_layout_free(&layout);
}

/* ---- Comparison ---- */

static double displayed(double linear)
{
    return round(255 * (double)weft_srgb_of_linear((float)fmin(fmax(linear, 0), 1)));
}

stage_difference stage_compare(weft_player *player, weft_scene scene, weft_mode mode, int width, int height,
                               stage_evaluator *evaluate, void *context)
{
    weft_error error = {0};
    weft_image image;
    weft_surface_sample *sample;
    scene.pane_count = 1;
    scene.pane[0] = mode;
    expect_ok(weft_player_picture(player, &scene, width, height, 1, NULL, &image, &error), &error);
    expect_ok(weft_player_read_surface(player, &scene, mode, width, height, &sample, &error), &error);
    stage_difference difference = {0};
    for (int i = 0; i < width * height; i++) {
        if (sample[i].covered == 0)
            continue;
        weft_rgba value = evaluate(context, &sample[i]);
        if (value.a < 0.999)
            continue;
        const double expected[3] = {value.r, value.g, value.b};
        for (int c = 0; c < 3; c++) {
            double error_255 = displayed((double)image.pixels[3 * i + c]) - displayed(scene.exposure * expected[c]);
            difference.rmse += error_255 * error_255;
            difference.largest = fmax(difference.largest, fabs(error_255));
        }
        difference.pixels++;
    }
    difference.rmse = sqrt(difference.rmse / (3.0 * (double)difference.pixels));
    free(sample);
    weft_image_free(&image);
    return difference;
}

weft_vec3 stage_vector(const float v[3])
{
    return weft_vec3_of((weft_real)v[0], (weft_real)v[1], (weft_real)v[2]);
}

weft_rgba stage_lit(weft_rgb brdf_pi, weft_vec3 light, double opacity)
{
    double cosine = fmax(light.z, 0);
    return (weft_rgba){brdf_pi.r * cosine, brdf_pi.g * cosine, brdf_pi.b * cosine, opacity};
}

/* Between texels graphics cards keep 8 bits of the fraction; the software rasteriser keeps more. Maps of components
 * that are divided by the square of a small incidence show it. */
static bool filters_coarsely(void)
{
    return !strstr(weft_gl_renderer(), "llvmpipe");
}

void stage_expect_small(const char *what, stage_difference difference)
{
    printf("%s: RMSE %.4f/255, largest %g/255 over %ld pixels\n", what, difference.rmse, difference.largest,
           difference.pixels);
    assert_true(difference.pixels > STAGE_SHADED_WIDTH * STAGE_SHADED_HEIGHT / 5);
    assert_true(difference.rmse < 1);
    assert_true(difference.largest < (filters_coarsely() ? 8 : 4));
}

/* ---- Components ---- */

enum { COMPONENT_DIRECTIONS = 37 };

/* Anything smooth in light and view that is positive on the whole. */
static double factor_of(int layer, int colour, weft_vec3 light, weft_vec3 view)
{
    double phase = 0.7 * layer + 0.3 * colour;
    double wave = cos(phase + 2.3 * light.x - 1.1 * view.y) * cos(1.9 * light.y + 1.3 * view.x + layer);
    return light.z * (layer == 0 ? 1 : 0.8 * wave);
}

static void put_direction(int index, float *xyz)
{
    weft_vec3 direction = weft_direction_of_angles(weft_ubo81_angles(index));
    xyz[0] = (float)direction.x;
    xyz[1] = (float)direction.y;
    xyz[2] = (float)direction.z;
}

static void fill_image(weft_components *components, int view, int light)
{
    int image = view * COMPONENT_DIRECTIONS + light;
    put_direction(light, components->light + 3 * image);
    for (int i = 0; i < 3 * components->component_count; i++)
        components->value[(size_t)image * 3 * (size_t)components->component_count + (size_t)i] =
            weft_half_of_float((float)factor_of(i / 3, i % 3, stage_vector(components->light + 3 * image),
                                                stage_vector(components->view + 3 * view)));
}

/* The last squares of the largest level are dark enough for their ceilings to be reached. Floors are so bright that
 * dark texels reach them; they differ by a step between squares, since a pixel on the edge of a hill may see either. */
static void fill_layers_level(weft_components_level *level, int component_count)
{
    int texels = level->width * level->height;
    for (int i = 0; i < texels * component_count; i++) {
        int layer = i / (4 * texels) * 4 + i % 4;
        level->coefficient[i] = (int8_t)(layer == 0 ? 90 + rand() % 30 : rand() % 61 - 30);
    }
    size_t ceilings = weft_ceiling_count(level->width, level->height);
    for (size_t i = 0; i < ceilings; i++)
        level->ceiling[i] = i + 2 < ceilings ? 255 : 176;
    for (size_t i = 0; i < 3 * ceilings; i++)
        level->floor[i] = (uint8_t)(172 + 4 * (i % 3) + i / 3 % 2);
}

void stage_components(weft_components_kind kind, int component_count, weft_material *material)
{
    weft_error error = {0};
    weft_components shape = {.kind = kind,
                             .component_count = component_count,
                             .view_count = COMPONENT_DIRECTIONS,
                             .image_count = COMPONENT_DIRECTIONS * COMPONENT_DIRECTIONS,
                             .light_side = 12,
                             .view_side = 9,
                             .light_smoothness = 1e-2f,
                             .view_smoothness = 1e-2f,
                             .exponent = 2.4f,
                             .incidence_power = 2,
                             .cosine_power = -1,
                             .least_incidence = 0.3f,
                             .view_length = 0.8f,
                             .view_nugget = 0.01f,
                             .least_cosine = 0.5f};
    expect_ok(weft_components_create(&shape, material->level[0].width, material->level[0].height, material->level_count,
                                     &material->components, &error),
              &error);
    for (int view = 0; view < COMPONENT_DIRECTIONS; view++) {
        put_direction(view, material->components->view + 3 * view);
        material->components->first[view + 1] = (uint32_t)(COMPONENT_DIRECTIONS * (view + 1));
        for (int light = 0; light < COMPONENT_DIRECTIONS; light++)
            fill_image(material->components, view, light);
    }
    for (int k = 0; k < component_count; k++) {
        material->components->scale[k] = 0.35f / 127;
        material->components->length[k] = k < 4 ? 0.7f : 1.2f;
        material->components->nugget[k] = 0.02f;
    }
    srand(5);
    for (int k = 0; k < material->level_count; k++)
        fill_layers_level(&material->components->level[k], component_count);
}

void stage_heights(bool hills, int levels, weft_material *material)
{
    int width = hills ? 2 * material->level[0].width : 1, height = hills ? 2 * material->level[0].height : 1;
    const double size_mm[2] = {4, 2.6};
    weft_error error = {0};
    weft_material_heights *heights;
    float *value = malloc((size_t)width * (size_t)height * sizeof *value);
    for (int i = 0; i < width * height; i++) {
        double u = (i % width + 0.5) / width, v = 1 - (i / width + 0.5) / height;
        value[i] = (float)(-0.4 + (hills ? 0.3 * sin(2 * WEFT_PI * u) * cos(2 * WEFT_PI * v + 1) : 0));
    }
    expect_ok(weft_material_heights_create(value, width, height, levels, size_mm, &heights, &error), &error);
    weft_material_take_heights(material, heights);
    free(value);
}
