/* weft tile --blend: what the ends differ by is spread over the tile, in components and in lobes. */
#include "edit/blend/blend.h"
#include "edit/blend/steps.h"
#include "tests/support/cmocka_all.h"
#include "tests/support/expect_ok.h"

#include <math.h>
#include <stdlib.h>

static const double two_pi = 6.283185307179586;

/* A uniform deviate in 0 .. 1 (Steele, Lea and Flood 2014). */
static double uniform(uint64_t *state)
{
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return (double)((z ^ z >> 31) >> 11) / 9007199254740992.0;
}

/* A field of its own steps, on grids that no half fits. */
static void a_membrane_is_as_steep_as_asked(void **state)
{
    (void)state;
    const int size[][2] = {{7, 13}, {33, 20}, {5, 64}, {3, 3}, {101, 77}};
    for (int k = 0; k < 5; k++) {
        weft_membrane m;
        int width = size[k][0], height = size[k][1], texels = width * height;
        uint64_t seed = 11;
        double mean = 0, error = 0, spread = 0;
        float *wanted = malloc((size_t)texels * sizeof *wanted);
        assert_int_equal(weft_membrane_create(width, height, &m, NULL), WEFT_OK);
        for (int i = 0; i < texels; i++) {
            wanted[i] = (float)(3 * sin(two_pi * (i % width) / width) + uniform(&seed));
            mean += wanted[i] / texels;
        }
        for (int y = 0; y < height; y++)
            for (int x = 0; x < width; x++) {
                int here = y * width + x;
                m.step[0][here] = wanted[y * width + (x + 1) % width] - wanted[here];
                m.step[1][here] = wanted[(y + 1) % height * width + x] - wanted[here];
            }
        assert_int_equal(weft_membrane_solve(&m, NULL), WEFT_OK);
        for (int i = 0; i < texels; i++) {
            error += pow(m.value[i] - (wanted[i] - mean), 2);
            spread += pow(wanted[i] - mean, 2);
        }
        assert_true(sqrt(error) < 0.02 * sqrt(spread));
        weft_membrane_free(&m);
        free(wanted);
    }
}

/* ---- Materials without a cut that would join them ---- */

enum { WIDTH = 80, HEIGHT = 64, TEXELS = WIDTH * HEIGHT, COMPONENTS = 4, LIGHTS = 5 };

/* Blots that never come back: 0.2 .. about 1. */
static double blots(int x, int y)
{
    uint64_t seed = 23;
    double sum = 0.2;
    for (int i = 0; i < 200; i++) {
        double dx = x - WIDTH * uniform(&seed), dy = y - HEIGHT * uniform(&seed);
        sum += 0.25 * exp(-(dx * dx + dy * dy) / 8);
    }
    return sum;
}

static weft_blend_report blended(const weft_material *material, weft_material *tile)
{
    weft_error error = {0};
    weft_blend_report report;
    expect_ok(weft_blend(material, tile, &report, &error), &error);
    print_message("%.4f above before, %.4f after; strongest %.2f, %.2f; mean %.3f, %.3f\n", report.before.above_99th,
                  report.after.above_99th, report.before.strongest, report.after.strongest,
                  report.before.mean_difference, report.after.mean_difference);
    return report;
}

static void expect_no_seam(const weft_blend_report *report)
{
    assert_true(report->before.above_99th > 0.1);
    assert_true(report->after.above_99th <= 0.02);
    assert_true(report->after.strongest <= 1);
    assert_true(report->after.mean_difference < 1.2);
}

static void set_lights(weft_components *components)
{
    components->view[2] = 1;
    components->first[1] = LIGHTS;
    for (int i = 0; i < LIGHTS; i++) {
        double angle = two_pi * i / (LIGHTS - 1), slant = i < LIGHTS - 1 ? 0.8 : 0;
        float *light = components->light + 3 * i;
        light[0] = (float)(slant * cos(angle)), light[1] = (float)(slant * sin(angle));
        light[2] = (float)sqrt(1 - slant * slant);
        for (int c = 0; c < 3; c++) {
            weft_half *value = components->value + 3 * i * COMPONENTS + c;
            value[0] = weft_half_of_float(light[2]);
            value[3] = weft_half_of_float(light[2] * light[0]);
        }
    }
    for (int k = 0; k < COMPONENTS; k++)
        components->scale[k] = 1 / 127.0f;
}

