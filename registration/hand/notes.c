#include "registration/hand/notes.h"

#include <math.h>

/* Balls and pin have true sizes, the sheet has what --opening says: where they contradict the paper, one is wrong. */
static weft_code note_misfits(weft_hand *hand, weft_error *error)
{
    const double most = 3;
    if (hand->lamps.ball_misfit > most)
        WEFT_TRY(weft_lines_add(&hand->notes, error,
                                "the highlights on the balls lie %.0f standard errors off, median: is the opening, or "
                                "the diameter of the balls, what was said?",
                                hand->lamps.ball_misfit));
    if (hand->lamps.pin_misfit > most)
        return weft_lines_add(&hand->notes, error,
                              "the shadows of the pin lie %.0f standard errors off, median: is the opening, or the "
                              "height of the pin, what was said?",
                              hand->lamps.pin_misfit);
    return WEFT_OK;
}

/* Paper and ink leave the middle of the tone curve open. */
static weft_code note_tone(weft_hand *hand, weft_error *error)
{
    const double most = 0.05;
    if (!(hand->lamps.dark_error > most))
        return WEFT_OK;
    return weft_lines_add(
        &hand->notes, error,
        "dark cloth, a tenth as bright as the paper, may be off by %.0f %% (a standard error), bright "
        "cloth by less: the tone curve is known no better. Next time take four photographs twice, the "
        "second two stops darker, or use raw files",
        100 * hand->lamps.dark_error);
}

weft_code weft_hand_note(weft_hand *hand, weft_error *error)
{
    WEFT_TRY(note_misfits(hand, error));
    return note_tone(hand, error);
}

/* ---- Whether they differ ---- */

static bool is_near(weft_vec3 a, weft_vec3 b)
{
    const double near_rad = weft_rad_of_deg(3);
    return weft_dot(weft_unit(a), weft_unit(b)) > cos(near_rad);
}

weft_code weft_hand_check_variety(const char *folder, const weft_hand *hand, weft_error *error)
{
    const weft_hand_photograph *first = NULL;
    int used = 0;
    for (int i = 0; i < hand->count; i++) {
        const weft_hand_photograph *p = &hand->photograph[i];
        if (!weft_hand_used(p))
            continue;
        used++;
        if (!first)
            first = p;
        if (!is_near(p->lamp.position_mm, first->lamp.position_mm) ||
            !is_near(weft_pose_camera_position(&p->pose), weft_pose_camera_position(&first->pose)))
            return WEFT_OK;
    }
    return weft_fail(error, WEFT_BAD_INPUT,
                     "'%s': all %d photographs that can be used show one view under one light: move the camera, or "
                     "the lamp, from each to the next",
                     folder, used);
}
