/* The sections of the page. */
#include "bench/numerics/report.h"
#include "bench/numerics/claims.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { DOUBLE, FLOAT, LANES, STORED, GLSL };

static void begin(const char *section)
{
    printf("<!-- numerics %s -->\n\n", section);
}

/* A number in two digits; a dash where there is none. */
static void print_number(double x)
{
    if (x < 0)
        printf(" - |");
    else if (x > 0)
        printf(" %.1e |", x);
    else
        printf(" 0 |");
}

static const numerics_found *found_of(const numerics_results *results, int id, int column, int objective)
{
    return &results->of[id][column].found[objective];
}

static bool is_measured(const numerics_results *results, int id, int column)
{
    return found_of(results, id, column, NUMERICS_RELATIVE)->evaluations > 0;
}

/* ---- Relative errors ---- */

static void print_relative_of(const numerics_results *results, int id, int column, double bound)
{
    const numerics_column *of = &results->of[id][column];
    if (!is_measured(results, id, column)) {
        printf(" - | - | - | - |");
        return;
    }
    print_number(column == GLSL ? -1 : of->vectors.size);
    print_number(of->found[NUMERICS_RELATIVE].median);
    print_number(of->found[NUMERICS_RELATIVE].search.size);
    print_number(bound);
}

static void print_relative(const numerics_results *results, int column, const char *section)
{
    begin(section);
    printf("| model | vectors | random, median | search | bound |\n| --- | --- | --- | --- | --- |\n");
    for (int id = 0; id < NUMERICS_STORED_HALF; id++) {
        const numerics_claim *claim = numerics_claim_of((numerics_id)id);
        const double bounds[NUMERICS_COLUMNS] = {claim->in_double, claim->in_float, claim->in_lanes, 0, claim->in_glsl};
        if (!is_measured(results, id, column))
            continue;
        printf("| %s |", claim->name);
        print_relative_of(results, id, column, bounds[column]);
        printf("\n");
    }
    printf("\n");
}

static void print_shaders(const numerics_results *results)
{
    if (results->renderer) {
        print_relative(results, GLSL, "glsl");
        printf("Driver: %s.\n\n", results->renderer);
        return;
    }
    begin("glsl");
    printf("Left out, as there was no OpenGL: %s.\n\n", results->no_shader);
}

/* ---- Growth and absolute errors ---- */

static void print_growth(const numerics_results *results)
{
    begin("growth");
    printf("| model | double | bound | float | bound | absolute, double | absolute, float |\n");
    printf("| --- | --- | --- | --- | --- | --- | --- |\n");
    for (int id = 0; id < NUMERICS_STORED_HALF; id++) {
        const numerics_claim *claim = numerics_claim_of((numerics_id)id);
        printf("| %s |", claim->name);
        for (int column = DOUBLE; column <= FLOAT; column++) {
            double bound = column == DOUBLE ? claim->growth_double : claim->growth_float;
            if (bound > 0)
                printf(" %.1f | %g |", found_of(results, id, column, NUMERICS_GROWTH)->search.size, bound);
            else
                printf(" - | - |");
        }
        print_number(found_of(results, id, DOUBLE, NUMERICS_ABSOLUTE)->search.size);
        print_number(found_of(results, id, FLOAT, NUMERICS_ABSOLUTE)->search.size);
        printf("\n");
    }
    printf("\n");
}

/* ---- Places ---- */

/* "wi (0.1, 0.2, 0.3)" */
static void print_argument(const numerics_argument *argument, const double *value, int digits)
{
    printf("%s ", argument->name);
    if (numerics_width(argument) == 1)
        printf("%.*g", digits, *value);
    else
        printf("(%.*g, %.*g, %.*g)", digits, value[0], digits, value[1], digits, value[2]);
}

static void print_place(const numerics_results *results, int id, int column)
{
    const numerics_domain *domain = numerics_domain_of((numerics_id)id);
    const double *value = found_of(results, id, column, NUMERICS_RELATIVE)->search.argument;
    bool first = true;
    for (int i = 0; i < domain->argument_count; i++) {
        if (domain->argument[i].kind != NUMERICS_ZERO) {
            printf(first ? "" : ", ");
            print_argument(&domain->argument[i], value, 6);
            first = false;
        }
        value += numerics_width(&domain->argument[i]);
    }
    printf(" |");
}

static void print_places(const numerics_results *results)
{
    begin("places");
    printf("| model | where it is worst, and what the code does there | worst in float (search) | worst in double "
           "(search) |\n");
    printf("| --- | --- | --- | --- |\n");
    for (int id = 0; id < NUMERICS_STORED_HALF; id++) {
        printf("| %s | %s | ", numerics_claim_of((numerics_id)id)->name, numerics_claim_of((numerics_id)id)->extreme);
        print_place(results, id, FLOAT);
        printf(" ");
        print_place(results, id, DOUBLE);
        printf("\n");
    }
    printf("\n");
}

