#include "capture/synthetic/plan.h"

#include "capture/virtual/world.h"

#include <stdio.h>

weft_synthetic_request weft_synthetic_request_default(void)
{
    return (weft_synthetic_request){.seed = 1,
                                    .photograph_count = 60,
                                    .width = 3000,
                                    .opening_mm = 50,
                                    .focal_length_mm = 35,
                                    .max_view_rad = weft_rad_of_deg(65),
                                    .lamp_radius_mm = 12,
                                    .window = 100,
                                    .white_balance = 0,
                                    .truth_size = 64};
}

/* ---- Lens ---- */

/* One lens of a kind for a seed: a little barrel distortion, an axis beside the middle. */
static weft_synthetic_lens lens_of(const weft_synthetic_request *request)
{
    weft_dice d = weft_dice_of(request->seed, -1);
    weft_synthetic_lens lens = {.width = request->width,
                                .height = request->width * 2 / 3,
                                .sensor_width_mm = 23.5,
                                .focal_length_mm = request->focal_length_mm,
                                .rim_mm = 24,
                                .rim_radius_mm = 24 * 14.5 / request->focal_length_mm};
    lens.image_distance_mm = lens.focal_length_mm * (1 + weft_dice_between(&d, -0.02, 0.03));
    lens.axis_x = 0.5 * (lens.width - 1) + weft_dice_between(&d, -0.004, 0.004) * lens.width;
    lens.axis_y = 0.5 * (lens.height - 1) + weft_dice_between(&d, -0.004, 0.004) * lens.width;
    lens.division[0] = -weft_dice_between(&d, 0.015, 0.035);
    lens.division[1] = weft_dice_between(&d, -0.004, 0.008);
    return lens;
}

static void focus(const weft_synthetic_request *request, double depth_mm, double f_number, weft_synthetic_lens *lens)
{
    lens->focus_mm = depth_mm;
    lens->pupil_radius_mm = lens->focal_length_mm / (2 * f_number);
    lens->image_distance_mm *= 1 + request->breathing * lens->focal_length_mm / (depth_mm - lens->focal_length_mm);
    weft_synthetic_lens_prepare(lens);
}

/* ---- Poses ---- */

static weft_pose pose_of_axes(weft_vec3 eye, weft_vec3 right, weft_vec3 down, weft_vec3 forward)
{
    return (weft_pose){
        {{right.x, right.y, right.z}, {down.x, down.y, down.z}, {forward.x, forward.y, forward.z}},
        {-weft_dot(right, eye), -weft_dot(down, eye), -weft_dot(forward, eye)},
    };
}

/* A camera at `eye` that looks at `aim`; up in the picture is away from the viewer on the sheet and the zenith when the
 * view is slant, then rolled. The orientation turns the camera by a quarter, as EXIF counts. */
static weft_pose look_at(weft_vec3 eye, weft_vec3 aim, double phi, double roll, int orientation)
{
    weft_vec3 forward = weft_unit(weft_subtract(aim, eye));
    double theta = acos(weft_clamp(-forward.z, -1, 1));
    weft_vec3 up = {-cos(phi) * cos(theta), -sin(phi) * cos(theta), sin(theta)};
    weft_vec3 right = weft_unit(weft_cross(forward, up)), down = weft_cross(forward, right);
    double c = cos(roll), s = sin(roll);
    weft_vec3 x = weft_add(weft_scale(right, c), weft_scale(down, s));
    weft_vec3 y = weft_subtract(weft_scale(down, c), weft_scale(right, s));
    if (orientation == 6)
        return pose_of_axes(eye, y, weft_scale(x, -1), forward);
    if (orientation == 8)
        return pose_of_axes(eye, weft_scale(y, -1), x, forward);
    return pose_of_axes(eye, x, y, forward);
}

/* How much of the half frame a point needs: 1 at the edge. */
static double need_of(const weft_synthetic_lens *lens, const weft_pose *pose, weft_vec3 point)
{
    double pixel[2];
    if (!weft_synthetic_lens_project(lens, weft_pose_apply(pose, point), pixel))
        return INFINITY;
    return fmax(fabs(2 * pixel[0] / (lens->width - 1) - 1), fabs(2 * pixel[1] / (lens->height - 1) - 1));
}

