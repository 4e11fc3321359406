/* That the parts of an error add up, and that a fault in a stage shows in the part of that stage. */
#include "tests/compare/fixture.h"

#include "capture/virtual/ground_truth.h"
#include "compare/error_budget/error_budget.h"
#include "compress/compress.h"
#include "tests/support/scratch_folder.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

/* ---- Answers that are made up ---- */

static uint64_t random_state = 11;

/* Below 1. */
static double draw(void)
{
    random_state = random_state * 6364136223846793005u + 1442695040888963407u;
    return (double)(random_state >> 11) * 0x1p-53;
}

static double draw_normal(void)
{
    return sqrt(-2 * log(1 - draw())) * cos(2 * 3.14159265358979324 * draw());
}

enum { MADE_UP = 20000 };

/* Each stage adds an independent error of the given standard deviation to cloth of mean square 1; the answers of the
 * cloth and of its samples have noise besides, four times as large as the error of the directions. */
static void make_up(const double deviation[WEFT_SOURCE_COUNT], weft_source_answer *answer)
{
    for (int i = 0; i < MADE_UP; i++)
        for (int c = 0; c < 3; c++) {
            weft_source_answer *a = &answer[i];
            double cloth = draw_normal(), sampled = cloth + deviation[0] * draw_normal();
            for (int k = 0; k < 2; k++) {
                a->cloth[k][c] = cloth + 4 * deviation[0] * draw_normal();
                a->sampled[k][c] = sampled + 4 * deviation[0] * draw_normal();
            }
            a->registered[c] = sampled + deviation[1] * draw_normal();
            a->fitted[c] = a->registered[c] + deviation[2] * draw_normal();
            a->stored[c] = a->fitted[c] + deviation[3] * draw_normal();
        }
}

static weft_error_stack stack_of(const weft_source_answer *answer, size_t count)
{
    weft_error_stack stack;
    weft_error error = {0};
    expect_ok(weft_error_stack_of(answer, count, 1, &stack, &error), &error);
    return stack;
}

static void assert_adds_up(const weft_error_stack *stack)
{
    double sum = 0;
    for (int part = 0; part < WEFT_SOURCE_COUNT; part++)
        sum += stack->part[part].value;
    assert_float_equal(sum, stack->whole.value, 1e-12);
}

static void each_part_is_what_its_stage_added(void **state)
{
    (void)state;
    static weft_source_answer answer[MADE_UP];
    const double deviation[WEFT_SOURCE_COUNT] = {0.05, 0.2, 0.3, 0.1};
    make_up(deviation, answer);
    weft_error_stack stack = stack_of(answer, MADE_UP);
    assert_adds_up(&stack);
    for (int part = 0; part < WEFT_SOURCE_COUNT; part++) {
        double expected = deviation[part] * deviation[part];
        assert_float_equal(stack.part[part].value, expected, 0.003);
        assert_float_equal(stack.own[part], expected, 0.003);
        assert_true(fabs(stack.part[part].value - expected) < stack.part[part].high - stack.part[part].low);
    }
    assert_float_equal(stack.noise, 4 * 0.05 / sqrt(2), 0.003);
    /* The mean of n squares of a normal deviate has the standard error sqrt(2 / n): 1.96 of them on either side. */
    double spread = 2 * 1.96 * stack.part[2].value * sqrt(2 / (3.0 * MADE_UP)),
           width = stack.part[2].high - stack.part[2].low;
    assert_true(width > 0.8 * spread && width < 3 * spread);
}

/* A model that undoes half of what registration did has a negative part, however much it changed. */
static void a_stage_may_make_up_for_another(void **state)
{
    (void)state;
    static weft_source_answer answer[MADE_UP];
    make_up((const double[WEFT_SOURCE_COUNT]){0.01, 0.2, 0, 0}, answer);
    for (int i = 0; i < MADE_UP; i++)
        for (int c = 0; c < 3; c++) {
            weft_source_answer *a = &answer[i];
            double before = (a->sampled[0][c] + a->sampled[1][c]) / 2;
            a->stored[c] = a->fitted[c] = (a->registered[c] + before) / 2;
        }
    weft_error_stack stack = stack_of(answer, MADE_UP);
    assert_adds_up(&stack);
    assert_float_equal(stack.part[WEFT_SOURCE_MODEL].value, -0.03, 0.003);
    assert_float_equal(stack.own[WEFT_SOURCE_MODEL], 0.01, 0.003);
    assert_float_equal(stack.part[WEFT_SOURCE_STORAGE].value, 0, 0);
}

