#include "cli/arguments.h"
#include "cli/command.h"
#include "registration/registration.h"
#include "registration/report_tables.h"

#include <limits.h>
#include <stdio.h>
#include <string.h>

typedef struct register_command {
    conversion files;
    const char *report_folder;
    int width, height;
    bool allow_unfinished;
} register_command;

enum { KEY_REPORT = 0x2000, KEY_ALLOW_UNFINISHED, LARGEST_SIZE = 8192 };

static const struct argp_option option_table[] = {
    {"output", 'o', "NAME.btf.h5", 0, "The dataset to write", 0},
    {"size", 's', "WxH", 0, "Texels of the opening (default: 64x64)", 0},
    {"report", KEY_REPORT, "DIR", 0, "Write a report with pictures into this folder", 0},
    {"allow-unfinished", KEY_ALLOW_UNFINISHED, 0, 0, "Register what there is of a session that is not finished", 0},
    {0},
};

static error_t parse_option(int key, char *argument, struct argp_state *state)
{
    register_command *command = state->input;
    switch (key) {
    case 's':
        parse_size("size", argument, LARGEST_SIZE, &command->width, &command->height, state);
        return 0;
    case KEY_REPORT:
        command->report_folder = argument;
        return 0;
    case KEY_ALLOW_UNFINISHED:
        command->allow_unfinished = true;
        return 0;
    default:
        return parse_conversion(key, argument, state, &command->files);
    }
}

static const struct argp_child children[] = {{&common_argp, 0, "Common options:", 9}, {0}};

static const struct argp parser = {
    option_table,
    parse_option,
    "SESSION -o NAME.btf.h5",
    "Example: weft register session/ -o cloth.btf.h5 --size 64x64 --report report/\n\n"
    "Turns the photographs of a session into a dataset: finds where the camera stood "
    "for every view, rectifies the photographs and calibrates them against the white "
    "reference. What cannot be used is named and masked; so is, without a word, what a view does "
    "not see of texels beside the frame.",
    children,
    NULL,
    NULL};

static void say_faults(const register_command *command, const weft_session *session, const weft_registration *r)
{
    for (int stay = 0; stay < r->survey.stay_count; stay++) {
        const weft_stay *one = &r->survey.stay[stay];
        if (r->pose[stay].remark[0])
            command_say(&command->files.common, "view %s, stay %d: %s%s",
                        weft_view_name_of(r->survey.view[one->view]).text, one->stay,
                        r->pose[stay].source == WEFT_POSE_FAILED ? "masked: " : "kept the markers' pose: ",
                        r->pose[stay].remark);
    }
    for (int shot = 0; shot < session->shot_count; shot++) {
        if (r->fault[shot].reason[0])
            command_say(&command->files.common, "masked: %s", r->fault[shot].reason);
    }
    if (r->estimated_whites)
        command_say(&command->files.common,
                    "%d photographs show no usable white reference; they use the light's power measured in the others",
                    r->estimated_whites);
}

static weft_code say_outcome(const register_command *command, const weft_session *session, const weft_registration *r,
                             weft_error *error)
{
    weft_ring_summary all;
    WEFT_TRY(weft_ring_summarise(session, r, -1, &all, error));
    say_faults(command, session, r);
    command_say(&command->files.common, "%s: %d x %d texels, %d of %d photographs, %d of %d stays registered",
                command->files.output, r->settings.width, r->settings.height, r->image_count, session->shot_count,
                r->survey.stay_count - r->failed_stays, r->survey.stay_count);
    command_say(
        &command->files.common,
        "random error of a position, estimated: %.4f texels median, %.4f worst; %.3f %% of the samples saturated",
        all.median_uncertainty, all.worst_uncertainty, 100 * all.saturated);
    if (command->report_folder)
        command_say(&command->files.common, "report: %s/index.html", command->report_folder);
    return WEFT_OK;
}

int command_register(int argc, char **argv)
{
    register_command command = {
        .files = {.noun = "session", .needed = "a session and -o NAME.btf.h5"}, .width = 64, .height = 64};
    command_parse(&parser, argc, argv, &command, &command.files.common);
    weft_progress progress = command_progress(&command.files.common);
    weft_session session;
    weft_registration registration;
    weft_error error = {0};
    weft_code code = weft_session_open(command.files.input, &session, &error);
    if (code != WEFT_OK)
        return command_exit("register", &command.files.common, code, &error);
    weft_registration_settings settings = weft_registration_defaults(&session);
    settings.width = command.width;
    settings.height = command.height;
    settings.allow_unfinished = command.allow_unfinished;
    settings.report_folder = command.report_folder;
    code = weft_register_session(&session, command.files.output, &settings, &progress, &registration, &error);
    if (code == WEFT_OK) {
        code = say_outcome(&command, &session, &registration, &error);
        weft_registration_free(&registration);
    }
    weft_session_free(&session);
    return command_exit("register", &command.files.common, code, &error);
}
