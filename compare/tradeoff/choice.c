#include "compare/tradeoff/priced_model.h"

#include <math.h>

/* An error so many times the least is as good: another split would say another one. */
static const double best_share = 1.01;

const char *weft_preset_name(weft_preset preset)
{
    static const char *const name[WEFT_PRESET_COUNT] = {"", "small", "balanced", "best"};
    return name[preset];
}

const char *weft_preset_reason(weft_preset preset)
{
    static const char *const reason[WEFT_PRESET_COUNT] = {
        "",
        "the fewest bytes with an error no more than halfway, by ratio, from the best to the smallest file",
        "the bend of the curve: farthest below the line between small and best, both axes logarithmic",
        "the fewest bytes with an error within a hundredth of the least",
    };
    return reason[preset];
}

static bool is_better(const weft_offer *a, const weft_offer *b, bool equal_counts)
{
    bool no_worse = a->bytes <= b->bytes && a->error <= b->error;
    return no_worse && (a->bytes < b->bytes || a->error < b->error || equal_counts);
}

bool weft_offer_is_beaten(const weft_offer *offer, size_t count, size_t which)
{
    for (size_t i = 0; i < count; i++) {
        if (i != which && offer[i].may_be_chosen && is_better(&offer[i], &offer[which], i < which))
            return true;
    }
    return false;
}

static bool may_serve(const weft_offer *offer, size_t count, size_t which)
{
    return offer[which].may_be_chosen && !weft_offer_is_beaten(offer, count, which);
}

static double least_error(const weft_offer *offer, size_t count)
{
    double least = INFINITY;
    for (size_t i = 0; i < count; i++) {
        if (may_serve(offer, count, i))
            least = fmin(least, offer[i].error);
    }
    return least;
}

/* The fewest bytes with an error of at most this. */
static size_t find_smallest(const weft_offer *offer, size_t count, double most_error)
{
    size_t smallest = count;
    for (size_t i = 0; i < count; i++) {
        if (may_serve(offer, count, i) && offer[i].error <= most_error &&
            (smallest == count || offer[i].bytes < offer[smallest].bytes))
            smallest = i;
    }
    return smallest;
}

/* By how much the logarithm of the error lies below the line from `from` to `to`. */
static double depth(const weft_offer *offer, const weft_offer *from, const weft_offer *to)
{
    const double tiny = 1e-12;
    double along = log(offer->bytes / from->bytes) / log(to->bytes / from->bytes);
    double start = log(fmax(from->error, tiny)), end = log(fmax(to->error, tiny));
    return start + along * (end - start) - log(fmax(offer->error, tiny));
}

static size_t find_bend(const weft_offer *offer, size_t count, size_t small, size_t best)
{
    size_t bend = small;
    double deepest = 0;
    for (size_t i = 0; i < count; i++) {
        bool is_between = offer[i].bytes > offer[small].bytes && offer[i].bytes < offer[best].bytes;
        double below = is_between && may_serve(offer, count, i) ? depth(&offer[i], &offer[small], &offer[best]) : 0;
        if (below > deepest) {
            bend = i;
            deepest = below;
        }
    }
    return bend;
}

size_t weft_preset_choose(const weft_offer *offer, size_t count, weft_preset preset)
{
    size_t smallest = find_smallest(offer, count, INFINITY);
    if (smallest == count || preset == WEFT_PRESET_NONE)
        return count;
    double least = least_error(offer, count), halfway = sqrt(least * offer[smallest].error);
    size_t best = find_smallest(offer, count, best_share * least);
    size_t small = find_smallest(offer, count, fmax(halfway, best_share * least));
    if (preset == WEFT_PRESET_BEST)
        return best;
    return preset == WEFT_PRESET_SMALL ? small : find_bend(offer, count, small, best);
}

weft_code weft_preset_choose_fast(weft_offer *offer, size_t count, weft_preset preset, double most_ms,
                                  weft_offer_time *ask, void *context, size_t *chosen, size_t *fastest,
                                  weft_error *error)
{
    double frame_ms, least_ms = INFINITY;
    *fastest = count;
    while ((*chosen = weft_preset_choose(offer, count, preset)) < count) {
        WEFT_TRY(ask(context, *chosen, &frame_ms, error));
        if (frame_ms <= most_ms)
            break;
        offer[*chosen].may_be_chosen = false;
        *fastest = frame_ms < least_ms ? *chosen : *fastest;
        least_ms = fmin(least_ms, frame_ms);
    }
    return WEFT_OK;
}