static double need_of_sheet(const weft_synthetic_lens *lens, const weft_pose *pose, double opening_mm)
{
    weft_target target = weft_target_printed(opening_mm);
    weft_rectangle outline = weft_target_sheet(&target);
    double need = 0;
    for (int i = 0; i < 8; i++) {
        weft_vec3 corner = {i & 1 ? outline.x0 : outline.x1, i & 2 ? outline.y0 : outline.y1, i & 4 ? 15 : 0};
        need = fmax(need, need_of(lens, pose, corner));
    }
    return need;
}

/* A view as a person aims it. */
typedef struct aim {
    double theta, phi, roll, fill;
    weft_vec3 at;
    int orientation;
} aim;

static weft_vec3 eye_of(const aim *a, double distance)
{
    weft_vec3 toward = {sin(a->theta) * cos(a->phi), sin(a->theta) * sin(a->phi), cos(a->theta)};
    return weft_add(a->at, weft_scale(toward, distance));
}

/* The nearest place from which the sheet fills `fill` of the frame. */
static weft_pose stand_back(const weft_synthetic_request *request, const weft_synthetic_lens *lens, const aim *a)
{
    double near = 60, far = 6000;
    for (int i = 0; i < 30; i++) {
        double middle = sqrt(near * far);
        weft_pose pose = look_at(eye_of(a, middle), a->at, a->phi, a->roll, a->orientation);
        if (need_of_sheet(lens, &pose, request->opening_mm) > a->fill)
            near = middle;
        else
            far = middle;
    }
    return look_at(eye_of(a, far), a->at, a->phi, a->roll, a->orientation);
}

/* A person turns the camera until the sheet fits best: level or upright, and rolled as far as the horizon does not tell
 * (it does where the view is slant). */
static void fit_frame(const weft_synthetic_request *request, const weft_synthetic_lens *lens, int upright, aim *a)
{
    enum { ROLLS = 7 };
    double nearest = INFINITY, roll = a->roll, most = WEFT_PI / 4 * pow(cos(a->theta), 4);
    aim best = *a;
    for (int i = 0; i < 2 * ROLLS; i++) {
        aim tried = *a;
        tried.orientation = i < ROLLS ? 1 : upright;
        tried.roll = most * (2.0 * (i % ROLLS) / (ROLLS - 1) - 1);
        weft_pose pose = stand_back(request, lens, &tried);
        if (pose.translation.z < nearest) {
            nearest = pose.translation.z;
            best = tried;
        }
    }
    best.roll += roll;
    *a = best;
}

static weft_pose free_pose(const weft_synthetic_request *request, const weft_synthetic_lens *lens, weft_dice *d,
                           int *orientation)
{
    double size = request->opening_mm * 4;
    /* Solid angle for solid angle, but a person takes more from above than that. */
    double cosine = 1 - pow(weft_dice_between(d, 0, 1), 1.2) * (1 - cos(request->max_view_rad));
    aim a = {.theta = acos(cosine), .phi = weft_dice_between(d, 0, 2 * WEFT_PI), .roll = weft_dice_normal(d, 0.05)};
    a.fill = weft_dice_between(d, 0.84, 0.95);
    a.at = weft_vec3_of(weft_dice_normal(d, 0.02 * size), weft_dice_normal(d, 0.02 * size), 0);
    int upright = weft_dice_between(d, 0, 1) < 0.7 ? 6 : 8;
    fit_frame(request, lens, upright, &a);
    *orientation = a.orientation;
    return stand_back(request, lens, &a);
}

/* ---- Lamps ---- */

static bool in_frame(const weft_synthetic_shot *shot, weft_vec3 point)
{
    return need_of(&shot->lens, &shot->pose, point) < 1.1;
}

