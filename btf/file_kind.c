#include "btf/file_kind.h"

#include "btf/material/file.h"

#include <fcntl.h>
#include <stdbool.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { HEAD_SIZE = 4096 };

/* ---- By name ---- */

static bool ends_with(const char *text, const char *ending)
{
    size_t length = strlen(text), tail = strlen(ending);
    return length >= tail && strcmp(text + length - tail, ending) == 0;
}

static bool kind_of_name(const char *path, weft_file_kind *kind)
{
    static const struct {
        const char *ending;
        weft_file_kind kind;
    } names[] = {{".h5", WEFT_FILE_DATASET},       {".weft", WEFT_FILE_MATERIAL}, {".wv", WEFT_FILE_WEAVE},
                 {".mc", WEFT_FILE_MICROCYLINDER}, {".stitch", WEFT_FILE_STITCH}, {".obj", WEFT_FILE_MESH},
                 {".exr", WEFT_FILE_RADIANCE},     {".hdr", WEFT_FILE_RADIANCE},  {".png", WEFT_FILE_PICTURE}};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        *kind = names[i].kind;
        if (ends_with(path, names[i].ending))
            return true;
    }
    return false;
}

/* ---- By content ---- */

static bool kind_of_bytes(const char *head, size_t size, weft_file_kind *kind)
{
    static const struct {
        const char *bytes;
        size_t size;
        weft_file_kind kind;
    } starts[] = {{"\x89HDF\r\n\x1a\n", 8, WEFT_FILE_DATASET},
                  {(const char *)weft_format_magic, sizeof weft_format_magic, WEFT_FILE_MATERIAL},
                  {"\x89PNG\r\n\x1a\n", 8, WEFT_FILE_PICTURE},
                  {"\x76\x2f\x31\x01", 4, WEFT_FILE_RADIANCE},
                  {"#?", 2, WEFT_FILE_RADIANCE}};
    for (size_t i = 0; i < sizeof starts / sizeof *starts; i++) {
        *kind = starts[i].kind;
        if (size >= starts[i].size && memcmp(head, starts[i].bytes, starts[i].size) == 0)
            return true;
    }
    return false;
}

/* Past spaces and comments, in slashes and stars or from # to the end of the line. */
static const char *first_word(const char *text)
{
    for (;;) {
        text += strspn(text, " \t\r\n");
        bool is_block = strncmp(text, "/*", 2) == 0;
        if (!is_block && *text != '#')
            return text;
        const char *end = strstr(text + 1, is_block ? "*/" : "\n");
        if (!end)
            return "";
        text = end + (is_block ? 2 : 1);
    }
}

static bool kind_of_word(const char *head, weft_file_kind *kind)
{
    static const struct {
        const char *word;
        weft_file_kind kind;
    } words[] = {{"weave", WEFT_FILE_WEAVE},   {"microcylinder", WEFT_FILE_MICROCYLINDER},
                 {"stitch", WEFT_FILE_STITCH}, {"v", WEFT_FILE_MESH},
                 {"vt", WEFT_FILE_MESH},       {"vn", WEFT_FILE_MESH},
                 {"o", WEFT_FILE_MESH},        {"g", WEFT_FILE_MESH},
                 {"s", WEFT_FILE_MESH},        {"mtllib", WEFT_FILE_MESH},
                 {"usemtl", WEFT_FILE_MESH}};
    const char *word = first_word(head);
    size_t length = strcspn(word, " \t\r\n{");
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        *kind = words[i].kind;
        if (strlen(words[i].word) == length && strncmp(word, words[i].word, length) == 0)
            return true;
    }
    return false;
}

/* The first bytes and a NUL; how many they are, 0 where the file cannot be read. */
static size_t read_head(const char *path, char head[HEAD_SIZE + 1])
{
    memset(head, 0, HEAD_SIZE + 1);
    int file = open(path, O_RDONLY | O_CLOEXEC);
    if (file < 0)
        return 0;
    ssize_t size = read(file, head, HEAD_SIZE);
    close(file);
    return size > 0 ? (size_t)size : 0;
}

static bool kind_of_content(const char *path, weft_file_kind *kind)
{
    char head[HEAD_SIZE + 1];
    size_t size = read_head(path, head);
    return size > 0 && (kind_of_bytes(head, size, kind) || kind_of_word(head, kind));
}

bool weft_file_is_bonn(const char *path)
{
    static const char *const starts[] = {"!DFMF", "!FMF", "!PVF", "!BDIF"};
    char head[HEAD_SIZE + 1];
    struct stat status;
    if (stat(path, &status) != 0 || !S_ISREG(status.st_mode) || read_head(path, head) == 0)
        return false;
    for (size_t i = 0; i < sizeof starts / sizeof *starts; i++) {
        if (strncmp(head, starts[i], strlen(starts[i])) == 0)
            return true;
    }
    return false;
}

weft_code weft_file_kind_of(const char *path, weft_file_kind *kind, weft_error *error)
{
    struct stat status;
    if (stat(path, &status) != 0)
        return weft_fail(error, WEFT_MISSING, "there is no file '%s'", path);
    *kind = WEFT_FILE_SESSION;
    if (S_ISDIR(status.st_mode))
        return WEFT_OK;
    if (S_ISREG(status.st_mode) && (kind_of_content(path, kind) || kind_of_name(path, kind)))
        return WEFT_OK;
    if (weft_file_is_bonn(path))
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' is a BTF of Bonn: weft import makes a dataset of it", path);
    return weft_fail(error, WEFT_BAD_INPUT, "'%s' is no dataset, material, weave, mesh, picture or session folder",
                     path);
}
