/* What `weft render` and `weft play` have in common: the scene on the command line, and how it is loaded. */
#ifndef WEFT_CLI_SCENE_OPTIONS_H
#define WEFT_CLI_SCENE_OPTIONS_H

#include "cli/command.h"
#include "player/player.h"

typedef struct scene_options {
    common_options common;
    const char *material, *dataset, *weave, *mesh;
    const char *mode; /* NULL: what is there */
    double tiles[2];  /* of the weave across the material; 0 = as the virtual rig lays it out */
    double repeat;    /* 0 = by the mesh */
    bool has_camera;  /* else by the mesh */
    int width, height;
    weft_scene scene;
} scene_options;

/* Options of the scene, an argp child whose input is a scene_options. */
extern const struct argp scene_argp;

/* To be called from ARGP_KEY_INIT: defaults. */
void scene_options_init(scene_options *options);

/* Loads the mesh and every model that is named into the player, and chooses the panes. Notes are told to the user.
 * Errors: those of reading. */
weft_code scene_load(scene_options *options, weft_player *player, weft_error *error);

/* Writes a linear picture: .exr as it is, other formats as the screen shows the scene (in place). Errors: WEFT_SYSTEM.
 */
weft_code scene_write_image(const char *path, const weft_scene *scene, weft_image *image, weft_error *error);

#endif