/* ---- Storage ---- */

static void print_storage(const numerics_results *results)
{
    begin("storage");
    printf("| stored | largest relative error | largest absolute error | bound (relative) | where |\n");
    printf("| --- | --- | --- | --- | --- |\n");
    for (int id = NUMERICS_STORED_HALF; id < NUMERICS_MODELS; id++) {
        printf("| %s |", numerics_claim_of((numerics_id)id)->name);
        print_number(found_of(results, id, STORED, NUMERICS_RELATIVE)->search.size);
        print_number(found_of(results, id, STORED, NUMERICS_ABSOLUTE)->search.size);
        print_number(numerics_bound(&numerics_stored, (numerics_id)id, NUMERICS_RELATIVE));
        printf(" ");
        print_place(results, id, STORED);
        printf("\n");
    }
    printf("\n");
}

/* ---- Where single precision ends ---- */

static int first_coordinate(const numerics_domain *domain, const char *name)
{
    int at = 0;
    for (int i = 0; strcmp(domain->argument[i].name, name) != 0; i++)
        at += numerics_coordinates(&domain->argument[i]);
    return at;
}

static double worst_at(const numerics_regime *regime, double share, long evaluations)
{
    numerics_hold hold = {.share = share};
    for (; hold.count < 3 && regime->argument[hold.count]; hold.count++)
        hold.coordinate[hold.count] = first_coordinate(numerics_domain_of(regime->id), regime->argument[hold.count]);
    long cost = numerics_claim_of(regime->id)->cost;
    return numerics_search(&numerics_float, regime->id, NUMERICS_RELATIVE, hold, evaluations / cost + 24).search.size;
}

enum { STEPS = 13 };

/* What a step of a regime stands for. */
static double value_of(const numerics_regime *regime, int step)
{
    return regime->first * pow(regime->last / regime->first, (double)step / (STEPS - 1));
}

/* The last step before the error passes `limit`; -1: it passes from the start. */
static int last_within(const double *worst, double limit)
{
    int step = 0;
    while (step < STEPS && worst[step] <= limit)
        step++;
    return step - 1;
}

static void print_reach(const numerics_regime *regime, const double *worst, double limit)
{
    int step = last_within(worst, limit);
    if (step < 0)
        printf(" nowhere |");
    else if (step == STEPS - 1)
        printf(" everywhere |");
    else
        printf(" %.1e |", value_of(regime, step));
}

static void print_regimes(long evaluations)
{
    static double worst[64][STEPS];
#pragma omp parallel for schedule(dynamic)
    for (int task = 0; task < numerics_regime_count * STEPS; task++) {
        const numerics_regime *regime = &numerics_regimes[task / STEPS];
        double share = regime->from + (regime->to - regime->from) * (task % STEPS) / (STEPS - 1);
        worst[task / STEPS][task % STEPS] = worst_at(regime, fmin(share, 1 - 0x1p-53), evaluations / 4);
    }
    begin("limits");
    printf(
        "| model | as it goes | from | to | within 1e-4 to | within 1e-3 to | within 1e-2 to | error at the end |\n");
    printf("| --- | --- | --- | --- | --- | --- | --- | --- |\n");
    for (int i = 0; i < numerics_regime_count; i++) {
        const numerics_regime *regime = &numerics_regimes[i];
        printf("| %s | %s | %.1e | %.1e |", numerics_claim_of(regime->id)->name, regime->what, regime->first,
               regime->last);
        print_reach(regime, worst[i], 1e-4);
        print_reach(regime, worst[i], 1e-3);
        print_reach(regime, worst[i], 1e-2);
        print_number(worst[i][STEPS - 1]);
        printf("\n");
    }
    printf("\n");
}

static void print_counts(const numerics_results *results)
{
    double evaluations = 0, jumps = 0, broken = 0;
    for (int id = 0; id < NUMERICS_MODELS; id++)
        for (int column = 0; column < NUMERICS_COLUMNS; column++)
            for (int objective = 0; objective < NUMERICS_OBJECTIVES; objective++) {
                const numerics_found *found = found_of(results, id, column, objective);
                evaluations += (double)found->evaluations;
                jumps += (double)found->jumps;
                broken += found->broken.size;
            }
    begin("counts");
    printf(
        "Of %.2g million evaluations %.0f were NaN, infinite or negative. %.0f were on the other side of a jump.\n\n",
        evaluations / 1e6, broken, jumps);
}

void numerics_print(const numerics_results *results, long evaluations)
{
    print_counts(results);
    print_relative(results, DOUBLE, "double");
    print_relative(results, FLOAT, "float");
    print_relative(results, LANES, "lanes");
    print_shaders(results);
    print_growth(results);
    print_regimes(evaluations);
    print_storage(results);
    print_places(results);
}
