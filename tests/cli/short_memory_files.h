/* What a folder holds: the names of its files, and their bytes as one number. */
#ifndef WEFT_TESTS_CLI_SHORT_MEMORY_FILES_H
#define WEFT_TESTS_CLI_SHORT_MEMORY_FILES_H

#include <stdbool.h>
#include <stdint.h>

enum { FILES_MOST = 128, FILES_NAME = 128 };

typedef struct file_list {
    int count;
    struct listed_file {
        char name[FILES_NAME]; /* from the folder on */
        uint64_t bytes;        /* FNV-1a hash of them, but of lines that tell how long something took */
    } file[FILES_MOST];
} file_list;

/* The regular files below `folder`. */
void files_list(const char *folder, file_list *list);

/* The first of `list` that is not in `whole` with the same bytes, or NULL. */
const struct listed_file *files_first_strange(const file_list *list, const file_list *whole);

/* Removes the folder with all that it holds; the second makes it anew. */
void files_remove(const char *folder);
void files_make_empty(const char *folder);

#endif
