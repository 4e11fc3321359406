#include "import/far_photograph.h"
#include "import/readers.h"

#include "base/text/image_list.h"

static weft_code add_named(const char *folder, const weft_lines *names, weft_collection *collection, weft_error *error)
{
    int unreadable = 0;
    for (int i = 0; i < names->count; i++) {
        weft_named_angles angles;
        bool is_named = weft_angle_name_parse(names->line[i], &angles);
        const char *doubt = is_named ? weft_angle_name_doubt(names->line[i]) : NULL;
        if (doubt)
            return weft_fail(error, WEFT_BAD_INPUT, "'%s': %s", names->line[i], doubt);
        if (is_named)
            WEFT_TRY(weft_collection_add_far(collection, names->line[i], 0, &angles, error));
        else if (unreadable++ == 0)
            WEFT_TRY(weft_lines_add(&collection->notes, error, "left out '%s': no tl, pl, tv and pv in its name",
                                    names->line[i]));
    }
    if (unreadable > 1)
        WEFT_TRY(weft_lines_add(&collection->notes, error, "left out %d images in '%s' without angles in their names",
                                unreadable, folder));
    return WEFT_OK;
}

weft_code weft_collection_of_names(const char *folder, weft_collection *collection, weft_error *error)
{
    collection->kind = "photographs named by their angles";
    collection->distance = WEFT_FAR;
    weft_lines names;
    WEFT_TRY(weft_images_list(folder, &names, error));
    weft_code code = add_named(folder, &names, collection, error);
    weft_lines_free(&names);
    WEFT_TRY(code);
    WEFT_TRY(weft_collection_sort_far(collection, folder, error));
    return weft_collection_complete_grid(collection, error);
}
