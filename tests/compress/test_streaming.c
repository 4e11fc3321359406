/* The parts of compressing out of core, each by itself. */
#include "tests/support/cmocka_all.h"

#include "base/processor.h"
#include "btf/dataset/fingerprint.h"
#include "compress/run/checkpoint.h"
#include "compress/run/memory.h"
#include "compress/run/mip_pyramid.h"
#include "tests/support/synthetic_dataset.h"
#include "tests/support/tiny_dataset.h"

#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* ---- Plan ---- */

static int chain_top(int width, int height)
{
    int top = 0;
    for (int side = width > height ? width : height; side > 1; side = (side + 1) / 2)
        top++;
    return top;
}

/* Every texel of every level must be finished by exactly one block, the last one that holds a part of it. */
static void check_plan(int width, int height, int side_level)
{
    weft_block_plan plan;
    int top = chain_top(width, height);
    int *covered = calloc((size_t)width * (size_t)height, sizeof *covered);
    assert_non_null(covered);
    assert_int_equal(weft_block_plan_create(width, height, side_level, top, &plan, NULL), WEFT_OK);
    for (size_t i = 0; i < plan.count; i++) {
        weft_block_place own = weft_block_place_at(&plan.place[i], 0);
        for (int texel = 0; texel < own.width * own.height; texel++)
            covered[(own.y + texel / own.width) * width + own.x + texel % own.width]++;
    }
    for (int texel = 0; texel < width * height; texel++)
        assert_int_equal(covered[texel], 1);
    for (int level = side_level + 1; level <= top; level++) {
        int x_count = (width + (1 << level) - 1) >> level, y_count = (height + (1 << level) - 1) >> level, groups = 0;
        for (size_t i = 0; i < plan.count; i++) {
            bool last = true;
            for (size_t j = i + 1; j < plan.count; j++)
                last = last && (plan.place[i].x >> level != plan.place[j].x >> level ||
                                plan.place[i].y >> level != plan.place[j].y >> level);
            assert_int_equal(plan.finished[i] >= level, last);
            groups += last;
        }
        assert_int_equal(groups, x_count * y_count);
    }
    weft_block_plan_free(&plan);
    free(covered);
}

static void a_plan_covers_each_texel_and_finishes_each_group_once(void **state)
{
    (void)state;
    const int size[][2] = {{1, 1}, {5, 3}, {37, 20}, {16, 16}, {50, 1}, {1, 33}};
    for (size_t i = 0; i < sizeof size / sizeof *size; i++) {
        for (int level = 0; level <= 4 && level <= chain_top(size[i][0], size[i][1]); level++)
            check_plan(size[i][0], size[i][1], level);
    }
}

/* ---- Sums ---- */

enum { IMAGES = 21, WIDE = 21, HIGH = 13 };

static weft_half all_samples[WIDE * HIGH * IMAGES * 3];
static uint8_t all_masks[WIDE * HIGH * IMAGES], held_out[IMAGES];

static void invent_samples(void)
{
    for (size_t i = 0; i < sizeof all_masks; i++) {
        all_masks[i] = i % 11 == 0 ? WEFT_MASK_SATURATED : 0;
        for (size_t k = 0; k < 3; k++)
            all_samples[3 * i + k] = weft_half_of_float(0.001f * (float)((i * 7919 + k * 104729) % 4001));
    }
    held_out[4] = 1;
}

static void copy_block(const weft_block_place *place, weft_half *samples, uint8_t *mask)
{
    for (int y = 0; y < place->height; y++) {
        size_t from = (size_t)((place->y + y) * WIDE + place->x) * IMAGES, count = (size_t)place->width * IMAGES;
        size_t to = (size_t)(y * place->width) * IMAGES;
        memcpy(samples + 3 * to, all_samples + 3 * from, 3 * count * sizeof *samples);
        memcpy(mask + to, all_masks + from, count);
    }
}