/* The first layer is brighter on the right; the second, which is seen from one side, has another sign there. Each
 * square of texels has just the ceiling that it needs. */
static weft_material factorised(double (*pattern)(int x, int y))
{
    weft_error error = {0};
    weft_material material;
    const weft_components shape = {.kind = WEFT_COMPONENTS_OF_LIGHT,
                                   .component_count = COMPONENTS,
                                   .view_count = 1,
                                   .image_count = LIGHTS,
                                   .light_side = 9,
                                   .view_side = 4,
                                   .light_smoothness = 0.1f,
                                   .view_smoothness = 0.1f,
                                   .least_cosine = 0.1f};
    expect_ok(weft_material_create(WIDTH, HEIGHT, 0, 0, 0, true, &material, &error), &error);
    expect_ok(weft_components_create(&shape, WIDTH, HEIGHT, material.level_count, &material.components, &error),
              &error);
    set_lights(material.components);
    weft_components_level *level = &material.components->level[0];
    for (int i = 0; i < TEXELS; i++) {
        int x = i % WIDTH, y = i / WIDTH,
            square = y / WEFT_CEILING_SIDE * (WIDTH / WEFT_CEILING_SIDE) + x / WEFT_CEILING_SIDE;
        double grey = 30 * pattern(x, y) * (1 + (double)x / WIDTH), tilted = grey * (0.3 - 0.6 * x / WIDTH);
        level->coefficient[COMPONENTS * i] = (int8_t)lround(fmin(grey, 127));
        level->coefficient[COMPONENTS * i + 1] = (int8_t)lround(tilted);
        uint8_t needed = weft_ceiling_code((float)((grey + fabs(tilted)) / 127));
        level->ceiling[square] = needed > level->ceiling[square] ? needed : level->ceiling[square];
    }
    return material;
}

/* The share of texels that would be brighter than the ceiling of their square by 1 %, seen from where they are
 * brightest. */
static double share_held_down(const weft_components *components)
{
    const weft_components_level *level = &components->level[0];
    int count = 0, across = (level->width + WEFT_CEILING_SIDE - 1) / WEFT_CEILING_SIDE;
    for (int i = 0; i < level->width * level->height; i++) {
        int square = i / level->width / WEFT_CEILING_SIDE * across + i % level->width / WEFT_CEILING_SIDE;
        double value = level->coefficient[COMPONENTS * i] * (double)components->scale[0] +
                       abs(level->coefficient[COMPONENTS * i + 1]) * (double)components->scale[1];
        count += value > 1.01 * weft_ceiling_of_code(level->ceiling[square]);
    }
    return (double)count / (level->width * level->height);
}

static void components_meet_under_every_light(void **state)
{
    (void)state;
    weft_material material = factorised(blots), tile;
    weft_blend_report report = blended(&material, &tile);
    expect_no_seam(&report);
    const weft_components_level *fine = &tile.components->level[0], *next = &tile.components->level[1];
    for (int y = 0; y < fine->height / 2; y++)
        for (int x = 0; x < fine->width / 2; x++) {
            double sum = 0;
            for (int i = 0; i < 4; i++)
                sum += fine->coefficient[COMPONENTS * ((2 * y + i / 2) * fine->width + 2 * x + i % 2)];
            assert_float_equal(next->coefficient[COMPONENTS * (y * next->width + x)], sum / 4, 1.01);
        }
    weft_material_free(&tile);
    weft_material_free(&material);
}

/* Fine grain: all texels of a square are nearly as bright as its ceiling. */
static double grain(int x, int y)
{
    uint64_t seed = 1000 * (uint64_t)y + (uint64_t)x;
    return 1 + 0.1 * uniform(&seed);
}

static void what_becomes_brighter_is_not_held_down(void **state)
{
    (void)state;
    weft_material material = factorised(grain), tile;
    blended(&material, &tile);
    print_message("%.4f of the texels are held down\n", share_held_down(tile.components));
    assert_true(share_held_down(tile.components) < 0.01);
    weft_material_free(&tile);
    weft_material_free(&material);
}

/* The same material twice: with codes that are multiples of 8, and with an eighth of them in steps eight times as
 * large, as files were once rounded. */
