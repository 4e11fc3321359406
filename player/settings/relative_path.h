/* Names of files that a file in another folder tells of. */
#ifndef WEFT_PLAYER_SETTINGS_RELATIVE_PATH_H
#define WEFT_PLAYER_SETTINGS_RELATIVE_PATH_H

#include "base/status.h"

/* The name of `path` seen from the folder that `from` lies in: "silk.weft" beside it, "../cloth/silk.weft" elsewhere;
 * absolute where both have only the root in common. Links are followed in the folders, not in the last name. The
 * folders must exist, the files need not. The caller frees *result. Errors: WEFT_BAD_INPUT for a folder that does not
 * exist, WEFT_SYSTEM. */
weft_code weft_path_relative_to(const char *path, const char *from, char **result, weft_error *error);

/* The other way round: what a file in the folder of `from` means by `name`. The caller frees; NULL where memory is
 * short. Pure. */
char *weft_path_beside(const char *name, const char *from);

#endif
