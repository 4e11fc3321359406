/* The scene that a command line asks for: options in any order, and the settings that they come to. */
#ifndef WEFT_PLAYER_SETTINGS_SCENE_OPTIONS_H
#define WEFT_PLAYER_SETTINGS_SCENE_OPTIONS_H

#include "btf/dataset/measured.h"
#include "player/settings/schema.h"
#include "player/settings/settings.h"

enum { WEFT_REQUEST_MAX_OPTIONS = 256 };

typedef struct weft_scene_request {
    weft_settings settings; /* what the options come to, once it is complete */
    const char *source;     /* the picture or text that they start from, or NULL */
    bool has_modes, split;  /* modes were asked for; as "split" */
    bool has_camera, has_lights;
    bool knows_measured[WEFT_MODE_COUNT]; /* what the files that are shown were measured from, where they say it */
    weft_measured measured[WEFT_MODE_COUNT];
    /* Kept until all are there, because --settings comes before all others, wherever it stands */
    int option_count;
    struct {
        const weft_setting *setting;
        const char *text;
    } option[WEFT_REQUEST_MAX_OPTIONS];
} weft_scene_request;

/* Takes note of an option, whose text must live on; NULL: it has none. Errors: WEFT_BAD_USAGE for too many of them. */
weft_code weft_scene_request_add(weft_scene_request *request, const weft_setting *setting, const char *text,
                                 weft_error *error);

/* Reads the settings that the options start from and applies these in their order. The caller frees with
 * weft_scene_request_free, also on failure. Errors: WEFT_BAD_USAGE for an option that cannot be understood and for
 * options that lack another; those of weft_settings_read and weft_settings_check_files. */
weft_code weft_scene_request_complete(weft_scene_request *request, weft_error *error);
void weft_scene_request_free(weft_scene_request *request);

/* Lights the scene by a built-in environment, with its shadows on a ground and highlights that keep their shape, where
 * the request says nothing else. */
void weft_look(weft_scene_request *request, const char *surroundings);

/* Whether an option of this name was given. Pure. */
bool weft_scene_request_has(const weft_scene_request *request, const char *name);

#endif
