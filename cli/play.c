#include "cli/command/arguments.h"
#include "compare/pictures/scene_error.h"
#include "player/gl/context.h"
#include "player/window/application.h"

#include <limits.h>

typedef struct play_command {
    weft_common_options common;
    weft_settings settings;
    int frame_limit; /* 0 = until the window is closed */
} play_command;

enum { WINDOW_WIDTH = 1280, WINDOW_HEIGHT = 800 };

static const weft_option option_table[] = {
    {"frames", .argument = "N", .help = "Quit after N frames", .kind = WEFT_OPTION_WHOLE,
     .offset = offsetof(play_command, frame_limit), .low = 1, .high = INT_MAX},
    {0},
};

/* A window has a panel beside its picture. */
static void choose_size(weft_settings *settings)
{
    if (settings->source || weft_settings_has(settings, "size"))
        return;
    settings->width = WINDOW_WIDTH;
    settings->height = WINDOW_HEIGHT;
}

static weft_code play(play_command *command, weft_error *error)
{
    const weft_application_setup setup = {
        .settings = &command->settings,
        .frame_limit = command->frame_limit,
        .measure = weft_scene_error_describe,
        .log = weft_command_log(&command->common),
    };
    weft_application *application;
    WEFT_TRY(weft_application_create(&setup, &application, error));
    weft_code code = weft_application_run(application, error);
    if (code == WEFT_OK) {
        long frames;
        double frame_ms;
        weft_application_speed(application, &frames, &frame_ms);
        weft_command_say(&command->common, "%ld frames, %.1f ms each, drawn by %s", frames, frame_ms,
                         weft_gl_renderer());
    }
    weft_application_free(application);
    return code;
}

static int run(int argc, char **argv)
{
    play_command command = {0};
    weft_arguments_parse(&weft_command_play, argc, argv, &command);
    choose_size(&command.settings);
    weft_error error = {0};
    weft_code code = play(&command, &error);
    weft_settings_free(&command.settings);
    return weft_command_exit("play", &command.common, code, &error);
}

const weft_command weft_command_play = {
    .name = "play",
    .summary = "draw a material in a window",
    .usage = "[NAME.weft]",
    .documentation = "Example: weft play silk.weft --raw silk.btf.h5 --weave silk.wv\n\n"
                     "Shows a material, a dataset or a cloth in a window; drag to turn it, drag with the right button "
                     "to move the light, H for all keys. "
                     "Files may be dropped on it, and are read again when they change.",
    .options = option_table,
    .settings_offset = offsetof(play_command, settings),
    .run = run,
};
