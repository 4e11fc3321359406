/* The whole job of `weft compress` on an invented dataset: reading, fitting all levels, writing
 * (docs/notes/benchmarks.md). */
#include "compress/compress.h"
#include "base/clock.h"
#include "btf/dataset/write_blocks.h"
#include "tests/support/synthetic_texel.h"

#include <argp.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

typedef struct job {
    int lobe_count;
    const char *dataset;
    char material[512];
} job;

/* Every block once, thrown away: what reading alone costs. */
static weft_code read_all(const job *given, double *seconds, weft_error *error)
{
    weft_dataset *dataset;
    int width, height;
    WEFT_TRY(weft_dataset_open(given->dataset, &dataset, error));
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    weft_dataset_block_size(layout, &width, &height);
    size_t samples = (size_t)width * (size_t)height * (size_t)layout->image_count;
    weft_half *values = malloc(3 * samples * sizeof *values);
    uint8_t *mask = malloc(samples);
    weft_code code = values && mask ? WEFT_OK : weft_fail_memory(error, "a block", 7 * samples);
    double began = weft_clock_seconds(CLOCK_MONOTONIC);
    for (int y = 0; code == WEFT_OK && y < layout->height; y += height) {
        for (int x = 0; code == WEFT_OK && x < layout->width; x += width) {
            int w = width < layout->width - x ? width : layout->width - x;
            int h = height < layout->height - y ? height : layout->height - y;
            code = weft_dataset_read_block(dataset, x, y, w, h, values, mask, error);
        }
    }
    *seconds = weft_clock_seconds(CLOCK_MONOTONIC) - began;
    free(values);
    free(mask);
    weft_dataset_close(dataset);
    return code;
}

static weft_code compress(const job *given, weft_compress_report *report, weft_error *error)
{
    weft_dataset *dataset;
    weft_material material = {0};
    weft_compress_options options = weft_compress_default_options();
    options.component_count = 0;
    options.lobe_count = given->lobe_count;
    WEFT_TRY(weft_dataset_open(given->dataset, &dataset, error));
    weft_code code = weft_compress(dataset, &options, NULL, &material, report, error);
    if (code == WEFT_OK) {
        code = weft_material_write(given->material, &material, error);
        weft_material_free(&material);
    }
    weft_dataset_close(dataset);
    return code;
}

static weft_code run(const job *given, weft_error *error)
{
    weft_compress_report report = {0};
    double reading = 0;
    WEFT_TRY(read_all(given, &reading, error));
    double wall = weft_clock_seconds(CLOCK_MONOTONIC), processor = weft_clock_seconds(CLOCK_PROCESS_CPUTIME_ID);
    WEFT_TRY(compress(given, &report, error));
    wall = weft_clock_seconds(CLOCK_MONOTONIC) - wall;
    processor = weft_clock_seconds(CLOCK_PROCESS_CPUTIME_ID) - processor;
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    double megabytes = 6e-6 * (double)report.sample_count;
    printf("%ld texels in all levels, %d lobes + T, %.0f MB of half floats, %d threads\n", report.texel_count,
           report.lobe_count, megabytes, omp_get_max_threads());
    printf("  whole job    %8.2f s by the wall, %8.2f s of processor, %.0f MB/s\n", wall, processor, megabytes / wall);
    printf("  reading only %8.2f s by the wall, %.0f MB/s\n", reading, megabytes / reading);
    printf("  a channel of a texel %.0f us of processor; peak memory %.0f MB\n",
           1e6 * processor / (3.0 * (double)report.texel_count), (double)usage.ru_maxrss / 1000);
    return WEFT_OK;
}

static const struct argp_option option[] = {
    {"lobes", 'l', "K", 0, "Lobes, 0 to 3 (default 2)", 0},
    {0},
};

static error_t parse_option(int key, char *text, struct argp_state *state)
{
    job *to = state->input;
    switch (key) {
    case 'l':
        if (strlen(text) != 1 || *text < '0' || *text > '3')
            argp_error(state, "'%s' is not 0, 1, 2 or 3", text);
        to->lobe_count = *text - '0';
        return 0;
    case ARGP_KEY_ARG:
        if (to->dataset)
            argp_error(state, "one dataset at a time");
        to->dataset = text;
        return 0;
    case ARGP_KEY_END:
        if (!to->dataset)
            argp_usage(state);
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp parser = {
    .options = option,
    .parser = parse_option,
    .args_doc = "NAME.btf.h5",
    .doc = "Times the whole job of `weft compress`, with reading and writing. The material is thrown away.",
};

/* An empty file for the material in TMPDIR. */
static weft_code make_material(job *given, weft_error *error)
{
    const char *directory = getenv("TMPDIR");
    snprintf(given->material, sizeof given->material, "%s/bench_compress.XXXXXX", directory ? directory : "/tmp");
    int file = mkstemp(given->material);
    if (file < 0)
        return weft_fail(error, WEFT_SYSTEM, "cannot make '%s'", given->material);
    close(file);
    return WEFT_OK;
}

int main(int argc, char **argv)
{
    job given = {.lobe_count = 2};
    argp_parse(&parser, argc, argv, 0, NULL, &given);
    weft_error error = {0};
    weft_code code = make_material(&given, &error);
    if (code == WEFT_OK) {
        code = run(&given, &error);
        unlink(given.material);
    }
    if (code != WEFT_OK)
        fprintf(stderr, "bench_compress: %s\n", error.message);
    return code == WEFT_OK ? EXIT_SUCCESS : EXIT_FAILURE;
}
