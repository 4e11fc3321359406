#include "import/colour_remarks.h"

#include "import/angle_name.h"

#include <stdlib.h>
#include <string.h>

static bool is_exr(const char *name)
{
    const char *dot = strrchr(name, '.');
    return dot && strcasecmp(dot, ".exr") == 0;
}

static weft_colour_remark *find(weft_colour_remarks *remarks, const weft_decoded *decoded, int index)
{
    int i = 0;
    while (i < remarks->count && strcmp(remarks->remark[i].words, decoded->words) != 0)
        i++;
    if (i == WEFT_COLOUR_REMARKS)
        return NULL;
    if (i == remarks->count) {
        remarks->remark[i] = (weft_colour_remark){.claim = decoded->claim, .first = index};
        memcpy(remarks->remark[i].words, decoded->words, sizeof decoded->words);
        remarks->count++;
    }
    return &remarks->remark[i];
}

void weft_colour_remarks_add(weft_colour_remarks *remarks, int index, const char *name, const weft_decoded *decoded)
{
    remarks->read++;
    remarks->unsaid_exr += decoded->claim == WEFT_CLAIM_NONE && is_exr(name);
    if (decoded->has_more && (remarks->more++ == 0 || index < remarks->first_of_more))
        remarks->first_of_more = index;
    weft_colour_remark *remark = decoded->words[0] ? find(remarks, decoded, index) : NULL;
    if (!remark)
        return;
    remark->count++;
    if (index < remark->first)
        remark->first = index;
}

static int by_first(const void *a, const void *b)
{
    const weft_colour_remark *p = a, *q = b;
    return p->first - q->first;
}

static weft_code note_one(const weft_colour_remarks *remarks, const weft_colour_remark *remark, const char *name,
                          weft_lines *notes, weft_error *error)
{
    const char *outcome = remark->claim == WEFT_CLAIM_CLEAR ? "turned into sRGB" : "taken as sRGB, see --colours";
    return weft_lines_add(notes, error, "colours of '%s': %s; %s (%d of %d photographs)", name, remark->words, outcome,
                          remark->count, remarks->read);
}

/* UTIA's are CIE XYZ, and do not say so. */
static weft_code ask_for_xyz(const weft_colour_remarks *remarks, const weft_collection *collection, weft_lines *notes,
                             weft_error *error)
{
    for (int i = 0; remarks->unsaid_exr > 0 && i < collection->count; i++) {
        const weft_photograph *photograph = &collection->photograph[i];
        weft_named_angles angles;
        if (!photograph->missing && is_exr(photograph->name) && weft_angle_name_parse(photograph->name, &angles))
            return weft_lines_add(notes, error,
                                  "EXR files named as UTIA names its own, which hold CIE XYZ: taken as linear sRGB; if "
                                  "they are XYZ say --colours xyz, else --colours srgb");
    }
    return WEFT_OK;
}

weft_code weft_colour_remarks_note(weft_colour_remarks *remarks, const weft_collection *collection,
                                   weft_import_colours colours, weft_lines *notes, weft_error *error)
{
    if (remarks->more > 0)
        WEFT_TRY(weft_lines_add(notes, error,
                                "'%s' holds more than one picture: the first is taken (%d of %d photographs)",
                                collection->photograph[remarks->first_of_more].name, remarks->more, remarks->read));
    if (colours != WEFT_IMPORT_AS_SAID)
        return WEFT_OK;
    qsort(remarks->remark, (size_t)remarks->count, sizeof *remarks->remark, by_first);
    for (int i = 0; i < remarks->count; i++)
        WEFT_TRY(note_one(remarks, &remarks->remark[i], collection->photograph[remarks->remark[i].first].name, notes,
                          error));
    return ask_for_xyz(remarks, collection, notes, error);
}
