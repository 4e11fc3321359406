/* How bright materials of bad input become: the largest value over many random lights and views, between the samples
 * and beyond them, for every set that leads a fit astray and every kind of model (docs/notes/lobes.md). */
#include "btf/dataset/dataset.h"
#include "compress/compress.h"
#include "tests/support/adversaries.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define FILE_NAME "brightest.btf.h5"

enum { SMALLEST_BUDGET = 4500, BUDGET_STEP = 1000, BUDGETS = 8 };

/* Columns of the table: the largest value of each is printed. */
typedef enum kind { PLAIN, TABLE, LIGHT_TABLE, TARGET, BUDGET, BUDGET_LIGHT, KINDS } kind;

static const char *const name_of_kind[KINDS] = {"no T", "T", "T and S", "error", "budget", "budget with S"};

/* Fits, and takes the largest value over the brightest sample into `most`. A budget that is too small counts as none.
 */
static weft_code look(weft_dataset *dataset, const weft_compress_options *options, const adversary_limits *limits,
                      long directions, double *most, weft_error *error)
{
    static uint64_t seed = 1;
    weft_material material;
    weft_compress_report report;
    double share = 0;
    weft_code code = weft_compress(dataset, options, NULL, &material, &report, error);
    if (code == WEFT_BAD_USAGE && options->budget_bytes > 0)
        return WEFT_OK;
    WEFT_TRY(code);
    code = adversary_largest_share(&material, limits, seed++, directions, &share, error);
    *most = fmax(*most, share * WEFT_BRIGHTEST_MULTIPLE);
    weft_material_free(&material);
    return code;
}

static weft_compress_options options_of(kind own, int lobes, int budget)
{
    weft_compress_options options = weft_compress_default_options();
    options.component_count = 0;
    options.levels = false;
    options.lobe_count = lobes;
    options.table = own != PLAIN;
    options.light_table = own == LIGHT_TABLE || own == TARGET || own == BUDGET_LIGHT;
    options.target_error = own == TARGET ? 0.05 : 0;
    options.budget_bytes =
        (uint64_t)(own == BUDGET || own == BUDGET_LIGHT ? SMALLEST_BUDGET + budget * BUDGET_STEP : 0);
    return options;
}

/* All models of one kind: 0 to 3 lobes, or up to 3 and all budgets. */
static weft_code look_at_kind(weft_dataset *dataset, kind own, const adversary_limits *limits, long directions,
                              double *most, weft_error *error)
{
    bool by_budget = own == BUDGET || own == BUDGET_LIGHT;
    int count = by_budget ? BUDGETS : own == TARGET ? 1 : 4;
    *most = 0;
    for (int i = 0; i < count; i++) {
        weft_compress_options options = options_of(own, by_budget || own == TARGET ? 3 : i, i);
        WEFT_TRY(look(dataset, &options, limits, directions / count, most, error));
    }
    return WEFT_OK;
}

static weft_code look_at_set(const adversary *one, long directions, weft_error *error)
{
    adversary_limits limits;
    weft_dataset *dataset;
    WEFT_TRY(adversary_write(one, FILE_NAME, &limits));
    WEFT_TRY(weft_dataset_open(FILE_NAME, &dataset, error));
    weft_code code = WEFT_OK;
    printf("| %s |", one->name);
    for (kind own = PLAIN; own < KINDS && code == WEFT_OK; own++) {
        double most;
        code = look_at_kind(dataset, own, &limits, directions / KINDS, &most, error);
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
    printf("| set |");
    for (kind own = PLAIN; own < KINDS; own++)
        printf(" %s |", name_of_kind[own]);
    printf("\n| --- |");
    for (kind own = PLAIN; own < KINDS; own++)
        printf(" --- |");
    printf("\n");
}

int main(int argc, char **argv)
{
    long directions = argc > 1 ? atol(argv[1]) : 10000000;
    int first = argc > 2 ? atoi(argv[2]) : 0, last = argc > 2 ? first + 1 : ADVERSARIES;
    if (argc > 3 || directions < 1 || first < 0 || last > ADVERSARIES) {
        fprintf(stderr, "usage: bench_brightest [DIRECTIONS [SET]]\n"
                        "DIRECTIONS: random lights and views a set, shared by all kinds of model, default 10000000\n"
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
