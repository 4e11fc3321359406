#include "registration/registration.h"

#include "base/atomic_file.h"

#include <stdio.h>
#include <stdlib.h>

/* Of one camera, the report lies in the folder asked for; of several, in a folder of each. */
static weft_code choose_settings(const weft_register_options *options, weft_registered *c, weft_error *error)
{
    if (c->list.count > 0 && options->report_folder)
        WEFT_TRY(weft_make_folder(options->report_folder, error));
    for (int i = 0; i < c->count; i++) {
        weft_registration_settings *settings = &c->settings[i];
        *settings = weft_registration_defaults(&c->session[i]);
        settings->width = options->width > 0 ? options->width : settings->width;
        settings->height = options->height > 0 ? options->height : settings->height;
        settings->allow_unfinished = options->allow_unfinished;
        settings->report_folder = options->report_folder;
        if (c->list.count == 0 || !options->report_folder)
            continue;
        snprintf(c->report_folder[i], sizeof c->report_folder[i], "%s/%s", options->report_folder, c->list.name[i]);
        settings->report_folder = c->report_folder[i];
    }
    return WEFT_OK;
}

/* What is the same for all cameras must be told of one model: the colours of another are others. */
static weft_code take_one_colour(const weft_register_options *options, weft_registered *c, weft_error *error)
{
    weft_colour colour;
    WEFT_TRY(weft_colour_read(options->colour, &colour, error));
    for (int i = 0; i < c->count; i++)
        c->session[i].colour.terms = 0;
    WEFT_TRY(weft_camera_sessions_agree(c->session, c->count, error));
    for (int i = 0; i < c->count; i++)
        c->session[i].colour = colour;
    return WEFT_OK;
}

static weft_code take_colour_of_each(const weft_register_options *options, weft_registered *c, weft_error *error)
{
    for (int i = 0; i < c->count; i++) {
        char path[PATH_MAX];
        WEFT_TRY(weft_camera_file(options->colour, c->list.name[i], path, sizeof path, error));
        WEFT_TRY(weft_colour_read(path, &c->session[i].colour, error));
    }
    return WEFT_OK;
}

static weft_code take_colour(const weft_register_options *options, weft_registered *c, weft_error *error)
{
    char path[PATH_MAX];
    if (!options->colour)
        return WEFT_OK;
    bool is_file = weft_camera_file(options->colour, NULL, path, sizeof path, error) == WEFT_OK;
    if (is_file)
        return take_one_colour(options, c, error);
    return c->list.count > 0 ? take_colour_of_each(options, c, error) : WEFT_BAD_INPUT;
}

static weft_code register_all(const char *folder, const char *output, const weft_register_options *options,
                              const weft_progress *progress, weft_registered *c, weft_error *error)
{
    WEFT_TRY(weft_camera_list_read(folder, &c->list, error));
    WEFT_TRY(choose_settings(options, c, error));
    WEFT_TRY(take_colour(options, c, error));
    return weft_register_cameras(c->session, c->count, output, c->settings, progress, c->registration, error);
}

weft_code weft_register_folder(const char *folder, const char *output, const weft_register_options *options,
                               const weft_progress *progress, weft_registered **result, weft_error *error)
{
    static const weft_register_options usual = {0};
    weft_registered *c = calloc(1, sizeof *c);
    if (!c)
        return weft_fail_memory(error, "cameras", sizeof *c);
    weft_code code = weft_camera_sessions_open(folder, &c->session, &c->count, error);
    if (code == WEFT_OK)
        code = register_all(folder, output, options ? options : &usual, progress, c, error);
    c->is_done = code == WEFT_OK;
    if (code == WEFT_OK)
        *result = c;
    else
        weft_registered_free(c);
    return code;
}

void weft_registered_free(weft_registered *c)
{
    if (!c)
        return;
    for (int i = 0; c->is_done && i < c->count; i++)
        weft_registration_free(&c->registration[i]);
    weft_camera_sessions_free(c->session, c->count);
    free(c);
}

weft_code weft_register(const char *session, const char *output, const weft_register_options *options,
                        const weft_progress *progress, weft_register_report *report, weft_error *error)
{
    weft_registered *c;
    WEFT_TRY(weft_register_folder(session, output, options, progress, &c, error));
    weft_register_report own = {.camera_count = c->count};
    for (int i = 0; i < c->count; i++) {
        const weft_registration *r = &c->registration[i];
        own.photograph_count += c->session[i].shot_count;
        own.used_count += r->image_count;
        own.viewpoint_count += r->survey.viewpoint_count;
        own.registered_count += r->survey.viewpoint_count - r->failed_viewpoints;
    }
    if (report)
        *report = own;
    weft_registered_free(c);
    return WEFT_OK;
}