/* The sums of every texel of a level, from blocks of one size. */
static void collect_level(int side_level, int level, float *result)
{
    static weft_half samples[WIDE * HIGH * IMAGES * 3];
    static uint8_t mask[WIDE * HIGH * IMAGES];
    weft_block_plan plan;
    weft_pyramid pyramid;
    weft_thread_pool *pool;
    int level_width = (WIDE + (1 << level) - 1) >> level;
    assert_int_equal(weft_block_plan_create(WIDE, HIGH, side_level, chain_top(WIDE, HIGH), &plan, NULL), WEFT_OK);
    assert_int_equal(weft_pyramid_create(&plan, held_out, IMAGES, 2, &pyramid, NULL), WEFT_OK);
    assert_int_equal(weft_thread_pool_create(2, &pool, NULL), WEFT_OK);
    for (size_t i = 0; i < plan.count; i++) {
        const weft_block_samples block = {plan.place[i], samples, mask};
        copy_block(&block.place, samples, mask);
        weft_pyramid_sum_block(&pyramid, pool, &block);
        weft_pyramid_pass_up(&pyramid, plan.finished[i]);
        weft_block_place own = weft_block_place_at(&block.place, level);
        for (int n = 0; level <= plan.finished[i] && n < own.width * own.height; n++) {
            int x = own.x + n % own.width, y = own.y + n / own.width;
            memcpy(result + (size_t)(y * level_width + x) * 4 * IMAGES,
                   weft_pyramid_group(&pyramid, &block.place, level, x, y), 4 * IMAGES * sizeof *result);
        }
        weft_pyramid_clear_finished(&pyramid, plan.finished[i]);
    }
    weft_thread_pool_free(pool);
    weft_pyramid_free(&pyramid);
    weft_block_plan_free(&plan);
}

static void sums_do_not_depend_on_the_blocks(void **state)
{
    (void)state;
    static float expected[WIDE * HIGH * 4 * IMAGES], found[WIDE * HIGH * 4 * IMAGES];
    invent_samples();
    for (int level = 1; level <= chain_top(WIDE, HIGH); level++) {
        memset(expected, 0, sizeof expected);
        collect_level(0, level, expected);
        for (int side_level = 1; side_level <= chain_top(WIDE, HIGH); side_level++) {
            memset(found, 0, sizeof found);
            collect_level(side_level, level, found);
            assert_memory_equal(found, expected, sizeof found);
        }
    }
    /* The last level is the sum of everything. */
    for (size_t image = 0; image < IMAGES; image++) {
        double sum = 0, count = 0;
        for (size_t texel = 0; texel < WIDE * HIGH; texel++) {
            size_t i = texel * IMAGES + image;
            if (all_masks[i] || held_out[image])
                continue;
            sum += (double)weft_float_of_half(all_samples[3 * i + 1]);
            count += 1;
        }
        assert_float_equal((double)expected[3 * image + 1], sum, 1e-3);
        assert_float_equal((double)expected[3 * IMAGES + image], count, 0);
    }
}

static void masked_samples_are_counted_and_do_not_count(void **state)
{
    (void)state;
    float group[4 * IMAGES];
    invent_samples();
    all_samples[3 * 11] = 0x7e00; /* NaN, masked */
    long masked = weft_group_of_texel(all_samples, all_masks, held_out, IMAGES, group);
    assert_int_equal(masked, 2);
    for (size_t i = 0; i < IMAGES; i++) {
        bool counts = i % 11 != 0 && i != 4;
        assert_true(group[3 * IMAGES + i] == (counts ? 1.0f : 0.0f));
        for (size_t k = 0; k < 3; k++)
            assert_true(group[3 * i + k] == (counts ? weft_float_of_half(all_samples[3 * i + k]) : 0.0f));
    }
}

enum { FINITE_HALVES = 0x7c00 };

