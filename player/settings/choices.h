/* Options of a scene that set more than the one value, or not as it stands: `read` of the schema (player/settings/
 * schema.h). Each takes a weft_scene_request. Errors: those of weft_option_set. */
#ifndef WEFT_PLAYER_SETTINGS_CHOICES_H
#define WEFT_PLAYER_SETTINGS_CHOICES_H

#include "base/text/option.h"

typedef weft_code weft_choice(const weft_option *option, const char *text, void *request, weft_error *error);

/* The file that is shown, whatever of the three it is: material, dataset or cloth. */
weft_choice weft_choose_file;

/* A map lights everything by itself, unless lights are asked for; "off": none. */
weft_choice weft_choose_environment;

/* The first takes the place of the lights that were there. */
weft_choice weft_choose_light;

/* Whether the cloth then has its real size follows from which of these is given last. */
weft_choice weft_choose_repeat, weft_choose_mesh_size, weft_choose_mesh_unit;

weft_choice weft_choose_camera, weft_choose_level, weft_choose_lobes, weft_choose_tables, weft_choose_modes;
weft_choice weft_choose_overlays, weft_choose_no_labels;

#endif
