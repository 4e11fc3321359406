#include "base/text/image_list.h"

#include <fts.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

static bool is_image(const char *name)
{
    static const char *const extension[] = {".png", ".jpg", ".jpeg", ".exr", ".tif", ".tiff", ".dng", ".cr2",
                                            ".cr3", ".nef", ".arw",  ".raf", ".orf", ".rw2",  ".pef", ".srw"};
    const char *dot = strrchr(name, '.');
    if (!dot || name[0] == '.')
        return false;
    for (size_t i = 0; i < sizeof extension / sizeof *extension; i++) {
        if (strcasecmp(dot, extension[i]) == 0)
            return true;
    }
    return false;
}

static int by_name(const FTSENT **a, const FTSENT **b)
{
    return strcmp((*a)->fts_name, (*b)->fts_name);
}

static weft_code list_tree(FTS *tree, size_t folder_length, weft_lines *names, weft_error *error)
{
    FTSENT *entry;
    while ((entry = fts_read(tree))) {
        if (entry->fts_info == FTS_DNR || entry->fts_info == FTS_ERR)
            return weft_fail(error, WEFT_BAD_INPUT, "cannot list '%s': %s", entry->fts_path,
                             strerror(entry->fts_errno));
        if (entry->fts_info == FTS_D && entry->fts_level > 1)
            fts_set(tree, entry, FTS_SKIP);
        if (entry->fts_info == FTS_F && is_image(entry->fts_name))
            WEFT_TRY(weft_lines_add(names, error, "%s", entry->fts_path + folder_length + 1));
    }
    return WEFT_OK;
}

weft_code weft_images_list(const char *folder, weft_lines *names, weft_error *error)
{
    *names = (weft_lines){0};
    size_t length = strlen(folder);
    while (length > 1 && folder[length - 1] == '/')
        length--;
    char *root = strndup(folder, length);
    if (!root)
        return weft_fail_memory(error, "path", length);
    char *roots[] = {root, NULL};
    FTS *tree = fts_open(roots, FTS_LOGICAL | FTS_NOCHDIR, by_name);
    weft_code code = tree ? list_tree(tree, length, names, error) : weft_fail_errno(error, "list", folder);
    if (tree)
        fts_close(tree);
    free(root);
    if (code != WEFT_OK)
        weft_lines_free(names);
    return code;
}
