/* The sections of components: what is written is read back, and what is wrong is named. */
#include "tests/support/cmocka_all.h"

#include "btf/material/component_rounding.h"
#include "btf/material/component_section.h"
#include "btf/material/material.h"
#include "tests/btf/material/components_example.h"
#include "tests/btf/material/weft_bytes.h"
#include "tests/support/expect_ok.h"
#include "tests/support/scratch_folder.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define NAME "components.weft"

static void components_are_read_back(void **state)
{
    (void)state;
    weft_error error = {0};
    weft_material material, again;
    components_write_example(NAME);
    expect_ok(weft_material_read(NAME, &material, &error), &error);
    const weft_components *a = material.components;
    assert_non_null(a);
    assert_int_equal(a->kind, WEFT_COMPONENTS_OF_HALF_VECTOR);
    assert_int_equal(a->component_count, 8);
    assert_int_equal(a->first[2], 3);
    assert_float_equal(a->light[3 * 6], 0.6f, 1e-7);
    assert_float_equal(a->scale[7], 0.015625f / 8, 0);
    assert_int_equal(a->level[0].coefficient[1], 31 - 127);
    assert_int_equal(a->level[2].ceiling[0], 202);
    assert_int_equal(a->level[2].floor[1], 121);
    expect_ok(weft_material_write("again.weft", &material, &error), &error);
    expect_ok(weft_material_read("again.weft", &again, &error), &error);
    const weft_components *b = again.components;
    assert_memory_equal(a->value, b->value, 7 * 8 * 3 * sizeof *a->value);
    for (int k = 0; k < material.level_count; k++)
        assert_memory_equal(a->level[k].coefficient, b->level[k].coefficient,
                            (size_t)(a->level[k].width * a->level[k].height * 8));
    weft_material_free(&material);
    weft_material_free(&again);
}

/* The example, as components by kriging. */
static weft_components *make_kriged(weft_material *material)
{
    components_write_example(NAME);
    assert_int_equal(weft_material_read(NAME, material, NULL), WEFT_OK);
    weft_components *components = material->components;
    components->kind = WEFT_COMPONENTS_KRIGED_OVER_HALF_VECTOR;
    components->exponent = 2.4f;
    components->incidence_power = 2;
    components->cosine_power = -1;
    components->least_incidence = 0.25f;
    components->view_length = 0.6f;
    components->view_nugget = 0.01f;
    components->trend = 10;
    for (int k = 0; k < components->component_count; k++) {
        components->length[k] = 0.5f + 0.1f * (float)k;
        components->nugget[k] = 1e-3f * (float)(k + 1);
    }
    return components;
}

static void kriged_components_are_read_back(void **state)
{
    (void)state;
    weft_error error = {0};
    weft_material material, again;
    const weft_components *a = make_kriged(&material);
    expect_ok(weft_material_write("kriged.weft", &material, &error), &error);
    expect_ok(weft_material_read("kriged.weft", &again, &error), &error);
    const weft_components *b = again.components;
    assert_int_equal(b->kind, a->kind);
    assert_true(b->exponent == a->exponent && b->incidence_power == a->incidence_power);
    assert_true(b->cosine_power == a->cosine_power && b->least_incidence == a->least_incidence);
    assert_true(b->view_length == a->view_length && b->view_nugget == a->view_nugget && b->trend == a->trend);
    assert_true(b->least_cosine == a->least_cosine);
    assert_memory_equal(b->length, a->length, 8 * sizeof *a->length);
    assert_memory_equal(b->nugget, a->nugget, 8 * sizeof *a->nugget);
    assert_memory_equal(b->value, a->value, 7 * 8 * 3 * sizeof *a->value);
    weft_material_free(&material);
    weft_material_free(&again);
}

/* What makes no sense is named, whatever the number. */
static void numbers_of_kriged_components_out_of_range_are_named(void **state)
{
    (void)state;
    for (int which = 0; which < 9; which++)
        for (int wrong = 0; wrong < 2; wrong++) {
            weft_material material;
            weft_components *c = make_kriged(&material), *again = NULL;
            float *number[] = {&c->exponent,        &c->incidence_power, &c->cosine_power,
                               &c->least_incidence, &c->view_length,     &c->view_nugget,
                               &c->trend,           &c->length[5],       &c->nugget[7]};
            *number[which] = wrong ? NAN : -5;
            size_t size = weft_components_section_size(c, WEFT_VALUES_BY_WEIGHTED_DIFFERENCES);
            uint8_t *bytes = malloc(size);
            const char *fault = NULL;
            weft_components_section_write(c, bytes);
            assert_int_equal(weft_components_section_read(bytes, size, WEFT_VALUES_BY_WEIGHTED_DIFFERENCES, 5, 3, 4,
                                                          &again, &fault, NULL),
                             WEFT_BAD_INPUT);
            assert_non_null(strstr(fault, "out of range"));
            free(bytes);
            weft_material_free(&material);
        }
}

