/* The whole job of `weft compress` on an invented dataset: reading, fitting all levels, writing (docs/benchmarks.md).
 */
#include "compress/compress.h"
#include "btf/dataset_blocks.h"
#include "tests/support/synthetic_texel.h"

#include <argp.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

typedef struct job {
    int size, lobe_count;
    const char *directory;
    char dataset[512], material[512];
} job;

static double seconds_of(clockid_t clock)
{
    struct timespec now;
    clock_gettime(clock, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Bands of the three families, so that neighbours along a row are alike. */
static void invent_texel(const weft_dataset_layout *layout, int x, int y, float *scratch, weft_half *samples)
{
    synthetic_kind kind = (synthetic_kind)(SYNTHETIC_KINDS * y / layout->height);
    synthetic_texel(layout, kind, (uint64_t)y * (uint64_t)layout->width + (uint64_t)x, 0.01, scratch);
    for (int i = 0; i < 3 * layout->image_count; i++)
        samples[i] = weft_half_of_float(scratch[i]);
}

static weft_code invent_block(weft_dataset_block_writer *writer, const weft_dataset_layout *layout, int x, int y,
                              int width, int height, weft_error *error)
{
    size_t per_texel = 3 * (size_t)layout->image_count, texels = (size_t)width * (size_t)height;
    weft_half *samples = malloc(texels * per_texel * sizeof *samples);
    uint8_t *mask = calloc(texels, (size_t)layout->image_count);
    float *scratch = malloc((size_t)omp_get_max_threads() * per_texel * sizeof *scratch);
    weft_code code = WEFT_OK;
    if (!samples || !mask || !scratch)
        code = weft_fail_memory(error, "a block of texels", texels * per_texel * sizeof *samples);
#pragma omp parallel for schedule(dynamic) if (code == WEFT_OK)
    for (size_t i = 0; i < (code == WEFT_OK ? texels : 0); i++)
        invent_texel(layout, x + (int)(i % (size_t)width), y + (int)(i / (size_t)width),
                     scratch + (size_t)omp_get_thread_num() * per_texel, samples + i * per_texel);
    if (code == WEFT_OK)
        code = weft_dataset_block_writer_put(writer, x, y, width, height, samples, mask, error);
    free(samples);
    free(mask);
    free(scratch);
    return code;
}

static weft_code invent_dataset(const job *given, weft_error *error)
{
    weft_dataset_layout layout;
    weft_dataset_block_writer *writer = NULL;
    int width, height;
    WEFT_TRY(synthetic_layout(given->size, given->size, &layout, error));
    weft_dataset_block_size(&layout, &width, &height);
    weft_code code = weft_dataset_block_writer_create(given->dataset, &layout, &writer, error);
    for (int y = 0; code == WEFT_OK && y < layout.height; y += height) {
        for (int x = 0; code == WEFT_OK && x < layout.width; x += width) {
            int w = width < layout.width - x ? width : layout.width - x;
            int h = height < layout.height - y ? height : layout.height - y;
            code = invent_block(writer, &layout, x, y, w, h, error);
        }
    }
    if (code == WEFT_OK)
        code = weft_dataset_block_writer_finish(writer, "{}", error);
    else
        weft_dataset_block_writer_abandon(writer);
    weft_dataset_layout_free(&layout);
    return code;
}

/* In a process of its own, so that its memory is not taken for that of the job. */
static weft_code invent_apart(const job *given, weft_error *error)
{
    fflush(NULL);
    pid_t child = fork();
    if (child < 0)
        return weft_fail(error, WEFT_SYSTEM, "cannot fork");
    if (child == 0) {
        weft_error own = {0};
        weft_code code = invent_dataset(given, &own);
        if (code != WEFT_OK)
            fprintf(stderr, "bench_compress: %s\n", own.message);
        _exit(code == WEFT_OK ? 0 : 1);
    }
    int status;
    if (waitpid(child, &status, 0) != child || status != 0)
        return weft_fail(error, WEFT_SYSTEM, "'%s' was not written", given->dataset);
    return WEFT_OK;
}

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
    double began = seconds_of(CLOCK_MONOTONIC);
    for (int y = 0; code == WEFT_OK && y < layout->height; y += height) {
        for (int x = 0; code == WEFT_OK && x < layout->width; x += width) {
            int w = width < layout->width - x ? width : layout->width - x;
            int h = height < layout->height - y ? height : layout->height - y;
            code = weft_dataset_read_block(dataset, x, y, w, h, values, mask, error);
        }
    }
    *seconds = seconds_of(CLOCK_MONOTONIC) - began;
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
    WEFT_TRY(invent_apart(given, error));
    WEFT_TRY(read_all(given, &reading, error));
    double wall = seconds_of(CLOCK_MONOTONIC), processor = seconds_of(CLOCK_PROCESS_CPUTIME_ID);
    WEFT_TRY(compress(given, &report, error));
    wall = seconds_of(CLOCK_MONOTONIC) - wall;
    processor = seconds_of(CLOCK_PROCESS_CPUTIME_ID) - processor;
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    double megabytes = 6e-6 * (double)report.sample_count;
    printf("%d x %d texels, %ld fits of a texel in all levels, %d lobes + T, %.0f MB of half floats, %d threads\n",
           given->size, given->size, report.texel_count, report.lobe_count, megabytes, omp_get_max_threads());
    printf("  whole job    %8.2f s by the wall, %8.2f s of processor, %.0f MB/s\n", wall, processor, megabytes / wall);
    printf("  reading only %8.2f s by the wall, %.0f MB/s\n", reading, megabytes / reading);
    printf("  a channel of a texel %.0f us of processor; peak memory %.0f MB\n",
           1e6 * processor / (3.0 * (double)report.texel_count), (double)usage.ru_maxrss / 1000);
    return WEFT_OK;
}

static const struct argp_option option[] = {
    {"size", 's', "N", 0, "N x N texels, 1 to 1024 (default 32); 256 is 3.4 GB of temporary file", 0},
    {"lobes", 'l', "K", 0, "Lobes, 0 to 3 (default 2)", 0},
    {"directory", 'd', "DIR", 0, "Where the temporary files go (default TMPDIR or /tmp)", 0},
    {0},
};

static int whole_number(const char *text, int low, int high, struct argp_state *state)
{
    char *end;
    long value = strtol(text, &end, 10);
    if (end == text || *end || value < low || value > high)
        argp_error(state, "'%s' is not a number from %d to %d", text, low, high);
    return (int)value;
}

static error_t parse_option(int key, char *text, struct argp_state *state)
{
    job *to = state->input;
    switch (key) {
    case 's':
        to->size = whole_number(text, 1, 1024, state);
        return 0;
    case 'l':
        to->lobe_count = whole_number(text, 0, 3, state);
        return 0;
    case 'd':
        to->directory = text;
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp parser = {
    .options = option,
    .parser = parse_option,
    .doc = "Times the whole job of `weft compress`, with reading and writing, on a dataset that it invents.",
};

int main(int argc, char **argv)
{
    const char *temporary = getenv("TMPDIR");
    job given = {.size = 32, .lobe_count = 2, .directory = temporary ? temporary : "/tmp"};
    argp_parse(&parser, argc, argv, 0, NULL, &given);
    weft_error error = {0};
    char name[256];
    if (snprintf(name, sizeof name, "%s/bench_compress.XXXXXX", given.directory) >= (int)sizeof name ||
        !mkdtemp(name)) {
        fprintf(stderr, "bench_compress: cannot make a directory in '%s'\n", given.directory);
        return EXIT_FAILURE;
    }
    snprintf(given.dataset, sizeof given.dataset, "%s/invented.btf.h5", name);
    snprintf(given.material, sizeof given.material, "%s/invented.weft", name);
    weft_code code = run(&given, &error);
    if (code != WEFT_OK)
        fprintf(stderr, "bench_compress: %s\n", error.message);
    unlink(given.dataset);
    unlink(given.material);
    rmdir(name);
    return code == WEFT_OK ? EXIT_SUCCESS : EXIT_FAILURE;
}
