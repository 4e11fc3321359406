/* A material decoded and evaluated: the reference of the player's shader. */
#include "btf/direction/direction.h"
#include "reflectance/lafortune/lafortune.h"
#include "tests/support/cmocka_all.h"

enum { WIDTH = 5, HEIGHT = 3, LOBES = 2, VIEWS = 7, LIGHTS = 9 };

static const weft_vec3 light = {0.36, 0.48, 0.8}, view = {-0.48, 0.36, 0.8};

typedef struct model {
    weft_material material;
    weft_table_directions directions;
} model;

static void fill_level(weft_material_level *level, int number)
{
    int texels = level->width * level->height;
    for (int t = 0; t < texels; t++) {
        weft_frame frame = weft_frame_of_normal(weft_unit(weft_vec3_of(0.02 * t, -0.1, 1)), 0.3 * t);
        weft_frame_encode(&frame, level->frame + 3 * t);
        for (int c = 0; c < 3; c++) {
            level->diffuse[4 * t + c] = weft_half_of_float((float)(0.1 * (c + 1) + 0.01 * t + 0.05 * number));
            for (int lobe = 0; lobe < LOBES; lobe++) {
                weft_half *code = level->lobe + 4 * ((size_t)((3 * lobe + c) * texels) + (size_t)t);
                const float value[4] = {-0.75f - 0.05f * (float)lobe, -0.5f, 0.75f + 0.0625f * (float)c,
                                        2 + 4 * (float)lobe + (float)t};
                for (int i = 0; i < 4; i++)
                    code[i] = weft_half_of_float(value[i]);
            }
        }
        for (int v = 0; v < VIEWS; v++)
            for (int i = 0; i < 4; i++)
                level->table[4 * (v * texels + t) + i] = (uint8_t)(40 + 11 * v + 7 * t + 23 * i + number);
        for (int l = 0; l < LIGHTS; l++)
            for (int i = 0; i < 4; i++)
                level->light_table[4 * (l * texels + t) + i] = (uint8_t)(70 + 13 * l + 5 * t + 17 * i + number);
    }
}

static int make_model(void **state)
{
    static model m;
    weft_error error = {0};
    assert_int_equal(weft_material_create(WIDTH, HEIGHT, LOBES, VIEWS, LIGHTS, 1, &m.material, &error), WEFT_OK);
    for (int i = 0; i < m.material.level_count; i++)
        fill_level(&m.material.level[i], i);
    for (int i = 0; i < VIEWS; i++)
        m.material.view[i] = weft_direction_of_angles(weft_ubo81_angles(i));
    for (int i = 0; i < LIGHTS; i++)
        m.material.light[i] = weft_direction_of_angles(weft_ubo81_angles(i));
    assert_int_equal(weft_table_directions_create(&m.material, &m.directions, &error), WEFT_OK);
    *state = &m;
    return 0;
}

static int free_model(void **state)
{
    model *m = *state;
    weft_table_directions_free(&m->directions);
    weft_material_free(&m->material);
    return 0;
}

static void assert_near(double a, double b)
{
    assert_true(fabs(a - b) <= 1e-12 * fmax(fabs(a), 1));
}

static void assert_same_colour(weft_rgba a, weft_rgba b)
{
    assert_near(a.r, b.r);
    assert_near(a.g, b.g);
    assert_near(a.b, b.b);
    assert_near(a.a, b.a);
}

static weft_rgba texel(const model *m, int level, int x, int y)
{
    return weft_material_texel(&m->material, &m->directions, level, x, y, light, view);
}

