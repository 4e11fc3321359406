#include "capture/capture.h"
#include "btf/session/poses_file.h"
#include "capture/laboratory/laboratory.h"
#include "capture/preflight/preflight.h"
#include "capture/virtual/ground_truth.h"
#include "cli/capture_report.h"
#include "cli/command/arguments.h"
#include "cli/command/operator.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct capture_command {
    weft_common_options common;
    weft_capture_request request;
    weft_virtual_request rig;
    weft_truth_request truth;
    const char *rig_file; /* "virtual" or NULL: the virtual rig as it stands */
    const char *colour;   /* file */
    const char *poses;    /* NULL: where the axes truly are is not known */
    bool dry_run, check;
} capture_command;

static const weft_option option_table[] = {
    {"output", 'o', "SESSION", "The folder of the session", .is_required = true, .kind = WEFT_OPTION_FOLDER,
     .offset = offsetof(capture_command, request.folder)},
    {"rig", .argument = "virtual|RIG.conf|FILE.json",
     .help = "The virtual rig (default), a rig of yours as its file describes it, or settings of the virtual rig",
     .kind = WEFT_OPTION_INPUT, .offset = offsetof(capture_command, rig_file)},
    {"sample", .argument = "CLOTH.wv|.stitch|NAME",
     .help = "What is photographed. Virtual rig: a weave (flat) or a stitch (with depth). Your own rig: any name",
     .is_required = true, .kind = WEFT_OPTION_INPUT, .offset = offsetof(capture_command, rig.sample)},
    {"plan", .argument = "ubo81|ubo151|FILE.csv",
     .help = "Which photographs: all pairs of 81 directions (default) or of 151, or a table with the columns "
             "theta_light_deg, "
             "phi_light_deg, theta_view_deg, phi_view_deg",
     .kind = WEFT_OPTION_INPUT, .offset = offsetof(capture_command, request.plan)},
    {"seed", .argument = "N", .help = "Start of the random numbers of the virtual rig", .usual = "1",
     .kind = WEFT_OPTION_SEED, .offset = offsetof(capture_command, rig.seed)},
    {"poses", .argument = "POSES.json|FOLDER",
     .help = "Calibrated axes of the virtual rig, from weft calibrate; for several cameras, a folder with one "
             "CAMERA.json each. Your own rig names its poses in its file",
     .kind = WEFT_OPTION_INPUT, .offset = offsetof(capture_command, poses)},
    {"truth", .argument = "FILE.h5",
     .help = "Where the ground truth goes (default: SESSION.truth.h5; of several cameras SESSION.CAMERA.truth.h5)",
     .kind = WEFT_OPTION_OUTPUT, .offset = offsetof(capture_command, truth.path)},
    {"truth-size", .argument = "N", .help = "Texels along a side of the truth", .usual = "64",
     .kind = WEFT_OPTION_WHOLE, .offset = offsetof(capture_command, truth.size), .low = 1, .high = 4096},
    {"truth-images", .argument = "N", .help = "Photographs of which the truth is computed", .usual = "81",
     .kind = WEFT_OPTION_WHOLE, .offset = offsetof(capture_command, truth.image_count), .low = 1, .high = 1000000},
    {"brackets", .argument = "N",
     .help = "Up to N more photographs of a shot, with other exposures, where the first one clips or is too dark (0 to "
             "4; default: 0)",
     .kind = WEFT_OPTION_WHOLE, .offset = offsetof(capture_command, request.brackets), .low = 0,
     .high = WEFT_SESSION_MAX_BRACKETS},
    {"colour", .argument = "COLOUR.json",
     .help = "The colours of the camera under the lamp, from weft colour: kept in the session for registration",
     .kind = WEFT_OPTION_INPUT, .offset = offsetof(capture_command, colour)},
    {"status", .argument = "FOLDER", .help = "Write a page that shows progress, and update it at every view",
     .kind = WEFT_OPTION_FOLDER, .offset = offsetof(capture_command, request.status)},
    {"dry-run", .help = "Say what would be done and what it needs; write nothing", .kind = WEFT_OPTION_FLAG,
     .offset = offsetof(capture_command, dry_run)},
    {"check",
     .help = "Check the rig with a few photographs: focus, light, noise, target, vibration, disk. Writes "
             "SESSION.check.png and no session",
     .kind = WEFT_OPTION_FLAG, .offset = offsetof(capture_command, check)},
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
    /* A second signal ends the program at once. That is safe, too: a session holds what was taken, axes stop when
     * nobody asks for them, and lamps are guarded. */
    struct sigaction action = {.sa_handler = ask_to_stop, .sa_flags = (int)SA_RESETHAND | SA_RESTART};
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
}