/* Version 1 has none. */
static void kriged_components_of_version_1_are_refused(void **state)
{
    (void)state;
    weft_material material;
    weft_components *c = make_kriged(&material), *again = NULL;
    size_t size = weft_components_section_size(c, WEFT_VALUES_BY_DIFFERENCES);
    uint8_t *bytes = calloc(1, size + 9 * 8);
    const char *fault = NULL;
    weft_components_section_write(c, bytes);
    assert_int_equal(
        weft_components_section_read(bytes, size, WEFT_VALUES_BY_DIFFERENCES, 5, 3, 4, &again, &fault, NULL),
        WEFT_BAD_INPUT);
    assert_non_null(strstr(fault, "unknown kind"));
    free(bytes);
    weft_material_free(&material);
}

/* A power by vectors is a power. */
static void powers_are_those_of_the_library(void **state)
{
    (void)state;
    for (float base = 1e-9f; base < 1e4f; base *= 1.07f)
        for (float exponent = 0.4f; exponent < 2.5f; exponent += 0.13f)
            assert_float_equal((double)weft_power(base, exponent) / pow((double)base, (double)exponent), 1, 1e-5);
    const float most = weft_power(INFINITY, 4);
    assert_true(most > 1e37f && isfinite(most) && weft_power(1e30f, 2.4f) == most);
    assert_true(weft_power(NAN, 2) < 1e-12f && weft_power(1e-38f, 4) >= 0);
    assert_true(weft_power(0, 2.4f) < 1e-12f && weft_power(-1, 0.5f) < 1e-12f);
    assert_true(weft_decoded(1, -3) == -3);
    assert_float_equal(weft_decoded(2, weft_coded(2, 0.37f)), 0.37f, 1e-5);
}

/* A floor never says more than what it is made of, and at most a sixteenth less. */
static void floors_are_rounded_down(void **state)
{
    (void)state;
    for (int code = 0; code < 256; code++) {
        float value = weft_floor_of_code((uint8_t)code), steps = (float)(16 + code % 16);
        if (code > 0)
            assert_float_equal(value, ldexp((double)steps / 16, code / 16 - 13), 0);
        assert_int_equal(weft_floor_code(value), code);
        assert_int_equal(weft_floor_code(nextafterf(value, -1)), code > 1 ? code - 1 : 0);
    }
    assert_float_equal(weft_floor_of_code(0), 0, 0);
    assert_int_equal(weft_floor_code(-INFINITY), 0);
    assert_int_equal(weft_floor_code(NAN), 0);
    assert_int_equal(weft_floor_code(INFINITY), 255);
}

/* ---- Differences ---- */

enum { EXAMPLE_VALUES = 7 * 8 * 3 };

static const weft_half *values_of_example(weft_material *material)
{
    components_write_example(NAME);
    assert_int_equal(weft_material_read(NAME, material, NULL), WEFT_OK);
    return material->components->value;
}

static uint8_t *write_differences(const weft_components *components, size_t *size)
{
    *size = weft_components_section_size(components, WEFT_VALUES_BY_WEIGHTED_DIFFERENCES);
    uint8_t *bytes = malloc(*size);
    weft_components_section_write(components, bytes);
    return bytes;
}

/* What version 1 wrote; values by differences are not set. */
static uint8_t *write_version_1(const weft_components *components, weft_value_coding coding, size_t *size)
{
    size_t written;
    uint8_t *bytes = write_differences(components, &written);
    *size = weft_components_section_size(components, coding);
    if (coding == WEFT_VALUES_AS_HALVES)
        memcpy(bytes + *size - EXAMPLE_VALUES * sizeof *components->value, components->value,
               EXAMPLE_VALUES * sizeof *components->value);
    return bytes;
}