static void black_cloth_has_no_stack(void **state)
{
    (void)state;
    const weft_source_answer answer = {0};
    weft_error_stack stack;
    weft_error error = {0};
    assert_int_equal(weft_error_stack_of(&answer, 1, 1, &stack, &error), WEFT_BAD_USAGE);
    assert_int_equal(weft_error_stack_of(&answer, 0, 1, &stack, &error), WEFT_BAD_USAGE);
}

/* ---- A weave, and files that are made of it ---- */

enum { SIDE = 8, RINGS = 3, COMPONENTS = 16, FEWER_COMPONENTS = 4, QUERIES = 400, PATHS = 32 };

static const double far_mm = 1e7;
static weft_virtual_sample sample;
static int shift; /* texels by which registration is off */

/* By the regular grid of points of the ground truth, and not by those that are tested. */
static weft_rgb exact(int x, int y, weft_vec3 light, weft_vec3 view)
{
    weft_rgb value = weft_truth_reflectance(&sample, SIDE, (x + shift) % SIDE, y, weft_scale(light, far_mm),
                                            weft_scale(view, far_mm));
    return (weft_rgb){value.r / light.z, value.g / light.z, value.b / light.z};
}

static void fit(const char *dataset_path, int component_count, bool finer, const char *path)
{
    weft_dataset *dataset;
    weft_material material;
    weft_error error = {0};
    weft_compress_options options = weft_compress_default_options();
    options.component_count = component_count;
    options.levels = false;
    options.finer = finer;
    expect_ok(weft_dataset_open(dataset_path, &dataset, &error), &error);
    expect_ok(weft_compress(dataset, &options, NULL, &material, NULL, &error), &error);
    expect_ok(weft_material_write(path, &material, &error), &error);
    weft_material_free(&material);
    weft_dataset_close(dataset);
}

/* What a material would be of which the lower bits of the coefficients were not stored. */
static void drop_bits(const char *path, int bits, const char *output)
{
    weft_material material;
    weft_error error = {0};
    double step = 1 << bits;
    expect_ok(weft_material_read(path, &material, &error), &error);
    int8_t *code = material.components->level[0].coefficient;
    for (int i = 0; i < SIDE * SIDE * material.components->component_count; i++)
        code[i] = (int8_t)(step * fmax(fmin(round(code[i] / step), 128 / step - 1), 1 - 128 / step));
    expect_ok(weft_material_write(output, &material, &error), &error);
    weft_material_free(&material);
}

static int make_files(void **state)
{
    weft_virtual_settings settings = weft_virtual_settings_default();
    char warning[WEFT_MESSAGE_SIZE];
    weft_error error = {0};
    settings.tiles_x = settings.tiles_y = 1;
    settings.cloth_noise = 1;
    scratch_folder_enter(state);
    expect_ok(weft_virtual_sample_read(WEFT_ASSETS "/weaves/wool_gabardine.wv", &settings, 1, &sample, warning, &error),
              &error);
    fixture_far_dataset("exact.btf.h5", SIDE, SIDE, RINGS, exact, FIXTURE_MASK_NONE);
    fit("exact.btf.h5", COMPONENTS, true, "fine.weft");
    fit("exact.btf.h5", COMPONENTS, false, "stored.weft");
    return 0;
}

static int remove_files(void **state)
{
    weft_virtual_sample_free(&sample);
    return scratch_folder_leave(state);
}

static weft_source_answer answers[QUERIES];

static weft_error_stack ask(const char *registered, const char *fitted, const char *stored)
{
    const weft_source_stages stages = {&sample, registered, fitted, stored};
    const weft_source_queries queries = {QUERIES, PATHS, 5};
    weft_source_span span;
    weft_error error = {0};
    expect_ok(weft_source_answers(&stages, &queries, NULL, answers, &span, &error), &error);
    assert_float_equal(weft_deg_of_rad(span.theta_rad), 30, 1e-6);
    assert_int_equal(span.asked, QUERIES);
    return stack_of(answers, (size_t)(span.asked - span.unseen));
}