/* Every half float, by every instruction set that this processor has. */
static void denormals_off_lose_no_sample(void **state)
{
    (void)state;
    static weft_half samples[3 * FINITE_HALVES];
    static uint8_t mask[FINITE_HALVES];
    static float group[4 * FINITE_HALVES];
    for (size_t i = 0; i < 3 * FINITE_HALVES; i++)
        samples[i] = (weft_half)(i % FINITE_HALVES);
    for (int set = 0; set <= (int)weft_processor_best(); set++) {
        weft_processor_limit((weft_instruction_set)set);
        unsigned before = weft_denormals_off();
        weft_group_of_texel(samples, mask, NULL, FINITE_HALVES, group);
        weft_denormals_restore(before);
        for (size_t i = 0; i < 3 * FINITE_HALVES; i++)
            assert_true(group[i] == weft_float_of_half(samples[i]));
    }
    weft_processor_limit(WEFT_INSTRUCTION_SETS);
}

/* ---- Threads ---- */

static atomic_int done[1000];

static void count_item(void *context, long item, int thread)
{
    assert_in_range(thread, 0, *(int *)context - 1);
    atomic_fetch_add(&done[item], 1);
}

static void a_crew_does_every_item_once(void **state)
{
    (void)state;
    for (int threads = 1; threads <= 9; threads += 4) {
        weft_thread_pool *pool;
        assert_int_equal(weft_thread_pool_create(threads, &pool, NULL), WEFT_OK);
        for (long count = 0; count <= 1000; count = 10 * count + 1 > 1000 ? count + 889 : 10 * count + 1) {
            memset(done, 0, sizeof done);
            weft_thread_pool_run(pool, count_item, &threads, count);
            for (long i = 0; i < 1000; i++)
                assert_int_equal(done[i], i < count);
        }
        weft_thread_pool_free(pool);
    }
}

/* ---- Reading ahead ---- */

static void blocks_come_in_order_and_whole(void **state)
{
    (void)state;
    weft_dataset_layout layout = tiny_layout(11, 6, 3, 4);
    assert_int_equal(tiny_dataset_write("ahead.btf.h5", &layout, tiny_distinct, NULL), WEFT_OK);
    weft_dataset *dataset = synthetic_dataset_open("ahead.btf.h5");
    const weft_block_place place[3] = {{0, 0, 4, 4}, {8, 4, 3, 2}, {4, 0, 4, 4}};
    weft_half expected[16 * 12 * 3];
    uint8_t expected_mask[16 * 12];
    for (size_t given = 0; given <= 3; given++) { /* freed before the end, too */
        weft_block_reader *reader;
        const weft_block_samples *block;
        assert_int_equal(weft_block_reader_create(dataset, place, 3, 16, &reader, NULL), WEFT_OK);
        weft_block_reader_next(reader, &block, NULL);
        weft_block_reader_free(reader);
        assert_int_equal(weft_block_reader_create(dataset, place, given, 16, &reader, NULL), WEFT_OK);
        for (size_t i = 0; i < given; i++) {
            assert_int_equal(weft_block_reader_next(reader, &block, NULL), WEFT_OK);
            assert_memory_equal(&block->place, &place[i], sizeof place[i]);
            size_t samples = (size_t)(place[i].width * place[i].height) * 12;
            assert_int_equal(weft_dataset_read_block(dataset, place[i].x, place[i].y, place[i].width, place[i].height,
                                                     expected, expected_mask, NULL),
                             WEFT_OK);
            assert_memory_equal(block->samples, expected, 3 * samples * sizeof *expected);
            assert_memory_equal(block->mask, expected_mask, samples);
        }
        assert_int_equal(weft_block_reader_next(reader, &block, NULL), WEFT_BAD_USAGE);
        weft_block_reader_free(reader);
    }
    weft_dataset_close(dataset);
    weft_dataset_layout_free(&layout);
}

