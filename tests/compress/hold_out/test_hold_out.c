/* What is held out, that it stays out, and what is said of it. */
#include "tests/compare/fixture.h"

#include "btf/direction/direction.h"
#include "compress/hold_out/hold_out.h"
#include "compress/hold_out/texel_subset.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { DIRECTIONS = WEFT_UBO81_COUNT, IMAGES = DIRECTIONS * DIRECTIONS };

static const char *const path = "hold_out.btf.h5";
static const char *const scratch = "hold_out_scratch.btf.h5";

/* ---- Splits ---- */

/* All pairs of ubo81; lights move by up to `jitter` in x from view to view. */
static weft_dataset_layout grid_layout(double jitter)
{
    weft_dataset_layout layout = {.width = 1, .height = 1, .image_count = IMAGES, .view_count = DIRECTIONS};
    assert_int_equal(weft_dataset_layout_allocate(&layout, NULL), WEFT_OK);
    for (int i = 0; i < IMAGES; i++) {
        weft_vec3 light = weft_direction_of_angles(weft_ubo81_angles(i % DIRECTIONS));
        light.x += jitter * (i / DIRECTIONS % 7 - 3) / 3.0;
        layout.light[i] = weft_unit(light);
        layout.view_of_image[i] = i / DIRECTIONS;
        layout.view[i / DIRECTIONS] = weft_direction_of_angles(weft_ubo81_angles(i / DIRECTIONS));
    }
    return layout;
}

/* A list of images, each from its own place above a sheet. */
static weft_dataset_layout list_layout(int count)
{
    weft_dataset_layout layout = {
        .width = 4, .height = 4, .image_count = count, .view_count = count, .distance = WEFT_NEAR, .texel_pitch_mm = 1};
    assert_int_equal(weft_dataset_layout_allocate(&layout, NULL), WEFT_OK);
    for (int i = 0; i < count; i++) {
        layout.light[i] = layout.view[i] = weft_vec3_of(3 * (i % 7) - 9, 4 * (i / 7) - 8, 50);
        layout.view_of_image[i] = i;
    }
    return layout;
}

static weft_splits split(const weft_dataset_layout *layout, uint64_t seed, int most)
{
    weft_splits splits;
    weft_error error = {0};
    expect_ok(weft_splits_create(layout, seed, most, &splits, &error), &error);
    return splits;
}

/* A direction that a split holds out lies between others: from 15 to 60 degrees. */
static void expect_inner(int direction)
{
    double theta_deg = weft_deg_of_rad(weft_ubo81_angles(direction).theta_rad);
    assert_true(theta_deg > 14 && theta_deg < 61);
}

/* Directions with the flag, by what the images say; every image of them must have it, and no other. */
static int held_directions(const uint8_t *held, int flag, uint8_t direction[DIRECTIONS])
{
    int count = 0;
    for (int d = 0; d < DIRECTIONS; d++) {
        int images = 0;
        for (int other = 0; other < DIRECTIONS; other++)
            images += (held[flag == WEFT_HELD_VIEW ? d * DIRECTIONS + other : other * DIRECTIONS + d] & flag) != 0;
        assert_true(images == 0 || images == DIRECTIONS);
        direction[d] = images > 0;
        count += direction[d];
    }
    return count;
}

static void a_tenth_of_views_and_lights_between_others_is_held_out_once(void **state)
{
    (void)state;
    weft_dataset_layout layout = grid_layout(0);
    weft_splits splits = split(&layout, 0, WEFT_SPLIT_MOST);
    int times[2][DIRECTIONS] = {0};
    assert_int_equal(splits.kind, WEFT_SPLIT_DIRECTIONS);
    assert_int_equal(splits.count, 7);
    for (int s = 0; s < splits.count; s++) {
        for (int k = 0; k < 2; k++) {
            uint8_t direction[DIRECTIONS];
            assert_int_equal(
                held_directions(weft_splits_held(&splits, s), k ? WEFT_HELD_LIGHT : WEFT_HELD_VIEW, direction), 8);
            for (int d = 0; d < DIRECTIONS; d++) {
                times[k][d] += direction[d];
                if (direction[d])
                    expect_inner(d);
            }
        }
    }
    for (int d = 0; d < DIRECTIONS; d++)
        assert_true(times[0][d] <= 1 && times[1][d] <= 1);
    weft_splits_free(&splits);
    weft_dataset_layout_free(&layout);
}