/* Somewhere over the sheet, neither in the picture nor behind the camera. */
static weft_vec3 hold_lamp(const weft_synthetic_shot *shot, weft_dice *d, double nearest, double farthest)
{
    weft_vec3 at = {0, 0, 0}, toward_eye = weft_unit(weft_pose_camera_position(&shot->pose));
    for (int try = 0; try < 200; try++) {
        double theta = acos(weft_dice_between(d, cos(weft_rad_of_deg(75)), 1)),
               phi = weft_dice_between(d, 0, 2 * WEFT_PI);
        double distance = nearest * pow(farthest / nearest, weft_dice_between(d, 0, 1));
        at = weft_scale(weft_vec3_of(sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta)), distance);
        if (weft_dot(weft_unit(at), toward_eye) < cos(weft_rad_of_deg(9)) && !in_frame(shot, at))
            break;
    }
    return at;
}

/* A flash above the lens and a little aside, as the camera is held level. */
static weft_synthetic_lamp flash_of(const weft_synthetic_request *request, const weft_synthetic_shot *shot)
{
    weft_dice d = weft_dice_of(request->seed, -2);
    weft_vec3 offset = {-weft_dice_between(&d, 10, 30), -weft_dice_between(&d, 60, 85), weft_dice_between(&d, -5, 15)};
    const double *f = shot->pose.rotation[2];
    return (weft_synthetic_lamp){.at = weft_pose_apply_inverse(&shot->pose, offset),
                                 .axis = {f[0], f[1], f[2]},
                                 .is_disc = true,
                                 .radius_mm = request->lamp_radius_mm,
                                 .intensity_cd = 3500,
                                 .colour = {1, 1, 1}};
}

static weft_synthetic_lamp lamp_at(const weft_synthetic_request *request, weft_vec3 at)
{
    return (weft_synthetic_lamp){.at = at,
                                 .axis = weft_unit(weft_scale(at, -1)),
                                 .radius_mm = request->lamp_radius_mm,
                                 .intensity_cd = 2500,
                                 .colour = {1, 0.93, 0.84}};
}

/* ---- Exposure ---- */

/* What a camera calls a step in thirds of a power of two: ISO 126 is 125, 1/101.6 s is 1/100 s. */
static double engraved(double value)
{
    static const double name[] = {1, 1.25, 1.6, 2, 2.5, 3.2, 4, 5, 6.4, 8, 10};
    double decade = pow(10, floor(log10(value) + 1e-9)), nearest = 1;
    for (size_t i = 1; i < sizeof name / sizeof *name; i++) {
        if (fabs(log(value / decade / name[i])) < fabs(log(value / decade / nearest)))
            nearest = name[i];
    }
    return nearest * decade;
}

/* The next of the steps in thirds of a power of two. */
static double third_stop(double value)
{
    return exp2(round(3 * log2(value)) / 3);
}

/* Aperture priority: the paper comes to a half of the range, give or take; by time, then by sensitivity. The shutter of
 * a flash is fixed. */
static weft_synthetic_exposure expose(const weft_synthetic_request *request, const weft_synthetic_lamp *lamp,
                                      weft_dice *d)
{
    double paper = 0.85 * weft_synthetic_lamp_illuminance(lamp, weft_vec3_of(0, 0, 0)) / WEFT_PI;
    double wanted = 0.48 * exp2(weft_dice_between(d, -0.5, 0.4)) / fmax(paper, 1);
    weft_synthetic_exposure e = {.f_number = 11, .iso = 100, .seconds = 1.0 / 160};
    double slowest = request->set == WEFT_SYNTHETIC_FREE || request->set == WEFT_SYNTHETIC_FLASH ? 1.0 / 60 : 2;
    if (request->set != WEFT_SYNTHETIC_FLASH)
        e.seconds = third_stop(fmin(wanted / weft_synthetic_gain(1, e.f_number, e.iso), slowest));
    e.iso = weft_clamp(100 * third_stop(wanted / weft_synthetic_gain(e.seconds, e.f_number, 100)), 100, 6400);
    e.gain = weft_synthetic_gain(e.seconds, e.f_number, e.iso) * (1 + weft_dice_normal(d, 0.004));
    e.seconds = 1 / engraved(1 / e.seconds);
    e.iso = engraved(e.iso);
    e.white_balance[0] = 1 / lamp->colour.r * lamp->colour.g * (1 + weft_dice_normal(d, request->white_balance));
    e.white_balance[1] = 1;
    e.white_balance[2] = 1 / lamp->colour.b * lamp->colour.g * (1 + weft_dice_normal(d, request->white_balance));
    return e;
}