static void read_differences(const uint8_t *bytes, size_t size, weft_value_coding coding, weft_components **components)
{
    const char *fault = NULL;
    assert_int_equal(weft_components_section_read(bytes, size, coding, 5, 3, 4, components, &fault, NULL), WEFT_OK);
}

/* All signs and sizes, of views of 2, 1 and 4 images. */
static void values_by_differences_are_read_back(void **state)
{
    (void)state;
    static const int whole[] = {2048, -2048, 2048, 0, 1, -1, -2048, 2048, -2048, 7, 300, -255, 256};
    weft_material material;
    const weft_half *value = values_of_example(&material);
    for (int i = 0; i < EXAMPLE_VALUES; i++)
        material.components->value[i] = weft_half_of_float((float)whole[i % 13]);
    assert_true(weft_components_have_differences(material.components));
    size_t size;
    uint8_t *bytes = write_differences(material.components, &size);
    weft_components *again;
    read_differences(bytes, size, WEFT_VALUES_BY_WEIGHTED_DIFFERENCES, &again);
    assert_memory_equal(again->value, value, EXAMPLE_VALUES * sizeof *value);
    material.components->value[5] = weft_half_of_float(2050);
    assert_false(weft_components_have_differences(material.components));
    weft_components_free(again);
    free(bytes);
    weft_material_free(&material);
}

/* LAYR of the example in memory, its views of 2, 3 and 2 images, and the codes of layer 0; all others are 0. */
static uint8_t *header_of_codes(weft_value_coding coding, const unsigned code[7][3], size_t *size)
{
    static const uint32_t first[] = {0, 2, 5, 7};
    weft_material material;
    values_of_example(&material);
    memcpy(material.components->first, first, sizeof first);
    uint8_t *bytes = write_version_1(material.components, coding, size);
    uint8_t *low = bytes + *size - 2 * EXAMPLE_VALUES, *high = low + EXAMPLE_VALUES;
    memset(low, 0, 2 * (size_t)EXAMPLE_VALUES);
    for (int i = 0; i < 21; i++) {
        int at = 24 * (i / 3) + i % 3;
        low[at] = (uint8_t)code[i / 3][i % 3];
        high[at] = (uint8_t)(code[i / 3][i % 3] >> 8);
    }
    weft_material_free(&material);
    return bytes;
}

static void expect_read_as(const uint8_t *bytes, size_t size, weft_value_coding coding, const int rgb[7][3])
{
    weft_components *components;
    read_differences(bytes, size, coding, &components);
    for (int i = 0; i < 21; i++)
        assert_float_equal(weft_float_of_half(components->value[24 * (i / 3) + i % 3]), rgb[i / 3][i % 3], 0);
    weft_components_free(components);
}

/* By hand, from the document: red, green and blue of layer 0 without weights. */
static void differences_are_those_of_the_document(void **state)
{
    (void)state;
    static const int rgb[7][3] = {{3, 5, 4}, {6, 9, 9}, {0, 2, 0}, {1, 1, 1}, {300, 1, 1}, {1, 1, 1}, {0, 0, -1}};
    /* x: (-2 5 -1) (-3 9 0) | (-2 2 -2) (0 1 0) (299 1 0) | (0 1 0) (0 0 -1)
     * d: (-2 5 -1) (-1 4 1) | (0 -3 -1) (3 -4 1) (299 0 0) | (2 -1 2) (0 -1 -1) */
    static const unsigned code[7][3] = {{3, 10, 1}, {1, 8, 2}, {0, 5, 1}, {6, 7, 2}, {598, 0, 0}, {4, 1, 4}, {0, 1, 1}};
    size_t size;
    uint8_t *bytes = header_of_codes(WEFT_VALUES_BY_DIFFERENCES, code, &size);
    expect_read_as(bytes, size, WEFT_VALUES_BY_DIFFERENCES, rgb);
    free(bytes);
}

/* The same with weights, computed from the document by a script. */
static void weighted_differences_are_those_of_the_document(void **state)
{
    (void)state;
    static const int8_t weight[9] = {97, 20, 12, 0, -8, 35, -11, 32, -3};
    static const int rgb[7][3] = {{13, 5, -3},  {21, 8, -3}, {8, 1, -2}, {20, 5, -3},
                                  {316, 4, -2}, {7, 0, 0},   {9, 4, -2}};
    static const unsigned code[7][3] = {{3, 10, 1},  {1, 8, 2}, {14, 5, 1}, {6, 7, 2},
                                        {598, 0, 0}, {4, 1, 4}, {17, 1, 1}};
    size_t size;
    uint8_t *bytes = header_of_codes(WEFT_VALUES_BY_WEIGHTED_DIFFERENCES, code, &size);
    uint8_t *weights = bytes + size - 2 * EXAMPLE_VALUES - 8 * sizeof weight;
    memset(weights, 0, 8 * sizeof weight);
    memcpy(weights, weight, sizeof weight);
    expect_read_as(bytes, size, WEFT_VALUES_BY_WEIGHTED_DIFFERENCES, rgb);
    free(bytes);
}

