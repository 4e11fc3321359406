#include "cli/command/arguments.h"
#include "compare/pictures/scene_error.h"
#include "player/gl/context.h"
#include "player/settings/exposure.h"
#include "player/settings/key_frames.h"
#include "player/settings/scene_loader.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { DEFAULT_FPS = 25 };

typedef struct render_command {
    weft_common_options common;
    weft_settings settings;
    const char *output;
    const char *path_file;    /* of a sequence, or NULL */
    double frames_per_second; /* 0: not given */
    weft_path path;
} render_command;

static const weft_option option_table[] = {
    {"output", 'o', "OUT.png|OUT.exr", "Write the picture here: .png as sRGB, .exr linear", .is_required = true,
     .kind = WEFT_OPTION_OUTPUT, .offset = offsetof(render_command, output)},
    {"path", .argument = "PATH.csv",
     .help = "Move camera and light through the key frames of this table; -o frame-%04d.png names the pictures",
     .kind = WEFT_OPTION_INPUT, .offset = offsetof(render_command, path_file)},
    {"fps", .argument = "N", .help = "Frames per second of a path (default: 25)", .kind = WEFT_OPTION_NUMBER,
     .offset = offsetof(render_command, frames_per_second), .low = 1e-3, .high = 1e4},
    {0},
};

/* ---- Names of the frames of a path ---- */

/* "%d" or "%04d" in a name. */
typedef struct place {
    size_t start, end; /* in the name */
    int width;         /* 0 for "%d" */
} place;

static bool find_place(const char *pattern, place *found)
{
    const char *percent = strchr(pattern, '%');
    *found = (place){0};
    if (!percent || strchr(percent + 1, '%'))
        return false;
    const char *at = percent + 1;
    if (*at == '0' && isdigit((unsigned char)at[1]) && at[2] == 'd') {
        found->width = at[1] - '0';
        at += 2;
    }
    found->start = (size_t)(percent - pattern);
    found->end = (size_t)(at - pattern) + 1;
    return *at == 'd';
}

/* Whether the name holds exactly one place for a number, %d or %04d, and no other '%'. */
static bool is_pattern(const char *pattern)
{
    place found;
    return find_place(pattern, &found);
}

/* The caller frees; NULL where memory is short. */
static char *frame_name(const char *pattern, int number)
{
    place p;
    char *name;
    if (!find_place(pattern, &p))
        return strdup(pattern);
    int length = asprintf(&name, "%.*s%0*d%s", (int)p.start, pattern, p.width, number, pattern + p.end);
    return length < 0 ? NULL : name;
}

/* ---- Options ---- */

/* Refuses options that would do nothing for want of another. In a window what they want may come later. */
static weft_code refuse_idle(const render_command *command, weft_error *error)
{
    const weft_settings *s = &command->settings;
    const struct {
        const char *option;
        bool works;
        const char *wanted;
    } row[] = {
        {"raw-format", s->dataset, "--raw NAME.btf.h5"},
        {"tiles", s->weave, "--weave CLOTH.wv"},
        {"noise", s->weave || s->scene.noise_seed == 0, "--weave CLOTH.wv"},
        {"lobes-on", s->material, "NAME.weft"},
        {"tables", s->material, "NAME.weft"},
        {"environment-turn", s->environment, "--environment MAP.hdr"},
        {"environment-strength", s->environment, "--environment MAP.hdr"},
        {"environment-reference", s->environment, "--environment MAP.hdr"},
        {"divider", s->scene.layout == WEFT_LAYOUT_WIPE, "--layout wipe"},
        {"shadows", s->scene.light_count > 0 || !s->scene.shadows, "a --light"},
        {"tone", !weft_settings_is_linear(command->output), "-o OUT.png: other pictures are linear"},
    };
    for (size_t i = 0; i < sizeof row / sizeof *row; i++)
        if (weft_settings_has(s, row[i].option) && !row[i].works)
            return weft_fail(error, WEFT_BAD_USAGE, "--%s needs %s", row[i].option, row[i].wanted);
    if (command->frames_per_second > 0 && !command->path_file)
        return weft_fail(error, WEFT_BAD_USAGE, "--fps needs --path PATH.csv");
    return WEFT_OK;
}

static weft_code check(void *values, weft_error *error)
{
    const render_command *command = values;
    WEFT_TRY(refuse_idle(command, error));
    if (!weft_settings_is_picture(command->output))
        return weft_fail(error, WEFT_BAD_USAGE, "'%s' names no kind of picture: -o takes .png, .exr or .tif",
                         command->output);
    if (command->path_file && !is_pattern(command->output))
        return weft_fail(error, WEFT_BAD_USAGE,
                         "--path needs one place for a number in -o, as in frame-%%04d.png, not '%s'", command->output);
    return WEFT_OK;
}

/* Whether something of lobes or tables is asked for that components do not have. */
static bool asks_of_lobes(const weft_scene *scene)
{
    bool some_off = !scene->view_table || !scene->light_table;
    for (int i = 0; i < WEFT_SCENE_MAX_LOBES; i++)
        some_off |= !scene->lobe[i];
    return some_off;
}

