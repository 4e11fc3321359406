#include "base/text/image_list.h"

#include <fts.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

static const char *const image_extension[] = {".png", ".jpg", ".jpeg", ".exr",  ".hdr", ".bmp", ".tif", ".tiff",
                                              ".dng", ".cr2", ".cr3",  ".nef",  ".arw", ".raf", ".orf", ".rw2",
                                              ".pef", ".srw", ".heic", ".heif", ".hif", NULL};
static const char *const film_extension[] = {".mov", ".mp4", ".m4v", ".avi", ".mkv", ".mts", ".3gp", ".webm", NULL};

static bool ends_in(const char *name, const char *const *extension)
{
    const char *dot = strrchr(name, '.');
    if (!dot || name[0] == '.')
        return false;
    while (*extension && strcasecmp(dot, *extension) != 0)
        extension++;
    return *extension != NULL;
}

/* What file systems, servers and other systems keep in a folder of their own: thumbnails, deleted files. */
static bool is_of_a_system(const char *folder)
{
    static const char *const name[] = {"@eaDir", "#recycle", "$RECYCLE.BIN", "__MACOSX", "lost+found", NULL};
    bool is = folder[0] == '.';
    for (int i = 0; name[i]; i++)
        is = is || strcasecmp(folder, name[i]) == 0;
    return is;
}

/* ---- The files of a folder and of the folders in it ---- */

/* What is done with a file, whose name is relative. */
typedef weft_code (*visitor)(void *into, const char *name, weft_error *error);

static int by_name(const FTSENT **a, const FTSENT **b)
{
    return strcmp((*a)->fts_name, (*b)->fts_name);
}

static weft_code visit_tree(FTS *tree, size_t folder_length, visitor visit, void *into, weft_error *error)
{
    FTSENT *entry;
    while ((entry = fts_read(tree))) {
        bool is_folder_itself = entry->fts_level == 0;
        if (entry->fts_info == FTS_DNR || entry->fts_info == FTS_ERR || (entry->fts_info == FTS_NS && is_folder_itself))
            return weft_fail(error, WEFT_BAD_INPUT, "cannot list '%s': %s", entry->fts_path,
                             strerror(entry->fts_errno));
        if (entry->fts_info == FTS_F && is_folder_itself)
            return weft_fail(error, WEFT_BAD_INPUT, "'%s' is a file, not a folder", entry->fts_path);
        if (entry->fts_info == FTS_D &&
            (entry->fts_level > 1 || (!is_folder_itself && is_of_a_system(entry->fts_name))))
            fts_set(tree, entry, FTS_SKIP);
        /* A link to nowhere is a photograph that is missing: whoever reads it says so. */
        if (entry->fts_info == FTS_F || (entry->fts_info == FTS_SLNONE && !is_folder_itself))
            WEFT_TRY(visit(into, entry->fts_path + folder_length + 1, error));
    }
    return WEFT_OK;
}

static weft_code visit_files(const char *folder, visitor visit, void *into, weft_error *error)
{
    size_t length = strlen(folder);
    while (length > 1 && folder[length - 1] == '/')
        length--;
    char *root = strndup(folder, length);
    if (!root)
        return weft_fail_memory(error, "path", length);
    char *roots[] = {root, NULL};
    FTS *tree = fts_open(roots, FTS_LOGICAL | FTS_NOCHDIR, by_name);
    weft_code code = tree ? visit_tree(tree, length, visit, into, error) : weft_fail_errno(error, "list", folder);
    if (tree)
        fts_close(tree);
    free(root);
    return code;
}

/* ---- Images, and what there is instead ---- */

static const char *without_folder(const char *name)
{
    const char *slash = strrchr(name, '/');
    return slash ? slash + 1 : name;
}

static weft_code add_image(void *into, const char *name, weft_error *error)
{
    return ends_in(without_folder(name), image_extension) ? weft_lines_add(into, error, "%s", name) : WEFT_OK;
}

weft_code weft_images_list(const char *folder, weft_lines *names, weft_error *error)
{
    *names = (weft_lines){0};
    weft_code code = visit_files(folder, add_image, names, error);
    if (code != WEFT_OK)
        weft_lines_free(names);
    return code;
}

typedef struct census {
    int files, films;
} census;

static weft_code count_file(void *into, const char *name, weft_error *error)
{
    (void)error;
    census *seen = into;
    seen->files++;
    seen->films += ends_in(without_folder(name), film_extension);
    return WEFT_OK;
}

weft_code weft_images_missing(const char *folder, weft_error *error)
{
    static const char *const holds = "holds no photograph (JPEG, HEIF, PNG, TIFF, BMP, EXR, HDR or camera raw)";
    census seen = {0};
    WEFT_TRY(visit_files(folder, count_file, &seen, error));
    if (seen.files == 0)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' %s: it is empty; copy the files of the camera into it", folder,
                         holds);
    if (seen.films > 0)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' %s: %d of its %d files are films; take single photographs",
                         folder, holds, seen.films, seen.files);
    return weft_fail(error, WEFT_BAD_INPUT, "'%s' %s: none of its %d files has the name of a photograph", folder, holds,
                     seen.files);
}
