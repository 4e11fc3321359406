#include "base/text/option.h"
#include "btf/file_kind.h"
#include "btf/session/camera_list.h"
#include "cli/command/arguments.h"

#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

enum { MAX_WORDS = 3 };

/* What files are called, and the words for them in the name of an argument: "NAME.weft", "CHART.jpg|SESSION". */
static const struct {
    const char *name, *words[MAX_WORDS];
} kinds[] = {
    [WEFT_FILE_SESSION] = {"a folder", {"SESSION", "FOLDER"}},
    [WEFT_FILE_DATASET] = {"a dataset", {".h5"}},
    [WEFT_FILE_MATERIAL] = {"a material", {".weft"}},
    [WEFT_FILE_WEAVE] = {"a weave", {".wv"}},
    [WEFT_FILE_MICROCYLINDER] = {"a microcylinder cloth", {".mc"}},
    [WEFT_FILE_STITCH] = {"a stitch", {".stitch"}},
    [WEFT_FILE_MESH] = {"a mesh", {".obj"}},
    [WEFT_FILE_RADIANCE] = {"a picture", {".exr", ".jpg"}},
    [WEFT_FILE_PICTURE] = {"a picture", {".png", ".jpg"}},
};

enum { KIND_COUNT = sizeof kinds / sizeof *kinds };

/* Whether one of the alternatives of an argument, from `part` to `end`, is of that kind. */
static bool is_kind(const char *part, const char *end, weft_file_kind kind)
{
    for (int i = 0; i < MAX_WORDS && kinds[kind].words[i]; i++) {
        const char *at = strstr(part, kinds[kind].words[i]);
        if (at && at < end)
            return true;
    }
    return false;
}

/* Whether the argument names files alone, by their ending, or folders: "ubo81|FILE.csv" may be a word, "CLOTH" may be
 * anything. *all_known: each of its alternatives is of a kind that files tell. */
static bool names_files(const char *argument, bool *all_known)
{
    *all_known = true;
    for (const char *part = argument; *part;) {
        const char *end = part + strcspn(part, "|");
        bool known = false;
        for (int kind = 0; kind < KIND_COUNT; kind++)
            known = known || is_kind(part, end, (weft_file_kind)kind);
        if (!known && !memchr(part, '.', (size_t)(end - part)))
            return false;
        *all_known = *all_known && known;
        part = *end ? end + 1 : end;
    }
    return true;
}

static bool holds(const char *folder, const char *name)
{
    char path[PATH_MAX];
    struct stat status;
    return snprintf(path, sizeof path, "%s/%s", folder, name) < (int)sizeof path && stat(path, &status) == 0;
}

/* Of one camera, or of several. */
static bool holds_session(const char *folder)
{
    return holds(folder, "session.json") || holds(folder, weft_camera_list_file);
}

static weft_code refuse(const char *path, const char *what, const char *argument, weft_error *error)
{
    char wanted[128];
    size_t length = 0;
    for (const char *part = argument; *part && length < sizeof wanted;) {
        const char *end = part + strcspn(part, "|");
        int written =
            snprintf(wanted + length, sizeof wanted - length, "%s%.*s", length ? " or " : "", (int)(end - part), part);
        length += (size_t)written;
        part = *end ? end + 1 : end;
    }
    return weft_fail(error, WEFT_BAD_INPUT, "'%s' is %s; %s is needed here", path, what, wanted);
}

weft_code weft_argument_check_type(const char *argument, const char *path, weft_error *error)
{
    struct stat status;
    weft_file_kind kind;
    bool all_known;
    /* What is not there, or is a device, is refused by its reader. */
    if (!names_files(argument, &all_known) || stat(path, &status) != 0 ||
        !(S_ISREG(status.st_mode) || S_ISDIR(status.st_mode)))
        return WEFT_OK;
    if (strcmp(argument, "SESSION") == 0 && S_ISDIR(status.st_mode) && !holds_session(path))
        return weft_fail(error, WEFT_BAD_INPUT,
                         "'%s' is not a session: it holds no session.json (for your own photographs use weft "
                         "photographs or weft import)",
                         path);
    if (weft_file_kind_of(path, &kind, NULL) == WEFT_OK) {
        bool belongs = is_kind(argument, argument + strlen(argument), kind);
        return belongs ? WEFT_OK : refuse(path, kinds[kind].name, argument, error);
    }
    if (weft_file_is_bonn(path))
        return refuse(path, "a BTF file of Bonn (weft import turns it into a dataset)", argument, error);
    if (!all_known || strstr(argument, ".jpg"))
        return WEFT_OK;
    return refuse(path, status.st_size == 0 ? "empty" : "neither dataset nor material, weave, mesh or picture",
                  argument, error);
}
