/* How bright materials of bad input become: the largest value over many random lights and views, between the samples
 * and beyond them, as a share of the ceiling that the samples allow, for every set that leads a fit astray and every
 * number of lobes (docs/notes/lobes.md). */
#include "btf/dataset/dataset.h"
#include "compress/compress.h"
#include "tests/support/adversaries.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define FILE_NAME "brightest.btf.h5"

enum { MOST_LOBES = 3 };

/* Fits, and takes the largest share of the ceiling into `most`. */
static weft_code look(weft_dataset *dataset, const weft_compress_options *options, const adversary_limits *limits,
                      long directions, double *most, weft_error *error)
{
    static uint64_t seed = 1;
    weft_material material;
    weft_compress_report report;
    double share = 0;
    WEFT_TRY(weft_compress(dataset, options, NULL, &material, &report, error));
    weft_code code = adversary_largest_share(&material, limits, seed++, directions, &share, error);
    *most = fmax(*most, share);
    weft_material_free(&material);
    return code;
}

static weft_code look_at_set(const adversary *one, long directions, weft_error *error)
{
    adversary_limits limits;
    weft_dataset *dataset;
    WEFT_TRY(adversary_write(one, FILE_NAME, &limits));
    WEFT_TRY(weft_dataset_open(FILE_NAME, &dataset, error));
    weft_code code = WEFT_OK;
    printf("| %s |", one->name);
    for (int lobes = 1; lobes <= MOST_LOBES && code == WEFT_OK; lobes++) {
        double most = 0;
        weft_compress_options options = weft_compress_default_options();
        options.component_count = 0;
        options.levels = false;
        options.lobe_count = lobes;
        code = look(dataset, &options, &limits, directions / MOST_LOBES, &most, error);
        printf(" %.2f |", most);
        fflush(stdout);
    }
    printf("\n");
    weft_dataset_close(dataset);
    remove(FILE_NAME);
    return code;
}

static void print_head(void)
{
    printf("| set | 1 lobe | 2 lobes | 3 lobes |\n| --- | --- | --- | --- |\n");
}

int main(int argc, char **argv)
{
    long directions = argc > 1 ? atol(argv[1]) : 10000000;
    int first = argc > 2 ? atoi(argv[2]) : 0, last = argc > 2 ? first + 1 : ADVERSARIES;
    if (argc > 3 || directions < 1 || first < 0 || last > ADVERSARIES) {
        fprintf(stderr, "usage: bench_brightest [DIRECTIONS [SET]]\n"
                        "DIRECTIONS: random lights and views a set, shared by all numbers of lobes, default 10000000\n"
                        "SET: from 0, default all\n");
        return WEFT_BAD_USAGE;
    }
    weft_error error = {0};
    weft_code code = WEFT_OK;
    print_head();
    for (int i = first; i < last && code == WEFT_OK; i++)
        code = look_at_set(&adversaries[i], directions, &error);
    if (code != WEFT_OK)
        fprintf(stderr, "bench_brightest: %s\n", error.message);
    return (int)code;
}
