/* A material made of the texels of another: what is moved, what is mixed, and where its levels come from. */
#include "btf/material/gather.h"
#include "tests/btf/material/components_example.h"
#include "tests/support/cmocka_all.h"
#include "tests/support/expect_ok.h"
#include "tests/support/scratch_folder.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define NAME "gather.weft"

enum { WIDTH = 5, HEIGHT = 3 }; /* of the example */

static void read_example(weft_material *material)
{
    weft_error error = {0};
    components_write_example(NAME);
    expect_ok(weft_material_read(NAME, material, &error), &error);
}

static weft_texel_mix whole(int x, int y)
{
    return (weft_texel_mix){{{x, y, 1}}};
}

static void place_in_order(weft_texel_mix mix[HEIGHT][WIDTH])
{
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            mix[y][x] = whole(x, y);
}

static weft_material gathered(const weft_material *from, int width, int height, const weft_texel_mix *mix)
{
    weft_error error = {0};
    weft_material result;
    expect_ok(weft_material_gather(from, width, height, mix, &result, &error), &error);
    return result;
}

static void texels_in_their_order_are_the_same_file(void **state)
{
    (void)state;
    weft_material material;
    weft_texel_mix mix[HEIGHT][WIDTH];
    read_example(&material);
    place_in_order(mix);
    weft_material same = gathered(&material, WIDTH, HEIGHT, &mix[0][0]);
    /* Levels of components are made anew: those of the example are no means. */
    for (int k = 1; k < material.level_count; k++) {
        weft_components_level *a = &material.components->level[k], *b = &same.components->level[k];
        memcpy(a->coefficient, b->coefficient, (size_t)(a->width * a->height * material.components->component_count));
        memcpy(a->ceiling, b->ceiling, weft_ceiling_count(a->width, a->height));
        memcpy(a->floor, b->floor, 3 * weft_ceiling_count(a->width, a->height));
    }
    weft_error error = {0};
    expect_ok(weft_material_write("as_it_was.weft", &material, &error), &error);
    expect_ok(weft_material_write("same.weft", &same, &error), &error);
    size_t size, same_size;
    unsigned char *bytes = scratch_load("as_it_was.weft", &size), *same_bytes = scratch_load("same.weft", &same_size);
    assert_int_equal(size, same_size);
    assert_memory_equal(bytes, same_bytes, size);
    free(bytes);
    free(same_bytes);
    weft_material_free(&same);
    weft_material_free(&material);
}

/* Every array, by the index that docs/reference/weft-format.md gives it. */
static void expect_same_texel(const weft_material *a, int k, size_t i, const weft_material *b, int l, size_t j)
{
    const weft_material_level *p = &a->level[k], *q = &b->level[l];
    size_t ni = (size_t)p->width * (size_t)p->height, nj = (size_t)q->width * (size_t)q->height;
    assert_memory_equal(p->frame + 3 * i, q->frame + 3 * j, 6);
    assert_memory_equal(p->diffuse + 4 * i, q->diffuse + 4 * j, 8);
    for (size_t plane = 0; plane < 3 * (size_t)a->lobe_count; plane++)
        assert_memory_equal(p->lobe + 4 * (plane * ni + i), q->lobe + 4 * (plane * nj + j), 8);
    for (size_t view = 0; view < (size_t)a->view_count; view++)
        assert_memory_equal(p->table + 4 * (view * ni + i), q->table + 4 * (view * nj + j), 4);
}

static void texels_and_levels_are_moved_alike(void **state)
{
    (void)state;
    weft_material material;
    weft_texel_mix mix[4];
    read_example(&material);
    for (int i = 0; i < 4; i++)
        mix[i] = whole(i % 2 + 2, i / 2);
    weft_material part = gathered(&material, 2, 2, mix);
    for (int y = 0; y < 2; y++)
        for (int x = 0; x < 2; x++)
            expect_same_texel(&part, 0, (size_t)(2 * y + x), &material, 0, (size_t)(WIDTH * y + x + 2));
    /* Two texels to the right are one texel of the next level. */
    expect_same_texel(&part, 1, 0, &material, 1, 1);
    assert_int_equal(part.level_count, 2);
    weft_material_free(&part);
    weft_material_free(&material);
}

