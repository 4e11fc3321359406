#include "base/numeric/statistics.h"
#include "bench/fit/arithmetic_floor.h"
#include "bench/fit/sections.h"
#include "bench/fit/statistics.h"
#include "compress/fit/kernels.h"

#include <stdlib.h>

enum { REPEATS = 201 };

/* What a pass reads and writes beside the samples. */
typedef struct pass_memory {
    float *table, *sums;
} pass_memory;

static weft_gram_point typical_point(int lobe_count)
{
    static const weft_fit_lobe lobe[WEFT_GRAM_LOBES] = {{.c = {-0.9, -0.8, 1}, .log_exponent = 2.5, .amplitude = 0.8},
                                                        {.c = {-0.1, -0.15, 1}, .log_exponent = 0.5, .amplitude = 0.5},
                                                        {.c = {0.8, 0.9, 1}, .log_exponent = 1.5, .amplitude = 0.3}};
    weft_fit fit = {.diffuse = 0.3, .lobe_count = lobe_count, .frame = weft_frame_of_normal(weft_vec3_of(0, 0, 1), 0)};
    for (int i = 0; i < lobe_count; i++)
        fit.lobe[i] = lobe[i];
    return weft_gram_point_of_fit(&fit);
}

static double pass_microseconds(weft_instruction_set set, const texel_source *source, const pass_memory *memory,
                                int lobe_count)
{
    weft_processor_limit(set);
    const weft_gram_point point = typical_point(lobe_count);
    double microseconds[REPEATS];
    for (int i = 0; i < REPEATS; i++) {
        double began = thread_microseconds();
        WEFT_DISPATCH(weft_gram_accumulate)
        (&source->bundle, source->samples.cosine, source->samples.value[0], &point, memory->table, WEFT_PART_ALL,
         memory->sums);
        microseconds[i] = thread_microseconds() - began;
    }
    return weft_quantile(microseconds, REPEATS, 0.5);
}

static double floor_microseconds(weft_instruction_set set, double multiply_adds)
{
    double microseconds[REPEATS];
    volatile float sink = 0;
    for (int i = 0; i < REPEATS; i++) {
        double began = thread_microseconds();
        sink = sink + execute_multiply_adds(set, multiply_adds);
        microseconds[i] = thread_microseconds() - began;
    }
    return weft_quantile(microseconds, REPEATS, 0.5);
}

static void add_row(const bench_plan *plan, weft_instruction_set set, const texel_source *source,
                    const pass_memory *memory, int lobe_count)
{
    int samples = source->bundle.image_count;
    double pass = pass_microseconds(set, source, memory, lobe_count);
    double least = floor_microseconds(set, (double)samples * pass_multiply_adds(lobe_count));
    report_row(plan->report, "%s, %d lobe%s", weft_instruction_set_name(set), lobe_count, lobe_count > 1 ? "s" : "");
    report_number(plan->report, "us a pass", 2, pass);
    report_number(plan->report, "ns a sample", 3, 1000 * pass / samples);
    report_number(plan->report, "us of multiply-adds", 2, least);
    report_number(plan->report, "% of it", 0, 100 * least / pass);
}

static weft_code measure(const bench_plan *plan, texel_source *source, weft_error *error)
{
    size_t views = (size_t)source->bundle.view_stride;
    pass_memory memory = {.table = aligned_alloc(64, views * sizeof(float)),
                          .sums = aligned_alloc(64, WEFT_GRAM_PRODUCTS * views * sizeof(float))};
    weft_code code = texel_source_load(source, 0, 1, false, error);
    if (code == WEFT_OK && (!memory.table || !memory.sums))
        code = weft_fail_memory(error, "sums of a pass", WEFT_GRAM_PRODUCTS * views * sizeof(float));
    if (code == WEFT_OK) {
        for (size_t view = 0; view < views; view++)
            memory.table[view] = 1;
        report_table(plan->report, "pass", "One pass over 6561 samples, with T");
        for (weft_instruction_set set = WEFT_BASELINE; set <= weft_processor_best(); set++) {
            for (int lobes = 1; lobes <= WEFT_GRAM_LOBES; lobes++)
                add_row(plan, set, source, &memory, lobes);
        }
    }
    free(memory.table);
    free(memory.sums);
    return code;
}

weft_code section_pass(const bench_plan *plan, weft_error *error)
{
    texel_source source;
    weft_code code = texel_source_invent(SYNTHETIC_WARD, &source, error);
    if (code == WEFT_OK)
        code = measure(plan, &source, error);
    texel_source_free(&source);
    return code;
}
