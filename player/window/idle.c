#include "player/window/idle.h"

static const double late_hint_s = 1;

bool weft_idle_at(weft_idle *idle, const weft_stir *stir, double now_s)
{
    bool has_note = now_s < stir->note_ends_s,
         is_other_note = has_note != idle->had_note || stir->note_ends_s != idle->note_ends_s;
    if (stir->has_events || stir->is_busy || is_other_note)
        idle->stirred_s = now_s;
    idle->had_note = has_note;
    idle->note_ends_s = stir->note_ends_s;
    return now_s - idle->stirred_s > late_hint_s;
}
