#include "import/collection.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

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

void weft_collection_free(weft_collection *collection)
{
    for (int i = 0; i < collection->count; i++)
        free(collection->photograph[i].name);
    free(collection->photograph);
    weft_lines_free(&collection->notes);
    *collection = (weft_collection){0};
}

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

static FILE *open_file(const char *folder, const char *name)
{
    char path[PATH_MAX];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return fopen(path, "rb");
}

static bool hold_the_same(FILE *a, FILE *b)
{
    char block[2][16384];
    size_t count[2];
    do {
        count[0] = fread(block[0], 1, sizeof block[0], a);
        count[1] = fread(block[1], 1, sizeof block[1], b);
        if (count[0] != count[1] || memcmp(block[0], block[1], count[0]) != 0)
            return false;
    } while (count[0] > 0);
    return !ferror(a) && !ferror(b);
}

bool weft_folder_holds_copies(const char *folder, const char *name, const char *other)
{
    FILE *a = open_file(folder, name), *b = open_file(folder, other);
    bool same = a && b && hold_the_same(a, b);
    if (a)
        fclose(a);
    if (b)
        fclose(b);
    return same;
}
