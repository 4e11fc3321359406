/* Runs every search. */
#include "bench/numerics/claims.h"
#include "bench/numerics/glsl.h"
#include "bench/numerics/report.h"

#include "base/text/csv.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const numerics_set *const sets[NUMERICS_COLUMNS] = {&numerics_double, &numerics_float, &numerics_lanes,
                                                           &numerics_stored, NULL};

const numerics_set *numerics_set_of_column(int column)
{
    return sets[column];
}

/* ---- Reference vectors ---- */

/* The number in a column; thread axes are words there. False where the file has no such column or no number. */
static bool cell(const weft_csv *csv, int row, const char *column, double *value)
{
    weft_error error;
    int index = weft_csv_column(csv, column);
    if (index < 0)
        return false;
    const char *text = weft_csv_text(csv, row, index);
    if (strcmp(text, "x") == 0 || strcmp(text, "y") == 0) {
        *value = text[0] == 'y';
        return true;
    }
    return weft_csv_number(csv, row, index, value, &error) == WEFT_OK;
}

static bool read_argument(const weft_csv *csv, int row, const numerics_argument *argument, double *value)
{
    if (numerics_width(argument) == 1)
        return cell(csv, row, argument->name, value);
    for (int i = 0; i < 3; i++) {
        char column[16];
        snprintf(column, sizeof column, "%s%c", argument->name, "xyz"[i]);
        if (!cell(csv, row, column, &value[i]))
            return false;
    }
    return true;
}

/* False where the row is not of this model: staple and filament share their files. */
static bool read_row(const weft_csv *csv, int row, const numerics_domain *domain, bool single, double *argument)
{
    int at = 0;
    for (int i = 0; i < domain->argument_count; i++) {
        const numerics_argument *a = &domain->argument[i];
        if (!read_argument(csv, row, a, argument + at) ||
            (strcmp(a->name, "psi") == 0 && (a->kind == NUMERICS_ZERO) != (argument[at] == 0)))
            return false;
        at += numerics_width(a);
    }
    for (int i = 0; i < at && single; i++)
        argument[i] = numerics_single(argument[i]);
    return true;
}

/* A check looks at fewer rows of what is expensive: the tests of each model look at all. */
static int row_step(numerics_id id, bool bounded_only)
{
    const int rows_alike = 30;
    return bounded_only ? 1 + numerics_claim_of(id)->cost / rows_alike : 1;
}

static numerics_worst measure_vectors(const numerics_set *set, numerics_id id, int step)
{
    const numerics_domain *domain = numerics_domain_of(id);
    numerics_worst worst = {.size = -1};
    weft_csv csv;
    weft_error error;
    char path[512];
    snprintf(path, sizeof path, "%s/reference/%s", WEFT_TEST_DATA, domain->vectors ? domain->vectors : "");
    if (!domain->vectors || weft_csv_read(path, true, &csv, &error) != WEFT_OK)
        return worst;
    for (int row = 0; row < csv.row_count; row += step) {
        double argument[NUMERICS_MAX_ARGUMENTS] = {0};
        if (!read_row(&csv, row, domain, set->single, argument))
            continue;
        numerics_error at = numerics_error_at(set, id, argument, numerics_number_count(domain), false);
        if (at.size[NUMERICS_RELATIVE] > worst.size) {
            worst.size = at.size[NUMERICS_RELATIVE];
            memcpy(worst.argument, argument, sizeof argument);
        }
    }
    weft_csv_free(&csv);
    return worst;
}

/* ---- Searches ---- */

static long budget(numerics_id id, long evaluations)
{
    const long least = 24;
    long share = evaluations / numerics_claim_of(id)->cost;
    return share > least ? share : least;
}

/* What has no bound is searched for the page alone. */
static bool is_wanted(const numerics_set *set, numerics_id id, int objective, bool bounded_only)
{
    bool stored = set == &numerics_stored;
    if (!set || !set->function[id] || stored != (id >= NUMERICS_STORED_HALF))
        return false;
    return !bounded_only || numerics_bound(set, id, (numerics_objective)objective) > 0;
}