static void an_error_of_reading_reaches_the_caller(void **state)
{
    (void)state;
    weft_dataset *dataset = synthetic_dataset_open("ahead.btf.h5");
    const weft_block_place place[2] = {{0, 0, 4, 4}, {8, 4, 4, 2}}; /* the second is outside */
    weft_block_reader *reader;
    const weft_block_samples *block;
    weft_error error = {0};
    assert_int_equal(weft_block_reader_create(dataset, place, 2, 16, &reader, NULL), WEFT_OK);
    assert_int_equal(weft_block_reader_next(reader, &block, &error), WEFT_OK);
    assert_int_equal(weft_block_reader_next(reader, &block, &error), WEFT_BAD_USAGE);
    assert_non_null(strstr(error.message, "4 x 2 texels at (8, 4)"));
    weft_block_reader_free(reader);
    weft_dataset_close(dataset);
}

static void a_small_cache_reads_the_same(void **state)
{
    (void)state;
    weft_dataset *dataset = synthetic_dataset_open("ahead.btf.h5");
    weft_half before[66 * 36], after[66 * 36];
    uint8_t mask_before[66 * 12], mask_after[66 * 12];
    uint64_t bytes;
    assert_int_equal(weft_dataset_read_block(dataset, 0, 0, 11, 6, before, mask_before, NULL), WEFT_OK);
    assert_int_equal(weft_dataset_limit_cache(dataset, &bytes, NULL), WEFT_OK);
    assert_in_range(bytes, 1, 16 << 20);
    assert_int_equal(weft_dataset_read_block(dataset, 0, 0, 11, 6, after, mask_after, NULL), WEFT_OK);
    assert_memory_equal(before, after, sizeof before);
    assert_memory_equal(mask_before, mask_after, sizeof mask_before);
    weft_dataset_close(dataset);
}

/* ---- Checkpoints ---- */

static void records_come_back_in_order(void **state)
{
    (void)state;
    const weft_checkpoint_identity identity = {"program", "dataset", "options"};
    char why[WEFT_MESSAGE_SIZE];
    weft_checkpoint *checkpoint;
    unlink("records.partial");
    for (int round = 0; round < 3; round++) {
        assert_int_equal(weft_checkpoint_open("records.partial", &identity, &checkpoint, why, NULL), WEFT_OK);
        assert_string_equal(why, "");
        assert_int_equal(weft_checkpoint_unread(checkpoint), round);
        for (int i = 0; i < round; i++) {
            weft_record record;
            int number = -1;
            char rest[64];
            assert_int_equal(weft_checkpoint_read(checkpoint, &record, NULL), WEFT_OK);
            weft_record_transfer(&record, &number, sizeof number);
            assert_int_equal(number, i);
            weft_record_transfer(&record, rest, sizeof rest); /* more than there is */
            assert_true(record.failed);
            free(record.bytes);
        }
        weft_record record = {0};
        weft_record_transfer(&record, &round, sizeof round);
        assert_int_equal(weft_checkpoint_unread(checkpoint), 0);
        assert_int_equal(weft_checkpoint_append(checkpoint, &record, NULL), WEFT_OK);
        assert_int_equal(weft_checkpoint_unread(checkpoint), 0);
        free(record.bytes);
        weft_checkpoint_close(checkpoint);
    }
    weft_checkpoint_identity other = identity;
    other.program = "programme";
    assert_int_equal(weft_checkpoint_open("records.partial", &other, &checkpoint, why, NULL), WEFT_OK);
    assert_non_null(strstr(why, "another version"));
    assert_int_equal(weft_checkpoint_unread(checkpoint), 0);
    weft_checkpoint_close(checkpoint);
    assert_int_not_equal(access("records.partial", F_OK), 0); /* none without records */
}

/* ---- Memory ---- */

static void the_default_is_at_most_a_quarter_of_the_memory(void **state)
{
    (void)state;
    uint64_t physical = (uint64_t)sysconf(_SC_PHYS_PAGES) * (uint64_t)sysconf(_SC_PAGESIZE);
    assert_in_range(weft_memory_default(), 1 << 20, physical / 4);
    assert_in_range(weft_memory_resident(), 1 << 18, physical);
}

/* ---- Fingerprints ---- */

