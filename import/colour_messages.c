#include "import/run.h"

#include "import/angle_name.h"

#include <stdlib.h>
#include <string.h>

static bool is_exr(const char *name)
{
    const char *dot = strrchr(name, '.');
    return dot && strcasecmp(dot, ".exr") == 0;
}

static weft_colour_message *find(weft_colour_messages *messages, const weft_decoded *decoded, int index)
{
    int i = 0;
    while (i < messages->count && strcmp(messages->message[i].words, decoded->words) != 0)
        i++;
    if (i == WEFT_COLOUR_MESSAGES)
        return NULL;
    if (i == messages->count) {
        messages->message[i] = (weft_colour_message){.claim = decoded->claim, .first = index};
        memcpy(messages->message[i].words, decoded->words, sizeof decoded->words);
        messages->count++;
    }
    return &messages->message[i];
}

void weft_colour_messages_add(weft_colour_messages *messages, int index, const char *name, const weft_decoded *decoded)
{
    messages->read++;
    messages->unsaid_exr += decoded->claim == WEFT_CLAIM_NONE && is_exr(name);
    if (decoded->has_more && (messages->more++ == 0 || index < messages->first_of_more))
        messages->first_of_more = index;
    weft_colour_message *message = decoded->words[0] ? find(messages, decoded, index) : NULL;
    if (!message)
        return;
    message->count++;
    if (index < message->first)
        message->first = index;
}

static int by_first(const void *a, const void *b)
{
    const weft_colour_message *p = a, *q = b;
    return p->first - q->first;
}

static weft_code note_one(const weft_colour_messages *messages, const weft_colour_message *message, const char *name,
                          weft_lines *notes, weft_error *error)
{
    const char *outcome = message->claim == WEFT_CLAIM_CLEAR ? "turned into sRGB" : "taken as sRGB, see --colours";
    return weft_lines_add(notes, error, "colours of '%s': %s; %s (%d of %d photographs)", name, message->words, outcome,
                          message->count, messages->read);
}

/* UTIA's are CIE XYZ, and do not say so. */
static weft_code ask_for_xyz(const weft_colour_messages *messages, const weft_collection *collection, weft_lines *notes,
                             weft_error *error)
{
    for (int i = 0; messages->unsaid_exr > 0 && i < collection->count; i++) {
        const weft_photograph *photograph = &collection->photograph[i];
        weft_named_angles angles;
        if (!photograph->missing && is_exr(photograph->name) && weft_angle_name_parse(photograph->name, &angles))
            return weft_lines_add(notes, error,
                                  "EXR files named as UTIA names its own, which hold CIE XYZ: taken as linear sRGB; if "
                                  "they are XYZ, pass --colours xyz, else --colours srgb");
    }
    return WEFT_OK;
}

weft_code weft_colour_messages_note(weft_colour_messages *messages, const weft_collection *collection,
                                    weft_import_colours colours, weft_lines *notes, weft_error *error)
{
    if (messages->more > 0)
        WEFT_TRY(weft_lines_add(notes, error,
                                "'%s' holds more than one picture: the first is taken (%d of %d photographs)",
                                collection->photograph[messages->first_of_more].name, messages->more, messages->read));
    if (colours != WEFT_IMPORT_AS_SAID)
        return WEFT_OK;
    qsort(messages->message, (size_t)messages->count, sizeof *messages->message, by_first);
    for (int i = 0; i < messages->count; i++)
        WEFT_TRY(note_one(messages, &messages->message[i], collection->photograph[messages->message[i].first].name,
                          notes, error));
    return ask_for_xyz(messages, collection, notes, error);
}