/* ---- Sets ---- */

static void plan_free(const weft_synthetic_request *request, weft_dice *d, weft_synthetic_shot *shot)
{
    shot->pose = free_pose(request, &shot->lens, d, &shot->orientation);
    shot->lamp = request->set == WEFT_SYNTHETIC_FLASH ? flash_of(request, shot)
                                                      : lamp_at(request, hold_lamp(shot, d, 300, 1500));
}

static void plan_tripod(const weft_synthetic_request *request, weft_dice *d, weft_synthetic_shot *shot)
{
    weft_dice stand = weft_dice_of(request->seed, -3);
    aim a = {.theta = weft_dice_between(&stand, 0.02, 0.12),
             .phi = -WEFT_PI / 2 + weft_dice_normal(&stand, 0.1),
             .roll = weft_dice_normal(&stand, 0.02)};
    a.fill = 0.93;
    shot->orientation = a.orientation = 6;
    shot->pose = stand_back(request, &shot->lens, &a);
    shot->lamp = lamp_at(request, hold_lamp(shot, d, 500, 900));
}

/* A turntable of 12 steps; the arm of the camera has as many places as the photographs need, and so has that of the
 * lamp, which stands on the other side of the room. */
static void plan_stepped(const weft_synthetic_request *request, int photograph, weft_dice *d, weft_synthetic_shot *shot)
{
    enum { STEPS = 12 };
    int arms = (request->photograph_count + STEPS - 1) / STEPS, arm = photograph / STEPS, step = photograph % STEPS;
    double theta = arms > 1 ? request->max_view_rad * arm / (arms - 1) : request->max_view_rad / 2;
    double phi = 2 * WEFT_PI * step / STEPS;
    aim a = {.theta = theta + weft_dice_normal(d, 0.003),
             .phi = phi + weft_dice_normal(d, 0.003),
             .roll = weft_dice_normal(d, 0.002)};
    a.at = weft_vec3_of(weft_dice_normal(d, 0.4), weft_dice_normal(d, 0.4), 0);
    a.fill = 0.80;
    shot->nominal_theta_rad = theta;
    shot->nominal_phi_rad = phi;
    shot->orientation = a.orientation = 1;
    double lamp_theta = weft_rad_of_deg(15 + 50 * fmod(0.618034 * arm + 0.3, 1)) + weft_dice_normal(d, 0.003);
    double lamp_phi = a.phi + weft_rad_of_deg(140);
    weft_vec3 lamp = {sin(lamp_theta) * cos(lamp_phi), sin(lamp_theta) * sin(lamp_phi), cos(lamp_theta)};
    shot->pose = look_at(eye_of(&a, 620 + weft_dice_normal(d, 0.5)), a.at, a.phi, a.roll, 1);
    shot->lamp = lamp_at(request, weft_scale(lamp, 800 + weft_dice_normal(d, 1)));
}

/* ---- The plan ---- */

/* As cameras count, with the endings that computers leave. */
static void name_shot(const weft_synthetic_request *request, int photograph, weft_synthetic_shot *shot)
{
    static const char *const ending[3][2] = {{"JPG", "jpg"}, {"tif", "TIF"}, {"exr", "exr"}};
    weft_dice d = weft_dice_of(request->seed, -4);
    int first = (int)weft_dice_between(&d, 100, 8000), number = (first + photograph) % 10000;
    snprintf(shot->name, sizeof shot->name, "IMG_%04d.%s", number, ending[request->format][photograph % 7 == 5]);
    unsigned count = (unsigned)photograph;
    snprintf(shot->date, sizeof shot->date, "2026:03:14 %02u:%02u:%02u", (14 + count / 180) % 24, count / 3 % 60,
             count % 3 * 20 + count % 17);
}

/* The first photograph of the series that a photograph belongs to: itself where it belongs to none. Series lie evenly
 * among the photographs. */
static int first_of_series(const weft_synthetic_request *request, int photograph)
{
    for (int i = 0; i < request->series_count; i++) {
        if ((int)((i + 0.3) * request->photograph_count / request->series_count) == photograph - 1)
            return photograph - 1;
    }
    return photograph;
}

