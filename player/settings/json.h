/* A structure of plain values as a JSON object, by the table of its settings. */
#ifndef WEFT_PLAYER_SETTINGS_JSON_H
#define WEFT_PLAYER_SETTINGS_JSON_H

#include "base/status.h"
#include "player/settings/schema.h"

#include <jansson.h>

/* Adds what the table has keys for to `object`. Errors: WEFT_BAD_USAGE for a number that is not finite; WEFT_SYSTEM. */
weft_code weft_settings_write_json(const weft_setting *table, const void *structure, json_t *object, weft_error *error);

/* Settings that the object lacks stay as they are. `where` names the object in messages ("settings of 'a.png'").
 * Errors: WEFT_BAD_INPUT with the path to the key that is unknown, of another type or out of range; what was read
 * before it is then set. */
weft_code weft_settings_read_json(const weft_setting *table, const json_t *object, const char *where, void *structure,
                                  weft_error *error);

/* ---- Names of files that a file in another folder tells of ---- */

/* The name of `path` seen from the folder that `from` lies in: "silk.weft" beside it, "../cloth/silk.weft" elsewhere;
 * absolute where both have only the root in common. Links are followed in the folders, not in the last name. The
 * folders must exist, the files need not. The caller frees *result. Errors: WEFT_BAD_INPUT for a folder that does not
 * exist, WEFT_SYSTEM. */
weft_code weft_path_relative_to(const char *path, const char *from, char **result, weft_error *error);

/* The other way round: what a file in the folder of `from` means by `name`. The caller frees; NULL where memory is
 * short. Pure. */
char *weft_path_beside(const char *name, const char *from);

#endif