static uint8_t one_sample_brighter(const weft_dataset_layout *layout, int image, int x, int y, float rgb[3])
{
    uint8_t mask = tiny_distinct(layout, image, x, y, rgb);
    if (image == 5 && x == 6 && y == 3) /* one of the texels that are looked at */
        rgb[1] += 1;
    return mask;
}

static weft_dataset_fingerprint fingerprint_of(const weft_dataset_layout *layout, tiny_sample *sample)
{
    weft_dataset_fingerprint result;
    assert_int_equal(tiny_dataset_write("finger.btf.h5", layout, sample, NULL), WEFT_OK);
    weft_dataset *dataset = synthetic_dataset_open("finger.btf.h5");
    assert_int_equal(weft_dataset_fingerprint_take(dataset, &result, NULL), WEFT_OK);
    weft_dataset_close(dataset);
    return result;
}

static void a_fingerprint_tells_layouts_and_samples_apart(void **state)
{
    (void)state;
    weft_dataset_layout layout = tiny_layout(11, 6, 3, 4);
    weft_dataset_fingerprint one = fingerprint_of(&layout, tiny_distinct),
                             again = fingerprint_of(&layout, tiny_distinct);
    weft_dataset_fingerprint brighter = fingerprint_of(&layout, one_sample_brighter);
    layout.light[2] = layout.light[3];
    weft_dataset_fingerprint moved = fingerprint_of(&layout, tiny_distinct);
    assert_int_equal(one.layout, again.layout);
    assert_int_equal(one.samples, again.samples);
    assert_int_equal(one.layout, brighter.layout);
    assert_int_not_equal(one.samples, brighter.samples);
    assert_int_not_equal(one.layout, moved.layout);
    weft_dataset_layout_free(&layout);
}

static void a_material_of_another_dataset_is_noticed(void **state)
{
    (void)state;
    weft_dataset_layout layout = tiny_layout(11, 6, 3, 4);
    weft_dataset_fingerprint own = fingerprint_of(&layout, tiny_distinct);
    weft_dataset *dataset = synthetic_dataset_open("finger.btf.h5");
    char metadata[128], warning[WEFT_MESSAGE_SIZE];
    const struct {
        uint32_t layout, samples;
        const char *expected;
    } all[3] = {{own.layout, own.samples, ""},
                {own.layout, own.samples ^ 1, "the samples differ"},
                {own.layout ^ 1, own.samples, "sizes, lights or views differ"}};
    for (int i = 0; i < 3; i++) {
        snprintf(metadata, sizeof metadata, "{\"dataset\":{\"layout\":\"%08x\",\"samples\":\"%08x\"}}", all[i].layout,
                 all[i].samples);
        assert_int_equal(weft_dataset_fingerprint_compare(dataset, metadata, warning, NULL), WEFT_OK);
        assert_non_null(strstr(warning, all[i].expected));
        assert_int_equal(warning[0] != 0, i > 0);
    }
    assert_int_equal(weft_dataset_fingerprint_compare(dataset, "{}", warning, NULL), WEFT_OK);
    assert_string_equal(warning, "");
    weft_dataset_close(dataset);
    weft_dataset_layout_free(&layout);
}

int test_streaming(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_plan_covers_each_texel_and_finishes_each_group_once),
        cmocka_unit_test(sums_do_not_depend_on_the_blocks),
        cmocka_unit_test(masked_samples_are_counted_and_do_not_count),
        cmocka_unit_test(denormals_off_lose_no_sample),
        cmocka_unit_test(a_crew_does_every_item_once),
        cmocka_unit_test(blocks_come_in_order_and_whole),
        cmocka_unit_test(an_error_of_reading_reaches_the_caller),
        cmocka_unit_test(a_small_cache_reads_the_same),
        cmocka_unit_test(records_come_back_in_order),
        cmocka_unit_test(the_default_is_at_most_a_quarter_of_the_memory),
        cmocka_unit_test(a_fingerprint_tells_layouts_and_samples_apart),
        cmocka_unit_test(a_material_of_another_dataset_is_noticed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
