#include "capture/capture.h"
#include "cli/arguments.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct capture_command {
    weft_common_options common;
    weft_capture_request request;
    const char *rig;
    bool dry_run;
} capture_command;

static const weft_option option_table[] = {
    {"output", 'o', "SESSION", "The folder of the session", .is_required = true, .kind = WEFT_OPTION_TEXT,
     .offset = offsetof(capture_command, request.folder)},
    {"rig", .argument = "virtual|FILE.json", .help = "The rig, or a file with its settings (default: virtual)",
     .kind = WEFT_OPTION_INPUT, .offset = offsetof(capture_command, rig)},
    {"sample", .argument = "CLOTH.wv|.stitch",
     .help = "What the virtual rig photographs: a weave, flat, or a stitch, which has depth", .is_required = true,
     .kind = WEFT_OPTION_INPUT, .offset = offsetof(capture_command, request.sample)},
    {"plan", .argument = "ubo81|FILE.csv",
     .help = "Which photographs: all pairs of 81 directions (default), or a table with the columns theta_light_deg, "
             "phi_light_deg, theta_view_deg, phi_view_deg",
     .kind = WEFT_OPTION_INPUT, .offset = offsetof(capture_command, request.plan)},
    {"seed", .argument = "N", .help = "Start of the random numbers of the virtual rig (default: 1)",
     .kind = WEFT_OPTION_SEED, .offset = offsetof(capture_command, request.seed)},
    {"truth", .argument = "FILE.h5", .help = "Where the ground truth goes (default: SESSION.truth.h5)",
     .kind = WEFT_OPTION_OUTPUT, .offset = offsetof(capture_command, request.truth)},
    {"truth-size", .argument = "N", .help = "Texels along a side of the truth (default: 64)", .kind = WEFT_OPTION_WHOLE,
     .offset = offsetof(capture_command, request.truth_size), .low = 1, .high = 4096},
    {"truth-images", .argument = "N", .help = "Photographs of which the truth is computed (default: 81)",
     .kind = WEFT_OPTION_WHOLE, .offset = offsetof(capture_command, request.truth_images), .low = 1, .high = 1000000},
    {"dry-run", .help = "Say what would be done and what it needs; write nothing", .kind = WEFT_OPTION_FLAG,
     .offset = offsetof(capture_command, dry_run)},
    {0},
};

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

static weft_code read_rig(capture_command *command, weft_error *error)
{
    if (!command->rig || strcmp(command->rig, "virtual") == 0)
        return WEFT_OK;
    return weft_rig_settings_read(command->rig, &command->request.settings, error);
}

static void say_warning(const weft_common_options *common, const char *warning)
{
    if (warning[0])
        weft_command_say(common, "%s", warning);
}

static weft_code rehearse(const capture_command *command, weft_error *error)
{
    const weft_common_options *common = &command->common;
    weft_capture_rehearsal rehearsal;
    WEFT_TRY(weft_capture_rehearse(&command->request, &rehearsal, error));
    say_warning(common, rehearsal.warning);
    weft_command_say(common, "%d photographs: %d views, each with all its lights before the camera moves on",
                     rehearsal.shot_count, rehearsal.view_count);
    weft_command_say(common, "%d lights step aside for the camera", rehearsal.driven_aside);
    weft_command_say(common, "disk: %.2f GB; time: about %.0f s, at the %.1f ms that one photograph took",
                     (double)rehearsal.bytes * 1e-9, rehearsal.seconds_per_photograph * rehearsal.shot_count,
                     rehearsal.seconds_per_photograph * 1e3);
    return WEFT_OK;
}

static void say_summary(const capture_command *command, const weft_capture_summary *summary)
{
    const weft_common_options *common = &command->common;
    say_warning(common, summary->warning);
    if (summary->found > 0)
        weft_command_say(common, "%d photographs were there already", summary->found);
    if (summary->damaged > 0)
        weft_command_say(common, "%d photographs did not match the journal and were taken again", summary->damaged);
    if (summary->timeouts > 0)
        weft_command_say(common, "%d exposures that the camera did not deliver were repeated", summary->timeouts);
    weft_command_say(common, "%s: %d photographs, of which %d taken now, in %.1f s with %d exposures",
                     command->request.folder, summary->found + summary->taken, summary->taken, summary->seconds,
                     summary->exposures);
}

static weft_code capture(const capture_command *command, weft_error *error)
{
    weft_progress progress = weft_command_progress(&command->common);
    weft_capture_summary summary;
    listen_for_stop();
    WEFT_TRY(weft_capture_run(&command->request, &stop_asked, &progress, &summary, error));
    say_summary(command, &summary);
    return WEFT_OK;
}

static int run(int argc, char **argv)
{
    capture_command command = {.request = weft_capture_request_default()};
    weft_arguments_parse(&weft_command_capture, argc, argv, &command);
    weft_error error = {0};
    weft_code code = read_rig(&command, &error);
    if (code == WEFT_OK)
        code = command.dry_run ? rehearse(&command, &error) : capture(&command, &error);
    return weft_command_exit("capture", &command.common, code, &error);
}

const weft_command weft_command_capture = {
    .name = "capture",
    .summary = "photograph a sample under all views and lights",
    .usage = "-o SESSION",
    .documentation = "Example: weft capture --rig virtual --sample assets/weaves/silk_charmeuse.wv -o silk/\n\n"
                     "Takes the photographs of a session: every pair of view and light of the plan. Run the same "
                     "command again after an "
                     "interruption of any kind, and it goes on where it was.",
    .options = option_table,
    .needs = "--sample CLOTH.wv or CLOTH.stitch, and -o SESSION",
    .surplus = "the session is named by -o",
    .run = run,
};