/* Chooses what the command line left open, and says what that was. A linear picture keeps its numbers. */
static weft_code look(const render_command *command, weft_player *player, weft_scene *scene, weft_error *error)
{
    const weft_common_options *common = &command->common;
    const weft_settings *settings = &command->settings;
    char text[WEFT_MESSAGE_SIZE];
    bool exposed = false;
    if (!weft_settings_is_linear(command->output))
        WEFT_TRY(weft_expose(settings, player, scene, &exposed, error));
    if (exposed)
        weft_command_say(common, "exposure %.3g (--exposure 1 shows reflectance)", scene->exposure);
    WEFT_TRY(weft_describe_unmeasured(settings, player, scene, text, error));
    if (text[0])
        weft_command_say(common, "%s", text);
    if (weft_player_drawn_components(player, scene) > 0 && asks_of_lobes(scene))
        weft_command_say(common, "the material is drawn by its components: --lobes-on and --tables change nothing");
    return WEFT_OK;
}

static weft_code draw_picture(render_command *command, weft_player *player, weft_error *error)
{
    const weft_common_options *common = &command->common;
    const weft_settings *settings = &command->settings;
    weft_progress progress = weft_command_progress(common);
    char errors[WEFT_SCENE_ERROR_SIZE];
    WEFT_TRY(weft_settings_draw(command->output, player, settings, &progress, error));
    WEFT_TRY(weft_scene_error_describe(player, &settings->scene, settings->width, settings->height, errors, error));
    if (errors[0])
        weft_command_say(common, "%s", errors);
    WEFT_TRY(weft_environment_error_describe(player, settings, errors, error));
    if (errors[0])
        weft_command_say(common, "%s", errors);
    return WEFT_OK;
}

/* What was drawn before an error stays. */
static weft_code draw_sequence(const render_command *command, weft_player *player, const weft_progress *progress,
                               weft_error *error)
{
    double frames_per_second = command->frames_per_second > 0 ? command->frames_per_second : DEFAULT_FPS;
    const weft_path *path = &command->path;
    weft_settings at_frame = command->settings;
    int count;
    WEFT_TRY(weft_path_count_frames(path, frames_per_second, &count, error));
    for (int i = 0; i < count; i++) {
        weft_progress_report(progress, "drawing frames", i, count);
        weft_path_apply(path, path->time_s[0] + i / frames_per_second, &at_frame.scene);
        char *name = frame_name(command->output, i);
        if (!name)
            return weft_fail_memory(error, command->output, strlen(command->output));
        weft_code code = weft_settings_draw(name, player, &at_frame, NULL, error);
        free(name);
        WEFT_TRY(code);
    }
    weft_progress_report(progress, "drawing frames", count, count);
    return WEFT_OK;
}

static weft_code draw(render_command *command, weft_player *player, weft_error *error)
{
    const weft_progress progress = weft_command_progress(&command->common);
    const weft_log log = weft_command_log(&command->common);
    weft_settings *settings = &command->settings;
    if (command->path_file)
        WEFT_TRY(weft_path_read(command->path_file, &command->path, error));
    WEFT_TRY(weft_scene_load(settings, player, &progress, &log, error));
    WEFT_TRY(look(command, player, &settings->scene, error));
    return command->path_file ? draw_sequence(command, player, &progress, error) : draw_picture(command, player, error);
}

static weft_code render(render_command *command, weft_error *error)
{
    const weft_settings *settings = &command->settings;
    weft_headless *headless = NULL;
    weft_player *player = NULL;
    WEFT_TRY(weft_headless_create(WEFT_GL_CORE, &headless, error));
    weft_code code = weft_player_create(&player, error);
    if (code == WEFT_OK)
        code = draw(command, player, error);
    if (code == WEFT_OK)
        weft_command_say(&command->common, "%s: %d x %d, drawn by %s", command->output, settings->width,
                         settings->height, weft_gl_renderer());
    weft_player_free(player);
    weft_headless_free(headless);
    return code;
}

static int run(int argc, char **argv)
{
    render_command command = {0};
    weft_arguments_parse(&weft_command_render, argc, argv, &command);
    weft_error error = {0};
    weft_code code = render(&command, &error);
    weft_path_free(&command.path);
    weft_settings_free(&command.settings);
    return weft_command_exit("render", &command.common, code, &error);
}

const weft_command weft_command_render = {
    .name = "render",
    .summary = "draw a material to an image file",
    .usage = "[NAME.weft] -o OUT.png\n[NAME.weft] --path PATH.csv -o frame-%04d.png",
    .documentation = "Example: weft render silk.weft --raw silk.btf.h5 --weave silk.wv --mode split -o silk.png\n\n"
                     "Draws a material without a window. The picture keeps its settings: --settings draws it again.",
    .options = option_table,
    .settings_offset = offsetof(render_command, settings),
    .needs = "-o OUT.png",
    .check = check,
    .run = run,
};
