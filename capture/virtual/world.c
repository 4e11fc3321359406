#include "capture/virtual/world.h"

#include "btf/session/rig_poses.h"
#include "capture/virtual/random.h"

#include <math.h>

weft_vec3 weft_pose_apply(const weft_pose *pose, weft_vec3 p)
{
    const double(*r)[3] = pose->rotation;
    weft_vec3 rotated = {r[0][0] * p.x + r[0][1] * p.y + r[0][2] * p.z, r[1][0] * p.x + r[1][1] * p.y + r[1][2] * p.z,
                         r[2][0] * p.x + r[2][1] * p.y + r[2][2] * p.z};
    return weft_add(rotated, pose->translation);
}

weft_vec3 weft_pose_apply_inverse(const weft_pose *pose, weft_vec3 p)
{
    const double(*r)[3] = pose->rotation;
    weft_vec3 d = weft_subtract(p, pose->translation);
    return (weft_vec3){r[0][0] * d.x + r[1][0] * d.y + r[2][0] * d.z, r[0][1] * d.x + r[1][1] * d.y + r[2][1] * d.z,
                       r[0][2] * d.x + r[1][2] * d.y + r[2][2] * d.z};
}

/* The rotation about `vector` by its length in radians (Rodrigues 1840). */
static weft_pose pose_of_vectors(weft_vec3 vector, weft_vec3 translation)
{
    double angle = weft_length(vector), c = cos(angle), s = sin(angle);
    weft_vec3 k = weft_unit(vector);
    return (weft_pose){{{c + k.x * k.x * (1 - c), k.x * k.y * (1 - c) - k.z * s, k.x * k.z * (1 - c) + k.y * s},
                        {k.y * k.x * (1 - c) + k.z * s, c + k.y * k.y * (1 - c), k.y * k.z * (1 - c) - k.x * s},
                        {k.z * k.x * (1 - c) - k.y * s, k.z * k.y * (1 - c) + k.x * s, c + k.z * k.z * (1 - c)}},
                       translation};
}

weft_virtual_world weft_virtual_world_of_camera(const weft_virtual_settings *settings, uint64_t seed, int index)
{
    /* Far apart, and below 2^63. */
    const uint64_t step = 0x1f83d9abfb41bd6b, largest = ((uint64_t)1 << 63) - 1;
    uint64_t camera_seed = (seed + (uint64_t)index * step) & largest;
    weft_virtual_world world = {.settings = *settings,
                                .seed = seed,
                                .index = index,
                                .camera_seed = camera_seed,
                                .camera = weft_rig_settings_camera(&settings->rig)};
    weft_vec3 error = weft_random_direction(camera_seed, WEFT_RANDOM_CALIBRATION, 0);
    double angle = 2 * WEFT_PI * weft_random_uniform(camera_seed, WEFT_RANDOM_CALIBRATION, 1);
    world.camera.fx *= 1 + settings->focal_length_error * copysign(1, error.x);
    world.camera.fy *= 1 + settings->focal_length_error * copysign(1, error.x);
    world.camera.k1 *= 1 + settings->k1_error * copysign(1, error.y);
    world.camera.cx += settings->principal_point_error_px * cos(angle);
    world.camera.cy += settings->principal_point_error_px * sin(angle);
    double rotation_rad = weft_rad_of_deg(settings->mounting_rotation_deg);
    world.mounting = pose_of_vectors(
        weft_scale(weft_random_direction(seed, WEFT_RANDOM_MOUNTING, 0), rotation_rad),
        weft_scale(weft_random_direction(seed, WEFT_RANDOM_MOUNTING, 1), settings->mounting_translation_mm));
    return world;
}