/* The cloth, asked at random places of a texel, says what the ground truth finds on a grid; rows count from the top. */
static void cloth_is_that_of_the_photographs(void **state)
{
    (void)state;
    const weft_vec3 light = weft_unit(weft_vec3_of(0.3, -0.2, 1)), view = weft_unit(weft_vec3_of(-0.4, 0.1, 1));
    double square = 0, difference = 0, upside_down = 0;
    shift = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        const weft_cloth_texel texel = {SIDE, SIDE, i % SIDE, i / SIDE};
        double said = weft_cloth_reflectance(&sample, &texel, light, view, 1024, (uint64_t)i).g;
        double true_one = exact(texel.x, texel.y, light, view).g * light.z;
        double other = exact(texel.x, SIDE - 1 - texel.y, light, view).g * light.z;
        square += true_one * true_one;
        difference += (said - true_one) * (said - true_one);
        upside_down += (said - other) * (said - other);
    }
    assert_true(difference < 0.001 * square);
    assert_true(upside_down > 0.02 * square);
}

static void exact_samples_leave_nothing_to_registration(void **state)
{
    (void)state;
    weft_error_stack stack = ask("exact.btf.h5", "fine.weft", "stored.weft");
    assert_adds_up(&stack);
    assert_true(stack.part[WEFT_SOURCE_DIRECTIONS].value > 0);
    assert_true(fabs(stack.own[WEFT_SOURCE_REGISTRATION]) < 0.2 * stack.part[WEFT_SOURCE_DIRECTIONS].value);
}

static void shifted_registration_shows_in_its_part_alone(void **state)
{
    (void)state;
    weft_error_stack sound = ask("exact.btf.h5", "fine.weft", "stored.weft");
    shift = 1;
    fixture_far_dataset("shifted.btf.h5", SIDE, SIDE, RINGS, exact, FIXTURE_MASK_NONE);
    shift = 0;
    fit("shifted.btf.h5", COMPONENTS, true, "shifted-fine.weft");
    fit("shifted.btf.h5", COMPONENTS, false, "shifted.weft");
    weft_error_stack off = ask("shifted.btf.h5", "shifted-fine.weft", "shifted.weft");
    double grew = off.part[WEFT_SOURCE_REGISTRATION].value - sound.part[WEFT_SOURCE_REGISTRATION].value;
    assert_true(grew > 0.05);
    assert_float_equal(off.part[WEFT_SOURCE_DIRECTIONS].value, sound.part[WEFT_SOURCE_DIRECTIONS].value, 0);
    assert_float_equal(off.part[WEFT_SOURCE_MODEL].value, sound.part[WEFT_SOURCE_MODEL].value, 0.15 * grew);
    assert_float_equal(off.part[WEFT_SOURCE_STORAGE].value, sound.part[WEFT_SOURCE_STORAGE].value, 0.01 * grew);
    assert_float_equal(off.whole.value - sound.whole.value, grew, 0.15 * grew);
}

static void smaller_model_shows_in_its_part_alone(void **state)
{
    (void)state;
    weft_error_stack sound = ask("exact.btf.h5", "fine.weft", "stored.weft");
    fit("exact.btf.h5", FEWER_COMPONENTS, true, "small-fine.weft");
    fit("exact.btf.h5", FEWER_COMPONENTS, false, "small.weft");
    weft_error_stack small = ask("exact.btf.h5", "small-fine.weft", "small.weft");
    double grew = small.part[WEFT_SOURCE_MODEL].value - sound.part[WEFT_SOURCE_MODEL].value;
    assert_true(grew > 0.002);
    assert_float_equal(small.part[WEFT_SOURCE_DIRECTIONS].value, sound.part[WEFT_SOURCE_DIRECTIONS].value, 0);
    assert_float_equal(small.part[WEFT_SOURCE_REGISTRATION].value, sound.part[WEFT_SOURCE_REGISTRATION].value, 0);
    assert_float_equal(small.part[WEFT_SOURCE_STORAGE].value, sound.part[WEFT_SOURCE_STORAGE].value, 0.1 * grew);
}

/* A number that is off by up to half a step, evenly, is off by 1/12 in the square; without its last bit, which is 0 or
 * a whole step, by 1/2 more: 7 times as much, if `fitted` is what was rounded. */