/* The same again, two stops darker. Neither hand is quite still; a stand is. */
static void take_darker(const weft_synthetic_request *request, int photograph, weft_synthetic_shot *shot)
{
    const double times = 4, camera_mm = 0.5, lamp_mm = 2;
    weft_dice d = weft_dice_of(request->seed, photograph);
    shot->exposure.gain *= (1 + weft_dice_normal(&d, 0.004)) / times;
    shot->exposure.seconds = 1 / engraved(times / shot->exposure.seconds);
    if (request->set != WEFT_SYNTHETIC_FREE && request->set != WEFT_SYNTHETIC_FLASH)
        return;
    double *moved[] = {&shot->pose.translation.x, &shot->pose.translation.y, &shot->pose.translation.z};
    for (int axis = 0; axis < 3; axis++)
        *moved[axis] += weft_dice_normal(&d, camera_mm);
    weft_vec3 aside = {weft_dice_normal(&d, lamp_mm), weft_dice_normal(&d, lamp_mm), weft_dice_normal(&d, lamp_mm)};
    shot->lamp = request->set == WEFT_SYNTHETIC_FLASH ? flash_of(request, shot)
                                                      : lamp_at(request, weft_add(shot->lamp.at, aside));
}

static void plan_shot(const weft_synthetic_request *request, int photograph, weft_synthetic_shot *shot)
{
    int first = first_of_series(request, photograph);
    weft_dice d = weft_dice_of(request->seed, first);
    *shot = (weft_synthetic_shot){.lens = lens_of(request),
                                  .fault = weft_synthetic_fault_of(request, photograph),
                                  .key = weft_random_bits(request->seed, WEFT_RANDOM_NOISE, (uint64_t)photograph)};
    name_shot(request, photograph, shot);
    if (request->set == WEFT_SYNTHETIC_TRIPOD)
        plan_tripod(request, &d, shot);
    else if (request->set == WEFT_SYNTHETIC_STEPPED)
        plan_stepped(request, first, &d, shot);
    else
        plan_free(request, &d, shot);
    shot->exposure = expose(request, &shot->lamp, &d);
    double depth = shot->pose.translation.z;
    weft_dice focusing = request->set == WEFT_SYNTHETIC_TRIPOD ? weft_dice_of(request->seed, -5) : d;
    focus(request, depth * (1 + weft_dice_normal(&focusing, 0.01)), shot->exposure.f_number, &shot->lens);
    d.next += 2;
    shot->hand_shadow = weft_dice_between(&d, 0, 1) < request->hand_shadows;
    if (first != photograph)
        take_darker(request, photograph, shot);
    weft_synthetic_place_hand(request, &d, shot);
    weft_synthetic_spoil(&d, shot);
}

void weft_synthetic_plan(const weft_synthetic_request *request, weft_synthetic_shot *shot)
{
    for (int i = 0; i < request->photograph_count; i++)
        plan_shot(request, i, &shot[i]);
}

weft_synthetic_scene weft_synthetic_scene_of(const weft_synthetic_request *request, const weft_synthetic_shot *shot,
                                             const weft_synthetic_sheet *sheet, const weft_virtual_sample *content)
{
    weft_synthetic_scene scene = {.sheet = sheet, .content = content, .lamp = shot->lamp, .gloss = request->gloss};
    scene.window = (weft_synthetic_window){.middle = {-1900, 1500, 700},
                                           .across = {0.619644, 0.784883, 0},
                                           .normal = {0.784883, -0.619644, 0},
                                           .half_width_mm = 500,
                                           .half_height_mm = 600,
                                           .luminance = request->window};
    scene.wall_luminance = 0.02 * request->window;
    if (!request->no_balls)
        weft_synthetic_scene_put_balls(&scene);
    if (!request->no_pin)
        weft_synthetic_scene_put_pin(&scene);
    if (shot->hand_shadow || shot->fault == WEFT_SYNTHETIC_HAND_OVER)
        weft_synthetic_scene_put_hand(&scene, shot->hand, shot->hand_along);
    return scene;
}
