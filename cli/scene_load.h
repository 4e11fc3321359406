/* The files of a scene: read in the background, shown in a player as they arrive, and replaced while it plays. */
#ifndef WEFT_CLI_SCENE_LOAD_H
#define WEFT_CLI_SCENE_LOAD_H

#include "cli/scene_options.h"

typedef struct scene_loader scene_loader;

/* Begins to read what the settings of `options` name, which must live on; needs no OpenGL. From here on the settings
 * name what is shown. The caller frees with scene_loader_free, before the player. Errors: WEFT_SYSTEM. */
weft_code scene_loader_create(scene_options *options, scene_loader **result, weft_error *error);
void scene_loader_free(scene_loader *loader);

/* Says where to show it; before all functions below. Errors: WEFT_SYSTEM. */
weft_code scene_loader_attach(scene_loader *loader, weft_player *player, weft_error *error);

/* Shows what has arrived, for some milliseconds. *shown: something is, and the settings' scene may have other panes and
 * another `repeat`; names of the settings that were there before are then freed, with an error too. `note`
 * (WEFT_MESSAGE_SIZE) is what the user should know, or "". Errors: of one file; what was shown in its place stays. */
weft_code scene_loader_poll(scene_loader *loader, bool *shown, char note[WEFT_MESSAGE_SIZE], weft_error *error);

/* All of it; notes are told to the user. Errors: those of reading; WEFT_BAD_USAGE where a comparison lacks a model. */
weft_code scene_loader_finish(scene_loader *loader, weft_error *error);

/* All of these at once, for who only wants the picture. Errors: as above. */
weft_code scene_load(scene_options *options, weft_player *player, weft_error *error);

/* Share of the file that is being read; -1: none. */
double scene_loader_progress(scene_loader *loader);

/* Begins to read a file that replaces the one of its kind; a picture with settings replaces all there is. Errors:
 * WEFT_BAD_INPUT for a file of no such kind; WEFT_SYSTEM. */
weft_code scene_loader_open(scene_loader *loader, const char *path, weft_error *error);

/* The same for a mesh, built in or a file. */
weft_code scene_loader_open_mesh(scene_loader *loader, const char *name, weft_error *error);

/* Begins to read again what is shown: all files, or that of a slot (cli/scene_part.h). Errors: WEFT_SYSTEM. */
weft_code scene_loader_reload(scene_loader *loader, weft_error *error);
weft_code scene_loader_reload_slot(scene_loader *loader, int slot, weft_error *error);

#endif
