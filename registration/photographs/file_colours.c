#include "registration/photographs/file_colours.h"

#include "base/picture/colour_claim.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Photographs are relative to white paper, so a matrix that moves white is not for them: CIE XYZ. */
static bool keeps_white(const weft_colour_space *space)
{
    for (int i = 0; i < 3; i++) {
        if (fabs(space->matrix[i][0] + space->matrix[i][1] + space->matrix[i][2] - 1) > 1e-3)
            return false;
    }
    return true;
}

void weft_photographs_read_colours(const char *path, weft_photographs_photograph *photograph)
{
    weft_colour_claim claim;
    bool is_raw = photograph->exif.is_linear && !photograph->exif.is_float;
    if (weft_colour_claim_read(path, &claim, NULL) != WEFT_OK || is_raw)
        return;
    bool is_clear = claim.kind == WEFT_CLAIM_CLEAR;
    if (claim.kind == WEFT_CLAIM_NONE || (is_clear && weft_colour_space_has_srgb_primaries(&claim.space)))
        return;
    snprintf(photograph->colours, sizeof photograph->colours, "%s", claim.words);
    if (!is_clear || !keeps_white(&claim.space))
        return;
    photograph->file_colour.terms = WEFT_COLOUR_LINEAR_TERMS;
    for (int i = 0; i < 3; i++)
        memcpy(photograph->file_colour.matrix[i], claim.space.matrix[i], sizeof claim.space.matrix[i]);
}

static bool says_the_same(const weft_photographs_photograph *p, const weft_photographs_photograph *q)
{
    return weft_photographs_used(q) && strcmp(p->colours, q->colours) == 0;
}

weft_code weft_photographs_note_colours(weft_photograph_set *set, weft_error *error)
{
    int used = 0;
    for (int i = 0; i < set->count; i++)
        used += weft_photographs_used(&set->photograph[i]);
    for (int i = 0; i < set->count; i++) {
        const weft_photographs_photograph *p = &set->photograph[i];
        int before = 0, same = 0;
        for (int k = 0; k < set->count; k++) {
            same += says_the_same(p, &set->photograph[k]);
            before += k < i && says_the_same(p, &set->photograph[k]);
        }
        if (!weft_photographs_used(p) || !p->colours[0] || before > 0)
            continue;
        WEFT_TRY(weft_lines_add(&set->notes, error, "colours of '%s': %s; %s (%d of %d photographs)", p->name,
                                p->colours, p->file_colour.terms ? "turned into sRGB" : "not turned into sRGB", same,
                                used));
    }
    return WEFT_OK;
}
