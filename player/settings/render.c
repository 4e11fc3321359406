#include "weft/render.h"

#include "player/gl/context.h"
#include "player/settings/exposure.h"
#include "player/settings/scene_loader.h"

#include <string.h>

enum { MOST_OPTIONS = 256 };

/* The file that `weft render` takes without an option, "material". */
static const char argument_name[] = "material";

/* "NAME=VALUE" or "NAME". */
static weft_code find_option(const char *text, weft_given_option *given, weft_error *error)
{
    size_t length = strcspn(text, "=");
    for (const weft_setting *s = weft_settings_schema(); s->key || s->option.name; s++) {
        const char *name = s->option.name ? s->option.name : s->option.argument ? argument_name : NULL;
        if (name && strlen(name) == length && strncmp(name, text, length) == 0) {
            *given = (weft_given_option){s, text[length] ? text + length + 1 : NULL};
            return WEFT_OK;
        }
    }
    return weft_fail(error, WEFT_BAD_USAGE, "a picture has no option '%s'", text);
}

static weft_code read_options(const char *const *options, weft_settings *settings, weft_error *error)
{
    weft_given_option given[MOST_OPTIONS];
    int count = 0;
    for (; options[count]; count++) {
        if (count == MOST_OPTIONS)
            return weft_fail(error, WEFT_BAD_USAGE, "more than %d options", MOST_OPTIONS);
        WEFT_TRY(find_option(options[count], &given[count], error));
    }
    return weft_settings_of_options(given, count, settings, error);
}

static weft_code draw(weft_settings *settings, weft_player *player, const char *output, const weft_progress *progress,
                      const weft_log *log, weft_error *error)
{
    bool is_exposed;
    WEFT_TRY(weft_scene_load(settings, player, progress, log, error));
    if (!weft_settings_is_linear(output))
        WEFT_TRY(weft_expose(settings, player, &settings->scene, &is_exposed, error));
    return weft_settings_draw(output, player, settings, progress, error);
}

static weft_code draw_headless(weft_settings *settings, const char *output, const weft_progress *progress,
                               const weft_log *log, weft_error *error)
{
    weft_headless *headless = NULL;
    weft_player *player = NULL;
    WEFT_TRY(weft_headless_create(WEFT_GL_CORE, &headless, error));
    weft_code code = weft_player_create(&player, error);
    if (code == WEFT_OK)
        code = draw(settings, player, output, progress, log, error);
    weft_player_free(player);
    weft_headless_free(headless);
    return code;
}

weft_code weft_render(const char *const *options, const char *output, const weft_progress *progress,
                      const weft_log *log, weft_error *error)
{
    static const weft_log silent = {0};
    weft_settings settings = {0};
    if (!weft_settings_is_picture(output))
        return weft_fail(error, WEFT_BAD_USAGE, "'%s' names no kind of picture: .png, .exr or .tif", output);
    weft_code code = read_options(options, &settings, error);
    if (code == WEFT_OK)
        code = draw_headless(&settings, output, progress, log ? log : &silent, error);
    weft_settings_free(&settings);
    return code;
}