/* All quadrants, and the inner half of the rings as well as the outer one. */
static void what_is_held_out_is_spread_over_the_hemisphere(void **state)
{
    (void)state;
    weft_dataset_layout layout = grid_layout(0);
    weft_splits splits = split(&layout, 0, WEFT_SPLIT_MOST);
    for (int s = 0; s < splits.count; s++) {
        uint8_t direction[DIRECTIONS];
        int quadrant[4] = {0}, steep = 0, low = 0;
        held_directions(weft_splits_held(&splits, s), WEFT_HELD_VIEW, direction);
        for (int d = 0; d < DIRECTIONS; d++) {
            weft_angles angles = weft_ubo81_angles(d);
            if (!direction[d])
                continue;
            quadrant[(int)(angles.phi_rad / (WEFT_PI / 2)) % 4]++;
            steep += angles.theta_rad < 0.6;
            low += angles.theta_rad > 0.6;
        }
        for (int q = 0; q < 4; q++)
            assert_in_range(quadrant[q], 1, 4);
        assert_true(steep >= 2 && low >= 3);
    }
    weft_splits_free(&splits);
    weft_dataset_layout_free(&layout);
}

static void a_split_depends_on_the_seed_alone(void **state)
{
    (void)state;
    weft_dataset_layout layout = grid_layout(0);
    weft_splits a = split(&layout, 0, 2), again = split(&layout, 0, 2), other = split(&layout, 1, 1);
    assert_memory_equal(a.held, again.held, 2 * IMAGES);
    assert_memory_not_equal(a.held, other.held, IMAGES);
    assert_memory_equal(weft_splits_held(&a, 1), other.held, IMAGES);
    weft_splits_free(&a);
    weft_splits_free(&again);
    weft_splits_free(&other);
    weft_dataset_layout_free(&layout);
}

static void lights_that_jitter_are_held_out_with_their_neighbours(void **state)
{
    (void)state;
    weft_dataset_layout still = grid_layout(0), moved = grid_layout(0.02);
    weft_splits a = split(&still, 0, 1), b = split(&moved, 0, 1);
    assert_int_equal(b.kind, WEFT_SPLIT_DIRECTIONS);
    uint8_t direction[DIRECTIONS];
    assert_int_equal(held_directions(b.held, WEFT_HELD_LIGHT, direction), 8);
    assert_int_equal(held_directions(b.held, WEFT_HELD_VIEW, direction), 8);
    weft_splits_free(&a);
    weft_splits_free(&b);
    weft_dataset_layout_free(&still);
    weft_dataset_layout_free(&moved);
}

static void every_image_of_a_list_is_held_out_once(void **state)
{
    (void)state;
    weft_dataset_layout layout = list_layout(42);
    weft_splits splits = split(&layout, 0, WEFT_SPLIT_MOST);
    assert_int_equal(splits.kind, WEFT_SPLIT_PHOTOGRAPHS);
    assert_int_equal(splits.count, 10);
    int times[42] = {0};
    for (int s = 0; s < splits.count; s++) {
        int count = 0;
        for (int i = 0; i < 42; i++) {
            count += weft_splits_held(&splits, s)[i] == WEFT_HELD_IMAGE;
            times[i] += weft_splits_held(&splits, s)[i] != 0;
        }
        assert_in_range(count, 4, 5);
    }
    for (int i = 0; i < 42; i++)
        assert_int_equal(times[i], 1);
    weft_splits_free(&splits);
    weft_dataset_layout_free(&layout);
}

