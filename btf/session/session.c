#include "btf/session/session.h"

#include "base/integers.h"
#include "base/text/json_text.h"
#include "btf/session/camera_json.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SESSION_VERSION = 1, MAX_SESSION_BYTES = 1 << 28 };

static const char session_name[] = "session.json";
static const weft_json_kind kind = {"weft_session", SESSION_VERSION, "is not a session", "is a session"};

static void session_path(const weft_session *session, char path[PATH_MAX])
{
    snprintf(path, PATH_MAX, "%s/%s", session->folder, session_name);
}

/* ---- Writing ---- */

static json_t *pack_target(const weft_target *t)
{
    return json_pack("{sf sf sf sf}", "opening_mm", t->opening_mm, "white_reflectance", t->white_reflectance,
                     "paper_reflectance", t->paper_reflectance, "ink_reflectance", t->ink_reflectance);
}

static json_t *pack_noise(const weft_sensor_noise *noise)
{
    return json_pack("{sf sf}", "electrons_per_value", noise->electrons_per_value, "read_noise_electrons",
                     noise->read_noise_electrons);
}

static json_t *pack_angles(weft_angles a)
{
    return json_pack("[ff]", weft_deg_of_rad(a.theta_rad), weft_deg_of_rad(a.phi_rad));
}

static json_t *pack_shot(const weft_session *session, int index)
{
    const weft_shot *shot = &session->shot[index];
    json_t *json = json_pack("{so so so}", "light", pack_angles(shot->light), "view", pack_angles(shot->view),
                             "light_driven", pack_angles(shot->light_driven));
    if (session->turns) {
        const double *deg = session->turns[index].deg;
        weft_json_put(&json, "turns_deg", json_pack("[fff]", deg[0], deg[1], deg[2]));
    }
    if (session->pose) {
        const double *w = session->pose[index].rotation, *t = session->pose[index].translation;
        weft_json_put(&json, "pose",
                      json_pack("[ffffff]", weft_deg_of_rad(w[0]), weft_deg_of_rad(w[1]), weft_deg_of_rad(w[2]), t[0],
                                t[1], t[2]));
    }
    return json;
}

static json_t *pack_plan(const weft_session *session)
{
    json_t *plan = json_array();
    for (int i = 0; plan && i < session->shot_count; i++)
        weft_json_append(&plan, pack_shot(session, i));
    return plan;
}

static json_t *pack_session(const weft_session *s)
{
    json_error_t ignored;
    errno = 0;
    json_t *settings = json_loads(s->rig_settings ? s->rig_settings : "{}", 0, &ignored);
    if (!settings && errno != ENOMEM)
        settings = json_object();
    json_t *root = json_pack("{si ss so so so sf sf si si so so so}", "weft_session", SESSION_VERSION, "rig", s->rig,
                             "sample", weft_json_text(s->sample, strlen(s->sample)), "rig_settings", settings, "camera",
                             weft_camera_pack(&s->camera), "camera_distance_mm", s->camera_distance_mm,
                             "light_distance_mm", s->light_distance_mm, "bits", s->bits, "black_level", s->black_level,
                             "noise", pack_noise(&s->noise), "target", pack_target(&s->target), "plan", pack_plan(s));
    if (s->colour.terms > 0)
        weft_json_put(&root, "colour", weft_colour_pack(&s->colour));
    if (s->camera_model)
        weft_json_put(&root, "camera_model", weft_json_text(s->camera_model, strlen(s->camera_model)));
    if (weft_session_frame_count(s) > 0)
        weft_json_put(&root, "sensor_frames", json_pack("{si si}", "dark", s->dark_frames, "flat", s->flat_frames));
    return root;
}

weft_code weft_session_create(const weft_session *session, weft_error *error)
{
    char path[PATH_MAX];
    session_path(session, path);
    return weft_json_write(path, pack_session(session), JSON_INDENT(1) | JSON_REAL_PRECISION(17), error);
}

/* ---- Reading ---- */

