#include "registration/photographs/steps.h"

#include "base/text/image_list.h"
#include "registration/photographs/file_colours.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void read_exif(const char *folder, weft_photographs_photograph *photograph)
{
    weft_error error = {0};
    char *path;
    if (asprintf(&path, "%s/%s", folder, photograph->name) < 0) {
        snprintf(photograph->remark, sizeof photograph->remark, "memory is short");
        return;
    }
    if (weft_exif_read(path, &photograph->exif, &error) != WEFT_OK)
        snprintf(photograph->remark, sizeof photograph->remark, "%.180s", error.message);
    else
        weft_photographs_read_colours(path, photograph);
    free(path);
}

const weft_exif *weft_photographs_common_size(const weft_photograph_set *set)
{
    const weft_exif *best = NULL;
    int most = 0;
    for (int i = 0; i < set->count; i++) {
        const weft_exif *one = &set->photograph[i].exif;
        int same = 0;
        for (int k = 0; k < set->count && weft_photographs_used(&set->photograph[i]); k++)
            same += weft_photographs_used(&set->photograph[k]) && set->photograph[k].exif.width == one->width &&
                    set->photograph[k].exif.height == one->height;
        if (same > most)
            most = same, best = one;
    }
    return best;
}

static void leave_out_other_sizes(weft_photograph_set *set, const weft_exif *common)
{
    for (int i = 0; i < set->count; i++) {
        weft_photographs_photograph *p = &set->photograph[i];
        if (!weft_photographs_used(p) || (p->exif.width == common->width && p->exif.height == common->height))
            continue;
        bool turned = p->exif.width == common->height && p->exif.height == common->width;
        snprintf(p->remark, sizeof p->remark, "it has %d x %d pixels, most have %d x %d%s", p->exif.width,
                 p->exif.height, common->width, common->height,
                 turned ? ": a program turned it; copy the files as the camera wrote them" : "");
    }
}

static weft_code name_photographs(const char *folder, const weft_lines *names, weft_photograph_set *set,
                                  weft_error *error)
{
    if (names->count == 0)
        return weft_images_missing(folder, error);
    if (names->count < WEFT_PHOTOGRAPHS_FEWEST)
        return weft_fail(error, WEFT_BAD_INPUT,
                         "'%s' holds %d photograph%s, %d are needed and 20 do better: take more, each with the camera "
                         "and the lamp elsewhere",
                         folder, names->count, names->count == 1 ? "" : "s", WEFT_PHOTOGRAPHS_FEWEST);
    if (!(set->photograph = calloc((size_t)names->count, sizeof *set->photograph)))
        return weft_fail_memory(error, "photographs", (size_t)names->count * sizeof *set->photograph);
    for (int i = 0; i < names->count; i++, set->count++) {
        if (!(set->photograph[i].name = strdup(names->line[i])))
            return weft_fail_memory(error, names->line[i], strlen(names->line[i]));
    }
    return WEFT_OK;
}

weft_code weft_photographs_list(const char *folder, weft_photograph_set *set, weft_error *error)
{
    weft_lines names;
    WEFT_TRY(weft_images_list(folder, &names, error));
    weft_code code = name_photographs(folder, &names, set, error);
    weft_lines_free(&names);
    WEFT_TRY(code);
#pragma omp parallel for schedule(dynamic, 1)
    for (int i = 0; i < set->count; i++)
        read_exif(folder, &set->photograph[i]);
    const weft_exif *common = weft_photographs_common_size(set);
    if (!common)
        return weft_fail(error, WEFT_BAD_INPUT,
                         "none of the %d images in '%s' can be read: %s; save them as JPEG, TIFF or DNG", set->count,
                         folder, set->photograph[0].remark);
    leave_out_other_sizes(set, common);
    return WEFT_OK;
}