/* Equations 1 and 2 written out for the green channel of one texel. */
static void texel_is_the_equation_of_its_codes(void **state)
{
    const model *m = *state;
    int x = 3, y = 1, t = y * WIDTH + x;
    const weft_material_level *level = &m->material.level[0];
    weft_frame frame = weft_frame_decode(level->frame + 3 * t);
    double l[3] = {weft_dot(light, frame.tangent), weft_dot(light, frame.bitangent), weft_dot(light, frame.normal)};
    double v[3] = {weft_dot(view, frame.tangent), weft_dot(view, frame.bitangent), weft_dot(view, frame.normal)};
    double sum = weft_float_of_half(level->diffuse[4 * t + 1]);
    for (int lobe = 0; lobe < LOBES; lobe++) {
        const weft_half *code = level->lobe + 4 * ((3 * lobe + 1) * WIDTH * HEIGHT + t);
        double a = 0;
        for (int i = 0; i < 3; i++)
            a += weft_float_of_half(code[i]) * l[i] * v[i];
        sum += pow(fmax(a, 0), weft_float_of_half(code[3]));
    }
    weft_barycentric corner = weft_triangulation_lookup(m->directions.views, view);
    double table = 0, opacity = 0;
    for (int i = 0; i < 3 && corner.index[i] >= 0; i++) {
        const uint8_t *code = level->table + 4 * (corner.index[i] * WIDTH * HEIGHT + t);
        table += corner.weight[i] * (code[1] / 255.0) * (code[1] / 255.0);
        opacity += corner.weight[i] * code[3] / 255.0;
    }
    weft_barycentric lit = weft_triangulation_lookup(m->directions.lights, light);
    double light_table = 0;
    for (int i = 0; i < 3 && lit.index[i] >= 0; i++) {
        double code = level->light_table[4 * (lit.index[i] * WIDTH * HEIGHT + t) + 1] / 255.0;
        light_table += lit.weight[i] * code * code;
    }
    assert_true(light_table > 0 && light_table < 0.9);
    assert_near(texel(m, 0, x, y).g, sum * table * light_table);
    assert_near(texel(m, 0, x, y).a, opacity);
}

static void below_the_horizon_there_is_nothing_but_opacity(void **state)
{
    const model *m = *state;
    const weft_vec3 below = {0.6, 0, -0.8};
    weft_real opacity = weft_material_texel(&m->material, &m->directions, 0, 0, 0, light, view).a;
    assert_true(opacity > 0);
    assert_same_colour(weft_material_texel(&m->material, &m->directions, 0, 0, 0, below, view),
                       (weft_rgba){0, 0, 0, opacity});
    assert_same_colour(weft_material_sample(&m->material, &m->directions, 0, 0, 0, light, below), (weft_rgba){0});
    assert_same_colour(weft_material_sample(&m->material, &m->directions, 0, (weft_real)NAN, 0, light, view),
                       (weft_rgba){0});
}

static weft_rgba sample(const model *m, double level, double u, double v)
{
    return weft_material_sample(&m->material, &m->directions, level, u, v, light, view);
}

static void sample_at_a_texel_centre_is_the_texel(void **state)
{
    const model *m = *state;
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            assert_same_colour(sample(m, 0, (x + 0.5) / WIDTH, 1 - (y + 0.5) / HEIGHT), texel(m, 0, x, y));
}

static void sample_is_bilinear_and_repeats(void **state)
{
    const model *m = *state;
    /* Half way across the right and the top edge. */
    double u = 0, v = 1;
    weft_rgba a = texel(m, 0, 0, 0), b = texel(m, 0, WIDTH - 1, 0), c = texel(m, 0, 0, HEIGHT - 1),
              d = texel(m, 0, WIDTH - 1, HEIGHT - 1);
    weft_rgba mean = {(a.r + b.r + c.r + d.r) / 4, (a.g + b.g + c.g + d.g) / 4, (a.b + b.b + c.b + d.b) / 4,
                      (a.a + b.a + c.a + d.a) / 4};
    assert_same_colour(sample(m, 0, u, v), mean);
    assert_same_colour(sample(m, 0, u - 4, v + 3), mean);
}

static void levels_are_mixed_and_clamped(void **state)
{
    const model *m = *state;
    weft_rgba fine = sample(m, 0, 0.3, 0.4), coarse = sample(m, 1, 0.3, 0.4), between = sample(m, 0.25, 0.3, 0.4);
    assert_near(between.r, fine.r + 0.25 * (coarse.r - fine.r));
    int last = m->material.level_count - 1;
    assert_same_colour(sample(m, 100, 0.3, 0.4), texel(m, last, 0, 0));
    assert_same_colour(sample(m, -1, 0.3, 0.4), fine);
}

/* ---- Ceilings ---- */

