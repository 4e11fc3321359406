#include "cli/arguments.h"
#include "cli/scene_errors.h"
#include "cli/scene_load.h"
#include "cli/sequence.h"

#include "player/gl/context.h"

typedef struct render_command {
    scene_options scene;
    const char *output;
    const char *path_file; /* of a sequence, or NULL */
    double frames_per_second;
    weft_path path;
} render_command;

enum { KEY_PATH = 0x4000, KEY_FPS };

static const struct argp_option option_table[] = {
    {"output", 'o', "OUT.png|OUT.exr", 0, "Write the picture here: .png as sRGB, .exr linear", 0},
    {"path", KEY_PATH, "PATH.csv", 0,
     "Move camera and light through the key frames of this table; -o frame-%04d.png names the pictures", 0},
    {"fps", KEY_FPS, "N", 0, "Frames per second of a path (default: 25)", 0},
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
    case KEY_PATH:
        command->path_file = argument;
        return 0;
    case KEY_FPS:
        command->frames_per_second = parse_number("fps", argument, 1e-3, 1e4, state);
        return 0;
    case ARGP_KEY_END:
        if (!command->output)
            argp_error(state, "needs -o OUT.png");
        refuse_same_file(command->output, command->scene.settings.environment, state);
        if (command->path_file && !sequence_is_pattern(command->output))
            argp_error(state, "--path needs one place for a number in -o, as in frame-%%04d.png, not '%s'",
                       command->output);
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp_child children[] = {{&scene_argp, 0, NULL, 1}, {0}};

static const struct argp parser = {
    option_table,
    parse_option,
    "[NAME.weft] -o OUT.png\n[NAME.weft] --path PATH.csv -o frame-%04d.png",
    "Example: weft render silk.weft --raw silk.btf.h5 --weave silk.wv --mode split -o silk.png\n\n"
    "Draws a material without a window. The picture keeps its settings: --settings draws it again.",
    children,
    NULL,
    NULL};

static weft_code draw_picture(render_command *command, weft_player *player, weft_error *error)
{
    const scene_options *scene = &command->scene;
    const weft_settings *settings = &scene->settings;
    weft_progress progress = command_progress(&scene->common);
    char errors[SCENE_ERRORS_SIZE];
    WEFT_TRY(weft_settings_draw(command->output, player, settings, &progress, error));
    WEFT_TRY(scene_errors_print(player, &settings->scene, settings->width, settings->height, errors, error));
    if (errors[0])
        command_say(&scene->common, "%s", errors);
    WEFT_TRY(environment_error_print(player, settings, errors, error));
    if (errors[0])
        command_say(&scene->common, "%s", errors);
    return WEFT_OK;
}

static weft_code draw(render_command *command, weft_player *player, weft_error *error)
{
    if (command->path_file)
        WEFT_TRY(weft_path_read(command->path_file, &command->path, error));
    WEFT_TRY(scene_load(&command->scene, player, error));
    if (!command->path_file)
        return draw_picture(command, player, error);
    return sequence_draw(command->output, &command->path, command->frames_per_second, &command->scene, player, error);
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
    render_command command = {.frames_per_second = 25};
    command_parse(&parser, argc, argv, &command, &command.scene.common);
    weft_error error = {0};
    weft_code code = render(&command, &error);
    weft_path_free(&command.path);
    scene_options_free(&command.scene);
    return command_exit("render", &command.scene.common, code, &error);
}
