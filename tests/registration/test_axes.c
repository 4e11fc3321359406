/* The axes of a goniometer out of 20 shots, against what they truly are. The shots come from the virtual goniometer
 * (capture/virtual/goniometer.h): parts that carry each other, with errors of its own, its true lens, and scatter from
 * shot to shot. What is fitted are lines in the frame of the plate. */
#include "capture/virtual/random.h"
#include "capture/virtual/world.h"
#include "registration/axes/expectation.h"
#include "tests/support/cmocka_all.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SHOTS = 20, TEXELS = 64 };

/* Rings of theta, and how many shots on each: those of assets/plans/calibration.csv. */
typedef struct ring {
    double theta_deg;
    int shots;
    double phi_deg;
} ring;

static const ring rings[] = {{0, 1, 0}, {20, 4, 30}, {40, 5, 0}, {60, 5, 36}, {75, 5, 10}};

typedef struct series {
    weft_virtual_world world;
    weft_axes_shot shot[SHOTS];
    weft_rig_poses nominal;
} series;

static weft_angles degrees(double theta_deg, double phi_deg)
{
    return (weft_angles){weft_rad_of_deg(theta_deg), weft_rad_of_deg(phi_deg)};
}

static weft_virtual_settings off_settings(void)
{
    weft_virtual_settings s = weft_virtual_settings_default();
    s.axes = 1;
    s.axis_tilt_deg = s.axis_zero_deg = s.aim_rotation_deg = 0.5;
    s.axis_offset_mm = 1;
    s.aim_mm = 2;
    return s;
}

static void see(const weft_virtual_world *world, weft_angles view, int stay, weft_axes_shot *shot)
{
    weft_pose pose = weft_virtual_world_pose(world, view, stay);
    weft_homography map = weft_homography_of_pose(&world->camera, &pose);
    *shot = (weft_axes_shot){.name = "shot", .turns = weft_turns_of_view(view)};
    for (int i = 0; i < WEFT_AXES_POINTS; i++) {
        double x = i % 2 ? 27 : -27, y = i / 2 ? 27 : -27;
        weft_pixel at = weft_camera_distort(&world->camera, weft_homography_apply(&map, x, y));
        weft_vec3 noise = weft_random_normal3(world->seed, WEFT_RANDOM_NOISE, (uint64_t)(stay * 16 + i));
        shot->point[i] = (weft_axes_point){{x, y}, {at.x + 0.01 * noise.x, at.y + 0.01 * noise.y}};
    }
}

static series take(const weft_virtual_settings *settings, uint64_t seed)
{
    series s = {.world = weft_virtual_world_of(settings, seed)};
    weft_camera camera = weft_rig_settings_camera(&settings->rig);
    int taken = 0;
    for (size_t r = 0; r < sizeof rings / sizeof *rings; r++) {
        for (int i = 0; i < rings[r].shots; i++, taken++)
            see(&s.world, degrees(rings[r].theta_deg, rings[r].phi_deg + 360.0 * i / rings[r].shots), taken,
                &s.shot[taken]);
    }
    s.nominal = weft_rig_poses_nominal(&camera, settings->rig.camera_distance_mm);
    return s;
}

/* The rig as it stands, without what differs from shot to shot. */
static weft_virtual_world at_rest(const weft_virtual_world *world)
{
    weft_virtual_world rest = *world;
    rest.settings.stay_rotation_deg = rest.settings.stay_translation_mm = 0;
    return rest;
}

/* The line that the plate turns about between two poses is that of the axis: its direction, from the poses alone. */
static weft_vec3 true_direction(const weft_virtual_world *rest, weft_angles from, weft_angles to)
{
    weft_pose a = weft_virtual_world_pose(rest, from, 0), b = weft_virtual_world_pose(rest, to, 0);
    double r[3][3] = {{0}};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++)
                r[i][j] += a.rotation[k][i] * b.rotation[k][j];
    return weft_unit((weft_vec3){r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1]});
}

static double angle_deg(weft_vec3 a, weft_vec3 b)
{
    return weft_deg_of_rad(atan2(weft_length(weft_cross(a, b)), weft_dot(a, b)));
}

typedef struct errors {
    double line_deg[2];          /* of the axes of theta and phi */
    double view_deg, texels;     /* root mean squares over the views of ubo81, of poses without scatter */
    double worst_deg;            /* of a view's direction */
    double expected_texels, expected_deg; /* the same root mean squares, as calibration expects them */
} errors;

static double shift_texels(const weft_virtual_world *rest, const weft_pose *truth, const weft_rig_poses *found,
                           const weft_pose *pose)
{
    weft_homography seen = weft_homography_of_pose(&rest->camera, truth);
    weft_homography map = weft_homography_of_pose(&found->camera, pose), back = weft_homography_inverse(&map);
    double sum = 0, opening = rest->settings.rig.opening_mm;
    for (int i = 0; i < 25; i++) {
        double x = opening * ((i % 5 + 0.5) / 5 - 0.5), y = opening * ((i / 5 + 0.5) / 5 - 0.5);
        weft_pixel at = weft_camera_distort(&rest->camera, weft_homography_apply(&seen, x, y));
        at = weft_camera_undistort(&found->camera, at);
        weft_pixel place = weft_homography_apply(&back, at.x, at.y);
        sum += (place.x - x) * (place.x - x) + (place.y - y) * (place.y - y);
    }
    return sqrt(sum / 25) * TEXELS / opening;
}