/* This and what follows tell in `cause` why they could not. */
static bool unpack_target(json_t *json, weft_target *t, json_error_t *cause)
{
    return json_unpack_ex(json, cause, 0, "{sF sF sF sF}", "opening_mm", &t->opening_mm, "white_reflectance",
                          &t->white_reflectance, "paper_reflectance", &t->paper_reflectance, "ink_reflectance",
                          &t->ink_reflectance) == 0;
}

/* Sessions of before brackets have none. */
static bool unpack_noise(json_t *json, weft_sensor_noise *noise, json_error_t *cause)
{
    return !json || json_unpack_ex(json, cause, 0, "{sF sF}", "electrons_per_value", &noise->electrons_per_value,
                                   "read_noise_electrons", &noise->read_noise_electrons) == 0;
}

static bool unpack_angles(json_t *json, weft_angles *angles)
{
    double theta_deg, phi_deg;
    if (json_unpack(json, "[FF]", &theta_deg, &phi_deg) != 0 || !(theta_deg >= 0 && theta_deg < 90) ||
        !(fabs(phi_deg) <= 360))
        return false;
    *angles = (weft_angles){weft_rad_of_deg(theta_deg), weft_rad_of_deg(phi_deg)};
    return true;
}

static bool unpack_shot(json_t *json, weft_shot *shot)
{
    return unpack_angles(json_object_get(json, "light"), &shot->light) &&
           unpack_angles(json_object_get(json, "view"), &shot->view) &&
           unpack_angles(json_object_get(json, "light_driven"), &shot->light_driven);
}

/* Turns of 10^4 degrees and places 10^6 mm away are of no rig. */
static const double largest_turn_deg = 1e4, largest_mm = 1e6;

static bool unpack_turns(json_t *json, weft_turns *turns)
{
    double *deg = turns->deg;
    return json_unpack(json, "[FFF!]", &deg[0], &deg[1], &deg[2]) == 0 && fabs(deg[0]) <= largest_turn_deg &&
           fabs(deg[1]) <= largest_turn_deg && fabs(deg[2]) <= largest_turn_deg;
}

static bool unpack_pose(json_t *json, weft_motion *pose)
{
    double *w = pose->rotation, *t = pose->translation;
    bool sound = json_unpack(json, "[FFFFFF!]", &w[0], &w[1], &w[2], &t[0], &t[1], &t[2]) == 0;
    for (int i = 0; sound && i < 3; i++) {
        sound = fabs(w[i]) <= 361 && fabs(t[i]) <= largest_mm;
        w[i] = weft_rad_of_deg(w[i]);
    }
    weft_pose seen = weft_pose_of_motion(pose);
    return sound && weft_pose_is_above(&seen);
}

/* Whether shots have a field: of all or of none. */
static weft_code are_all_told(json_t *plan, const char *name, const char *path, bool *told, weft_error *error)
{
    size_t count = json_array_size(plan);
    *told = json_object_get(json_array_get(plan, 0), name);
    for (size_t i = 1; i < count; i++) {
        if (*told != (json_object_get(json_array_get(plan, i), name) != NULL))
            return weft_fail(error, WEFT_BAD_INPUT, "'%s': some shots of the plan have '%s', shot %zu has none", path,
                             name, *told ? i : 0);
    }
    return WEFT_OK;
}

/* What only some rigs know. */
static weft_code unpack_places(json_t *plan, const char *path, weft_session *session, weft_error *error)
{
    size_t count = (size_t)session->shot_count;
    bool turns = false, poses = false;
    WEFT_TRY(are_all_told(plan, "turns_deg", path, &turns, error));
    WEFT_TRY(are_all_told(plan, "pose", path, &poses, error));
    session->turns = turns ? calloc(count, sizeof *session->turns) : NULL;
    session->pose = poses ? calloc(count, sizeof *session->pose) : NULL;
    if ((turns && !session->turns) || (poses && !session->pose))
        return weft_fail_memory(error, "plan", count * sizeof *session->pose);
    for (size_t i = 0; i < count; i++) {
        json_t *shot = json_array_get(plan, i);
        if (turns && !unpack_turns(json_object_get(shot, "turns_deg"), &session->turns[i]))
            return weft_fail(error, WEFT_BAD_INPUT, "'%s': 'turns_deg' of shot %zu of the plan is invalid", path, i);
        if (poses && !unpack_pose(json_object_get(shot, "pose"), &session->pose[i]))
            return weft_fail(error, WEFT_BAD_INPUT, "'%s': 'pose' of shot %zu of the plan is invalid", path, i);
    }
    return WEFT_OK;
}

