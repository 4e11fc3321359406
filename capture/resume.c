#include "capture/capture.h"

#include "base/atomic_file.h"
#include "base/text/json_text.h"
#include "capture/photograph_writer.h"
#include "capture/session_check.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <jansson.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>
#include <unistd.h>

/* ---- One process at a time ---- */

static weft_code lock_folder(const char *folder, int *lock, weft_error *error)
{
    char path[PATH_MAX];
    snprintf(path, sizeof path, "%s/.lock", folder);
    *lock = open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (*lock < 0)
        return weft_fail_errno(error, "open", path);
    if (flock(*lock, LOCK_EX | LOCK_NB) == 0)
        return WEFT_OK;
    if (errno == EWOULDBLOCK)
        return weft_fail(error, WEFT_SYSTEM, "another process takes photographs in session '%s'", folder);
    return weft_fail_errno(error, "lock", path);
}

/* What a process left that died before it renamed it: whoever holds the lock is alone. */
static void sweep(const char *folder)
{
    char path[PATH_MAX];
    snprintf(path, sizeof path, "%s/session.json", folder);
    weft_sweep_left_over(path);
    snprintf(path, sizeof path, "%s/%s", folder, weft_unfinished_photograph);
    unlink(path);
}

/* ---- New or known ---- */

/* Hidden files are locks and temporary files. */
static weft_code refuse_unexpected_files(const char *folder, weft_error *error)
{
    DIR *listing = opendir(folder);
    if (!listing)
        return weft_fail_errno(error, "list folder", folder);
    bool has_others = false;
    for (struct dirent *entry; (entry = readdir(listing));)
        has_others = has_others || entry->d_name[0] != '.';
    closedir(listing);
    return has_others ? weft_fail(error, WEFT_BAD_INPUT, "folder '%s' is neither empty nor a session", folder)
                      : WEFT_OK;
}

static weft_code create_or_open(const weft_session *wanted, weft_session *session, weft_error *error)
{
    char path[PATH_MAX];
    snprintf(path, sizeof path, "%s/session.json", wanted->folder);
    if (access(path, F_OK) != 0) {
        WEFT_TRY(refuse_unexpected_files(wanted->folder, error));
        WEFT_TRY(weft_session_create(wanted, error));
    }
    /* Also a new session is read back, so that it is the same numbers that a later run will work with. */
    return weft_session_open(wanted->folder, session, error);
}

/* ---- The same session? ---- */

static bool nearly(double a, double b)
{
    return fabs(a - b) <= 1e-9 * fmax(1, fabs(b));
}

static bool same_angles(weft_angles a, weft_angles b)
{
    return nearly(a.theta_rad, b.theta_rad) && nearly(a.phi_rad, b.phi_rad);
}

/* The number of the first shot that differs, or -1. */
static int first_other_shot(const weft_session *a, const weft_session *b)
{
    for (int i = 0; i < a->shot_count; i++) {
        const weft_shot *p = &a->shot[i], *q = &b->shot[i];
        if (!same_angles(p->light, q->light) || !same_angles(p->view, q->view) ||
            !same_angles(p->light_driven, q->light_driven))
            return i;
    }
    return -1;
}

/* Names a key of which two JSON objects hold different values, in `name`; false where there is none. */
static bool find_difference(json_t *a, json_t *b, char *name, size_t size)
{
    const char *key;
    json_t *value;
    json_object_foreach (a, key, value) {
        json_t *other = json_object_get(b, key);
        bool same = json_is_number(value) && json_is_number(other)
                        ? nearly(json_number_value(value), json_number_value(other))
                        : json_equal(value, other);
        if (!same) {
            snprintf(name, size, "%s", key);
            return true;
        }
    }
    return false;
}

static weft_code check_settings(const weft_session *wanted, const weft_session *found, weft_error *error)
{
    json_t *a = NULL, *b = NULL;
    char name[64];
    weft_code code = weft_json_parse(wanted->rig_settings, strlen(wanted->rig_settings), 0, wanted->folder, &a, error);
    if (code == WEFT_OK)
        code = weft_json_parse(found->rig_settings, strlen(found->rig_settings), 0, wanted->folder, &b, error);
    if (code == WEFT_OK)
        weft_settings_rename_former(b);
    if (code == WEFT_OK && (find_difference(a, b, name, sizeof name) || find_difference(b, a, name, sizeof name)))
        code = weft_fail(error, WEFT_BAD_INPUT,
                         "session '%s' was begun with another '%s'; repeat its settings or choose another folder",
                         wanted->folder, name);
    json_decref(a);
    json_decref(b);
    return code;
}

/* Numbers come back from the file as they went in, to the last digit or nearly. */
static bool same_colour(const weft_colour *a, const weft_colour *b)
{
    bool same = a->terms == b->terms;
    for (int i = 0; same && i < 3 * a->terms; i++)
        same = nearly(a->matrix[i / a->terms][i % a->terms], b->matrix[i / a->terms][i % a->terms]);
    return same;
}

/* Whether both know, or do not know, where the rig puts the camera, and put it there. */
static bool same_poses(const weft_session *a, const weft_session *b)
{
    if (!a->pose || !b->pose)
        return !a->pose && !b->pose;
    for (int i = 0; i < a->shot_count; i++) {
        for (int k = 0; k < 3; k++) {
            if (!nearly(a->pose[i].rotation[k], b->pose[i].rotation[k]) ||
                !nearly(a->pose[i].translation[k], b->pose[i].translation[k]))
                return false;
        }
    }
    return true;
}