static void of_one_view_lights_are_held_out(void **state)
{
    (void)state;
    weft_dataset_layout layout = grid_layout(0);
    layout.image_count = DIRECTIONS;
    layout.view_count = 1;
    weft_splits splits = split(&layout, 0, 1);
    int count = 0;
    for (int i = 0; i < DIRECTIONS; i++) {
        assert_true(splits.held[i] == 0 || splits.held[i] == WEFT_HELD_LIGHT);
        count += splits.held[i] != 0;
        if (splits.held[i])
            expect_inner(i);
    }
    assert_int_equal(count, 8);
    weft_splits_free(&splits);
    weft_dataset_layout_free(&layout);
}

static int enough_splits(int views, int lights)
{
    weft_dataset_layout layout = {.width = 1, .height = 1, .image_count = views * lights, .view_count = views};
    weft_error error = {0};
    int count;
    assert_int_equal(weft_dataset_layout_allocate(&layout, NULL), WEFT_OK);
    for (int i = 0; i < layout.image_count; i++) {
        layout.light[i] = weft_direction_of_angles(weft_ubo81_angles(i % lights));
        layout.view_of_image[i] = i / lights;
        layout.view[i / lights] = weft_direction_of_angles(weft_ubo81_angles(i / lights));
    }
    expect_ok(weft_hold_out_enough_splits(&layout, &count, &error), &error);
    weft_dataset_layout_free(&layout);
    return count;
}

/* 10 views and lights are held out together, or as many as leave others for a prediction. */
static void few_directions_are_held_out_more_than_once(void **state)
{
    (void)state;
    assert_int_equal(enough_splits(81, 81), 1); /* 8 and 8 */
    assert_int_equal(enough_splits(61, 61), 1); /* 5 or 6 of each */
    assert_int_equal(enough_splits(41, 41), 2); /* 4 and 4 */
    assert_int_equal(enough_splits(1, 81), 2);  /* 8 */
    assert_int_equal(enough_splits(19, 19), 1); /* of 6 inner directions two are held out three times */
    weft_dataset_layout list = list_layout(42);
    int count;
    assert_int_equal(weft_hold_out_enough_splits(&list, &count, NULL), WEFT_OK);
    assert_int_equal(count, 1);
    weft_dataset_layout_free(&list);
}

static void a_handful_is_left_out_one_by_one(void **state)
{
    (void)state;
    weft_dataset_layout layout = list_layout(9);
    weft_splits splits = split(&layout, 0, 1);
    assert_int_equal(splits.kind, WEFT_SPLIT_EACH);
    assert_int_equal(splits.count, 9);
    for (int s = 0; s < 9; s++)
        for (int i = 0; i < 9; i++)
            assert_int_equal(weft_splits_held(&splits, s)[i], i == s ? WEFT_HELD_IMAGE : 0);
    weft_splits_free(&splits);
    layout.image_count = layout.view_count = 1;
    assert_int_equal(weft_splits_create(&layout, 0, 1, &splits, NULL), WEFT_BAD_USAGE);
    weft_dataset_layout_free(&layout);
}

/* ---- Texels ---- */

static weft_rgb by_place(int x, int y, weft_vec3 light, weft_vec3 view)
{
    (void)light;
    return (weft_rgb){0.01 * x, 0.01 * y, 0.1 + 0.1 * view.z};
}

static weft_texel_subset read_subset(weft_texel_subset_kind kind, int side)
{
    weft_dataset *dataset;
    weft_texel_subset subset;
    weft_error error = {0};
    expect_ok(weft_dataset_open(path, &dataset, &error), &error);
    expect_ok(weft_texel_subset_read(dataset, kind, side, &subset, &error), &error);
    weft_dataset_close(dataset);
    return subset;
}

/* The place that a texel of by_place says it has, in a far dataset: red is x, green y, times the cosine of 1. */
static void place_of(const weft_texel_subset *subset, int texel, int *x, int *y)
{
    const weft_half *half = subset->samples + 3 * (size_t)texel * (size_t)subset->layout.image_count;
    *x = (int)lround(100 * (double)weft_float_of_half(half[0]));
    *y = (int)lround(100 * (double)weft_float_of_half(half[1]));
}