static weft_code unpack_plan(json_t *plan, const char *path, weft_session *session, weft_error *error)
{
    size_t count = json_array_size(plan);
    if (count < 1 || count > WEFT_SESSION_MAX_SHOTS)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s': the plan has %zu shots, not 1 to %d", path, count,
                         WEFT_SESSION_MAX_SHOTS);
    session->shot_count = (int)count;
    session->shot = calloc(count, sizeof *session->shot);
    session->record = calloc(count, sizeof *session->record);
    if (!session->shot || !session->record)
        return weft_fail_memory(error, "plan", count * sizeof *session->shot);
    errno = 0;
    for (size_t i = 0; i < count; i++) {
        if (!unpack_shot(json_array_get(plan, i), &session->shot[i]))
            return weft_json_fail(error, WEFT_BAD_INPUT, "'%s': shot %zu of the plan is malformed", path, i);
    }
    return unpack_places(plan, path, session, error);
}

static bool is_reflectance(double value)
{
    return value >= 0 && value <= 1;
}

static weft_code check_values(const weft_session *s, const char *path, weft_error *error)
{
    const weft_camera *c = &s->camera;
    if (c->width < 1 || c->height < 1 || c->width > 32768 || c->height > 32768)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s': photographs of %d x %d pixels", path, c->width, c->height);
    if (s->bits < 8 || s->bits > 16 || s->black_level < 0 || s->black_level >= 1 << s->bits)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s': %d bits with black level %d", path, s->bits, s->black_level);
    if (!(c->fx > 0 && c->fy > 0 && s->camera_distance_mm > 0 && s->light_distance_mm > 0 && s->target.opening_mm > 0))
        return weft_fail(error, WEFT_BAD_INPUT, "'%s': a focal length, distance or opening is not positive", path);
    if (!(s->noise.electrons_per_value >= 0 && s->noise.read_noise_electrons >= 0))
        return weft_fail(error, WEFT_BAD_INPUT, "'%s': noise of the sensor is negative", path);
    const weft_target *t = &s->target;
    if (!(t->white_reflectance > 0 && is_reflectance(t->white_reflectance)) || !is_reflectance(t->paper_reflectance) ||
        !is_reflectance(t->ink_reflectance))
        return weft_fail(error, WEFT_BAD_INPUT,
                         "'%s': reflectances of the target %g (white), %g (paper), %g (ink), must be 0 to 1", path,
                         t->white_reflectance, t->paper_reflectance, t->ink_reflectance);
    return WEFT_OK;
}

/* Errors: WEFT_SYSTEM for memory. */
static weft_code copy_texts(const char *rig, const char *sample, const json_t *settings, weft_session *s,
                            weft_error *error)
{
    s->rig = strdup(rig);
    s->sample = strdup(sample);
    s->rig_settings = settings ? json_dumps(settings, JSON_COMPACT) : strdup("{}");
    return s->rig && s->sample && s->rig_settings ? WEFT_OK : weft_fail_memory(error, session_name, 0);
}

