#include "btf/session/session.h"

#include <stdio.h>
#include <string.h>

weft_pose weft_session_pose(const weft_session *session, weft_angles view)
{
    for (int i = 0; session->pose && i < session->shot_count; i++) {
        const weft_angles *shown = &session->shot[i].view;
        if (shown->theta_rad == view.theta_rad && shown->phi_rad == view.phi_rad)
            return weft_pose_of_motion(&session->pose[i]);
    }
    return weft_pose_of_view(view, session->camera_distance_mm);
}

static int whole_degrees(weft_real rad)
{
    return (int)lround(weft_deg_of_rad(rad));
}

void weft_session_photograph_path(const weft_session *session, int shot, char *path, int size)
{
    const weft_shot *s = &session->shot[shot];
    int tl = whole_degrees(s->light.theta_rad), pl = whole_degrees(s->light.phi_rad);
    int tv = whole_degrees(s->view.theta_rad), pv = whole_degrees(s->view.phi_rad);
    snprintf(path, (size_t)size, "%s/tv%03d_pv%03d/tl%03d_pl%03d_tv%03d_pv%03d.tif", session->folder, tv, pv, tl, pl,
             tv, pv);
}

void weft_session_bracket_path(const weft_session *session, int shot, int bracket, char *path, int size)
{
    weft_session_photograph_path(session, shot, path, size);
    size_t stem = strlen(path) - strlen(".tif");
    snprintf(path + stem, (size_t)size - stem, ".bracket%d.tif", bracket + 1);
}

int weft_session_frame_count(const weft_session *session)
{
    return 2 * session->dark_frames + session->flat_frames;
}

weft_frame_kind weft_session_frame_kind(const weft_session *session, int frame)
{
    return frame < session->dark_frames       ? WEFT_FRAME_DARK_BRIEF
           : frame < 2 * session->dark_frames ? WEFT_FRAME_DARK_LONG
                                              : WEFT_FRAME_FLAT;
}

void weft_session_frame_path(const weft_session *session, int frame, char *path, int size)
{
    static const char *const names[] = {"dark_brief", "dark_long", "flat"};
    weft_frame_kind kind = weft_session_frame_kind(session, frame);
    snprintf(path, (size_t)size, "%s/sensor/%s_%03d.tif", session->folder, names[kind],
             frame - (int)kind * session->dark_frames + 1);
}
