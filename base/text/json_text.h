/* JSON files, and text from elsewhere (names of files and folders) as JSON. */
#ifndef WEFT_BASE_TEXT_JSON_TEXT_H
#define WEFT_BASE_TEXT_JSON_TEXT_H

#include "base/status.h"

#include <errno.h>
#include <jansson.h>

/* A JSON string of `length` bytes that need not be UTF-8: where they are not, every byte beyond ASCII becomes '?'. The
 * caller owns the reference; NULL where memory is short. */
json_t *weft_json_text(const char *text, size_t length);

/* For what jansson could not read or unpack: WEFT_SYSTEM where memory was short, else weft_fail with `code` and what
 * follows. Jansson does not always say which, but malloc does: set errno to 0 before jansson is called. */
#define weft_json_fail(error, code, ...)                                                                               \
    (errno == ENOMEM ? weft_fail_memory(error, "JSON", 0) : weft_fail(error, code, __VA_ARGS__))

/* Reads JSON from a text of `path`. The caller owns *root. Errors: WEFT_BAD_INPUT with line and column where it is no
 * JSON, WEFT_SYSTEM where memory is short. */
weft_code weft_json_parse(const char *text, size_t size, size_t flags, const char *path, json_t **root,
                          weft_error *error);

/* json_object_set_new and json_array_append_new for what is built and then checked once: where memory is short, `value`
 * NULL included, the whole goes away and *object or *list is NULL, as it stays. */
void weft_json_put(json_t **object, const char *name, json_t *value);
void weft_json_append(json_t **list, json_t *value);

/* A number; null where it is not finite, because JSON has no infinity. NULL where memory is short. */
json_t *weft_json_number(double value);

/* Writes JSON atomically with jansson's `flags`. Takes `root`; NULL is a lack of memory. Errors: WEFT_SYSTEM;
 * WEFT_BAD_USAGE where the path names no file. */
weft_code weft_json_write(const char *path, json_t *root, size_t flags, weft_error *error);

/* The text of an object with one more member, which is taken. The caller frees it; NULL where memory is short. */
char *weft_json_with_member(const char *object, const char *name, json_t *value, size_t flags);

/* Reads a JSON file; an object that names a key twice is refused. The caller owns *root. Errors: WEFT_BAD_INPUT where
 * the file is missing, larger than `limit` bytes, or no JSON, with line and column. */
weft_code weft_json_read(const char *path, size_t limit, json_t **root, weft_error *error);

/* A kind of JSON file: the member that holds its version, the version, and how messages name it. */
typedef struct weft_json_kind {
    const char *member;
    int version;
    const char *is_none; /* "is no lens" */
    const char *is_one;  /* "is a lens" */
} weft_json_kind;

/* The same for a file of a kind. Errors: WEFT_BAD_INPUT also for another kind or version. */
weft_code weft_json_read_kind(const char *path, size_t limit, const weft_json_kind *kind, json_t **root,
                              weft_error *error);

#endif