/* ---- Running ---- */

static void report_warning(const weft_common_options *common, const char *warning)
{
    if (warning[0])
        weft_command_say(common, "%s", warning);
}

static void report_camera(const capture_command *command, const weft_rig *rig)
{
    if (rig->camera_name)
        weft_command_say(&command->common, "camera '%s':", rig->camera_name);
}

static weft_code rehearse(const capture_command *command, weft_rig *rig, const char *warning, weft_error *error)
{
    for (weft_rig *one = rig; one; one = one->next) {
        weft_capture_rehearsal rehearsal;
        report_camera(command, one);
        WEFT_TRY(weft_capture_rehearse(&command->request, one, &rehearsal, error));
        report_warning(&command->common, warning);
        weft_report_rehearsal(&command->common, &rehearsal, one->stage.order != NULL);
        weft_capture_rehearsal_free(&rehearsal);
    }
    return rig->next ? weft_report_synchronised_shots(&command->common, &command->request, rig, error) : WEFT_OK;
}

/* ---- Checks before a run ---- */

static weft_code judge(const capture_command *command, const char *camera, const weft_preflight *result,
                       weft_error *error)
{
    char path[PATH_MAX], ending[64];
    snprintf(ending, sizeof ending, "%s%s.check.png", camera ? "." : "", camera ? camera : "");
    weft_beside_folder(command->request.folder, ending, path);
    WEFT_TRY(weft_image_write(path, &result->sheet, NULL, error));
    WEFT_TRY(weft_report_checks(&command->common, result, error));
    weft_command_say(&command->common,
                     "%s shows %d views: with the lamp, the change until the next photograph times 8, "
                     "without the lamp times 100",
                     path, result->pose_count);
    int failed = 0;
    for (int kind = 0; kind < WEFT_CHECK_KINDS; kind++)
        failed += result->check[kind].done && !result->check[kind].passed;
    return failed ? weft_fail(error, WEFT_BAD_INPUT, "%d of the checks failed", failed) : WEFT_OK;
}

/* Of several cameras, one after another. */
static weft_code check_all(const capture_command *command, weft_rig *rig, weft_error *error)
{
    weft_progress progress = weft_command_progress(&command->common);
    weft_code result = WEFT_OK;
    for (weft_rig *one = rig; one; one = one->next) {
        weft_preflight found;
        report_camera(command, one);
        weft_code code = weft_preflight_run(&command->request, one, &progress, &found, error);
        if (code == WEFT_OK) {
            code = judge(command, one->camera_name, &found, error);
            weft_preflight_free(&found);
        }
        if (weft_class_of(code) == WEFT_SYSTEM)
            return code;
        result = result == WEFT_OK ? code : result;
    }
    return result;
}

/* ---- The run ---- */