/* Squares of 4 x 4, three by three of them in a dataset whose sides are no multiple of them. */
static void small_squares_are_one_of_every_cell(void **state)
{
    (void)state;
    enum { SIDE = 12, SQUARE = 4 };
    fixture_far_dataset(path, 31, 26, 2, by_place, FIXTURE_MASK_NONE);
    weft_texel_subset subset = read_subset(WEFT_TEXEL_SUBSET_SMALL_PATCHES, SIDE);
    assert_int_equal(subset.neighbours, SQUARE);
    for (int texel = 0; texel < SIDE * SIDE; texel++) {
        int i = texel % SIDE, j = texel / SIDE, x, y, first_x, first_y;
        place_of(&subset, texel, &x, &y);
        place_of(&subset, (j - j % SQUARE) * SIDE + i - i % SQUARE, &first_x, &first_y);
        assert_int_equal(x - first_x, i % SQUARE);
        assert_int_equal(y - first_y, j % SQUARE);
        assert_in_range(first_x, 31 * (i / SQUARE) / 3, 31 * (i / SQUARE + 1) / 3 - SQUARE);
        assert_in_range(first_y, 26 * (j / SQUARE) / 3, 26 * (j / SQUARE + 1) / 3 - SQUARE);
    }
    weft_texel_subset_free(&subset);
    unlink(path);
}

static void scattered_texels_are_one_of_every_cell(void **state)
{
    (void)state;
    fixture_far_dataset(path, 24, 20, 2, by_place, FIXTURE_MASK_NONE);
    weft_texel_subset subset = read_subset(WEFT_TEXEL_SUBSET_SCATTERED, 6);
    assert_int_equal(subset.layout.width, 6);
    assert_int_equal(subset.layout.height, 6);
    int phases = 0;
    for (int texel = 0; texel < 36; texel++) {
        int x, y;
        place_of(&subset, texel, &x, &y);
        assert_in_range(x, 4 * (texel % 6), 4 * (texel % 6) + 3);
        assert_in_range(y, 20 * (texel / 6) / 6, 20 * (texel / 6 + 1) / 6 - 1);
        phases |= 1 << x % 4;
    }
    assert_int_equal(phases, 15);
    weft_texel_subset_free(&subset);
    unlink(path);
}

/* Of 31 x 26 texels: 4 x 4 single ones, then all whole texels of levels 2 and 3 and as many as 8 x 8 of level 1. */
static void texels_of_levels_are_means_of_what_they_cover(void **state)
{
    (void)state;
    enum { SIDE = 4, COUNT = 16 + 64 + 42 + 9 };
    weft_dataset *dataset;
    weft_texel_subset subset;
    weft_error error = {0};
    uint8_t *level;
    int of_level[WEFT_TEXEL_SUBSET_LAST_LEVEL + 1] = {0}, places[WEFT_TEXEL_SUBSET_LAST_LEVEL + 1] = {0}, odd = 0;
    fixture_far_dataset(path, 31, 26, 2, by_place, FIXTURE_MASK_NONE);
    expect_ok(weft_dataset_open(path, &dataset, &error), &error);
    expect_ok(weft_texel_subset_read_levels(dataset, SIDE, &subset, &level, &error), &error);
    weft_dataset_close(dataset);
    assert_int_equal(subset.layout.width, SIDE);
    assert_int_equal(subset.layout.height, (COUNT + SIDE - 1) / SIDE);
    for (int texel = 0; texel < subset.layout.width * subset.layout.height; texel++) {
        const weft_half *half = subset.samples + 3 * (size_t)texel * (size_t)subset.layout.image_count;
        int k = level[texel];
        if (texel >= COUNT) {
            assert_int_equal(k, WEFT_TEXEL_SUBSET_NO_LEVEL);
            continue;
        }
        /* The mean place of a whole texel of its level. */
        double x = 100 * (double)weft_float_of_half(half[0]) - ((1 << k) - 1) / 2.0,
               y = 100 * (double)weft_float_of_half(half[1]) - ((1 << k) - 1) / 2.0;
        assert_int_equal(k, texel < 16 ? 0 : texel < 80 ? 1 : texel < 122 ? 2 : 3);
        assert_true(fabs(x - (1 << k) * round(x / (1 << k))) < 0.05);
        assert_true(fabs(y - (1 << k) * round(y / (1 << k))) < 0.05);
        assert_true(x > -0.05 && y > -0.05 && x + (1 << k) < 31.1 && y + (1 << k) < 26.1);
        places[k] += (int)lround(x / (1 << k)) + 100 * (int)lround(y / (1 << k));
        odd += k == 0 && lround(x) % 2 != lround(y) % 2;
        of_level[k]++;
    }
    assert_int_equal(of_level[2], 7 * 6);
    assert_int_equal(places[2], 6 * 21 + 7 * 1500); /* each once */
    assert_int_equal(of_level[3], 3 * 3);
    assert_int_equal(places[3], 3 * 3 + 3 * 300);
    assert_in_range(odd, 3, 13);
    weft_texel_subset_free(&subset);
    free(level);
    unlink(path);
}