/* Red is three and a half times green, rounded up, blue is minus green, and every view has what the one before it has:
 * weights of 112, -32 and, of the view before, 32 leave nothing of red, blue and all views but the first. */
static void weights_are_those_that_leave_least(void **state)
{
    (void)state;
    static const uint32_t first[] = {0, 3, 6, 7};
    static const int green[] = {31, -78, 200, 31, -78, 200, 31};
    weft_material material;
    values_of_example(&material);
    memset(material.components->value, 0, EXAMPLE_VALUES * sizeof *material.components->value);
    memcpy(material.components->first, first, sizeof first);
    for (int i = 0; i < 7; i++) {
        weft_half *value = material.components->value + 24 * i + 3;
        value[0] = weft_half_of_float(floorf(3.5f * (float)green[i] + 0.5f));
        value[1] = weft_half_of_float((float)green[i]);
        value[2] = weft_half_of_float((float)-green[i]);
    }
    size_t size;
    uint8_t *bytes = write_differences(material.components, &size);
    const uint8_t *low = bytes + size - 2 * EXAMPLE_VALUES, *high = low + EXAMPLE_VALUES;
    const int8_t *weight = (const int8_t *)(low - 8 * 9) + 9;
    assert_int_equal(weight[0], 112);
    assert_int_equal(weight[6], -32);
    assert_int_equal(weight[4], 0);
    assert_int_equal(weight[5], 32);
    for (int i = 0; i < EXAMPLE_VALUES; i++) {
        int is_told = i / 24 < 3 && i % 24 == 4;
        assert_int_equal(low[i] + 256 * high[i] != 0, is_told);
    }
    free(bytes);
    weft_material_free(&material);
}

/* Values that are no whole numbers are written as 2048ths of the largest of their component. */
static void other_values_are_rounded(void **state)
{
    (void)state;
    weft_error error = {0};
    weft_material material, again;
    const weft_half *value = values_of_example(&material);
    for (int i = 0; i < EXAMPLE_VALUES; i++)
        material.components->value[i] = weft_half_of_float(i / 3 % 8 == 2 ? (float)(i % 7) : sinf((float)i));
    expect_ok(weft_material_write("rounded.weft", &material, &error), &error);
    expect_ok(weft_material_read("rounded.weft", &again, &error), &error);
    const weft_components *a = material.components, *b = again.components;
    assert_true(weft_components_have_differences(b));
    for (int i = 0; i < EXAMPLE_VALUES; i++) {
        int k = i / 3 % 8;
        float was = a->scale[k] * weft_float_of_half(value[i]), is = b->scale[k] * weft_float_of_half(b->value[i]);
        assert_float_equal(is, was, k == 2 ? 0 : a->scale[k] / 4090);
    }
    weft_material_free(&material);
    weft_material_free(&again);
}

/* Weights of up to 4 would leave differences of more than 16 bits: then others are taken. */
static void extreme_values_are_read_back(void **state)
{
    (void)state;
    weft_error error = {0};
    weft_material material, again;
    const weft_half *value = values_of_example(&material);
    for (int i = 0; i < EXAMPLE_VALUES; i++)
        material.components->value[i] = weft_half_of_float((i * 2654435761u >> 13 & 1) ? 2048.0f : -2048.0f);
    expect_ok(weft_material_write("extreme.weft", &material, &error), &error);
    expect_ok(weft_material_read("extreme.weft", &again, &error), &error);
    assert_memory_equal(again.components->value, value, EXAMPLE_VALUES * sizeof *value);
    weft_material_free(&material);
    weft_material_free(&again);
}

