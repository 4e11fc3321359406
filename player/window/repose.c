#include "player/window/repose.h"

static const double late_hint_s = 1;

bool weft_repose_at(weft_repose *repose, const weft_stir *stir, double now_s)
{
    bool has_note = now_s < stir->note_ends_s,
         is_other_note = has_note != repose->had_note || stir->note_ends_s != repose->note_ends_s;
    if (stir->has_events || stir->is_busy || is_other_note)
        repose->stirred_s = now_s;
    repose->had_note = has_note;
    repose->note_ends_s = stir->note_ends_s;
    return now_s - repose->stirred_s > late_hint_s;
}