/* Two by two squares of 16 x 16 neighbours, each somewhere in its quarter of the dataset, and not all at the same
 * place.
 */
static void squares_are_one_of_every_cell(void **state)
{
    (void)state;
    enum { SIDE = 32, SQUARE = 16 };
    fixture_far_dataset(path, 56, 60, 2, by_place, FIXTURE_MASK_NONE);
    weft_texel_subset subset = read_subset(WEFT_TEXEL_SUBSET_PATCHES, SIDE);
    int first_x[4], first_y[4];
    assert_int_equal(subset.layout.width, SIDE);
    assert_int_equal(subset.layout.height, SIDE);
    for (int texel = 0; texel < SIDE * SIDE; texel++) {
        int i = texel % SIDE, j = texel / SIDE, square = 2 * (j / SQUARE) + i / SQUARE, x, y;
        place_of(&subset, texel, &x, &y);
        if (i % SQUARE == 0 && j % SQUARE == 0) {
            first_x[square] = x;
            first_y[square] = y;
            assert_in_range(x, 28 * (square % 2), 28 * (square % 2) + 28 - SQUARE);
            assert_in_range(y, 30 * (square / 2), 30 * (square / 2) + 30 - SQUARE);
        }
        assert_int_equal(x, first_x[square] + i % SQUARE);
        assert_int_equal(y, first_y[square] + j % SQUARE);
    }
    assert_true(first_x[1] - first_x[0] != 28 || first_x[3] - first_x[2] != 28);
    weft_texel_subset_free(&subset);
    subset = read_subset(WEFT_TEXEL_SUBSET_PATCHES, 64);
    for (int texel = 0; texel < 56 * 60; texel++) {
        int x, y;
        place_of(&subset, texel, &x, &y);
        assert_int_equal(x + 56 * y, texel);
    }
    weft_texel_subset_free(&subset);
    unlink(path);
}

static weft_rgb by_directions(int x, int y, weft_vec3 light, weft_vec3 view)
{
    return (weft_rgb){0.01 * x, 0.01 * y, 0.3 + 0.3 * view.x + 0.3 * light.y};
}