/* Rounded, all values are whole numbers: of a layer that no texel has any of, too. */
static void an_empty_layer_keeps_none_from_packing(void **state)
{
    (void)state;
    enum { EMPTY = 5 };
    weft_material material;
    values_of_example(&material);
    weft_components *components = material.components;
    for (int k = 0; k < components->level_count; k++) {
        size_t texels = (size_t)components->level[k].width * (size_t)components->level[k].height;
        int8_t *group =
            components->level[k].coefficient + EMPTY / WEFT_COMPONENTS_GROUP * WEFT_COMPONENTS_GROUP * texels;
        for (size_t i = 0; i < texels; i++)
            group[WEFT_COMPONENTS_GROUP * i + EMPTY % WEFT_COMPONENTS_GROUP] = 0;
    }
    components->value[0] = weft_half_of_float(0.3f);
    assert_false(weft_components_have_differences(components));
    weft_components_round_values(0.01, components);
    assert_true(weft_components_have_differences(components));
    weft_material_free(&material);
}

/* Steps of 32 codes on the finest level, half of that on each coarser one: the scale stays, for they end with 1. */
static void coarser_levels_are_rounded_less(void **state)
{
    (void)state;
    enum { LAYER = 2, TIMES = 32 };
    weft_material material, whole;
    values_of_example(&material);
    values_of_example(&whole);
    weft_components *components = material.components;
    double square = 0;
    for (int i = 0; i < 3 * components->image_count; i++)
        square += pow((double)weft_float_of_half(components->value[3 * (8 * (i / 3) + LAYER) + i % 3]), 2);
    double rms = (double)components->scale[LAYER] * sqrt(square / (3 * components->image_count));
    weft_components_round_coefficients(TIMES * rms, true, components);
    assert_float_equal(components->scale[LAYER], whole.components->scale[LAYER], 0);
    int changed = 0;
    for (int k = 0; k < components->level_count; k++) {
        const weft_components_level *level = &components->level[k];
        for (int i = 0; i < level->width * level->height; i++) {
            int at = WEFT_COMPONENTS_GROUP * i + LAYER, code = level->coefficient[at],
                before = whole.components->level[k].coefficient[at];
            assert_true(abs(code) == 127 || abs(code) % (TIMES >> k) == 0);
            assert_in_range(abs(code - before), 0, TIMES >> k >> 1);
            changed += code != before;
        }
    }
    assert_true(changed > 10);
    weft_material_free(&whole);
    weft_material_free(&material);
}

static void values_too_large_are_refused(void **state)
{
    (void)state;
    weft_material material;
    values_of_example(&material);
    memset(material.components->value, 0, EXAMPLE_VALUES * sizeof *material.components->value);
    for (int i = 0; i < 2; i++) {
        size_t size;
        uint8_t *bytes = write_differences(material.components, &size);
        bytes[size - EXAMPLE_VALUES - 1] = i == 0 ? 1 : 2;
        bytes[size - 1] = 16; /* 4096: 2048; with 2 more: 2049; with 1 more: -2049 */
        weft_components *components = NULL;
        const char *fault = NULL;
        assert_int_equal(weft_components_section_read(bytes, size, WEFT_VALUES_BY_WEIGHTED_DIFFERENCES, 5, 3, 4,
                                                      &components, &fault, NULL),
                         WEFT_BAD_INPUT);
        assert_non_null(strstr(fault, "no whole number"));
        free(bytes);
    }
    weft_material_free(&material);
}

/* ---- Damage ---- */

/* LAYR of the example in memory, uncompressed. */
typedef struct header {
    uint8_t *bytes;
    size_t size;
} header;

static header take_header(void)
{
    weft_material material;
    components_write_example(NAME);
    assert_int_equal(weft_material_read(NAME, &material, NULL), WEFT_OK);
    header h;
    h.bytes = write_version_1(material.components, WEFT_VALUES_AS_HALVES, &h.size);
    weft_material_free(&material);
    return h;
}

static void expect_fault(header h, const char *what)
{
    weft_components *components = NULL;
    const char *fault = NULL;
    assert_int_equal(
        weft_components_section_read(h.bytes, h.size, WEFT_VALUES_AS_HALVES, 5, 3, 4, &components, &fault, NULL),
        WEFT_BAD_INPUT);
    assert_non_null(fault);
    assert_non_null(strstr(fault, what));
    free(h.bytes);
}

static header with_word(int word, uint32_t value)
{
    header h = take_header();
    memcpy(h.bytes + 4 * word, &value, sizeof value);
    return h;
}

static header with_real(size_t at, float value)
{
    header h = take_header();
    memcpy(h.bytes + at, &value, sizeof value);
    return h;
}

