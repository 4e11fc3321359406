/* A folder of reflectance transformation imaging: one camera that stands, a lamp that goes round, and an .lp file. */
#include "import/readers.h"

#include "base/text/image_list.h"
#include "base/text/light_list.h"
#include "import/far_photograph.h"

#include <dirent.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool ends_in_lp(const char *name)
{
    const char *dot = strrchr(name, '.');
    return dot && dot > name && strcasecmp(dot, ".lp") == 0;
}

weft_code weft_light_list_in(const char *folder, char **path, int *count, weft_error *error)
{
    DIR *stream = opendir(folder);
    *path = NULL;
    *count = 0;
    if (!stream)
        return weft_fail_errno(error, "list", folder);
    weft_code code = WEFT_OK;
    for (struct dirent *entry; code == WEFT_OK && (entry = readdir(stream));) {
        if (!ends_in_lp(entry->d_name) || (*count)++ > 0)
            continue;
        if (!(*path = weft_join_path(folder, entry->d_name)))
            code = weft_fail_memory(error, "path", strlen(folder));
    }
    closedir(stream);
    return code;
}

static weft_code add_lit(const weft_light_list *list, const weft_listed_light *row, const char *name,
                         weft_collection *collection, weft_error *error)
{
    weft_vec3 light = weft_unit(row->light);
    const weft_real horizon = 1e-6;
    if (!(light.z > horizon))
        return weft_lines_add(&collection->notes, error, "left out '%s': its lamp is below the horizon (%s:%d)",
                              row->file, list->path, row->line);
    weft_photograph photograph = {.missing = !name, .light = light, .view = {0, 0, 1}};
    return weft_collection_add(collection, name ? name : row->file, photograph, error);
}

/* Every row with the image that it names; photographs that no row names are told. */
static weft_code add_rows(const char *folder, const weft_light_list *list, const weft_lines *images,
                          weft_collection *collection, weft_error *error)
{
    const char **of_row = calloc((size_t)list->count, sizeof *of_row);
    if (!of_row)
        return weft_fail_memory(error, "names", (size_t)list->count * sizeof *of_row);
    weft_code code = WEFT_OK;
    for (int i = 0; code == WEFT_OK && i < images->count; i++) {
        int row = weft_light_list_find(list, images->line[i]);
        if (row < 0)
            code = weft_lines_add(&collection->notes, error, "left out '%s': not in '%s'", images->line[i], list->path);
        else if (of_row[row] && weft_folder_holds_copies(folder, of_row[row], images->line[i]))
            code = weft_lines_add(&collection->notes, error, "left out '%s': it is a copy of '%s'", images->line[i],
                                  of_row[row]);
        else if (of_row[row])
            code = weft_fail(error, WEFT_BAD_INPUT, "%s:%d: '%s' and '%s' both have this name", list->path,
                             list->row[row].line, of_row[row], images->line[i]);
        else
            of_row[row] = images->line[i];
    }
    for (int i = 0; code == WEFT_OK && i < list->count; i++)
        code = add_lit(list, &list->row[i], of_row[i], collection, error);
    free(of_row);
    return code;
}

/* Positions say how far the lamps are, of which nothing but the direction is used. */
static weft_code note_positions(const weft_light_list *list, weft_collection *collection, weft_error *error)
{
    const double suspicious_mm = 100;
    double nearest = INFINITY, farthest = 0;
    for (int i = 0; i < list->count; i++) {
        nearest = fmin(nearest, weft_length(list->row[i].light));
        farthest = fmax(farthest, weft_length(list->row[i].light));
    }
    if (!list->positions)
        return WEFT_OK;
    return weft_lines_add(
        &collection->notes, error,
        "'%s': lamps stand %.4g to %.4g mm from the middle of the sample%s; they are taken as far, by "
        "their directions alone",
        list->path, nearest, farthest, nearest < suspicious_mm ? " (are these cm or m?)" : "");
}

static weft_code check_lights(const weft_light_list *list, weft_error *error)
{
    for (int i = 0; i < list->count; i++) {
        if (!list->row[i].has_light)
            return weft_fail(error, WEFT_BAD_INPUT, "'%s' lists no lamps", list->path);
    }
    return WEFT_OK;
}

static weft_code add_listed(const char *folder, const weft_light_list *list, weft_collection *collection,
                            weft_error *error)
{
    weft_lines images;
    WEFT_TRY(check_lights(list, error));
    WEFT_TRY(note_positions(list, collection, error));
    for (int i = 0; i < list->notes.count; i++)
        WEFT_TRY(weft_lines_add(&collection->notes, error, "%s", list->notes.line[i]));
    WEFT_TRY(weft_images_list(folder, &images, error));
    weft_code code = add_rows(folder, list, &images, collection, error);
    weft_lines_free(&images);
    return code;
}

/* The path of the list, in new memory. */
static weft_code find_list(const char *folder, const char *lights, char **path, weft_error *error)
{
    int count = 1;
    *path = lights ? strdup(lights) : NULL;
    if (!lights)
        WEFT_TRY(weft_light_list_in(folder, path, &count, error));
    if (!*path)
        return weft_fail_memory(error, "path", strlen(folder));
    if (count == 1)
        return WEFT_OK;
    free(*path);
    return weft_fail(error, WEFT_BAD_INPUT, "'%s' holds %d .lp files: name one by --lights", folder, count);
}

weft_code weft_collection_of_lights(const char *folder, const char *lights, weft_collection *collection,
                                    weft_error *error)
{
    collection->kind = "photographs from one place under many lamps";
    collection->distance = WEFT_FAR;
    char *path;
    weft_light_list list;
    WEFT_TRY(find_list(folder, lights, &path, error));
    weft_code code = weft_light_list_read(path, &list, error);
    free(path);
    WEFT_TRY(code);
    code = add_listed(folder, &list, collection, error);
    weft_light_list_free(&list);
    return code == WEFT_OK ? weft_collection_sort_far(collection, folder, error) : code;
}