/* A regular choice and a block see lights from where their texels lie. */
static void texels_of_a_near_dataset_keep_their_directions(void **state)
{
    (void)state;
    fixture_near_dataset(path, 31, 5, by_directions);
    weft_dataset *dataset;
    assert_int_equal(weft_dataset_open(path, &dataset, NULL), WEFT_OK);
    const weft_dataset_layout *whole = weft_dataset_get_layout(dataset);
    for (int kind = WEFT_TEXEL_SUBSET_REGULAR; kind <= WEFT_TEXEL_SUBSET_BLOCK; kind++) {
        weft_texel_subset subset = read_subset((weft_texel_subset_kind)kind, 6);
        int stride = kind == WEFT_TEXEL_SUBSET_REGULAR ? 5 : 1, first = kind == WEFT_TEXEL_SUBSET_REGULAR ? 2 : 12;
        for (int texel = 0; texel < 36; texel++) {
            int i = texel % 6, j = texel / 6, x = first + stride * i, y = first + stride * j;
            uint8_t mask[5];
            weft_half sample[15];
            assert_int_equal(weft_dataset_read_block(dataset, x, y, 1, 1, sample, mask, NULL), WEFT_OK);
            assert_memory_equal(sample, subset.samples + (size_t)15 * (size_t)texel, sizeof sample);
            for (int image = 0; image < 5; image++) {
                weft_vec3 a = weft_dataset_light_direction(whole, image, x, y);
                weft_vec3 b = weft_dataset_light_direction(&subset.layout, image, i, j);
                assert_true(weft_length(weft_subtract(a, b)) < 1e-6);
                a = weft_dataset_view_direction(whole, whole->view_of_image[image], x, y);
                b = weft_dataset_view_direction(&subset.layout, subset.layout.view_of_image[image], i, j);
                assert_true(weft_length(weft_subtract(a, b)) < 1e-6);
            }
        }
        weft_texel_subset_free(&subset);
    }
    weft_dataset_close(dataset);
    unlink(path);
}

/* Opacity and frames go along; what is held out does not, and no file is left. */
static void what_is_written_lacks_what_is_held_out(void **state)
{
    (void)state;
    enum { KEPT = 6, VIEWS = 4, ALL = 8 };
    float opacity[VIEWS] = {0.125f, 0.25f, 0.5f, 1}, frame[6] = {0, 0.6f, 0.8f, 1, 0, 0};
    weft_half samples[3 * ALL];
    uint8_t mask[ALL] = {0};
    const uint8_t held[ALL] = {0, 0, 0, WEFT_HELD_VIEW, WEFT_HELD_VIEW, 0, 0, 0};
    weft_texel_subset subset = {
        .layout = {.width = 1, .height = 1, .image_count = ALL, .view_count = VIEWS, .texel_pitch_mm = 1},
        .samples = samples,
        .mask = mask,
        .opacity = opacity,
        .frames = frame};
    assert_int_equal(weft_dataset_layout_allocate(&subset.layout, NULL), WEFT_OK);
    for (int i = 0; i < ALL; i++) {
        subset.layout.light[i] = weft_direction_of_angles(weft_ubo81_angles(i));
        subset.layout.view_of_image[i] = i < 3 ? 0 : i < 5 ? 1 : i < 6 ? 2 : 3;
        samples[3 * i] = samples[3 * i + 1] = samples[3 * i + 2] = weft_half_of_float((float)i);
    }
    for (int view = 0; view < VIEWS; view++)
        subset.layout.view[view] = weft_direction_of_angles(weft_ubo81_angles(10 * view));
    weft_dataset *dataset;
    weft_error error = {0};
    expect_ok(weft_texel_subset_write(&subset, held, scratch, &dataset, &error), &error);
    assert_int_not_equal(access(scratch, F_OK), 0);
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    assert_int_equal(layout->image_count, KEPT);
    assert_int_equal(layout->view_count, 3);
    weft_half read[3 * KEPT];
    float read_opacity[3], read_frame[6];
    expect_ok(weft_dataset_read_block(dataset, 0, 0, 1, 1, read, NULL, &error), &error);
    static const int image[KEPT] = {0, 1, 2, 5, 6, 7}, view_of[KEPT] = {0, 0, 0, 1, 2, 2};
    for (int i = 0; i < KEPT; i++) {
        assert_float_equal(weft_float_of_half(read[3 * i]), image[i], 1e-6);
        assert_int_equal(layout->view_of_image[i], view_of[i]);
    }
    assert_true(weft_dot(layout->view[1], weft_direction_of_angles(weft_ubo81_angles(20))) > 0.99999);
    expect_ok(weft_dataset_read_opacity(dataset, 0, 1, read_opacity, &error), &error);
    assert_float_equal(read_opacity[1], 0.5, 0.003);
    expect_ok(weft_dataset_read_frames(dataset, 0, 1, read_frame, &error), &error);
    assert_float_equal(read_frame[1], 0.6, 0.001);
    weft_dataset_close(dataset);
    weft_dataset_layout_free(&subset.layout);
}

