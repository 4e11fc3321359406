#include "cli/arguments.h"
#include "cli/play_host.h"
#include "cli/scene_values.h"

#include <limits.h>
#include <stdio.h>
#include <string.h>

typedef struct play_command {
    scene_options scene;
    int frame_limit; /* 0 = until the window is closed */
} play_command;

enum { KEY_FRAMES = 0x5000, WINDOW_WIDTH = 1280, WINDOW_HEIGHT = 800 };

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
    "Shows a material in a window; drag to turn it, drag with the right button to move the light, H for all keys. "
    "Files may be dropped on it, and are read again when they change.",
    children,
    NULL,
    NULL};

/* ---- The command ---- */

/* A window has a panel beside its picture. */
static void choose_size(scene_options *scene)
{
    bool is_given = scene->source != NULL;
    for (int i = 0; i < scene->option_count; i++)
        is_given |= scene->option[i].key == KEY_SIZE;
    if (is_given)
        return;
    scene->settings.width = WINDOW_WIDTH;
    scene->settings.height = WINDOW_HEIGHT;
}

/* `title` outlives the settings, whose names change as files are dropped. */
static weft_application_setup setup_of(play_command *command, play_host *host, char title[256])
{
    const weft_settings *settings = &command->scene.settings;
    const char *first = settings->material  ? settings->material
                        : settings->dataset ? settings->dataset
                                            : settings->weave;
    const char *slash = strrchr(first, '/');
    snprintf(title, 256, "%s", slash ? slash + 1 : first);
    return (weft_application_setup){
        .title = title,
        .width = settings->width,
        .height = settings->height,
        .frame_limit = command->frame_limit,
        .host = play_host_calls(host),
    };
}

/* Reading begins before the window opens. */
static weft_code play(play_command *command, play_host *host, char title[256], weft_error *error)
{
    const weft_application_setup setup = setup_of(command, host, title);
    WEFT_TRY(play_host_create(&command->scene, host, error));
    WEFT_TRY(weft_application_create(&setup, &host->application, error));
    WEFT_TRY(scene_loader_attach(host->loader, weft_application_player(host->application), error));
    return weft_application_run(host->application, &command->scene.settings.scene, error);
}

int command_play(int argc, char **argv)
{
    play_command command = {0};
    command_parse(&parser, argc, argv, &command, &command.scene.common);
    choose_size(&command.scene);
    weft_error error = {0};
    play_host host = {0};
    char title[256];
    weft_code code = play(&command, &host, title, &error);
    if (code == WEFT_OK) {
        long frames;
        double frame_ms;
        weft_application_speed(host.application, &frames, &frame_ms);
        command_say(&command.scene.common, "%ld frames, %.1f ms each, drawn by %s", frames, frame_ms,
                    weft_gl_renderer());
    }
    play_host_free(&host);
    weft_application_free(host.application);
    scene_options_free(&command.scene);
    return command_exit("play", &command.scene.common, code, &error);
}