static double largest_of(weft_rgba value)
{
    return fmax(value.r, fmax(value.g, value.b));
}

static void set_ceilings(const model *m, float value)
{
    for (int k = 0; k < m->material.level_count; k++) {
        weft_material_level level = m->material.level[k];
        for (int t = 0; t < level.width * level.height; t++)
            weft_material_set_ceiling(&level, (size_t)t, value);
    }
}

/* A path of directions through the mirror direction of `view`, where the lobes are largest. */
static weft_vec3 light_on_path(double t)
{
    return weft_unit(weft_vec3_of(0.48 + t, -0.36 + 0.4 * t, 0.8));
}

static weft_rgba on_path(const model *m, double t)
{
    return weft_material_texel(&m->material, &m->directions, 0, 2, 1, light_on_path(t), view);
}

/* Half way between the least and the largest value of the path. */
static float ceiling_of_path(const model *m)
{
    double least = INFINITY, most = 0;
    for (double t = -2; t < 2; t += 0.01) {
        double value = largest_of(on_path(m, t));
        least = fmin(least, value);
        most = fmax(most, value);
    }
    assert_true(most > 1.5 * least);
    return (float)(0.5 * (least + most));
}

static void a_ceiling_is_never_exceeded_and_keeps_hue_and_opacity(void **state)
{
    const model *m = *state;
    const float ceiling = ceiling_of_path(m);
    int limited = 0, below = 0;
    for (double t = -2; t < 2; t += 0.01) {
        weft_rgba free = on_path(m, t);
        set_ceilings(m, ceiling);
        weft_rgba held = on_path(m, t);
        double most = weft_float_of_half(m->material.level[0].diffuse[3]), share = fmin(1, most / largest_of(free));
        set_ceilings(m, 0);
        assert_true(largest_of(held) <= most);
        assert_near(held.r, share * free.r);
        assert_near(held.g, share * free.g);
        assert_near(held.b, share * free.b);
        assert_near(held.a, free.a);
        limited += share < 1;
        below += share == 1;
    }
    assert_true(limited > 20 && below > 20);
}

/* A step of the value under the ceiling is at most twice that of the value without it. */
static void a_ceiling_makes_no_jump(void **state)
{
    const model *m = *state;
    const float ceiling = ceiling_of_path(m);
    for (double t = -2; t < 2; t += 0.001) {
        double step = largest_of(on_path(m, t + 0.001)) - largest_of(on_path(m, t));
        set_ceilings(m, ceiling);
        weft_rgba a = on_path(m, t), b = on_path(m, t + 0.001);
        set_ceilings(m, 0);
        assert_true(fabs(b.r - a.r) <= 2 * fabs(step) + 1e-4 && fabs(b.b - a.b) <= 2 * fabs(step) + 1e-4);
    }
}

static void ceilings_are_stored_rounded_up(void **state)
{
    const model *m = *state;
    weft_material_level level = m->material.level[0];
    const float value[] = {-1, 0, (float)NAN, 1e-12f, 0.2f, 1, 65504, 1e9f};
    const weft_half code[] = {0, 0, 0, 1, 0x3267, 0x3c00, 0x7bff, 0x7bff};
    for (size_t i = 0; i < sizeof value / sizeof *value; i++) {
        weft_material_set_ceiling(&level, 4, value[i]);
        assert_int_equal(level.diffuse[4 * 4 + 3], code[i]);
    }
    weft_material_set_ceiling(&level, 4, 0);
}

int test_material_texel(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(texel_is_the_equation_of_its_codes),
        cmocka_unit_test(below_the_horizon_there_is_nothing_but_opacity),
        cmocka_unit_test(sample_at_a_texel_centre_is_the_texel),
        cmocka_unit_test(sample_is_bilinear_and_repeats),
        cmocka_unit_test(levels_are_mixed_and_clamped),
        cmocka_unit_test(a_ceiling_is_never_exceeded_and_keeps_hue_and_opacity),
        cmocka_unit_test(a_ceiling_makes_no_jump),
        cmocka_unit_test(ceilings_are_stored_rounded_up),
    };
    return cmocka_run_group_tests_name("material texel", tests, make_model, free_model);
}
