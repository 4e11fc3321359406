#include "import/collection.h"

#include <limits.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

char *weft_join_path(const char *folder, const char *name)
{
    char *path;
    return asprintf(&path, "%s/%s", folder, name) < 0 ? NULL : path;
}

bool weft_folder_holds(const char *folder, const char *name)
{
    char path[PATH_MAX];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return access(path, F_OK) == 0;
}

weft_code weft_collection_add(weft_collection *collection, const char *name, weft_photograph photograph,
                              weft_error *error)
{
    if (collection->count == collection->capacity) {
        int capacity = collection->capacity ? 2 * collection->capacity : 64;
        weft_photograph *grown = realloc(collection->photograph, (size_t)capacity * sizeof *grown);
        if (!grown)
            return weft_fail_memory(error, "photographs", (size_t)capacity * sizeof *grown);
        collection->photograph = grown;
        collection->capacity = capacity;
    }
    photograph.name = strdup(name);
    if (!photograph.name)
        return weft_fail_memory(error, "name", strlen(name));
    collection->photograph[collection->count++] = photograph;
    return WEFT_OK;
}

static weft_code check_folder(const char *folder, weft_error *error)
{
    struct stat status;
    if (stat(folder, &status) != 0)
        return weft_fail(error, WEFT_BAD_INPUT, "there is no folder '%s'", folder);
    if (!S_ISDIR(status.st_mode))
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' is not a folder of photographs (unpack an archive first)",
                         folder);
    if (weft_folder_holds(folder, "session.json"))
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' is a session of `weft capture`: use `weft register`", folder);
    return WEFT_OK;
}

static weft_code list_photographs(const char *folder, weft_collection *collection, weft_error *error)
{
    if (weft_folder_holds(folder, "camera_pos.txt"))
        return weft_collection_of_positions(folder, collection, error);
    if (weft_folder_holds(folder, "directions.csv"))
        return weft_collection_of_table(folder, collection, error);
    return weft_collection_of_names(folder, collection, error);
}

static int count_present(const weft_collection *collection)
{
    int count = 0;
    for (int i = 0; i < collection->count; i++)
        count += !collection->photograph[i].missing;
    return count;
}

weft_code weft_collection_open(const char *folder, weft_collection *collection, weft_error *error)
{
    *collection = (weft_collection){0};
    weft_code code = check_folder(folder, error);
    if (code == WEFT_OK)
        code = list_photographs(folder, collection, error);
    if (code == WEFT_OK && count_present(collection) == 0)
        code = weft_fail(error, WEFT_BAD_INPUT,
                         "'%s' holds no photograph: neither positions, nor directions.csv, nor names like %s", folder,
                         "tv045_pv090/tl030_pl120_tv045_pv090.png");
    if (code != WEFT_OK)
        weft_collection_free(collection);
    return code;
}

void weft_collection_free(weft_collection *collection)
{
    for (int i = 0; i < collection->count; i++)
        free(collection->photograph[i].name);
    free(collection->photograph);
    weft_lines_free(&collection->notes);
    *collection = (weft_collection){0};
}