static void what_is_spread_over_coarse_codes_is_as_fine(void **state)
{
    (void)state;
    enum { TIMES = 8 };
    weft_material fine = factorised(blots), coarse = factorised(blots), tile[2];
    for (int k = 0; k < fine.level_count; k++) {
        weft_components_level *level[2] = {&fine.components->level[k], &coarse.components->level[k]};
        for (int i = 0; i < COMPONENTS * level[0]->width * level[0]->height; i++) {
            level[1]->coefficient[i] = (int8_t)(level[0]->coefficient[i] / TIMES);
            level[0]->coefficient[i] = (int8_t)(TIMES * level[1]->coefficient[i]);
        }
    }
    for (int layer = 0; layer < COMPONENTS; layer++)
        coarse.components->scale[layer] *= TIMES;
    blended(&fine, &tile[0]);
    blended(&coarse, &tile[1]);
    double apart = 0;
    for (int i = 0; i < COMPONENTS * tile[0].level[0].width * tile[0].level[0].height; i++) {
        double value[2];
        for (int t = 0; t < 2; t++)
            value[t] = tile[t].components->level[0].coefficient[i] * (double)tile[t].components->scale[i % COMPONENTS];
        apart = fmax(apart, fabs(value[1] - value[0]) / (double)fine.components->scale[0]);
    }
    print_message("%.3f steps of the fine codes apart at most\n", apart);
    assert_true(apart < 1.01);
    for (int t = 0; t < 2; t++)
        weft_material_free(&tile[t]);
    weft_material_free(&coarse);
    weft_material_free(&fine);
}

/* A glossy cloth that leans to the left at one end and to the right at the other, and is brighter there. */
static weft_material glossy(void)
{
    weft_error error = {0};
    weft_material material;
    expect_ok(weft_material_create(WIDTH, HEIGHT, 1, 0, 0, true, &material, &error), &error);
    for (int k = 0; k < material.level_count; k++) {
        const weft_material_level *level = &material.level[k];
        for (int i = 0; i < level->width * level->height; i++) {
            int x = (i % level->width) << k, y = (i / level->width) << k;
            double grey = blots(x, y) * (1 + (double)x / WIDTH), root = pow(grey, 1.0 / 3);
            level->frame[3 * i] = (int16_t)(6000 - 12000 * x / WIDTH);
            for (int c = 0; c < 3; c++) {
                const double lobe[4] = {-0.8 * root, -0.8 * root, 0.8 * root, 3};
                level->diffuse[4 * i + c] = weft_half_of_float((float)(0.3 * grey));
                for (int j = 0; j < 4; j++)
                    level->lobe[4 * (c * level->width * level->height + i) + j] = weft_half_of_float((float)lobe[j]);
            }
        }
    }
    return material;
}

static double mean_diffuse(const weft_material_level *level)
{
    double sum = 0;
    for (int i = 0; i < level->width * level->height; i++)
        sum += weft_float_of_half(level->diffuse[4 * i]) / (level->width * level->height);
    return sum;
}

static void lobes_meet_and_levels_go_with_them(void **state)
{
    (void)state;
    weft_material material = glossy(), tile;
    weft_blend_report report = blended(&material, &tile);
    expect_no_seam(&report);
    assert_float_equal(mean_diffuse(&tile.level[2]) / mean_diffuse(&tile.level[0]), 1, 0.05);
    for (int i = 0; i < tile.level[0].width * tile.level[0].height; i++) {
        int next = i % tile.level[0].width + 1 < tile.level[0].width ? i + 1 : i + 1 - tile.level[0].width;
        assert_in_range(abs(tile.level[0].frame[3 * next] - tile.level[0].frame[3 * i]), 0, 600); /* 150 inside */
    }
    /* The diffuse term is multiplied by what the lobe is: the third power of its C. */
    for (int i = 0; i < tile.level[0].width * tile.level[0].height; i++) {
        double lobe = pow(weft_float_of_half(tile.level[0].lobe[4 * i + 2]) / 0.8, 3);
        assert_float_equal(weft_float_of_half(tile.level[0].diffuse[4 * i]) / (0.3 * lobe), 1, 0.01);
    }
    weft_material_free(&tile);
    weft_material_free(&material);
}

int test_blend_spread(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_membrane_is_as_steep_as_asked),
        cmocka_unit_test(components_meet_under_every_light),
        cmocka_unit_test(what_becomes_brighter_is_not_held_down),
        cmocka_unit_test(what_is_spread_over_coarse_codes_is_as_fine),
        cmocka_unit_test(lobes_meet_and_levels_go_with_them),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
