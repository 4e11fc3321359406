/* What each option of the scene does to the settings. */
#ifndef WEFT_CLI_SCENE_VALUES_H
#define WEFT_CLI_SCENE_VALUES_H

#include "cli/scene_options.h"

enum {
    KEY_SETTINGS = 0x3000,
    KEY_RAW,
    KEY_RAW_FORMAT,
    KEY_WEAVE,
    KEY_TILES,
    KEY_MODE,
    KEY_LAYOUT,
    KEY_DIVIDER,
    KEY_MESH,
    KEY_MESH_SIZE,
    KEY_MESH_UNIT,
    KEY_REPEAT,
    KEY_LIGHT,
    KEY_SHADOWS,
    KEY_ENVIRONMENT,
    KEY_ENVIRONMENT_TURN,
    KEY_ENVIRONMENT_STRENGTH,
    KEY_ENVIRONMENT_REFERENCE,
    KEY_EXPOSURE,
    KEY_TONE,
    KEY_CAMERA,
    KEY_SIZE,
    KEY_SAMPLES,
    KEY_LEVEL,
    KEY_FILTER,
    KEY_LOBES,
    KEY_TABLES,
    KEY_TABLE_BITS,
    KEY_NOISE,
    KEY_SHOW,
    KEY_NO_LABELS
};

/* Applies one option; ARGP_KEY_ARG is the material. Wrong usage does not return. */
void scene_apply(scene_options *options, int key, const char *argument, struct argp_state *state);

#endif