static errors compare(const series *s, const weft_axes_report *report)
{
    weft_virtual_world rest = at_rest(&s->world);
    const weft_rig_poses *found = &report->file.poses;
    errors e = {0};
    weft_axes_fit still = report->fit;
    still.scatter.rotation_rad = still.scatter.translation_mm = 0;
    e.line_deg[0] = angle_deg(true_direction(&rest, degrees(0, 0), degrees(60, 0)), found->joint[0].direction);
    e.line_deg[1] = angle_deg(true_direction(&rest, degrees(0, 0), degrees(0, 90)), found->joint[1].direction);
    for (int i = 0; i < WEFT_UBO81_COUNT; i++) {
        weft_angles view = weft_ubo81_angles(i);
        weft_turns turns = weft_turns_of_view(view);
        weft_pose truth = weft_virtual_world_pose(&rest, view, 0), pose = weft_rig_poses_at(found, &turns);
        double angle = angle_deg(weft_pose_camera_position(&truth), weft_pose_camera_position(&pose));
        double texels = shift_texels(&rest, &truth, found, &pose);
        weft_expected_pose expected =
            weft_axes_expect_pose(&still, &s->nominal, rest.settings.rig.opening_mm, TEXELS, &turns);
        e.view_deg += angle * angle / WEFT_UBO81_COUNT;
        e.texels += texels * texels / WEFT_UBO81_COUNT;
        e.expected_texels += expected.texels * expected.texels / WEFT_UBO81_COUNT;
        e.expected_deg += pow(weft_deg_of_rad(expected.direction_rad), 2) / WEFT_UBO81_COUNT;
        e.worst_deg = fmax(e.worst_deg, angle);
    }
    e.view_deg = sqrt(e.view_deg);
    e.texels = sqrt(e.texels);
    e.expected_texels = sqrt(e.expected_texels);
    e.expected_deg = sqrt(e.expected_deg);
    return e;
}

static weft_axes_report calibrate(series *s)
{
    weft_axes_report report;
    weft_error error = {0};
    weft_code code = weft_axes_calibrate(s->shot, SHOTS, &s->nominal, false, &report, &error);
    if (code != WEFT_OK)
        fail_msg("%s", error.message);
    return report;
}

/* Root mean squares over seeds. */
static errors calibrate_seeds(const weft_virtual_settings *settings, int seeds, const char *name)
{
    errors sum = {0};
    for (int seed = 1; seed <= seeds; seed++) {
        series s = take(settings, (uint64_t)seed);
        weft_axes_report report = calibrate(&s);
        errors e = compare(&s, &report);
        sum.line_deg[0] += e.line_deg[0] * e.line_deg[0] / seeds;
        sum.line_deg[1] += e.line_deg[1] * e.line_deg[1] / seeds;
        sum.view_deg += e.view_deg * e.view_deg / seeds;
        sum.texels += e.texels * e.texels / seeds;
        sum.expected_texels += e.expected_texels * e.expected_texels / seeds;
        sum.expected_deg += e.expected_deg * e.expected_deg / seeds;
        sum.worst_deg = fmax(sum.worst_deg, e.worst_deg);
        assert_int_equal(report.used, SHOTS);
        weft_axes_report_free(&report);
    }
    sum.line_deg[0] = sqrt(sum.line_deg[0]);
    sum.line_deg[1] = sqrt(sum.line_deg[1]);
    sum.view_deg = sqrt(sum.view_deg);
    sum.texels = sqrt(sum.texels);
    sum.expected_texels = sqrt(sum.expected_texels);
    sum.expected_deg = sqrt(sum.expected_deg);
    print_message("%s: lines %.4f %.4f degrees; views %.4f (expected %.4f), worst of all %.4f degrees; %.4f texels "
                  "(expected %.4f)\n",
                  name, sum.line_deg[0], sum.line_deg[1], sum.view_deg, sum.expected_deg, sum.worst_deg, sum.texels,
                  sum.expected_texels);
    return sum;
}

static void test_half_a_degree(void **state)
{
    (void)state;
    weft_virtual_settings s = off_settings();
    calibrate_seeds(&s, 8, "half a degree, scatter of 0.05 degrees");
    s.stay_rotation_deg = 0.02;
    s.stay_translation_mm = 0.05;
    calibrate_seeds(&s, 8, "half a degree, scatter of 0.02 degrees");
    s.stay_rotation_deg = s.stay_translation_mm = 0;
    calibrate_seeds(&s, 8, "half a degree, no scatter");
    s = off_settings();
    s.axis_wobble_deg = 0.1;
    s.axis_uneven_deg = 0.1;
    s.axis_scale = 0.002;
    calibrate_seeds(&s, 8, "with wobble, unevenness, scale");
    s.stay_rotation_deg = s.stay_translation_mm = 0;
    calibrate_seeds(&s, 8, "with wobble, unevenness, scale, no scatter");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_half_a_degree),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