static void report_summary(const capture_command *command, const weft_capture_summary *summary)
{
    const weft_common_options *common = &command->common;
    if (summary->found > 0)
        weft_command_say(common, "%d photographs were there already", summary->found);
    if (summary->damaged > 0)
        weft_command_say(common, "%d photographs did not match the journal and were taken again", summary->damaged);
    if (summary->timeouts > 0)
        weft_command_say(common, "%d exposures that the camera did not deliver were repeated", summary->timeouts);
    if (summary->disturbed > 0)
        weft_command_say(common, "%d photographs during which the stage did not stand still were taken again",
                         summary->disturbed);
    if (summary->bracketed > 0)
        weft_command_say(common, "%d more photographs, with other exposures", summary->bracketed);
    weft_command_say(common, "%s: %d photographs, of which %d taken now, in %.1f s with %d exposures",
                     command->request.folder, summary->found + summary->taken, summary->taken, summary->seconds,
                     summary->exposures);
}

/* The truth of each of several cameras lies in a file of its own: its name goes before the ending. */
static void choose_truth_path(const capture_command *command, const weft_rig *rig, char path[PATH_MAX])
{
    const char *asked = command->truth.path;
    char ending[64];
    size_t length = asked ? strlen(asked) : 0;
    bool has_ending = length > 3 && strcmp(asked + length - 3, ".h5") == 0;
    snprintf(ending, sizeof ending, ".%s%s", rig->camera_name, has_ending ? ".h5" : ".truth.h5");
    if (asked)
        snprintf(path, PATH_MAX, "%.*s%s", (int)(length - (has_ending ? 3 : 0)), asked, ending);
    else
        weft_beside_folder(command->request.folder, ending, path);
}

/* Of each camera of the virtual rig, with or without writing it. */
static weft_code handle_truth(const capture_command *command, const weft_virtual_rig *virtual,
                              const weft_capture *capture, bool write, const weft_progress *progress, weft_error *error)
{
    for (int i = 0; i < capture->camera_count; i++) {
        const weft_session *session = &capture->held[i].session;
        weft_truth_request truth = command->truth;
        char path[PATH_MAX];
        if (capture->camera_count > 1) {
            choose_truth_path(command, &virtual[i].rig, path);
            truth.path = path;
        }
        WEFT_TRY(write ? weft_truth_write(&truth, session, &virtual[i], progress, error)
                       : weft_truth_check_path(&truth, session, error));
    }
    return WEFT_OK;
}

/* The photographs of any rig; then, of the virtual one, the truth that they are to be measured against. */
static weft_code photograph(const capture_command *command, const weft_virtual_rig *virtual, weft_capture *capture,
                            const weft_progress *progress, weft_error *error)
{
    if (virtual)
        WEFT_TRY(handle_truth(command, virtual, capture, false, progress, error));
    WEFT_TRY(weft_capture_take(capture, &stop_asked, progress, error));
    return virtual ? handle_truth(command, virtual, capture, true, progress, error) : WEFT_OK;
}

static weft_code take_session(const capture_command *command, weft_rig *rig, const weft_virtual_rig *virtual,
                              weft_error *error)
{
    weft_progress progress = weft_command_progress(&command->common);
    weft_capture capture;
    listen_for_stop();
    WEFT_TRY(weft_capture_begin(&command->request, rig, &progress, &capture, error));
    weft_code code = photograph(command, virtual, &capture, &progress, error);
    weft_capture_end(&capture);
    if (code == WEFT_OK) {
        report_warning(&command->common, virtual ? virtual->warning : "");
        report_summary(command, &capture.summary);
    }
    return code;
}

/* ---- Rigs of one or several cameras ---- */

/* Of one camera a file, of several a folder. */
static weft_code read_poses(const capture_command *command, weft_rig *rig, weft_error *error)
{
    static weft_poses_file poses[WEFT_VIRTUAL_CAMERAS_MAX];
    static char path[WEFT_VIRTUAL_CAMERAS_MAX][PATH_MAX];
    for (int i = 0; command->poses && rig; i++, rig = rig->next) {
        WEFT_TRY(weft_camera_file(command->poses, rig->camera_name, path[i], PATH_MAX, error));
        WEFT_TRY(weft_poses_read(path[i], &poses[i], error));
        rig->poses = &poses[i].poses;
        rig->poses_path = path[i];
    }
    return WEFT_OK;
}

