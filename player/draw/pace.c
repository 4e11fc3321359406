#include "player/draw/pace.h"

#include <math.h>

enum { SIDES = 6, SLOW_FRAMES = 2, FAST_FRAMES = 8 };

static const double sides[SIDES] = {1, 5.0 / 6, 2.0 / 3, 1.0 / 2, 1.0 / 3, 1.0 / 4};
static const double spare = 0.85;       /* share of the target that a larger picture may take */
static const double least_budget = 0.2; /* of it, for drawing: nothing is won where the panel alone takes all */
static const double memory = 0.8;       /* of exact_ms, from frame to frame */

bool weft_pace_is_interactive(const weft_pace *pace)
{
    return pace->exact_ms > WEFT_PACE_INTERACTIVE_MS;
}

double weft_pace_side(const weft_pace *pace)
{
    return weft_pace_is_interactive(pace) ? sides[pace->step] : 1;
}

/* The part of `target_ms` that is left for drawing. */
static double budget_ms(double target_ms, double shown_ms)
{
    return fmax(target_ms - shown_ms, least_budget * target_ms);
}

/* The side that there was time for; as if nothing of a frame were the same for all sides. */
static double side_in_time(double side, double drawn_ms, double budget)
{
    return side * sqrt(budget / fmax(drawn_ms, 1e-3));
}

static void become_smaller(weft_pace *pace, double side)
{
    pace->slow_side = pace->slow > 0 ? fmax(pace->slow_side, side) : side;
    pace->fast = 0;
    if (++pace->slow < SLOW_FRAMES)
        return;
    pace->slow = 0;
    while (pace->step < SIDES - 1 && sides[pace->step] > pace->slow_side)
        pace->step++;
}

static void become_larger(weft_pace *pace, double side)
{
    pace->slow = 0;
    pace->fast = pace->step > 0 && side >= sides[pace->step - 1] ? pace->fast + 1 : 0;
    if (pace->fast < FAST_FRAMES)
        return;
    pace->fast = 0;
    pace->step--;
}

static void note_exact(weft_pace *pace, double drawn_ms)
{
    double usual_ms = pace->last_ms > 0 ? fmin(pace->last_ms, drawn_ms) : drawn_ms;
    pace->exact_ms = pace->exact_ms > 0 ? memory * pace->exact_ms + (1 - memory) * usual_ms : usual_ms;
    pace->last_ms = drawn_ms;
}

void weft_pace_note(weft_pace *pace, bool interactive, double drawn_ms, double shown_ms)
{
    if (!(drawn_ms >= 0 && shown_ms >= 0) || !isfinite(drawn_ms) || !isfinite(shown_ms))
        return;
    if (!interactive) {
        note_exact(pace, drawn_ms);
        return;
    }
    double budget = budget_ms(WEFT_PACE_MS, shown_ms);
    if (drawn_ms > budget)
        become_smaller(pace, side_in_time(sides[pace->step], drawn_ms, budget));
    else
        become_larger(pace, side_in_time(sides[pace->step], drawn_ms, budget_ms(spare * WEFT_PACE_MS, shown_ms)));
}
