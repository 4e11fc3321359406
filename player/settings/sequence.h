/* A sequence of pictures along a path. */
#ifndef WEFT_PLAYER_SETTINGS_SEQUENCE_H
#define WEFT_PLAYER_SETTINGS_SEQUENCE_H

#include "player/settings/key_frames.h"
#include "player/settings/settings.h"

/* Whether the name holds exactly one place for a number, %d or %04d, and no other '%'. Pure. */
bool weft_sequence_is_pattern(const char *pattern);

/* Draws the scene of `settings`, loaded into the player, along the path: `pattern` with the number of the frame, from
 * 0, names each picture. Errors: those of weft_path_count_frames and weft_settings_draw; what was drawn before stays.
 */
weft_code weft_sequence_draw(const char *pattern, const weft_path *path, double frames_per_second,
                             const weft_settings *settings, weft_player *player, const weft_progress *progress,
                             weft_error *error);

#endif