static void coarser_storage_shows_in_its_part_alone(void **state)
{
    (void)state;
    weft_error_stack sound = ask("exact.btf.h5", "fine.weft", "stored.weft");
    drop_bits("stored.weft", 1, "coarse.weft");
    weft_error_stack coarse = ask("exact.btf.h5", "fine.weft", "coarse.weft");
    assert_float_equal(coarse.own[WEFT_SOURCE_STORAGE] / sound.own[WEFT_SOURCE_STORAGE], 7, 1.5);
    drop_bits("stored.weft", 5, "coarser.weft");
    coarse = ask("exact.btf.h5", "fine.weft", "coarser.weft");
    assert_true(coarse.part[WEFT_SOURCE_STORAGE].low > sound.part[WEFT_SOURCE_STORAGE].high);
    for (int part = 0; part < WEFT_SOURCE_STORAGE; part++)
        assert_float_equal(coarse.part[part].value, sound.part[part].value, 0);
}

static void answers_do_not_depend_on_threads(void **state)
{
    (void)state;
    static weft_source_answer alone[QUERIES];
    ask("exact.btf.h5", "fine.weft", "stored.weft");
    memcpy(alone, answers, sizeof alone);
    omp_set_num_threads(1);
    ask("exact.btf.h5", "fine.weft", "stored.weft");
    omp_set_num_threads(omp_get_num_procs());
    for (int i = 0; i < QUERIES; i++)
        for (int c = 0; c < 3; c++) {
            assert_float_equal(alone[i].sampled[0][c], answers[i].sampled[0][c], 0);
            assert_float_equal(alone[i].stored[c], answers[i].stored[c], 0);
        }
}

/* Coefficient k of a texel; four components stand together. */
static size_t index_of(size_t k, size_t texel)
{
    return (k / 4 * SIDE * SIDE + texel) * 4 + k % 4;
}

/* The step of the codes of a component: what they are multiples of. */
static int step_of(const int8_t *code, size_t k)
{
    int step = 0;
    for (size_t t = 0; t < SIDE * SIDE; t++)
        for (int rest = abs(code[index_of(k, t)]), other; rest > 0; rest = other) {
            other = step % rest;
            step = rest;
        }
    return step;
}

/* The second half of the components is the first half in finer steps, of which 254 make one. What is stored has steps
 * of its own for each component, wherever the error of the fit hides them: it is the nearest of these to the finer
 * value. */
static void finer_components_hold_what_rounding_left(void **state)
{
    (void)state;
    weft_material fine, stored;
    weft_error error = {0};
    expect_ok(weft_material_read("fine.weft", &fine, &error), &error);
    expect_ok(weft_material_read("stored.weft", &stored, &error), &error);
    assert_int_equal(fine.components->component_count, 2 * COMPONENTS);
    const int8_t *both = fine.components->level[0].coefficient, *rounded = stored.components->level[0].coefficient;
    double square = 0;
    for (size_t k = 0; k < COMPONENTS; k++) {
        double product = 0, own = 0;
        for (size_t t = 0; t < SIDE * SIDE; t++) {
            double finer = both[index_of(COMPONENTS + k, t)], exact = both[index_of(k, t)] + finer / 254;
            product += exact * rounded[index_of(k, t)];
            own += exact * exact;
            square += finer * finer / (SIDE * SIDE * COMPONENTS);
        }
        double half_step = 0.5 * step_of(rounded, k);
        for (size_t t = 0; t < SIDE * SIDE; t++) {
            double exact = both[index_of(k, t)] + both[index_of(COMPONENTS + k, t)] / 254.0;
            assert_float_equal(exact * product / own, rounded[index_of(k, t)], 1.5 * half_step);
        }
        assert_float_equal(fine.components->scale[COMPONENTS + k] * 254, fine.components->scale[k],
                           1e-6 * fine.components->scale[k]);
    }
    assert_float_equal(sqrt(square), 127 / sqrt(3), 10);
    weft_material_free(&fine);
    weft_material_free(&stored);
}

int test_error_budget(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_part_is_what_its_stage_added),
        cmocka_unit_test(a_stage_may_make_up_for_another),
        cmocka_unit_test(black_cloth_has_no_stack),
        cmocka_unit_test(cloth_is_that_of_the_photographs),
        cmocka_unit_test(exact_samples_leave_nothing_to_registration),
        cmocka_unit_test(shifted_registration_shows_in_its_part_alone),
        cmocka_unit_test(smaller_model_shows_in_its_part_alone),
        cmocka_unit_test(coarser_storage_shows_in_its_part_alone),
        cmocka_unit_test(answers_do_not_depend_on_threads),
        cmocka_unit_test(finer_components_hold_what_rounding_left),
    };
    return cmocka_run_group_tests(tests, make_files, remove_files);
}
