/* The files of a scene: read in the background, shown in a player as they arrive, and replaced while it plays. */
#ifndef WEFT_PLAYER_SETTINGS_SCENE_LOADER_H
#define WEFT_PLAYER_SETTINGS_SCENE_LOADER_H

#include "btf/material/held_out.h"
#include "player/settings/settings.h"

typedef struct weft_scene_loader weft_scene_loader;

/* Begins to read what `settings` name, which must live on; needs no OpenGL. From here on the settings
 * name what is shown. The caller frees with weft_scene_loader_free, before the player. Errors: WEFT_SYSTEM. */
weft_code weft_scene_loader_create(weft_settings *settings, weft_scene_loader **result, weft_error *error);
void weft_scene_loader_free(weft_scene_loader *loader);

/* Says where to show it; before all functions below. Errors: WEFT_SYSTEM. */
weft_code weft_scene_loader_attach(weft_scene_loader *loader, weft_player *player, weft_error *error);

/* Shows what has arrived, for some milliseconds. *shown: something is, and the settings' scene may have other panes and
 * another `repeat`; names of the settings that were there before are then freed, with an error too. `note`
 * (WEFT_MESSAGE_SIZE) is what the user should know, or "". Errors: of one file; what was shown in its place stays. */
weft_code weft_scene_loader_poll(weft_scene_loader *loader, bool *shown, char note[WEFT_MESSAGE_SIZE],
                                 weft_error *error);

/* All of it. `log` hears what the user should know; `progress` may be NULL. Errors: those of reading; WEFT_BAD_USAGE
 * where a comparison lacks a model. */
weft_code weft_scene_loader_finish(weft_scene_loader *loader, const weft_progress *progress, const weft_log *log,
                                   weft_error *error);

/* All of these at once, for who only wants the picture. Errors: as above; WEFT_BAD_USAGE for a scene of 0 components
 * where the material has no lobes. */
weft_code weft_scene_load(weft_settings *settings, weft_player *player, const weft_progress *progress,
                          const weft_log *log, weft_error *error);

/* Share of the file that is being read; -1: none. */
double weft_scene_loader_progress(weft_scene_loader *loader);

/* What the material that is there says of its error; NULL where it says nothing, or there is none. Its contents change
 * with the material, the place does not. */
const weft_hold_out *weft_scene_loader_held_out(const weft_scene_loader *loader);

/* Begins to read a file that replaces the one of its kind; a picture with settings replaces all there is. Errors:
 * WEFT_BAD_INPUT for a file of no such kind; WEFT_SYSTEM. */
weft_code weft_scene_loader_open(weft_scene_loader *loader, const char *path, weft_error *error);

/* The same for a mesh, built in or a file. */
weft_code weft_scene_loader_open_mesh(weft_scene_loader *loader, const char *name, weft_error *error);

/* The same for a built-in environment. */
weft_code weft_scene_loader_open_surroundings(weft_scene_loader *loader, const char *name, weft_error *error);

/* Begins to read again what is shown: all files, or that of a slot (player/settings/scene_part.h). Errors: WEFT_SYSTEM.
 */
weft_code weft_scene_loader_reload(weft_scene_loader *loader, weft_error *error);
weft_code weft_scene_loader_reload_slot(weft_scene_loader *loader, int slot, weft_error *error);

#endif
