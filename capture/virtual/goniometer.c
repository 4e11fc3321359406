#include "capture/virtual/world.h"

#include "capture/virtual/random.h"

/* A rigid part in the frame of the rig: where it is, and its axes. */
typedef struct part {
    weft_vec3 at, x, y, z;
} part;

enum { RING, ARM, CAMERA };

static weft_vec3 turn_vector(weft_vec3 v, weft_vec3 axis, double rad)
{
    weft_vec3 along = weft_scale(axis, weft_dot(v, axis)), across = weft_subtract(v, along);
    weft_vec3 turned = weft_add(weft_scale(across, cos(rad)), weft_scale(weft_cross(axis, v), sin(rad)));
    return weft_add(along, turned);
}

/* Turns a part in place about an axis through where it is. */
static void turn_part(part *p, weft_vec3 axis, double rad)
{
    p->x = turn_vector(p->x, axis, rad);
    p->y = turn_vector(p->y, axis, rad);
    p->z = turn_vector(p->z, axis, rad);
}

/* A direction of a part in the frame of the rig. */
static weft_vec3 of_part(const part *p, weft_vec3 v)
{
    return weft_add(weft_add(weft_scale(p->x, v.x), weft_scale(p->y, v.y)), weft_scale(p->z, v.z));
}

static void move_part(part *p, weft_vec3 by)
{
    p->at = weft_add(p->at, of_part(p, by));
}

/* What is drawn once for each part. */
static double sign_of(uint64_t seed, int which, int use)
{
    return weft_random_uniform(seed, WEFT_RANDOM_AXIS, 100 + 10 * (uint64_t)which + (uint64_t)use) < 0.5 ? -1 : 1;
}

static double phase_of(uint64_t seed, int which, int use)
{
    return 2 * WEFT_PI * weft_random_uniform(seed, WEFT_RANDOM_AXIS, 200 + 10 * (uint64_t)which + (uint64_t)use);
}

/* Bolts a part askew on the one that carries it: leant about a line across its axis `axis`, and shifted across it. */
static void bolt(const weft_virtual_settings *s, uint64_t seed, int which, weft_vec3 axis, weft_vec3 across, part *p)
{
    double to = phase_of(seed, which, 0), from = phase_of(seed, which, 1);
    weft_vec3 shift = weft_scale(turn_vector(across, axis, from), s->axis_offset_mm);
    turn_part(p, turn_vector(across, axis, to), weft_rad_of_deg(s->axis_tilt_deg));
    p->at = weft_add(p->at, shift);
}

/* What an axis truly turns by, when its scale is driven to `rad`. */
static double true_turn(const weft_virtual_settings *s, uint64_t seed, int which, double rad)
{
    double uneven = weft_rad_of_deg(s->axis_uneven_deg) * cos(rad + phase_of(seed, which, 2));
    return rad * (1 + sign_of(seed, which, 0) * s->axis_scale) +
           sign_of(seed, which, 1) * weft_rad_of_deg(s->axis_zero_deg) + uneven;
}

/* The bearing lets the part lean to and fro in one plane: once a turn, and less, three times. */
static void wobble(const weft_virtual_settings *s, uint64_t seed, int which, double rad, weft_vec3 axis,
                   weft_vec3 across, part *p)
{
    double once = cos(rad + phase_of(seed, which, 3)), thrice = cos(3 * rad + phase_of(seed, which, 4)) / 3;
    weft_vec3 hinge = turn_vector(across, axis, phase_of(seed, which, 5));
    turn_part(p, hinge, weft_rad_of_deg(s->axis_wobble_deg) * (once + thrice));
}

static weft_pose look_from(const part *camera)
{
    /* The zenith is up in the picture: that is against x of the arm. */
    weft_vec3 right = camera->y, down = camera->x, forward = weft_scale(camera->z, -1);
    return (weft_pose){{{right.x, right.y, right.z}, {down.x, down.y, down.z}, {forward.x, forward.y, forward.z}},
                       {-weft_dot(right, camera->at), -weft_dot(down, camera->at), -weft_dot(forward, camera->at)}};
}

weft_pose weft_virtual_goniometer_pose(const weft_virtual_settings *s, uint64_t seed, weft_angles view)
{
    double phi = view.phi_rad - 2 * WEFT_PI * round(view.phi_rad / (2 * WEFT_PI)), theta = view.theta_rad;
    part p = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    bolt(s, seed, RING, p.z, p.x, &p);
    wobble(s, seed, RING, phi, p.z, p.x, &p);
    turn_part(&p, p.z, true_turn(s, seed, RING, phi));
    bolt(s, seed, ARM, p.y, p.z, &p);
    wobble(s, seed, ARM, theta, p.y, p.z, &p);
    turn_part(&p, p.y, true_turn(s, seed, ARM, theta));
    move_part(&p, (weft_vec3){0, 0, s->rig.camera_distance_mm});
    turn_part(&p, of_part(&p, weft_random_direction(seed, WEFT_RANDOM_AXIS, CAMERA)),
              weft_rad_of_deg(s->aim_rotation_deg));
    move_part(&p, weft_scale(weft_random_direction(seed, WEFT_RANDOM_AXIS, CAMERA + 1), s->aim_mm));
    return look_from(&p);
}
