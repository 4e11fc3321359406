/* What `weft render` and `weft play` have in common: the scene on the command line, and how it is loaded. */
#ifndef WEFT_CLI_SCENE_OPTIONS_H
#define WEFT_CLI_SCENE_OPTIONS_H

#include "cli/command.h"
#include "player/settings/settings.h"

enum { SCENE_MAX_OPTIONS = 256 };

typedef struct scene_options {
    common_options common;
    weft_settings settings; /* what the options come to, once they are parsed; freed by scene_options_free */
    const char *source;     /* the picture it starts from, or NULL */
    bool has_modes, split;  /* --mode was given; it is split */
    bool has_camera, has_lights;
    /* Kept until the end of the command line, because --settings comes before all others, wherever it stands */
    int option_count;
    struct {
        int key;
        char *argument;
    } option[SCENE_MAX_OPTIONS];
} scene_options;

/* Options of the scene, an argp child whose input is a scene_options. */
extern const struct argp scene_argp;

void scene_options_free(scene_options *options);

#endif
