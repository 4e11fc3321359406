#include "tests/cli/short_memory_files.h"

#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { DESCRIPTORS = 16 };

/* What a page says of how long something took: no two runs agree there. */
static bool tells_time(const char *line, size_t size)
{
    return memmem(line, size, "time taken", 10) || memmem(line, size, " ms a frame", 11) ||
           memmem(line, size, "fits together took", 18);
}

static uint64_t hash_file(const char *path)
{
    FILE *file = fopen(path, "rb");
    if (!file)
        abort();
    uint64_t hash = 0xcbf29ce484222325;
    char *line = NULL;
    size_t capacity = 0;
    for (ssize_t size; (size = getline(&line, &capacity, file)) > 0;) {
        if (tells_time(line, (size_t)size))
            continue;
        for (ssize_t i = 0; i < size; i++)
            hash = (hash ^ (unsigned char)line[i]) * 0x100000001b3;
    }
    free(line);
    fclose(file);
    return hash;
}

/* nftw takes no context. */
static file_list *filled;
static size_t folder_length;

static int add_file(const char *path, const struct stat *status, int kind, struct FTW *where)
{
    (void)status, (void)where;
    if (kind != FTW_F)
        return 0;
    if (filled->count == FILES_MOST)
        abort();
    struct listed_file *file = &filled->file[filled->count++];
    snprintf(file->name, sizeof file->name, "%s", path + folder_length + 1);
    file->bytes = hash_file(path);
    return 0;
}

void files_list(const char *folder, file_list *list)
{
    list->count = 0;
    filled = list;
    folder_length = strlen(folder);
    if (nftw(folder, add_file, DESCRIPTORS, FTW_PHYS) != 0)
        abort();
}

const struct listed_file *files_first_strange(const file_list *list, const file_list *whole)
{
    for (int i = 0; i < list->count; i++) {
        const struct listed_file *file = &list->file[i];
        int k = 0;
        while (k < whole->count &&
               (strcmp(whole->file[k].name, file->name) != 0 || whole->file[k].bytes != file->bytes))
            k++;
        if (k == whole->count)
            return file;
    }
    return NULL;
}

static int remove_one(const char *path, const struct stat *status, int kind, struct FTW *where)
{
    (void)status, (void)kind, (void)where;
    return remove(path);
}

void files_remove(const char *folder)
{
    struct stat status;
    if (stat(folder, &status) == 0)
        nftw(folder, remove_one, DESCRIPTORS, FTW_DEPTH | FTW_PHYS);
}

void files_make_empty(const char *folder)
{
    files_remove(folder);
    if (mkdir(folder, 0777) != 0)
        abort();
}
