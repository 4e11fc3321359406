#include "registration/outcome/outcome.h"

#include "base/text/json_text.h"
#include "btf/session/camera_json.h"

#include <string.h>

static json_t *pack_viewpoint(const weft_session *session, const weft_registration *r, int viewpoint)
{
    const weft_viewpoint *one = &r->survey.viewpoint[viewpoint];
    const weft_view_pose *pose = &r->pose[viewpoint];
    const double(*m)[3] = pose->homography.m;
    json_t *packed = json_pack("{si si si si ss si sf sf sf sf}", "view", one->view, "stay", one->viewpoint,
                               "photographs", one->count, "used", r->used[viewpoint], "rests_on",
                               weft_pose_source_name(pose), "markers", pose->marker_count, "marker_rms_px",
                               pose->marker_rms_px, "correlation", pose->correlation, "standard_error_texels",
                               weft_registration_uncertainty_texels(session, r, viewpoint), "shift_mm", pose->shift_mm);
    weft_json_put(&packed, "plate_mm_to_undistorted_pixels",
                  json_pack("[[fff][fff][fff]]", m[0][0], m[0][1], m[0][2], m[1][0], m[1][1], m[1][2], m[2][0], m[2][1],
                            m[2][2]));
    weft_viewpoint_white white = weft_viewpoint_white_of(r, viewpoint);
    if (white.photographs > 0)
        weft_json_put(&packed, "white_level", json_pack("[fff]", white.level[0], white.level[1], white.level[2]));
    if (pose->remark[0])
        weft_json_put(&packed, "remark", json_string(pose->remark));
    return packed;
}

static json_t *pack_session(const weft_session *s)
{
    return json_pack("{so ss ss sf sf sf si si}", "folder", weft_json_text(s->folder, strlen(s->folder)), "rig", s->rig,
                     "sample", s->sample, "camera_distance_mm", s->camera_distance_mm, "light_distance_mm",
                     s->light_distance_mm, "opening_mm", s->target.opening_mm, "bits", s->bits, "black_level",
                     s->black_level);
}

static json_t *pack_found(const weft_rig_found *found)
{
    const weft_bend *b = &found->bend.bend;
    const weft_vignetting *v = &found->vignetting;
    return json_pack("{s{s[fff] sf sf si} s{sf sf sf sf si}}", "bend", "per_mm", b->xx, b->xy, b->yy, "unit_mm",
                     found->bend.unit_mm, "standard_error_mm", found->bend.standard_error_mm, "stays",
                     found->bend.viewpoints, "vignetting", "r2", v->r2, "r4", v->r4, "reach", v->reach,
                     "standard_error", v->standard_error, "photographs", v->photographs);
}

static json_t *pack_sensor(const weft_sensor_summary *s)
{
    return json_pack("{si si sf sf sf sf si si}", "dark_frames", s->dark_frames, "flat_frames", s->flat_frames,
                     "dark_values_per_s", s->dark_rate, "least_response", s->least, "most_response", s->most,
                     "fall_off", s->fall_off, "hot_pixels", s->hot, "dead_pixels", s->dead);
}

static json_t *pack_faults(const weft_session *session, const weft_registration *r)
{
    json_t *faults = json_array();
    for (int shot = 0; shot < session->shot_count; shot++) {
        if (r->fault[shot].reason[0])
            weft_json_append(&faults, json_pack("{si ss}", "image", shot, "reason", r->fault[shot].reason));
    }
    return faults;
}

static json_t *pack_registration(const weft_session *session, const weft_registration *r)
{
    json_t *viewpoints = json_array();
    for (int viewpoint = 0; viewpoint < r->survey.viewpoint_count; viewpoint++)
        weft_json_append(&viewpoints, pack_viewpoint(session, r, viewpoint));
    json_t *root = json_pack("{ss so so so s{si si sf sf} si si so so}", "made_by", "weft register " WEFT_VERSION,
                             "session", pack_session(session), "camera", weft_camera_pack(&session->camera), "found",
                             pack_found(&r->found), "settings", "width", r->settings.width, "height",
                             r->settings.height, "tolerance_mm", r->settings.limits.tolerance_mm, "least_correlation",
                             r->settings.limits.least_correlation, "images", r->image_count, "white_levels_estimated",
                             r->estimated_whites, "faults", pack_faults(session, r), "stays", viewpoints);
    if (r->found.sensor.dark_frames > 0 || r->found.sensor.flat_frames > 0)
        weft_json_put(&root, "sensor", pack_sensor(&r->found.sensor));
    if (session->colour.terms > 0)
        weft_json_put(&root, "colour", weft_colour_pack(&session->colour));
    return root;
}

char *weft_registration_provenance(const weft_session *sessions, int count, const weft_registration *registrations)
{
    json_t *cameras = json_array();
    for (int i = 0; count > 1 && i < count; i++)
        weft_json_append(&cameras, pack_registration(&sessions[i], &registrations[i]));
    json_t *root = count == 1 ? pack_registration(&sessions[0], &registrations[0])
                              : json_pack("{ss sO}", "made_by", "weft register " WEFT_VERSION, "cameras", cameras);
    char *text = root ? json_dumps(root, JSON_COMPACT | JSON_REAL_PRECISION(9)) : NULL;
    json_decref(cameras);
    json_decref(root);
    return text;
}