static weft_code check_same(const weft_session *wanted, const weft_session *found, weft_error *error)
{
    if (strcmp(wanted->rig, found->rig) != 0)
        return weft_fail(error, WEFT_BAD_INPUT, "session '%s' was begun with the rig '%s', not '%s'", wanted->folder,
                         found->rig, wanted->rig);
    WEFT_TRY(check_settings(wanted, found, error));
    if (wanted->shot_count != found->shot_count)
        return weft_fail(error, WEFT_BAD_INPUT, "session '%s' was begun with a plan of %d shots, this one has %d",
                         wanted->folder, found->shot_count, wanted->shot_count);
    int shot = first_other_shot(wanted, found);
    if (shot >= 0)
        return weft_fail(error, WEFT_BAD_INPUT, "session '%s' was begun with another plan: shot %d differs",
                         wanted->folder, shot);
    if (wanted->colour.terms > 0 && !same_colour(&wanted->colour, &found->colour))
        return weft_fail(
            error, WEFT_BAD_INPUT,
            "session '%s' was begun with another colour file: leave out --colour here, and pass it to weft register",
            wanted->folder);
    if (wanted->dark_frames != found->dark_frames || wanted->flat_frames != found->flat_frames)
        return weft_fail(error, WEFT_BAD_INPUT,
                         "session '%s' was begun with %d dark and %d flat frames; repeat them or choose another folder",
                         wanted->folder, found->dark_frames, found->flat_frames);
    if (!same_poses(wanted, found))
        return weft_fail(error, WEFT_BAD_INPUT,
                         "session '%s' was begun with other poses of the rig; repeat them or choose another folder",
                         wanted->folder);
    return WEFT_OK;
}

/* ---- Are the photographs there? ---- */

/* What the journal has and the check finds wrong is taken again. */
static void forget_damaged(const weft_session_problems *problems, weft_held_session *held)
{
    for (int i = 0; i < problems->count; i++) {
        int shot = problems->problem[i].shot, frame = problems->problem[i].frame;
        if (frame >= 0)
            held->session.frame[frame].taken = false;
        if (shot < 0 || !held->session.record[shot].taken)
            continue;
        held->session.record[shot].taken = false;
        held->damaged++;
    }
}

static weft_code check_photographs(weft_held_session *held, const weft_progress *progress, weft_error *error)
{
    weft_session_problems problems;
    WEFT_TRY(weft_session_check(&held->session, progress, &problems, error));
    forget_damaged(&problems, held);
    weft_session_problems_free(&problems);
    return WEFT_OK;
}

static int count_viewpoints(const weft_session *session)
{
    int viewpoints = 0;
    for (int i = 0; i < session->shot_count; i++) {
        if (session->record[i].taken && session->record[i].viewpoint >= viewpoints)
            viewpoints = session->record[i].viewpoint + 1;
    }
    return viewpoints;
}

static weft_code hold(const weft_session *wanted, const weft_progress *progress, weft_held_session *held,
                      weft_error *error)
{
    WEFT_TRY(lock_folder(wanted->folder, &held->lock, error));
    sweep(wanted->folder);
    WEFT_TRY(create_or_open(wanted, &held->session, error));
    WEFT_TRY(check_same(wanted, &held->session, error));
    held->next_viewpoint = count_viewpoints(&held->session);
    return check_photographs(held, progress, error);
}

weft_code weft_session_hold(const weft_session *wanted, const weft_progress *progress, weft_held_session *held,
                            weft_error *error)
{
    *held = (weft_held_session){.lock = -1};
    WEFT_TRY(weft_make_folder(wanted->folder, error));
    weft_sync_folder_of(wanted->folder);
    weft_code code = hold(wanted, progress, held, error);
    if (code != WEFT_OK)
        weft_held_session_release(held);
    return code;
}

void weft_held_session_release(weft_held_session *held)
{
    weft_session_free(&held->session);
    if (held->lock >= 0)
        close(held->lock);
    held->lock = -1;
}

/* ---- The folder of several cameras ---- */

weft_camera_list weft_camera_list_of(const weft_rig *rig)
{
    weft_camera_list list = {0};
    for (const weft_rig *one = rig->first; one && list.count < WEFT_CAMERAS_MAX; one = one->next)
        snprintf(list.name[list.count++], WEFT_CAMERA_NAME_SIZE, "%s", one->camera_name);
    return list;
}

static bool is_same(const weft_camera_list *a, const weft_camera_list *b)
{
    bool same = a->count == b->count;
    for (int i = 0; same && i < a->count; i++)
        same = strcmp(a->name[i], b->name[i]) == 0;
    return same;
}

weft_code weft_camera_folder_prepare(const char *folder, const weft_camera_list *list, weft_error *error)
{
    weft_camera_list found;
    WEFT_TRY(weft_make_folder(folder, error));
    weft_sync_folder_of(folder);
    WEFT_TRY(weft_camera_list_read(folder, &found, error));
    if (found.count > 0)
        return is_same(list, &found)
                   ? WEFT_OK
                   : weft_fail(error, WEFT_BAD_INPUT,
                               "session '%s' was begun with other cameras; repeat them or choose another folder",
                               folder);
    WEFT_TRY(refuse_unexpected_files(folder, error));
    return weft_camera_list_write(folder, list, error);
}

void weft_camera_folder_sweep(const char *folder)
{
    char path[PATH_MAX];
    snprintf(path, sizeof path, "%s/%s", folder, weft_camera_list_file);
    weft_sweep_left_over(path);
}
