#include "cli/scene_errors.h"
#include "cli/scene_options.h"

#include "player/context.h"

typedef struct render_command {
    scene_options scene;
    const char *output;
} render_command;

static const struct argp_option option_table[] = {
    {"output", 'o', "OUT.png|OUT.exr", 0, "Write the picture here: .png as sRGB, .exr linear", 0},
    {0},
};

static error_t parse_option(int key, char *argument, struct argp_state *state)
{
    render_command *command = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &command->scene;
        return 0;
    case 'o':
        command->output = argument;
        return 0;
    case ARGP_KEY_END:
        if (!command->output)
            argp_error(state, "needs -o OUT.png");
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp_child children[] = {{&scene_argp, 0, NULL, 1}, {0}};

static const struct argp parser = {
    option_table,
    parse_option,
    "[NAME.weft] -o OUT.png",
    "Example: weft render silk.weft --raw silk.btf.h5 --weave silk.wv --mode split -o silk.png\n\n"
    "Draws a material under one light, without a window.",
    children,
    NULL,
    NULL};

static weft_code draw(render_command *command, weft_player *player, weft_error *error)
{
    scene_options *scene = &command->scene;
    const weft_settings *settings = &scene->settings;
    weft_progress progress = command_progress(&scene->common);
    char errors[SCENE_ERRORS_SIZE];
    WEFT_TRY(scene_load(scene, player, error));
    WEFT_TRY(weft_settings_draw(command->output, player, settings, &progress, error));
    WEFT_TRY(scene_errors_print(player, &settings->scene, settings->width, settings->height, errors, error));
    if (errors[0])
        command_say(&scene->common, "%s", errors);
    return WEFT_OK;
}

static weft_code render(render_command *command, weft_error *error)
{
    weft_headless *headless = NULL;
    weft_player *player = NULL;
    WEFT_TRY(weft_headless_create(WEFT_GL_CORE, &headless, error));
    weft_code code = weft_player_create(&player, error);
    if (code == WEFT_OK)
        code = draw(command, player, error);
    if (code == WEFT_OK)
        command_say(&command->scene.common, "%s: %d x %d, drawn by %s", command->output, command->scene.settings.width,
                    command->scene.settings.height, weft_gl_renderer());
    weft_player_free(player);
    weft_headless_free(headless);
    return code;
}

int command_render(int argc, char **argv)
{
    render_command command = {0};
    command_parse(&parser, argc, argv, &command, &command.scene.common);
    weft_error error = {0};
    weft_code code = render(&command, &error);
    scene_options_free(&command.scene);
    return command_exit("render", &command.scene.common, code, &error);
}