static weft_code capture_with_virtual_cameras(const capture_command *command, weft_virtual_rig *rigs, weft_error *error)
{
    WEFT_TRY(read_poses(command, &rigs[0].rig, error));
    if (command->dry_run)
        return rehearse(command, &rigs[0].rig, rigs[0].warning, error);
    return command->check ? check_all(command, &rigs[0].rig, error) : take_session(command, &rigs[0].rig, rigs, error);
}

static weft_code capture_with_virtual_rig(capture_command *command, weft_error *error)
{
    static weft_virtual_rig rigs[WEFT_VIRTUAL_CAMERAS_MAX];
    int count;
    if (command->rig_file && strcmp(command->rig_file, "virtual") != 0)
        WEFT_TRY(weft_virtual_settings_read(command->rig_file, &command->rig.settings, error));
    WEFT_TRY(weft_virtual_rigs_open(&command->rig, rigs, &count, error));
    weft_code code = capture_with_virtual_cameras(command, rigs, error);
    for (int i = 0; i < count; i++)
        weft_virtual_rig_close(&rigs[i]);
    return code;
}

static weft_code capture_with_laboratory(const capture_command *command, weft_error *error)
{
    weft_terminal_operator terminal = weft_operator_of(&command->common, &stop_asked);
    const weft_laboratory_request request = {.rig_file = command->rig_file,
                                             .sample = command->rig.sample,
                                             .rig_operator = weft_operator_at_terminal(&terminal),
                                             .stop = &stop_asked};
    weft_laboratory *laboratory;
    if (command->truth.path)
        return weft_fail(error, WEFT_BAD_USAGE, "--truth needs the virtual rig");
    if (command->poses)
        return weft_fail(error, WEFT_BAD_USAGE, "--poses needs the virtual rig; name the poses of your own rig in '%s'",
                         command->rig_file);
    WEFT_TRY(weft_laboratory_open(&request, &laboratory, error));
    weft_rig *rig = weft_laboratory_rig(laboratory);
    if (rig->next && command->colour) {
        weft_laboratory_close(laboratory);
        return weft_fail(error, WEFT_BAD_USAGE,
                         "--colour takes one camera; name the colour file of each camera in '%s'", command->rig_file);
    }
    weft_code code = command->dry_run ? rehearse(command, rig, "", error) : weft_laboratory_connect(laboratory, error);
    if (code == WEFT_OK && command->check)
        code = check_all(command, rig, error);
    else if (code == WEFT_OK && !command->dry_run)
        code = take_session(command, rig, NULL, error);
    weft_laboratory_close(laboratory);
    return code;
}

static bool is_rig_file(const char *path)
{
    const char *ending = path ? strrchr(path, '.') : NULL;
    return ending && strcmp(ending, ".conf") == 0;
}

static weft_code check_options(void *values, weft_error *error)
{
    const capture_command *command = values;
    return command->dry_run && command->check
               ? weft_fail(error, WEFT_BAD_USAGE, "--dry-run and --check exclude each other: --check uses the devices")
               : WEFT_OK;
}

static int run(int argc, char **argv)
{
    capture_command command = {.request = {.plan = "ubo81"}, .rig = {.settings = weft_virtual_settings_default()}};
    weft_arguments_parse(&weft_command_capture, argc, argv, &command);
    weft_error error = {0};
    weft_code code = command.colour ? weft_colour_read(command.colour, &command.request.colour, &error) : WEFT_OK;
    if (code == WEFT_OK)
        code = is_rig_file(command.rig_file) ? capture_with_laboratory(&command, &error)
                                             : capture_with_virtual_rig(&command, &error);
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
    .needs = "--sample with a cloth or a name, and -o SESSION",
    .surplus = "name the session with -o",
    .check = check_options,
    .run = run,
};
