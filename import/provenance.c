#include "import/provenance.h"

#include "btf/json_text.h"

#include <string.h>

/* The last part of a path: the rest is about the machine, not about the material. */
static json_t *folder_name(const char *source)
{
    size_t length = strlen(source);
    while (length > 1 && source[length - 1] == '/')
        length--;
    size_t begin = length;
    while (begin > 0 && source[begin - 1] != '/')
        begin--;
    return weft_json_text(source + begin, length - begin);
}

static json_t *file_name(const weft_photograph *photograph)
{
    return photograph->missing ? json_null() : weft_json_text(photograph->name, strlen(photograph->name));
}

static json_t *photograph_names(const weft_collection *collection)
{
    json_t *names = json_array();
    for (int i = 0; i < collection->count; i++)
        weft_json_append(&names, file_name(&collection->photograph[i]));
    return names;
}

char *weft_import_provenance(const char *source, const weft_collection *collection, const weft_import_options *options,
                             const weft_decoding *decoding, const weft_import_report *report)
{
    json_t *root = json_pack("{s:s, s:o, s:s, s:[ii], s:f, s:i, s:i, s:f, s:o}", "program", "weft import " WEFT_VERSION,
                             "source", folder_name(source), "kind", collection->kind, "photograph_size",
                             decoding->source_width, decoding->source_height, "saturated_at", options->saturated_at,
                             "missing", report->missing_count, "skipped", report->skipped_count, "saturated_fraction",
                             report->saturated_fraction, "photographs", photograph_names(collection));
    char *text = root ? json_dumps(root, JSON_COMPACT) : NULL;
    json_decref(root);
    return text;
}
