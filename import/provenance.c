#include "import/provenance.h"

#include <jansson.h>
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
    json_t *name = json_stringn(source + begin, length - begin);
    return name ? name : json_string("a folder whose name is not UTF-8");
}

static json_t *file_name(const weft_photograph *photograph, int index)
{
    if (photograph->missing)
        return json_null();
    json_t *name = json_string(photograph->name);
    return name ? name : json_sprintf("photograph %d", index);
}

static json_t *photograph_names(const weft_collection *collection)
{
    json_t *names = json_array();
    for (int i = 0; i < collection->count; i++)
        json_array_append_new(names, file_name(&collection->photograph[i], i));
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
