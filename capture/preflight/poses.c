#include "capture/preflight/measure.h"

static const double same_rad = 1e-6;

static bool same_view(const weft_shot *a, const weft_shot *b)
{
    return weft_dot(weft_direction_of_angles(a->view), weft_direction_of_angles(b->view)) > 1 - same_rad * same_rad;
}

/* Of the shots of the view of `shot`, that with the highest light. */
static int under_highest_light(const weft_session *session, int shot)
{
    int best = shot;
    for (int i = 0; i < session->shot_count; i++) {
        if (same_view(&session->shot[i], &session->shot[shot]) &&
            session->shot[i].light_driven.theta_rad < session->shot[best].light_driven.theta_rad)
            best = i;
    }
    return best;
}

static double nearest_chosen(const weft_session *session, const int *chosen, int count, int shot)
{
    double nearest = INFINITY;
    for (int i = 0; i < count; i++) {
        double angle = fabs(session->shot[chosen[i]].view.phi_rad - session->shot[shot].view.phi_rad);
        nearest = fmin(nearest, fmin(angle, 2 * WEFT_PI - angle));
    }
    return nearest;
}

/* The shot of the lowest ring that is farthest round from those chosen; -1 where there is no other view. */
static int farthest_round(const weft_session *session, double lowest_rad, const int *chosen, int count)
{
    double farthest = same_rad;
    int best = -1;
    for (int i = 0; i < session->shot_count; i++) {
        double far = nearest_chosen(session, chosen, count, i);
        if (session->shot[i].view.theta_rad > lowest_rad - same_rad && far > farthest) {
            farthest = far;
            best = i;
        }
    }
    return best;
}

int weft_preflight_poses(const weft_session *session, int shot[WEFT_PREFLIGHT_POSES])
{
    int highest = 0, count = 1;
    double lowest_rad = 0;
    for (int i = 0; i < session->shot_count; i++) {
        double theta_rad = session->shot[i].view.theta_rad;
        highest = theta_rad < session->shot[highest].view.theta_rad ? i : highest;
        lowest_rad = fmax(lowest_rad, theta_rad);
    }
    shot[0] = highest;
    if (lowest_rad > session->shot[highest].view.theta_rad + same_rad) {
        for (int next; count < WEFT_PREFLIGHT_POSES; count++) {
            next = farthest_round(session, lowest_rad, shot + 1, count - 1);
            if (next < 0)
                break;
            shot[count] = next;
        }
    }
    for (int i = 0; i < count; i++)
        shot[i] = under_highest_light(session, shot[i]);
    return count;
}