weft_pose weft_virtual_world_pose(const weft_virtual_world *world, weft_angles view, int viewpoint)
{
    const weft_virtual_settings *s = &world->settings;
    uint64_t index = 2 * (uint64_t)viewpoint;
    weft_vec3 turn = weft_random_normal3(world->camera_seed, WEFT_RANDOM_VIEWPOINT, index);
    weft_vec3 shift = weft_random_normal3(world->camera_seed, WEFT_RANDOM_VIEWPOINT, index + 1);
    weft_pose error = pose_of_vectors(weft_scale(turn, weft_rad_of_deg(s->viewpoint_rotation_deg)),
                                      weft_scale(shift, s->viewpoint_translation_mm));
    weft_pose nominal = s->axes != 0 ? weft_virtual_goniometer_pose(s, world->camera_seed, view)
                                     : weft_pose_of_view(view, s->rig.camera_distance_mm);
    weft_pose in_rig = weft_pose_after(&nominal, &error);
    return weft_pose_after(&in_rig, &world->mounting);
}

/* A number for a viewpoint and a commanded direction, insensitive to the last digits of a stored angle. */
static uint64_t index_of_move(weft_angles driven, int viewpoint)
{
    uint64_t theta = (uint64_t)llround(weft_deg_of_rad(driven.theta_rad) * 1e4);
    uint64_t phi = (uint64_t)llround(weft_deg_of_rad(driven.phi_rad) * 1e4);
    return ((uint64_t)viewpoint * 1000003 + theta) * 10000019 + phi;
}

weft_vec3 weft_virtual_world_light(const weft_virtual_world *world, weft_angles driven, int viewpoint)
{
    const weft_virtual_settings *s = &world->settings;
    uint64_t index = index_of_move(driven, s->cameras > 1 ? 0 : viewpoint);
    weft_vec3 turn = weft_random_normal3(world->seed, WEFT_RANDOM_LIGHT, index);
    weft_pose error = pose_of_vectors(weft_scale(turn, weft_rad_of_deg(s->light_rotation_deg)), (weft_vec3){0, 0, 0});
    weft_vec3 nominal = weft_scale(weft_direction_of_angles(driven), s->rig.light_distance_mm);
    weft_vec3 in_rig = weft_pose_apply(&error, nominal);
    return weft_pose_apply_inverse(&world->mounting, in_rig);
}

bool weft_virtual_world_shadowed(const weft_virtual_world *world, const weft_pose *pose, weft_vec3 light)
{
    double covered_rad = 0.9 * weft_rad_of_deg(world->settings.rig.camera_half_angle_deg);
    weft_vec3 toward_camera = weft_unit(weft_pose_camera_position(pose));
    return weft_dot(toward_camera, weft_unit(light)) > cos(covered_rad);
}

static double sector_rad(const weft_virtual_world *world)
{
    return 2 * WEFT_PI / world->settings.cameras;
}

/* From 0 to below one turn, and 0 for what is nearly one. */
static double wrapped(double rad)
{
    const double turn = 2 * WEFT_PI, nearly = 1e-9;
    double within = rad - turn * floor(rad / turn);
    return within > turn - nearly ? 0 : within;
}

int weft_virtual_ring_camera(const weft_virtual_world *world, weft_angles view)
{
    const double nearly = 1e-9;
    return (int)floor(wrapped(view.phi_rad) / sector_rad(world) + nearly);
}

weft_angles weft_virtual_ring_view(const weft_virtual_world *world, weft_angles view, int other)
{
    return (weft_angles){view.theta_rad, wrapped(view.phi_rad + (other - world->index) * sector_rad(world))};
}

bool weft_virtual_ring_shadows(const weft_virtual_world *world, weft_angles view, weft_vec3 light)
{
    double covered_rad = 0.9 * weft_rad_of_deg(world->settings.rig.camera_half_angle_deg);
    bool shadowed = false;
    for (int other = 0; view.theta_rad > 0 && other < (int)world->settings.cameras; other++) {
        weft_vec3 body = weft_direction_of_angles(weft_virtual_ring_view(world, view, other));
        shadowed = shadowed || (other != world->index && weft_dot(body, weft_unit(light)) > cos(covered_rad));
    }
    return shadowed;
}
