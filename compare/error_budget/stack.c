#include "compare/error_budget/error_budget.h"

#include "base/numeric/statistics.h"
#include "geometry/light/sample_sequence.h"

#include <math.h>
#include <stdlib.h>

enum { DRAWS = 1000 };

/* Sums over queries, of which ratios are taken. */
typedef struct sums {
    double energy, error[WEFT_SOURCE_COUNT]; /* of s, r, m and f */
} sums;

const char *weft_error_source_name(weft_error_source source)
{
    static const char *const name[WEFT_SOURCE_COUNT] = {"directions", "registration", "model", "storage"};
    return name[source];
}

static void add_channel(const weft_source_answer *a, int c, sums *sum)
{
    const double *t = (const double[]){a->cloth[0][c], a->cloth[1][c]};
    const double later[] = {a->registered[c], a->fitted[c], a->stored[c]};
    sum->energy += t[0] * t[1];
    sum->error[0] += (a->sampled[0][c] - t[0]) * (a->sampled[1][c] - t[1]);
    for (int stage = 1; stage < WEFT_SOURCE_COUNT; stage++)
        sum->error[stage] += (later[stage - 1] - t[0]) * (later[stage - 1] - t[1]);
}

static sums sums_of(const weft_source_answer *answer)
{
    sums sum = {0};
    for (int c = 0; c < 3; c++)
        add_channel(answer, c, &sum);
    return sum;
}

static void add(const sums *from, sums *to)
{
    to->energy += from->energy;
    for (int stage = 0; stage < WEFT_SOURCE_COUNT; stage++)
        to->error[stage] += from->error[stage];
}

/* Of the parts, and last of the whole. */
static double share_of(const sums *sum, int part)
{
    if (part == 0 || part == WEFT_SOURCE_COUNT)
        return sum->error[part == 0 ? 0 : WEFT_SOURCE_COUNT - 1] / sum->energy;
    return (sum->error[part] - sum->error[part - 1]) / sum->energy;
}

/* ---- Intervals ---- */

static sums draw_again(const sums *query, size_t count, uint64_t key)
{
    sums sum = {0};
    for (size_t i = 0; i < count; i++)
        add(&query[weft_sequence_key(key, i) % count], &sum);
    return sum;
}

/* `drawn` [DRAWS] is in the order of the numbers on return. */
static weft_source_share share_with_interval(const sums *all, const sums *draw, int part, double *drawn)
{
    for (int i = 0; i < DRAWS; i++)
        drawn[i] = share_of(&draw[i], part);
    return (weft_source_share){share_of(all, part), weft_quantile(drawn, DRAWS, 0.025),
                               weft_quantile(drawn, DRAWS, 0.975)};
}

static weft_code find_shares(const sums *query, const sums *all, uint64_t seed, weft_error_stack *stack,
                             weft_error *error)
{
    sums *draw = calloc(DRAWS, sizeof *draw);
    double *drawn = calloc(DRAWS, sizeof *drawn);
    weft_code code = draw && drawn ? WEFT_OK : weft_fail_memory(error, "draws", DRAWS * sizeof *draw);
    for (uint64_t i = 0; code == WEFT_OK && i < DRAWS; i++)
        draw[i] = draw_again(query, stack->query_count, weft_sequence_key(seed, i));
    for (int part = 0; code == WEFT_OK && part < WEFT_SOURCE_COUNT; part++)
        stack->part[part] = share_with_interval(all, draw, part, drawn);
    if (code == WEFT_OK)
        stack->whole = share_with_interval(all, draw, WEFT_SOURCE_COUNT, drawn);
    free(draw);
    free(drawn);
    return code;
}

/* ---- What each stage changed, and the noise ---- */

static void add_own(const weft_source_answer *a, int c, double own[WEFT_SOURCE_COUNT], double *noise)
{
    double apart = a->cloth[0][c] - a->cloth[1][c];
    own[0] += (a->sampled[0][c] - a->cloth[0][c]) * (a->sampled[1][c] - a->cloth[1][c]);
    own[1] += (a->registered[c] - a->sampled[0][c]) * (a->registered[c] - a->sampled[1][c]);
    own[2] += (a->fitted[c] - a->registered[c]) * (a->fitted[c] - a->registered[c]);
    own[3] += (a->stored[c] - a->fitted[c]) * (a->stored[c] - a->fitted[c]);
    *noise += apart * apart / 4;
}

static void find_own(const weft_source_answer *answer, double energy, weft_error_stack *stack)
{
    double noise = 0;
    for (size_t i = 0; i < stack->query_count; i++)
        for (int c = 0; c < 3; c++)
            add_own(&answer[i], c, stack->own, &noise);
    for (int part = 0; part < WEFT_SOURCE_COUNT; part++)
        stack->own[part] /= energy;
    stack->noise = sqrt(noise / energy);
}

weft_code weft_error_stack_of(const weft_source_answer *answer, size_t count, uint64_t seed, weft_error_stack *stack,
                              weft_error *error)
{
    *stack = (weft_error_stack){.query_count = count};
    sums all = {0}, *query = calloc(count + 1, sizeof *query);
    if (!query)
        return weft_fail_memory(error, "queries", count * sizeof *query);
    for (size_t i = 0; i < count; i++) {
        query[i] = sums_of(&answer[i]);
        add(&query[i], &all);
    }
    weft_code code = all.energy > 0 ? find_shares(query, &all, seed, stack, error)
                                    : weft_fail(error, WEFT_BAD_USAGE, "the cloth is black wherever it was asked for");
    if (code == WEFT_OK)
        find_own(answer, all.energy, stack);
    free(query);
    return code;
}
