#include "tests/support/axes_series.h"

#include "capture/virtual/random.h"

#include <math.h>

/* Rings of theta, and how many shots on each. */
typedef struct ring {
    double theta_deg;
    int shots;
    double phi_deg;
} ring;

static const ring rings[] = {{0, 1, 0}, {20, 4, 30}, {40, 5, 0}, {60, 5, 36}, {75, 5, 10}};

weft_angles axes_degrees(double theta_deg, double phi_deg)
{
    return (weft_angles){weft_rad_of_deg(theta_deg), weft_rad_of_deg(phi_deg)};
}

weft_virtual_settings axes_off_settings(void)
{
    weft_virtual_settings s = weft_virtual_settings_default();
    s.axes = 1;
    s.axis_tilt_deg = s.axis_zero_deg = s.aim_rotation_deg = 0.5;
    s.axis_offset_mm = 1;
    s.aim_mm = 2;
    return s;
}

void axes_see(const weft_virtual_world *world, weft_angles view, int viewpoint, weft_axes_shot *shot)
{
    weft_pose pose = weft_virtual_world_pose(world, view, viewpoint);
    weft_homography map = weft_homography_of_pose(&world->camera, &pose);
    *shot = (weft_axes_shot){.name = "shot", .turns = weft_turns_of_view(view)};
    for (int i = 0; i < WEFT_AXES_POINTS; i++) {
        double x = i % 2 ? 27 : -27, y = i / 2 ? 27 : -27;
        weft_pixel at = weft_camera_distort(&world->camera, weft_homography_apply(&map, x, y));
        weft_vec3 noise = weft_random_normal3(world->seed, WEFT_RANDOM_NOISE, 16 * (uint64_t)viewpoint + (uint64_t)i);
        shot->point[i] = (weft_axes_point){{x, y}, {at.x + 0.01 * noise.x, at.y + 0.01 * noise.y}};
    }
}

weft_angles axes_series_view(int index)
{
    const ring *r = rings;
    for (; index >= r->shots; r++)
        index -= r->shots;
    return axes_degrees(r->theta_deg, r->phi_deg + 360.0 * index / r->shots);
}

axes_series axes_series_take(const weft_virtual_settings *settings, uint64_t seed, int rounds)
{
    axes_series s = {.world = weft_virtual_world_of_camera(settings, seed, 0), .count = rounds * AXES_SERIES_SHOTS};
    weft_camera camera = weft_rig_settings_camera(&settings->rig);
    for (int i = 0; i < s.count; i++)
        axes_see(&s.world, axes_series_view(i % AXES_SERIES_SHOTS), i, &s.shot[i]);
    s.nominal = weft_rig_poses_nominal(&camera, settings->rig.camera_distance_mm);
    return s;
}

weft_virtual_world axes_at_rest(const weft_virtual_world *world)
{
    weft_virtual_world rest = *world;
    rest.settings.viewpoint_rotation_deg = rest.settings.viewpoint_translation_mm = 0;
    return rest;
}

weft_pose axes_true_turn(const weft_virtual_world *rest, weft_angles from, weft_angles to)
{
    weft_pose a = weft_virtual_world_pose(rest, from, 0), b = weft_virtual_world_pose(rest, to, 0),
              turn = {{{0}}, {0, 0, 0}};
    double shift[3] = {b.translation.x - a.translation.x, b.translation.y - a.translation.y,
                       b.translation.z - a.translation.z};
    double back[3] = {0};
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) {
            back[i] += a.rotation[k][i] * shift[k];
            for (int j = 0; j < 3; j++)
                turn.rotation[i][j] += a.rotation[k][i] * b.rotation[k][j];
        }
    }
    turn.translation = (weft_vec3){back[0], back[1], back[2]};
    return turn;
}

weft_vec3 axes_direction(const weft_pose *turn)
{
    const double(*r)[3] = turn->rotation;
    return weft_unit((weft_vec3){r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1]});
}

double axes_angle_deg(weft_vec3 a, weft_vec3 b)
{
    return weft_deg_of_rad(atan2(weft_length(weft_cross(a, b)), weft_dot(a, b)));
}
