#include "capture/camera_folder.h"

#include "base/atomic_file.h"
#include "capture/resume.h"

#include <limits.h>
#include <stdio.h>
#include <string.h>

weft_camera_list weft_camera_list_of(const weft_rig *rig)
{
    weft_camera_list list = {0};
    for (const weft_rig *one = rig->first; one && list.count < WEFT_CAMERAS_MAX; one = one->next)
        snprintf(list.name[list.count++], WEFT_CAMERA_NAME_SIZE, "%s", one->camera_name);
    return list;
}

static bool is_same(const weft_camera_list *a, const weft_camera_list *b)
{
    bool same = a->count == b->count;
    for (int i = 0; same && i < a->count; i++)
        same = strcmp(a->name[i], b->name[i]) == 0;
    return same;
}

weft_code weft_camera_folder_prepare(const char *folder, const weft_camera_list *list, weft_error *error)
{
    weft_camera_list found;
    WEFT_TRY(weft_make_folder(folder, error));
    weft_sync_folder_of(folder);
    WEFT_TRY(weft_camera_list_read(folder, &found, error));
    if (found.count > 0)
        return is_same(list, &found)
                   ? WEFT_OK
                   : weft_fail(error, WEFT_BAD_INPUT,
                               "session '%s' was begun with other cameras; repeat them or choose another folder",
                               folder);
    WEFT_TRY(weft_refuse_foreign_files(folder, error));
    return weft_camera_list_write(folder, list, error);
}

void weft_camera_folder_sweep(const char *folder)
{
    char path[PATH_MAX];
    snprintf(path, sizeof path, "%s/%s", folder, weft_camera_list_file);
    weft_sweep_left_over(path);
}
