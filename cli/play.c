#include "cli/arguments.h"
#include "cli/scene_errors.h"
#include "cli/scene_options.h"

#include "player/application.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct play_command {
    scene_options scene;
    int frame_limit; /* 0 = until the window is closed */
    weft_player *player;
} play_command;

enum { KEY_FRAMES = 0x5000 };

static const struct argp_option option_table[] = {
    {"frames", KEY_FRAMES, "N", 0, "Quit after N frames", 0},
    {0},
};

static error_t parse_option(int key, char *argument, struct argp_state *state)
{
    play_command *command = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &command->scene;
        return 0;
    case KEY_FRAMES:
        command->frame_limit = (int)parse_whole("frames", argument, 1, INT_MAX, state);
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp_child children[] = {{&scene_argp, 0, NULL, 1}, {0}};

static const struct argp parser = {
    option_table,
    parse_option,
    "[NAME.weft]",
    "Example: weft play silk.weft --raw silk.btf.h5 --weave silk.wv\n\n"
    "Shows a material in a window; drag to turn it, drag with the right button to move the light, H for all keys.",
    children,
    NULL,
    NULL};

/* ---- What the application asks for ---- */

/* The first free of weft-001.png, weft-002.png, ... in the current folder. */
static weft_code save_screenshot(void *context, const weft_scene *scene, int width, int height,
                                 char note[WEFT_NOTE_SIZE], weft_error *error)
{
    play_command *command = context;
    weft_settings *settings = &command->scene.settings;
    char path[32];
    int number = 1;
    do
        snprintf(path, sizeof path, "weft-%03d.png", number++);
    while (access(path, F_OK) == 0 && number < 1000);
    settings->scene = *scene;
    settings->width = width;
    settings->height = height;
    WEFT_TRY(weft_settings_draw(path, command->player, settings, NULL, error));
    snprintf(note, WEFT_NOTE_SIZE, "saved %s", path);
    command_say(&command->scene.common, "%s", note);
    return WEFT_OK;
}

static weft_code change_mesh(void *context, const char *name, weft_scene *scene, weft_error *error)
{
    play_command *command = context;
    weft_settings *settings = &command->scene.settings;
    char *old = settings->mesh;
    settings->mesh = strdup(name);
    settings->scene = *scene;
    weft_code code = settings->mesh ? scene_load_mesh(&command->scene, command->player, error)
                                    : weft_fail_memory(error, name, strlen(name));
    if (code == WEFT_OK)
        scene->repeat = settings->scene.repeat;
    free(code == WEFT_OK ? old : settings->mesh);
    if (code != WEFT_OK)
        settings->mesh = old;
    return code;
}

static weft_code measure_errors(void *context, const weft_scene *scene, int width, int height,
                                char note[WEFT_NOTE_SIZE], weft_error *error)
{
    const play_command *command = context;
    return scene_errors_print(command->player, scene, width, height, note, error);
}

/* ---- The command ---- */

static weft_application_setup setup_of(play_command *command)
{
    const weft_settings *options = &command->scene.settings;
    const char *first = options->material ? options->material : options->dataset ? options->dataset : options->weave;
    const char *slash = strrchr(first, '/');
    return (weft_application_setup){
        .title = slash ? slash + 1 : first,
        .file = {options->dataset, options->material, options->weave},
        .width = options->width,
        .height = options->height,
        .frame_limit = command->frame_limit,
        .host = {.context = command, .save = save_screenshot, .mesh = change_mesh, .measure = measure_errors},
    };
}

static weft_code play(play_command *command, weft_application **application, weft_error *error)
{
    const weft_application_setup setup = setup_of(command);
    WEFT_TRY(weft_application_create(&setup, application, error));
    command->player = weft_application_player(*application);
    WEFT_TRY(scene_load(&command->scene, command->player, error));
    return weft_application_run(*application, &command->scene.settings.scene, error);
}

int command_play(int argc, char **argv)
{
    play_command command = {0};
    command_parse(&parser, argc, argv, &command, &command.scene.common);
    weft_error error = {0};
    weft_application *application = NULL;
    weft_code code = play(&command, &application, &error);
    if (code == WEFT_OK) {
        long frames;
        double frame_ms;
        weft_application_speed(application, &frames, &frame_ms);
        command_say(&command.scene.common, "%ld frames, %.1f ms each, drawn by %s", frames, frame_ms,
                    weft_gl_renderer());
    }
    weft_application_free(application);
    scene_options_free(&command.scene);
    return command_exit("play", &command.scene.common, code, &error);
}
