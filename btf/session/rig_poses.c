#include "btf/session/rig_poses.h"

#include <complex.h>

const char *const weft_joint_text[WEFT_JOINTS] = {"camera theta", "camera phi", "sample phi"};

/* ---- Motions ---- */

static weft_vec3 rotated(const weft_pose *pose, weft_vec3 p)
{
    const double(*r)[3] = pose->rotation;
    return weft_vec3_of(r[0][0] * p.x + r[0][1] * p.y + r[0][2] * p.z, r[1][0] * p.x + r[1][1] * p.y + r[1][2] * p.z,
                        r[2][0] * p.x + r[2][1] * p.y + r[2][2] * p.z);
}

weft_pose weft_pose_of_motion(const weft_motion *motion)
{
    const double *w = motion->rotation, square = w[0] * w[0] + w[1] * w[1] + w[2] * w[2], angle = sqrt(square);
    /* Near 0 the series of sin a / a and (1 - cos a) / a^2. */
    double s = angle < 1e-4 ? 1 - square / 6 : sin(angle) / angle;
    double c = angle < 1e-4 ? 0.5 - square / 24 : (1 - cos(angle)) / square;
    const double cross[3][3] = {{0, -w[2], w[1]}, {w[2], 0, -w[0]}, {-w[1], w[0], 0}};
    weft_pose pose = {.translation =
                          weft_vec3_of(motion->translation[0], motion->translation[1], motion->translation[2])};
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            pose.rotation[i][j] = (i == j) + s * cross[i][j] + c * (w[i] * w[j] - (i == j) * square);
    }
    return pose;
}

/* By way of the quaternion, from its largest part (Shepperd 1978). */
weft_motion weft_motion_of_pose(const weft_pose *pose)
{
    const double(*r)[3] = pose->rotation;
    const double trace = r[0][0] + r[1][1] + r[2][2];
    double q[4] = {trace, r[0][0], r[1][1], r[2][2]};
    int largest = 0;
    for (int i = 1; i < 4; i++)
        largest = q[i] > q[largest] ? i : largest;
    if (largest == 0) {
        q[0] = 1 + trace;
        for (int i = 0; i < 3; i++)
            q[i + 1] = r[(i + 2) % 3][(i + 1) % 3] - r[(i + 1) % 3][(i + 2) % 3];
    } else {
        int i = largest - 1, j = (i + 1) % 3, k = (i + 2) % 3;
        q[0] = r[k][j] - r[j][k];
        q[i + 1] = 1 + r[i][i] - r[j][j] - r[k][k];
        q[j + 1] = r[i][j] + r[j][i];
        q[k + 1] = r[i][k] + r[k][i];
    }
    double sine = sqrt(q[1] * q[1] + q[2] * q[2] + q[3] * q[3]), sign = q[0] < 0 ? -1 : 1;
    double scale = sine > 0 ? sign * 2 * atan2(sine, fabs(q[0])) / sine : 0;
    return (weft_motion){{scale * q[1], scale * q[2], scale * q[3]},
                         {pose->translation.x, pose->translation.y, pose->translation.z}};
}

weft_pose weft_pose_after(const weft_pose *outer, const weft_pose *inner)
{
    weft_pose result;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            result.rotation[i][j] = 0;
            for (int k = 0; k < 3; k++)
                result.rotation[i][j] += outer->rotation[i][k] * inner->rotation[k][j];
        }
    }
    result.translation = weft_add(rotated(outer, inner->translation), outer->translation);
    return result;
}

/* The rotation about a line through `point`: what it leaves in place. */
static weft_pose about(weft_vec3 vector, weft_vec3 point)
{
    const weft_motion turn = {{vector.x, vector.y, vector.z}, {0, 0, 0}};
    weft_pose pose = weft_pose_of_motion(&turn);
    pose.translation = weft_subtract(point, rotated(&pose, point));
    return pose;
}

void weft_across(weft_vec3 direction, weft_vec3 *e1, weft_vec3 *e2)
{
    bool upright = fabs(direction.z) > 0.9;
    weft_vec3 start = weft_vec3_of(upright ? 1 : 0, 0, upright ? 0 : 1);
    *e1 = weft_unit(weft_subtract(start, weft_scale(direction, weft_dot(start, direction))));
    *e2 = weft_cross(direction, *e1);
}

/* ---- Joints ---- */

static weft_vec3 lean(const weft_joint *joint, double q)
{
    const double *w = joint->wobble;
    double complex back = w[0] + I * w[1], twice = w[2] + I * w[3];
    double complex now = back * (cexp(-I * q) - 1) + twice * (cexp(2 * I * q) - 1);
    weft_vec3 e1, e2;
    weft_across(joint->direction, &e1, &e2);
    return weft_add(weft_scale(e1, creal(now)), weft_scale(e2, cimag(now)));
}

static weft_pose turned(const weft_joint *joint, double deg)
{
    double q = weft_rad_of_deg(deg);
    double angle = q * (1 + joint->scale) + joint->uneven[0] * (cos(q) - 1) + joint->uneven[1] * sin(q);
    weft_pose turn = about(weft_scale(joint->direction, angle), joint->point);
    weft_pose leaning = about(lean(joint, q), joint->point);
    return weft_pose_after(&leaning, &turn);
}

weft_pose weft_rig_poses_at(const weft_rig_poses *poses, const weft_turns *turns)
{
    weft_pose pose = poses->home;
    for (int k = 0; k < WEFT_JOINTS; k++) {
        weft_pose turn = turned(&poses->joint[k], turns->deg[k]);
        pose = weft_pose_after(&pose, &turn);
    }
    return pose;
}

/* ---- As it should be ---- */

weft_rig_poses weft_rig_poses_nominal(const weft_camera *camera, double distance_mm)
{
    /* A camera that goes down toward x sees the plate turned about -y; one that goes toward y, about -z. A sample turns
     * about z itself. */
    return (weft_rig_poses){.camera = *camera,
                            .home = weft_pose_of_view((weft_angles){0, 0}, distance_mm),
                            .joint = {{.direction = {0, -1, 0}}, {.direction = {0, 0, -1}}, {.direction = {0, 0, 1}}}};
}

weft_turns weft_turns_of_view(weft_angles view)
{
    double phi_deg = weft_deg_of_rad(view.phi_rad);
    return (weft_turns){{weft_deg_of_rad(view.theta_rad), phi_deg - 360 * round(phi_deg / 360), 0}};
}

weft_angles weft_pose_view(const weft_pose *pose)
{
    return weft_angles_of_direction(weft_unit(weft_pose_camera_position(pose)));
}

bool weft_pose_is_above(const weft_pose *pose)
{
    /* Directions are stored as single floats, in which less than this is none. */
    const double least_cosine = 1e-6;
    return pose->translation.z > 0 && weft_unit(weft_pose_camera_position(pose)).z > least_cosine;
}
