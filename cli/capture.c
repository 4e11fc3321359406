#include "capture/capture.h"
#include "capture/virtual/ground_truth.h"
#include "cli/arguments.h"
#include "cli/command.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct capture_command {
    common_options common;
    weft_capture_request request;
    weft_virtual_request rig;
    weft_truth_request truth;
    const char *rig_file; /* NULL: the virtual rig as it stands */
    bool dry_run;
} capture_command;

enum { KEY_RIG = 0x2000, KEY_SAMPLE, KEY_PLAN, KEY_SEED, KEY_TRUTH, KEY_TRUTH_SIZE, KEY_TRUTH_IMAGES, KEY_DRY_RUN };

static const struct argp_option option_table[] = {
    {"output", 'o', "SESSION", 0, "The folder of the session", 0},
    {"rig", KEY_RIG, "virtual|FILE.json", 0, "The rig, or a file with its settings (default: virtual)", 0},
    {"sample", KEY_SAMPLE, "CLOTH.wv|.stitch", 0,
     "What the virtual rig photographs: a weave, flat, or a stitch, which has depth", 0},
    {"plan", KEY_PLAN, "ubo81|FILE.csv", 0,
     "Which photographs: all pairs of 81 directions (default), or a table with the columns theta_light_deg, "
     "phi_light_deg, "
     "theta_view_deg, phi_view_deg",
     0},
    {"seed", KEY_SEED, "N", 0, "Start of the random numbers of the virtual rig (default: 1)", 0},
    {"truth", KEY_TRUTH, "FILE.h5", 0, "Where the ground truth goes (default: SESSION.truth.h5)", 0},
    {"truth-size", KEY_TRUTH_SIZE, "N", 0, "Texels along a side of the truth (default: 64)", 0},
    {"truth-images", KEY_TRUTH_IMAGES, "N", 0, "Photographs of which the truth is computed (default: 81)", 0},
    {"dry-run", KEY_DRY_RUN, 0, 0, "Say what would be done and what it needs; write nothing", 0},
    {0},
};