/* ---- Errors ---- */

/* Held-out images of the first split of what fixture_far_dataset writes, found again by direction in a reflectance. */
static weft_dataset_layout spoilt_layout;
static weft_splits spoilt;
static double spoilt_factor;

static int nearest(const weft_vec3 *direction, int count, weft_vec3 wanted)
{
    int best = 0;
    for (int i = 1; i < count; i++)
        best = weft_dot(direction[i], wanted) > weft_dot(direction[best], wanted) ? i : best;
    return best;
}

static weft_rgb spoilt_diffuse(int x, int y, weft_vec3 light, weft_vec3 view)
{
    (void)x, (void)y;
    int v = nearest(spoilt_layout.view, DIRECTIONS, view), l = nearest(spoilt_layout.light, DIRECTIONS, light);
    double rho = spoilt.held[v * DIRECTIONS + l] ? 0.3 * spoilt_factor : 0.3;
    return (weft_rgb){rho, rho, rho};
}

static weft_hold_out measure(const weft_compress_options *options, int splits)
{
    weft_dataset *dataset;
    weft_hold_out result;
    weft_error error = {0};
    expect_ok(weft_dataset_open(path, &dataset, &error), &error);
    expect_ok(weft_hold_out_measure(dataset, options, splits, scratch, NULL, &result, &error), &error);
    weft_dataset_close(dataset);
    return result;
}

/* Images that are held out and twenty times as bright as all others stay unknown to the fit and to the interpolation:
 * both say a twentieth of them, whose error is 19 / 20. */
static void what_is_held_out_does_not_leak(void **state)
{
    (void)state;
    spoilt_layout = grid_layout(0);
    spoilt = split(&spoilt_layout, 0, 1);
    spoilt_factor = 20;
    fixture_far_dataset(path, 2, 1, 6, spoilt_diffuse, FIXTURE_MASK_NONE);
    weft_compress_options options = weft_compress_default_options();
    options.component_count = 0;
    weft_hold_out result = measure(&options, 1);
    assert_int_equal(result.kind, WEFT_SPLIT_DIRECTIONS);
    const weft_error_summary *all[4] = {&result.material.all, &result.material.view, &result.material.light,
                                        &result.material.both};
    for (int i = 0; i < 4; i++)
        assert_float_equal(all[i]->relative_rmse, 0.95, 0.003);
    assert_float_equal(result.photographs.all.relative_rmse, 0.95, 0.003);
    assert_true(result.fitted.relative_rmse < 0.02);
    assert_int_equal(result.material.all.count, 3 * 2 * (2 * 8 * DIRECTIONS - 64));
    assert_int_equal(result.material.both.count, 3 * 2 * 64);
    assert_int_equal(result.image_held_count, 2 * 8 * DIRECTIONS - 64);
    weft_splits_free(&spoilt);
    weft_dataset_layout_free(&spoilt_layout);
    unlink(path);
}

/* Nothing that a table of views, a lobe or a diffuse term would follow exactly. */
static weft_rgb curved(int x, int y, weft_vec3 light, weft_vec3 view)
{
    double value = 0.2 + 0.05 * x + 0.03 * y + 0.4 * light.x * light.x * view.y * view.y + 0.1 * view.x;
    return (weft_rgb){value, 0.5 * value, value * value};
}