static void every_field_is_checked(void **state)
{
    (void)state;
    const size_t views = 64, lights = views + 3 * 12, first = lights + 7 * 12, scale = first + 16, value = scale + 32;
    expect_fault(with_word(0, 3), "unknown kind");
    expect_fault(with_word(0, UINT32_MAX), "unknown kind");
    expect_fault(with_word(1, 6), "multiple of 4");
    expect_fault(with_word(1, 68), "multiple of 4");
    expect_fault(with_word(2, 0), "too few or too many");
    expect_fault(with_word(3, 0xffffffff), "too few or too many");
    expect_fault(with_word(4, 65), "4 to 64 nodes");
    expect_fault(with_word(5, 3), "4 to 64 nodes");
    expect_fault(with_word(3, 8), "size does not fit");
    expect_fault(with_word(10, 1), "not zero");
    expect_fault(with_real(24, 0), "out of range");
    expect_fault(with_real(28, NAN), "out of range");
    expect_fault(with_real(32, 1.5f), "out of range");
    expect_fault(with_real(36, -1), "out of range");
    expect_fault(with_real(36, NAN), "out of range");
    expect_fault(with_real(views, 0.5f), "no unit vector");
    expect_fault(with_real(lights + 8, -1), "no unit vector");
    expect_fault(with_real(lights, NAN), "no unit vector");
    expect_fault(with_word((int)first / 4, 1), "without all its images");
    expect_fault(with_word((int)first / 4 + 1, 3), "empty or out of order");
    expect_fault(with_word((int)first / 4 + 2, 9), "empty or out of order");
    expect_fault(with_real(scale, -1), "scale out of range");
    expect_fault(with_word((int)value / 4, 0x7c000000), "not finite");
    header h = take_header();
    h.size = 60;
    expect_fault(h, "too short");
}

/* Another number of components than the header says. */
static void coefficients_must_be_those_of_the_components(void **state)
{
    (void)state;
    weft_error error = {0};
    weft_material material;
    size_t size;
    components_write_example(NAME);
    unsigned char *bytes = scratch_load(NAME, &size);
    weft_bytes_put_u32(bytes + 56, 12);
    weft_bytes_repair(bytes, size, false);
    scratch_store(NAME, bytes, size);
    assert_int_equal(weft_class_of(weft_material_read(NAME, &material, &error)), WEFT_BAD_INPUT);
    assert_non_null(strstr(error.message, "section COEF of level 0: its size does not fit the material"));
    free(bytes);
}

static void ceilings_never_round_down(void **state)
{
    (void)state;
    for (int i = -180; i < 60; i++) {
        float value = exp2f((float)i / 7.3f);
        uint8_t code = weft_ceiling_code(value);
        assert_true(code == 255 || weft_ceiling_of_code(code) >= value);
        assert_true(code == 0 || weft_ceiling_of_code((uint8_t)(code - 1)) < value);
    }
    assert_int_equal(weft_ceiling_code(0), 0);
    assert_int_equal(weft_ceiling_code(1), 192);
    assert_int_equal(weft_ceiling_code(1e30f), 255);
}

int test_material_components(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(components_are_read_back),
        cmocka_unit_test(kriged_components_are_read_back),
        cmocka_unit_test(numbers_of_kriged_components_out_of_range_are_named),
        cmocka_unit_test(kriged_components_of_version_1_are_refused),
        cmocka_unit_test(powers_are_those_of_the_library),
        cmocka_unit_test(floors_are_rounded_down),
        cmocka_unit_test(values_by_differences_are_read_back),
        cmocka_unit_test(differences_are_those_of_the_document),
        cmocka_unit_test(weighted_differences_are_those_of_the_document),
        cmocka_unit_test(weights_are_those_that_leave_least),
        cmocka_unit_test(other_values_are_rounded),
        cmocka_unit_test(extreme_values_are_read_back),
        cmocka_unit_test(an_empty_layer_keeps_none_from_packing),
        cmocka_unit_test(coarser_levels_are_rounded_less),
        cmocka_unit_test(values_too_large_are_refused),
        cmocka_unit_test(every_field_is_checked),
        cmocka_unit_test(coefficients_must_be_those_of_the_components),
        cmocka_unit_test(ceilings_never_round_down),
    };
    return cmocka_run_group_tests(tests, scratch_folder_enter, scratch_folder_leave);
}