static void measure_column(numerics_id id, int column, int objective, long evaluations, bool bounded_only,
                           numerics_results *results)
{
    const numerics_set *set = sets[column];
    if (!is_wanted(set, id, objective, bounded_only))
        return;
    numerics_column *of = &results->of[id][column];
    of->found[objective] =
        numerics_search(set, id, (numerics_objective)objective, (numerics_hold){.count = 0}, budget(id, evaluations));
    if (objective == NUMERICS_RELATIVE)
        of->vectors = measure_vectors(set, id, row_step(id, bounded_only));
}

static void measure_shaders(long evaluations, numerics_results *results)
{
    weft_error error;
    if (numerics_glsl_open(&error) != WEFT_OK) {
        snprintf(results->no_shader, sizeof results->no_shader, "%s", error.message);
        return;
    }
    results->renderer = numerics_glsl_renderer();
    for (int id = 0; id < NUMERICS_MODELS; id++) {
        numerics_found *found = &results->of[id][NUMERICS_COLUMNS - 1].found[NUMERICS_RELATIVE];
        if (numerics_glsl_has((numerics_id)id) &&
            numerics_glsl_search((numerics_id)id, evaluations, found, &error) != WEFT_OK)
            found->broken.size = 1;
    }
}

void numerics_measure_all(long evaluations, bool bounded_only, numerics_results *results)
{
    enum { TASKS = NUMERICS_MODELS * NUMERICS_COLUMNS * NUMERICS_OBJECTIVES };
    memset(results, 0, sizeof *results);
    /* The expensive models come last in the list, and are begun first. */
#pragma omp parallel for schedule(dynamic)
    for (int task = TASKS - 1; task >= 0; task--) {
        int id = task / (NUMERICS_COLUMNS * NUMERICS_OBJECTIVES),
            rest = task % (NUMERICS_COLUMNS * NUMERICS_OBJECTIVES);
        measure_column((numerics_id)id, rest / NUMERICS_OBJECTIVES, rest % NUMERICS_OBJECTIVES, evaluations,
                       bounded_only, results);
    }
    measure_shaders(evaluations, results);
}

/* ---- Claims ---- */

static void print_numbers(numerics_id id, const double *argument)
{
    for (int i = 0; i < numerics_number_count(numerics_domain_of(id)); i++)
        fprintf(stderr, "%s%.9g", i ? " " : "  at ", argument[i]);
    fprintf(stderr, "\n");
}

static bool hold_one(numerics_id id, int column, const numerics_column *of, int objective)
{
    const numerics_set *set = sets[column];
    const numerics_claim *claim = numerics_claim_of(id);
    const numerics_found *found = &of->found[objective];
    double bound = set ? numerics_bound(set, id, (numerics_objective)objective) : claim->in_glsl;
    double largest = objective == NUMERICS_RELATIVE ? fmax(found->search.size, of->vectors.size) : found->search.size;
    const char *name = set ? set->name : "GLSL";
    static const char *const error_names[] = {"relative error", "absolute error", "growth of rounding"};
    if (found->broken.size > 0) {
        fprintf(stderr, "%s, %s: %g values are NaN, infinite or negative\n", claim->name, name, found->broken.size);
        print_numbers(id, found->broken.argument);
    }
    if (bound > 0 && !(largest <= bound)) {
        fprintf(stderr, "%s, %s: %s %.3g, more than the %.3g that are claimed\n", claim->name, name,
                error_names[objective], largest, bound);
        print_numbers(id, largest > found->search.size ? of->vectors.argument : found->search.argument);
    }
    bool errs = found->evaluations == 0 || largest > 0;
    if (!errs)
        fprintf(stderr, "%s, %s: no evaluation has any error, as if the model was not evaluated\n", claim->name, name);
    return errs && found->broken.size == 0 && (bound == 0 || largest <= bound);
}

bool numerics_hold_to_claims(const numerics_results *results)
{
    bool holds = true;
    for (int id = 0; id < NUMERICS_MODELS; id++)
        for (int column = 0; column < NUMERICS_COLUMNS; column++)
            for (int objective = 0; objective < NUMERICS_OBJECTIVES; objective++)
                holds &= hold_one((numerics_id)id, column, &results->of[id][column], objective);
    return holds;
}