/* A diffuse term is the only model whose least squares are written in one line: rho = sum s l_z / sum l_z^2. */
static double curved_error(const weft_dataset_layout *layout, const uint8_t *held, const uint8_t *asked, int flags)
{
    double error = 0, energy = 0;
    for (int texel = 0; texel < 6; texel++) {
        double sum[3] = {0}, weight = 0;
        for (int i = 0; i < IMAGES; i++) {
            weft_vec3 l = layout->light[i];
            weft_rgb f = curved(texel % 3, texel / 3, l, layout->view[layout->view_of_image[i]]);
            const double s[3] = {f.r * l.z, f.g * l.z, f.b * l.z};
            for (int c = 0; !held[i] && c < 3; c++)
                sum[c] += s[c] * l.z;
            weight += held[i] ? 0 : l.z * l.z;
        }
        for (int i = 0; i < IMAGES; i++) {
            weft_vec3 l = layout->light[i];
            weft_rgb f = curved(texel % 3, texel / 3, l, layout->view[layout->view_of_image[i]]);
            const double s[3] = {f.r * l.z, f.g * l.z, f.b * l.z};
            if (!asked[i] || (asked != held && held[i]) || (flags && asked[i] != flags))
                continue;
            for (int c = 0; c < 3; c++) {
                error += (sum[c] / weight * l.z - s[c]) * (sum[c] / weight * l.z - s[c]);
                energy += s[c] * s[c];
            }
        }
    }
    return sqrt(error / energy);
}

static void the_error_of_a_diffuse_term_is_that_computed_by_hand(void **state)
{
    (void)state;
    weft_dataset_layout layout = grid_layout(0);
    weft_splits splits = split(&layout, 0, 3);
    fixture_far_dataset(path, 3, 2, 6, curved, FIXTURE_MASK_NONE);
    weft_compress_options options = weft_compress_default_options();
    options.component_count = 0;
    options.lobe_count = 0;
    weft_hold_out one = measure(&options, 1), two = measure(&options, 2);
    const uint8_t *held = weft_splits_held(&splits, 0), *next = weft_splits_held(&splits, 1);
    assert_float_equal(one.material.all.relative_rmse, curved_error(&layout, held, held, 0), 1e-3);
    assert_float_equal(one.material.view.relative_rmse, curved_error(&layout, held, held, WEFT_HELD_VIEW), 1e-3);
    assert_float_equal(one.material.light.relative_rmse, curved_error(&layout, held, held, WEFT_HELD_LIGHT), 1e-3);
    assert_float_equal(one.material.both.relative_rmse,
                       curved_error(&layout, held, held, WEFT_HELD_VIEW | WEFT_HELD_LIGHT), 1e-3);
    assert_float_equal(one.fitted.relative_rmse, curved_error(&layout, held, next, 0), 1e-3);
    double mean = 0.5 * (curved_error(&layout, held, held, 0) + curved_error(&layout, next, next, 0));
    assert_float_equal(two.material.all.relative_rmse, mean, 1e-3);
    assert_int_equal(two.split_count, 2);
    weft_splits_free(&splits);
    weft_dataset_layout_free(&layout);
    unlink(path);
}

int test_hold_out(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_tenth_of_views_and_lights_between_others_is_held_out_once),
        cmocka_unit_test(what_is_held_out_is_spread_over_the_hemisphere),
        cmocka_unit_test(a_split_depends_on_the_seed_alone),
        cmocka_unit_test(lights_that_jitter_are_held_out_with_their_neighbours),
        cmocka_unit_test(every_image_of_a_list_is_held_out_once),
        cmocka_unit_test(of_one_view_lights_are_held_out),
        cmocka_unit_test(few_directions_are_held_out_more_than_once),
        cmocka_unit_test(a_handful_is_left_out_one_by_one),
        cmocka_unit_test(small_squares_are_one_of_every_cell),
        cmocka_unit_test(scattered_texels_are_one_of_every_cell),
        cmocka_unit_test(texels_of_levels_are_means_of_what_they_cover),
        cmocka_unit_test(squares_are_one_of_every_cell),
        cmocka_unit_test(texels_of_a_near_dataset_keep_their_directions),
        cmocka_unit_test(what_is_written_lacks_what_is_held_out),
        cmocka_unit_test(what_is_held_out_does_not_leak),
        cmocka_unit_test(the_error_of_a_diffuse_term_is_that_computed_by_hand),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
