#include "bench/numerics/claims.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

/* Below these a value has no relative accuracy: it or one of its factors is no normal number, or almost none. */
static const double least_single = 1e-24, least_double = 1e-290;

/* An error larger than this, or than what is claimed, may be a jump of the function. */
static const double suspicious = 1e-3;

static double least_jump(const numerics_set *set, numerics_id id)
{
    double claimed = numerics_bound(set, id, NUMERICS_RELATIVE);
    return claimed > 0 ? fmin(claimed, suspicious) : suspicious;
}

static numerics_value exact(numerics_id id, const double *argument)
{
    return numerics_quad.function[id](argument);
}

static double difference(numerics_value a, numerics_value b)
{
    return fabs(a.high - b.high + (a.low - b.low));
}

/* ---- Arguments moved by rounding ---- */

/* Each number up or down by a relative amount; `ups` has a bit for each. */
static void move_arguments(const double *from, int count, uint64_t ups, double amount, double *to)
{
    for (int i = 0; i < count; i++)
        to[i] = from[i] * (ups >> i & 1 ? 1 + amount : 1 - amount);
}

/* The arguments that go up in one of PATTERNS moves, by the binary digits of their places. Any two arguments go the
 * same way in one move and opposite ways in another: the effects of no two cancel in all. */
enum { PATTERNS = 6 };
_Static_assert(NUMERICS_MAX_ARGUMENTS <= 1 << (PATTERNS - 1), "every argument has its own pattern");
static uint64_t ups_by_place(int pattern)
{
    uint64_t ups = 0;
    for (unsigned i = 0; i < NUMERICS_MAX_ARGUMENTS; i++)
        ups |= (uint64_t)(i >> pattern & 1) << i;
    return ups;
}

/* What one rounding of each argument does to the exact value: the largest change over a few patterns of signs. */
static double rounding_spread(numerics_id id, const double *argument, int count, double roundoff, numerics_value value)
{
    double moved[NUMERICS_MAX_ARGUMENTS], spread = 0;
    /* A double next to the argument is its neighbour: a relative change of one roundoff may be lost. */
    double amount = roundoff < DBL_EPSILON ? DBL_EPSILON : roundoff;
    for (int i = 0; i < PATTERNS; i++) {
        move_arguments(argument, count, ups_by_place(i), amount, moved);
        spread = fmax(spread, difference(exact(id, moved), value));
    }
    return spread;
}

/* ---- Jumps ---- */

/* Whether the exact function still changes by half of its difference between two places when these are next to each
 * other; the arguments lie in doubles, so that is where the search between them ends. */
static bool jumps_between(numerics_id id, const double *a, const double *b, int count)
{
    enum { HALVINGS = 48 };
    double low[NUMERICS_MAX_ARGUMENTS], high[NUMERICS_MAX_ARGUMENTS], middle[NUMERICS_MAX_ARGUMENTS];
    memcpy(low, a, (size_t)count * sizeof *a);
    memcpy(high, b, (size_t)count * sizeof *b);
    numerics_value at_low = exact(id, low), at_high = exact(id, high);
    double whole = difference(at_low, at_high);
    for (int i = 0; i < HALVINGS; i++) {
        for (int k = 0; k < count; k++)
            middle[k] = (low[k] + high[k]) / 2;
        numerics_value at_middle = exact(id, middle);
        bool nearer_low = difference(at_middle, at_low) < difference(at_middle, at_high);
        memcpy(nearer_low ? low : high, middle, (size_t)count * sizeof *middle);
        *(nearer_low ? &at_low : &at_high) = at_middle;
    }
    return difference(at_low, at_high) > whole / 2;
}

static uint64_t random_ups(unsigned seed)
{
    uint64_t bits = (seed + 1) * 0x9e3779b97f4a7c15u;
    return bits ^ bits >> 29;
}

/* Whether the value is the exact one of the other side of a jump that lies within rounding of the arguments. */
static bool is_other_side(numerics_id id, const double *argument, int count, double roundoff, numerics_value value,
                          double error)
{
    enum { TRIES = 24 };
    double moved[NUMERICS_MAX_ARGUMENTS];
    for (unsigned i = 0; i < TRIES; i++) {
        double amount = roundoff * (i % 3 == 0 ? 2 : i % 3 == 1 ? 8 : 32);
        move_arguments(argument, count, random_ups(i), amount, moved);
        numerics_value there = exact(id, moved);
        if (difference(there, value) < error / 2 && jumps_between(id, argument, moved, count))
            return true;
    }
    return false;
}

numerics_error numerics_error_of_value(const numerics_set *set, numerics_id id, const double *argument, int count,
                                       numerics_value value, bool with_growth)
{
    numerics_value expected = exact(id, argument);
    numerics_error error = {.broken = !isfinite(value.high) || value.high < 0};
    if (error.broken)
        return error;
    double size = difference(value, expected), least = set->single ? least_single : least_double;
    double typical = fmax(fmax(fabs(expected.high), expected.scale * 1e-3), least), relative = size / typical;
    if (relative > least_jump(set, id) && is_other_side(id, argument, count, set->roundoff, value, size)) {
        error.jump = true;
        return error;
    }
    error.size[NUMERICS_RELATIVE] = relative;
    error.size[NUMERICS_ABSOLUTE] = size;
    if (with_growth) {
        double spread = rounding_spread(id, argument, count, set->roundoff, expected);
        error.size[NUMERICS_GROWTH] = size / (spread + set->roundoff * typical);
    }
    return error;
}

numerics_error numerics_error_at(const numerics_set *set, numerics_id id, const double *argument, int count,
                                 bool with_growth)
{
    return numerics_error_of_value(set, id, argument, count, set->function[id](argument), with_growth);
}