static void components_are_mixed_and_all_else_is_the_heaviest(void **state)
{
    (void)state;
    weft_material material;
    read_example(&material);
    material.components->level[0].ceiling[0] = 10;
    weft_texel_mix mix = {{{4, 1, 0.75f}, {1, 2, 0.25f}}};
    weft_material one = gathered(&material, 1, 1, &mix);
    const int8_t *from = material.components->level[0].coefficient, *to = one.components->level[0].coefficient;
    for (int group = 0; group < 2; group++)
        for (int c = 0; c < 4; c++) {
            int a = from[4 * (group * WIDTH * HEIGHT + WIDTH * 1 + 4) + c];
            int b = from[4 * (group * WIDTH * HEIGHT + WIDTH * 2 + 1) + c];
            assert_int_equal(to[4 * group + c], lround(0.75 * a + 0.25 * b));
        }
    assert_int_equal(one.components->level[0].ceiling[0], 10);
    expect_same_texel(&one, 0, 0, &material, 0, WIDTH * 1 + 4);
    weft_material_free(&one);
    weft_material_free(&material);
}

static void a_ceiling_is_the_largest_of_what_is_mixed_and_a_floor_the_least(void **state)
{
    (void)state;
    const weft_components shape = {.component_count = 4,
                                   .view_count = 1,
                                   .image_count = 1,
                                   .light_side = 4,
                                   .view_side = 4,
                                   .light_smoothness = 1,
                                   .view_smoothness = 1,
                                   .least_cosine = 1};
    weft_error error = {0};
    weft_material material;
    expect_ok(weft_material_create(24, 8, 0, 0, 0, 0, &material, &error), &error);
    expect_ok(weft_components_create(&shape, 24, 8, 1, &material.components, &error), &error);
    memcpy(material.components->level[0].ceiling, (uint8_t[]){50, 90, 70}, 3);
    memcpy(material.components->level[0].floor, (uint8_t[]){40, 5, 9, 20, 7, 8, 30, 6, 7}, 9);
    for (int i = 0; i < 6; i++) {
        int a = i % 3, b = (i % 3 + 1 + i / 3) % 3;
        weft_texel_mix mix = {{{8 * a, 0, 0.75f}, {8 * b + 3, 5, 0.25f}}};
        weft_material one = gathered(&material, 1, 1, &mix);
        const uint8_t *ceiling = material.components->level[0].ceiling;
        assert_int_equal(one.components->level[0].ceiling[0], ceiling[a] > ceiling[b] ? ceiling[a] : ceiling[b]);
        const uint8_t *least = material.components->level[0].floor;
        for (int c = 0; c < 3; c++) {
            int of_a = least[3 * a + c], of_b = least[3 * b + c];
            assert_int_equal(one.components->level[0].floor[c], of_a < of_b ? of_a : of_b);
        }
        weft_material_free(&one);
    }
    weft_material_free(&material);
}

static void levels_of_layers_are_means_of_what_they_cover(void **state)
{
    (void)state;
    weft_material material;
    weft_texel_mix mix[HEIGHT][WIDTH];
    read_example(&material);
    place_in_order(mix);
    weft_material same = gathered(&material, WIDTH, HEIGHT, &mix[0][0]);
    const weft_components_level *fine = &same.components->level[0],
                                *last = &same.components->level[same.level_count - 1];
    for (int c = 0; c < 4; c++) {
        double sum = 0;
        for (int i = 0; i < WIDTH * HEIGHT; i++)
            sum += fine->coefficient[4 * i + c];
        assert_int_equal(last->coefficient[c], lround(sum / (WIDTH * HEIGHT)));
    }
    /* The upper right texel of level 1 covers one column alone. */
    int expected = (int)lround((fine->coefficient[4 * 4] + fine->coefficient[4 * (WIDTH + 4)]) / 2.0);
    assert_int_equal(same.components->level[1].coefficient[4 * 2], expected);
    weft_material_free(&same);
    weft_material_free(&material);
}

static void more_texels_than_there_were_are_refused(void **state)
{
    (void)state;
    weft_error error = {0};
    weft_material material, larger;
    weft_texel_mix mix[40] = {0};
    read_example(&material);
    assert_int_equal(weft_material_gather(&material, 40, 1, mix, &larger, &error), WEFT_BAD_USAGE);
    weft_material_free(&material);
}

int test_material_gather(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(texels_in_their_order_are_the_same_file),
        cmocka_unit_test(texels_and_levels_are_moved_alike),
        cmocka_unit_test(components_are_mixed_and_all_else_is_the_heaviest),
        cmocka_unit_test(a_ceiling_is_the_largest_of_what_is_mixed_and_a_floor_the_least),
        cmocka_unit_test(levels_of_layers_are_means_of_what_they_cover),
        cmocka_unit_test(more_texels_than_there_were_are_refused),
    };
    return cmocka_run_group_tests(tests, scratch_folder_enter, scratch_folder_leave);
}
