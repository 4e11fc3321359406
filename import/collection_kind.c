#include "base/text/image_list.h"
#include "import/far_photograph.h"
#include "import/readers.h"

#include <stdlib.h>
#include <sys/stat.h>

static weft_code check_folder(const char *folder, weft_error *error)
{
    struct stat status;
    if (stat(folder, &status) != 0)
        return weft_fail(error, WEFT_MISSING, "there is no folder '%s'", folder);
    if (!S_ISDIR(status.st_mode))
        return weft_fail(error, WEFT_BAD_INPUT,
                         "'%s' is not a folder of photographs, nor a BTF of Bonn (unpack an archive first)", folder);
    if (weft_folder_holds(folder, "session.json"))
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' is a session of `weft capture`: use `weft register`", folder);
    return WEFT_OK;
}

static weft_code list_photographs(const char *folder, const char *lights, weft_collection *collection,
                                  weft_error *error)
{
    if (lights)
        return weft_collection_of_lights(folder, lights, collection, error);
    if (weft_folder_holds(folder, "camera_pos.txt"))
        return weft_collection_of_positions(folder, collection, error);
    if (weft_folder_holds(folder, "directions.csv"))
        return weft_collection_of_table(folder, collection, error);
    char *list;
    int count;
    WEFT_TRY(weft_light_list_in(folder, &list, &count, error));
    free(list);
    return count > 0 ? weft_collection_of_lights(folder, NULL, collection, error)
                     : weft_collection_of_names(folder, collection, error);
}

static int count_present(const weft_collection *collection)
{
    int count = 0;
    for (int i = 0; i < collection->count; i++)
        count += !collection->photograph[i].missing;
    return count;
}

/* Why none of a collection's photographs is there: each is missing, or there is no collection at all. */
static weft_code say_none_is_present(const weft_collection *collection, const char *folder, weft_error *error)
{
    if (collection->count > 0)
        return weft_fail(
            error, WEFT_BAD_INPUT,
            "'%s' holds none of the %d listed photographs, such as '%s'; the formats read are JPEG, HEIF, PNG, "
            "TIFF, BMP, EXR, HDR and camera raw",
            folder, collection->count, collection->photograph[0].name);
    return weft_fail(error, WEFT_BAD_INPUT,
                     "'%s' holds no photograph with known directions: no position files, no directions.csv, no .lp "
                     "file, no names like %s",
                     folder, "tv045_pv090/tl030_pl120_tv045_pv090.png");
}

weft_code weft_collection_open(const char *folder, const char *lights, bool leaves_out_doubles,
                               weft_collection *collection, weft_error *error)
{
    *collection = (weft_collection){.leaves_out_doubles = leaves_out_doubles};
    weft_code code = check_folder(folder, error);
    if (code == WEFT_OK)
        code = list_photographs(folder, lights, collection, error);
    if (code == WEFT_OK && count_present(collection) == 0)
        code = say_none_is_present(collection, folder, error);
    if (code != WEFT_OK)
        weft_collection_free(collection);
    return code;
}

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