static error_t parse_option(int key, char *argument, struct argp_state *state)
{
    capture_command *command = state->input;
    weft_capture_request *request = &command->request;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &command->common;
        return 0;
    case 'o':
        request->folder = argument;
        return 0;
    case KEY_RIG:
        command->rig_file = strcmp(argument, "virtual") == 0 ? NULL : argument;
        return 0;
    case KEY_SAMPLE:
        command->rig.sample = argument;
        return 0;
    case KEY_PLAN:
        request->plan = argument;
        return 0;
    case KEY_SEED:
        command->rig.seed = parse_whole("seed", argument, 0, INT64_MAX, state);
        return 0;
    case KEY_TRUTH:
        command->truth.path = argument;
        return 0;
    case KEY_TRUTH_SIZE:
        command->truth.size = (int)parse_whole("truth-size", argument, 1, 4096, state);
        return 0;
    case KEY_TRUTH_IMAGES:
        command->truth.image_count = (int)parse_whole("truth-images", argument, 1, 1000000, state);
        return 0;
    case KEY_DRY_RUN:
        command->dry_run = true;
        return 0;
    case ARGP_KEY_ARG:
        argp_error(state, "what is '%s'? The session is named by -o", argument);
        return 0;
    case ARGP_KEY_END:
        if (!request->folder || !command->rig.sample)
            argp_error(state, "needs --sample CLOTH.wv or CLOTH.stitch, and -o SESSION");
        refuse_same_file(command->truth.path, command->rig.sample, state);
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp_child children[] = {{&common_argp, 0, "Common options:", 9}, {0}};

static const struct argp parser = {
    option_table,
    parse_option,
    "-o SESSION",
    "Example: weft capture --rig virtual --sample assets/weaves/silk_charmeuse.wv -o silk/\n\n"
    "Takes the photographs of a session: every pair of view and light of the plan. Run the same command again after an "
    "interruption of any kind, and it goes on where it was.",
    children,
    NULL,
    NULL};

/* ---- Stopping ---- */

static volatile sig_atomic_t stop_asked;

static void ask_to_stop(int number)
{
    (void)number;
    stop_asked = 1;
}

static void listen_for_stop(void)
{
    /* A second signal ends the program at once; that is safe too. */
    struct sigaction action = {.sa_handler = ask_to_stop, .sa_flags = (int)SA_RESETHAND | SA_RESTART};
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
}

/* ---- Running ---- */

static void say_warning(const common_options *common, const char *warning)
{
    if (warning[0])
        command_say(common, "%s", warning);
}

static weft_code rehearse(const capture_command *command, weft_virtual_rig *rig, weft_error *error)
{
    const common_options *common = &command->common;
    weft_capture_rehearsal rehearsal;
    WEFT_TRY(weft_capture_rehearse(&command->request, &rig->rig, &rehearsal, error));
    say_warning(common, rig->warning);
    command_say(common, "%d photographs: %d views, each with all its lights before the camera moves on",
                rehearsal.shot_count, rehearsal.view_count);
    command_say(common, "%d lights step aside for the camera", rehearsal.driven_aside);
    command_say(common, "disk: %.2f GB; time: about %.0f s, at the %.1f ms that one photograph took",
                (double)rehearsal.bytes * 1e-9, rehearsal.seconds_per_photograph * rehearsal.shot_count,
                rehearsal.seconds_per_photograph * 1e3);
    return WEFT_OK;
}

static void say_summary(const capture_command *command, const weft_capture_summary *summary)
{
    const common_options *common = &command->common;
    if (summary->found > 0)
        command_say(common, "%d photographs were there already", summary->found);
    if (summary->damaged > 0)
        command_say(common, "%d photographs did not match the journal and were taken again", summary->damaged);
    if (summary->timeouts > 0)
        command_say(common, "%d exposures that the camera did not deliver were repeated", summary->timeouts);
    command_say(common, "%s: %d photographs, of which %d taken now, in %.1f s with %d exposures",
                command->request.folder, summary->found + summary->taken, summary->taken, summary->seconds,
                summary->exposures);
}

/* The photographs, then the truth that they are to be measured against. */
static weft_code photograph(const capture_command *command, const weft_virtual_rig *rig, weft_capture *capture,
                            const weft_progress *progress, weft_error *error)
{
    const weft_session *session = &capture->held.session;
    WEFT_TRY(weft_truth_check_path(&command->truth, session, error));
    WEFT_TRY(weft_capture_take(capture, &stop_asked, progress, error));
    return weft_truth_write(&command->truth, session, rig, progress, error);
}

static weft_code take_session(const capture_command *command, weft_virtual_rig *rig, weft_error *error)
{
    weft_progress progress = command_progress(&command->common);
    weft_capture capture;
    listen_for_stop();
    WEFT_TRY(weft_capture_begin(&command->request, &rig->rig, &progress, &capture, error));
    weft_code code = photograph(command, rig, &capture, &progress, error);
    weft_capture_end(&capture);
    if (code == WEFT_OK) {
        say_warning(&command->common, rig->warning);
        say_summary(command, &capture.summary);
    }
    return code;
}

static weft_code open_rig_and_capture(capture_command *command, weft_error *error)
{
    weft_virtual_rig rig;
    if (command->rig_file)
        WEFT_TRY(weft_virtual_settings_read(command->rig_file, &command->rig.settings, error));
    WEFT_TRY(weft_virtual_rig_open(&command->rig, &rig, error));
    weft_code code = command->dry_run ? rehearse(command, &rig, error) : take_session(command, &rig, error);
    weft_virtual_rig_close(&rig);
    return code;
}

int command_capture(int argc, char **argv)
{
    capture_command command = {.request = {.plan = "ubo81"},
                               .rig = {.seed = 1, .settings = weft_virtual_settings_default()},
                               .truth = {.size = 64, .image_count = WEFT_UBO81_COUNT}};
    command_parse(&parser, argc, argv, &command, &command.common);
    weft_error error = {0};
    weft_code code = open_rig_and_capture(&command, &error);
    return command_exit("capture", &command.common, code, &error);
}
