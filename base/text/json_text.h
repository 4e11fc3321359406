/* JSON files, and text from elsewhere (names of files and folders) as JSON. */
#ifndef WEFT_BASE_TEXT_JSON_TEXT_H
#define WEFT_BASE_TEXT_JSON_TEXT_H

#include "base/status.h"

#include <jansson.h>

/* A JSON string of `length` bytes that need not be UTF-8: where they are not, every byte beyond ASCII becomes '?'. The
 * caller owns the reference; NULL where memory is short. */
json_t *weft_json_text(const char *text, size_t length);

/* Reads a JSON file; an object that names a key twice is refused. The caller owns *root. Errors: WEFT_BAD_INPUT where
 * the file is missing, larger than `limit` bytes, or no JSON, with line and column. */
weft_code weft_json_read(const char *path, size_t limit, json_t **root, weft_error *error);

#endif
