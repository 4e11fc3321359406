/* A sequence of pictures along a path. */
#ifndef WEFT_CLI_SEQUENCE_H
#define WEFT_CLI_SEQUENCE_H

#include "cli/scene_options.h"
#include "player/settings/path.h"

/* Whether the name holds exactly one place for a number, %d or %04d, and no other '%'. Pure. */
bool sequence_is_pattern(const char *pattern);

/* Draws the scene, loaded into the player, along the path: `pattern` with the number of the frame, from 0, names each
 * picture. Errors: those of weft_path_count_frames and weft_settings_draw; what was drawn before stays. */
weft_code sequence_draw(const char *pattern, const weft_path *path, double frames_per_second,
                        const scene_options *options, weft_player *player, weft_error *error);

#endif
