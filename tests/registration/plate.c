#include "plate.h"

#include <assert.h>
#include <stdlib.h>

enum { supersamples = 6 };

double plate_uniform(unsigned *state)
{
    *state = *state * 1664525u + 1013904223u;
    unsigned mixed = (*state ^ *state >> 15) * 2246822519u;
    return (mixed >> 8) / 16777216.0;
}

double plate_normal(unsigned *state)
{
    double u = plate_uniform(state), v = plate_uniform(state);
    return sqrt(-2 * log(1 - u)) * cos(2 * WEFT_PI * v);
}

weft_camera plate_camera(int size, double distance_mm)
{
    weft_target target = weft_target_for_opening(32);
    double focal = 0.46 * size * distance_mm / weft_target_radius_mm(&target);
    return (weft_camera){.width = size,
                         .height = size,
                         .fx = focal,
                         .fy = 1.002 * focal,
                         .cx = 0.49 * size,
                         .cy = 0.505 * size,
                         .k1 = -0.15,
                         .k2 = 0.05,
                         .vignetting = {-0.8, 0.1, 0}};
}

static weft_pose turned(const weft_pose *pose, weft_vec3 axis_angle, weft_vec3 shift)
{
    double angle = weft_length(axis_angle);
    weft_vec3 axis = weft_unit(axis_angle);
    weft_pose result = *pose;
    for (int column = 0; column < 3; column++) {
        weft_vec3 v = {pose->rotation[0][column], pose->rotation[1][column], pose->rotation[2][column]};
        weft_vec3 along = weft_scale(axis, weft_dot(axis, v) * (1 - cos(angle)));
        v = weft_add(weft_add(weft_scale(v, cos(angle)), weft_scale(weft_cross(axis, v), sin(angle))), along);
        result.rotation[0][column] = v.x;
        result.rotation[1][column] = v.y;
        result.rotation[2][column] = v.z;
    }
    result.translation = weft_add(pose->translation, shift);
    return result;
}

weft_pose plate_jittered_pose(weft_angles view, double distance_mm, unsigned seed)
{
    unsigned state = seed * 7919u + 17u;
    weft_pose nominal = weft_pose_of_view(view, distance_mm);
    double turn[3], shift[3];
    for (int axis = 0; axis < 3; axis++) {
        turn[axis] = weft_rad_of_deg(0.05 * plate_normal(&state));
        shift[axis] = 0.3 * plate_normal(&state);
    }
    return turned(&nominal, (weft_vec3){turn[0], turn[1], turn[2]}, (weft_vec3){shift[0], shift[1], shift[2]});
}

/* Plate point seen at an undistorted pixel, and its distance along the camera's axis. */
static weft_vec3 meet_plate(const weft_camera *camera, const weft_pose *pose, weft_pixel pixel, double *depth)
{
    const double(*r)[3] = pose->rotation;
    weft_vec3 ray = {(pixel.x - camera->cx) / camera->fx, (pixel.y - camera->cy) / camera->fy, 1};
    weft_vec3 centre = weft_pose_camera_position(pose);
    weft_vec3 direction = {r[0][0] * ray.x + r[1][0] * ray.y + r[2][0], r[0][1] * ray.x + r[1][1] * ray.y + r[2][1],
                           r[0][2] * ray.x + r[1][2] * ray.y + r[2][2]};
    *depth = -centre.z / direction.z;
    return weft_add(centre, weft_scale(direction, *depth));
}

static double radiance(const plate_scene *scene, double x, double y)
{
    double radius = weft_target_radius_mm(&scene->target), light = 1 - scene->gradient * x / radius;
    if (x > radius * (1 - scene->covered) && x < 2 * radius)
        return 0.3 * light;
    if (weft_target_region_at(&scene->target, x, y) != WEFT_TARGET_OPENING)
        return light * weft_target_reflectance(&scene->target, x, y);
    if (scene->sample)
        return light * scene->sample(x, y);
    return light * (((int)floor(x / 2) + (int)floor(y / 2)) % 2 ? 0.7 : 0.1);
}

/* The undistorted place of a pixel, and what one pixel to the right and one down add to it: over some pixels the lens
 * is straight to a thousandth of one. */
typedef struct lens_at_pixel {
    weft_pixel middle, right, down;
} lens_at_pixel;

static lens_at_pixel lens_at(const weft_camera *camera, int px, int py)
{
    weft_pixel middle = weft_camera_undistort(camera, (weft_pixel){px, py}),
               right = weft_camera_undistort(camera, (weft_pixel){px + 1, py}),
               down = weft_camera_undistort(camera, (weft_pixel){px, py + 1});
    return (lens_at_pixel){middle, {right.x - middle.x, right.y - middle.y}, {down.x - middle.x, down.y - middle.y}};
}

static double pixel_value(const plate_scene *scene, const weft_camera *camera, const weft_pose *pose, int px, int py,
                          unsigned *state)
{
    double depth, sum = 0, focus = pose->translation.z;
    const lens_at_pixel l = lens_at(camera, px, py);
    meet_plate(camera, pose, l.middle, &depth);
    double radius = scene->aperture * fabs(1 - focus / depth);
    for (int i = 0; i < supersamples * supersamples; i++) {
        double lens = sqrt(plate_uniform(state)) * radius, azimuth = 2 * WEFT_PI * plate_uniform(state), z;
        double x = (i % supersamples + plate_uniform(state)) / supersamples - 0.5;
        double y = (i / supersamples + plate_uniform(state)) / supersamples - 0.5;
        if (radius > 0) {
            x += lens * cos(azimuth);
            y += lens * sin(azimuth);
        }
        weft_pixel at = {l.middle.x + x * l.right.x + y * l.down.x, l.middle.y + x * l.right.y + y * l.down.y};
        weft_vec3 point = meet_plate(camera, pose, at, &z);
        sum += radiance(scene, point.x, point.y);
    }
    double value = sum / (supersamples * supersamples);
    return value * weft_camera_vignetting(camera, (weft_pixel){px, py}) + scene->noise * plate_normal(state);
}

float *plate_photograph(const plate_scene *scene, const weft_camera *camera, const weft_pose *pose, unsigned seed)
{
    float *photograph = malloc((size_t)camera->width * (size_t)camera->height * sizeof *photograph);
    assert(photograph);
#pragma omp parallel for schedule(dynamic, 8)
    for (int y = 0; y < camera->height; y++) {
        unsigned state = seed * 2654435761u + (unsigned)y * 40503u;
        for (int x = 0; x < camera->width; x++)
            photograph[(long)y * camera->width + x] = (float)pixel_value(scene, camera, pose, x, y, &state);
    }
    return photograph;
}

double plate_error_mm(const weft_camera *camera, const weft_pose *pose, const weft_homography *found, double opening_mm)
{
    enum { grid = 9 };
    weft_homography truth = weft_homography_of_pose(camera, pose), inverse = weft_homography_inverse(found);
    double sum = 0;
    for (int i = 0; i < grid * grid; i++) {
        double x = opening_mm * (i % grid / (grid - 1.0) - 0.5), y = opening_mm * (i / grid / (grid - 1.0) - 0.5);
        weft_pixel seen = weft_homography_apply(&truth, x, y);
        weft_pixel back = weft_homography_apply(&inverse, seen.x, seen.y);
        sum += (back.x - x) * (back.x - x) + (back.y - y) * (back.y - y);
    }
    return sqrt(sum / (grid * grid));
}