static weft_code unpack_fields(json_t *root, const char *path, weft_session *s, weft_error *error)
{
    const char *rig = "", *sample = "";
    json_t *camera = NULL, *target = NULL, *settings = NULL;
    json_int_t bits = 0, black_level = 0;
    json_error_t cause;
    if (json_unpack_ex(root, &cause, 0, "{ss ss so so s?o sF sF sI sI}", "rig", &rig, "sample", &sample, "camera",
                       &camera, "target", &target, "rig_settings", &settings, "camera_distance_mm",
                       &s->camera_distance_mm, "light_distance_mm", &s->light_distance_mm, "bits", &bits, "black_level",
                       &black_level) != 0 ||
        !weft_camera_unpack(camera, &s->camera, &cause) || !unpack_target(target, &s->target, &cause) ||
        !unpack_noise(json_object_get(root, "noise"), &s->noise, &cause))
        return weft_json_fail(error, WEFT_BAD_INPUT, "'%s' lacks a field, or one has the wrong type: %s", path,
                              cause.text);
    if (settings && !json_is_object(settings))
        return weft_fail(error, WEFT_BAD_INPUT, "'%s': 'rig_settings' is no object", path);
    s->bits = weft_limited_int(bits);
    s->black_level = weft_limited_int(black_level);
    return copy_texts(rig, sample, settings, s, error);
}

/* Sessions of one camera alone have none. */
static weft_code unpack_model(json_t *json, const char *path, weft_session *session, weft_error *error)
{
    if (!json)
        return WEFT_OK;
    if (!json_is_string(json))
        return weft_fail(error, WEFT_BAD_INPUT, "'%s': 'camera_model' is no text", path);
    session->camera_model = strdup(json_string_value(json));
    return session->camera_model ? WEFT_OK : weft_fail_memory(error, session_name, 0);
}

/* Most sessions have none. */
static weft_code unpack_frames(json_t *json, const char *path, weft_session *session, weft_error *error)
{
    json_int_t dark = 0, flat = 0;
    if (!json)
        return WEFT_OK;
    if (json_unpack(json, "{sI sI}", "dark", &dark, "flat", &flat) != 0 || dark < 0 || flat < 0 ||
        dark > WEFT_SESSION_MAX_FRAMES || flat > WEFT_SESSION_MAX_FRAMES)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s': 'sensor_frames' must name 0 to %d frames 'dark' and 'flat'",
                         path, WEFT_SESSION_MAX_FRAMES);
    session->dark_frames = (int)dark;
    session->flat_frames = (int)flat;
    size_t count = (size_t)weft_session_frame_count(session);
    session->frame = calloc(count + 1, sizeof *session->frame);
    return session->frame ? WEFT_OK : weft_fail_memory(error, session_name, count * sizeof *session->frame);
}

static weft_code unpack_session(json_t *root, const char *path, weft_session *s, weft_error *error)
{
    errno = 0;
    WEFT_TRY(unpack_fields(root, path, s, error));
    WEFT_TRY(check_values(s, path, error));
    if (json_object_get(root, "colour"))
        WEFT_TRY(weft_colour_unpack(json_object_get(root, "colour"), path, &s->colour, error));
    WEFT_TRY(unpack_model(json_object_get(root, "camera_model"), path, s, error));
    WEFT_TRY(unpack_frames(json_object_get(root, "sensor_frames"), path, s, error));
    return unpack_plan(json_object_get(root, "plan"), path, s, error);
}

static weft_code read_session_json(weft_session *session, weft_error *error)
{
    char path[PATH_MAX];
    json_t *root = NULL;
    session_path(session, path);
    WEFT_TRY(weft_json_read_kind(path, MAX_SESSION_BYTES, &kind, &root, error));
    weft_code code = unpack_session(root, path, session, error);
    json_decref(root);
    return code;
}

weft_code weft_session_open(const char *folder, weft_session *session, weft_error *error)
{
    *session = (weft_session){.folder = strdup(folder)};
    weft_code code = session->folder ? read_session_json(session, error) : weft_fail_memory(error, folder, 0);
    if (code == WEFT_OK)
        code = weft_journal_read(session, error);
    if (code != WEFT_OK)
        weft_session_free(session);
    return code;
}

void weft_session_free(weft_session *session)
{
    free(session->folder);
    free(session->rig);
    free(session->sample);
    free(session->rig_settings);
    free(session->camera_model);
    free(session->shot);
    free(session->record);
    free(session->turns);
    free(session->pose);
    free(session->frame);
    *session = (weft_session){0};
}
