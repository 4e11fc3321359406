#include "btf/session/camera_list.h"
#include "tests/support/fuzz.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

static const weft_camera_list seed = {3, {"top", "left-side", "R_2"}};

void fuzz_write_seed(const char *path)
{
    if (weft_camera_list_write(".", &seed, NULL) != WEFT_OK || rename(weft_camera_list_file, path) != 0)
        abort();
}

/* Whatever was read names folders beside the list, each once. */
static void expect_folders(const weft_camera_list *list)
{
    if (list->count < 1 || list->count > WEFT_CAMERAS_MAX)
        abort();
    for (int i = 0; i < list->count; i++) {
        if (!memchr(list->name[i], 0, WEFT_CAMERA_NAME_SIZE) || !list->name[i][0] || strpbrk(list->name[i], "./\\ "))
            abort();
        for (int other = 0; other < i; other++) {
            if (strcasecmp(list->name[i], list->name[other]) == 0)
                abort();
        }
    }
}

/* The list has to lie in a folder, the bytes lie in memory: a link, which holds for all of them. */
static void link_list(const char *file)
{
    if (access(weft_camera_list_file, F_OK) != 0 && symlink(file, weft_camera_list_file) != 0)
        abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    weft_camera_list list;
    weft_error error = {0};
    link_list(fuzz_file(bytes, size));
    weft_code code = weft_camera_list_read(".", &list, &error);
    if (code != WEFT_OK && (error.code != code || !error.message[0]))
        abort();
    if (code == WEFT_OK)
        expect_folders(&list);
    return 0;
}
