/* Where the light of the virtual rig stands, told from the brightness of the white patches in its photographs. What is
 * expected is worked out here from the settings (docs/reference/session-format.md); nothing of capture/virtual/world.c,
 * from which rig and ground truth both take their light, is called. */
#include "capture/virtual/random.h"
#include "capture/virtual/virtual_rig.h"
#include "tests/support/cmocka_all.h"

#include <stdlib.h>

enum { SEED = 11, SIDE = 208, CASES = 7 };

static const double light_mm = 650, exposure_s = 0.5;

/* Degrees: view, light. */
static const double viewpoints[CASES][4] = {{0, 0, 40, 30},   {0, 0, 60, 200},  {0, 0, 75, 290},   {20, 90, 0, 0},
                                            {20, 90, 70, 10}, {40, 200, 55, 0}, {40, 200, 72, 120}};

static weft_angles degrees(double theta_deg, double phi_deg)
{
    return (weft_angles){weft_rad_of_deg(theta_deg), weft_rad_of_deg(phi_deg)};
}

/* A camera that does not err, and no noise: raw values are proportional to radiance times vignetting. */
static weft_virtual_settings settings_of(double mounting_deg, double mounting_mm, double arm_deg)
{
    weft_virtual_settings s = weft_virtual_settings_default();
    s.rig.width_px = s.rig.height_px = SIDE;
    s.rig.focal_length_px = 900;
    s.rig.bits = 16;
    s.rig.light_distance_mm = light_mm;
    s.rig.k1 = s.rig.k2 = 0;
    s.full_well_electrons = 1e7;
    s.read_noise_electrons = s.light_power_drift = 0;
    s.focal_length_error = s.principal_point_error_px = s.k1_error = 0;
    s.viewpoint_rotation_deg = s.viewpoint_translation_mm = 0;
    s.mounting_rotation_deg = mounting_deg;
    s.mounting_translation_mm = mounting_mm;
    s.light_rotation_deg = arm_deg;
    return s;
}

/* v turned about `axis_angle` by its length in radians. */
static weft_vec3 turn(weft_vec3 v, weft_vec3 axis_angle)
{
    double angle = weft_length(axis_angle);
    if (!(angle > 0))
        return v;
    weft_vec3 k = weft_scale(axis_angle, 1 / angle);
    weft_vec3 along = weft_scale(k, weft_dot(k, v));
    weft_vec3 across = weft_subtract(v, along);
    return weft_add(along, weft_add(weft_scale(across, cos(angle)), weft_scale(weft_cross(k, across), sin(angle))));
}

/* The plate is mounted turned by one angle and moved by one distance, both in directions drawn from the seed. */
typedef struct mounting {
    weft_vec3 turn, shift;
} mounting;

static mounting mounting_of(const weft_virtual_settings *s)
{
    return (mounting){
        weft_scale(weft_random_direction(SEED, WEFT_RANDOM_MOUNTING, 0), weft_rad_of_deg(s->mounting_rotation_deg)),
        weft_scale(weft_random_direction(SEED, WEFT_RANDOM_MOUNTING, 1), s->mounting_translation_mm)};
}

/* The draw of a move is numbered by the viewpoint and both driven angles in units of 1e-4 degrees. */
static weft_vec3 arm_turn(const weft_virtual_settings *s, weft_angles driven, int viewpoint)
{
    uint64_t theta = (uint64_t)llround(weft_deg_of_rad(driven.theta_rad) * 1e4);
    uint64_t phi = (uint64_t)llround(weft_deg_of_rad(driven.phi_rad) * 1e4);
    uint64_t move = ((uint64_t)viewpoint * 1000003 + theta) * 10000019 + phi;
    return weft_scale(weft_random_normal3(SEED, WEFT_RANDOM_LIGHT, move), weft_rad_of_deg(s->light_rotation_deg));
}

/* A point of the rig in the frame of the plate. */
static weft_vec3 to_plate(const mounting *m, weft_vec3 in_rig)
{
    return turn(weft_subtract(in_rig, m->shift), weft_scale(m->turn, -1));
}

static weft_vec3 light_on_plate(const weft_virtual_settings *s, weft_angles driven, int viewpoint)
{
    mounting m = mounting_of(s);
    weft_vec3 driven_to = weft_scale(weft_direction_of_angles(driven), light_mm);
    return to_plate(&m, turn(driven_to, arm_turn(s, driven, viewpoint)));
}

/* The pixel that sees a point of the plate: camera at the nominal pose, plate mounted askew. */
static weft_pixel pixel_of(const weft_virtual_settings *s, weft_angles view, double x_mm, double y_mm)
{
    mounting m = mounting_of(s);
    weft_vec3 in_rig = weft_add(turn(weft_vec3_of(x_mm, y_mm, 0), m.turn), m.shift);
    weft_pose pose = weft_pose_of_view(view, s->rig.camera_distance_mm);
    double at[3];
    for (int row = 0; row < 3; row++)
        at[row] =
            pose.rotation[row][0] * in_rig.x + pose.rotation[row][1] * in_rig.y + pose.rotation[row][2] * in_rig.z;
    double z = at[2] + pose.translation.z, focal = s->rig.focal_length_px;
    return (weft_pixel){(SIDE - 1) / 2.0 + focal * (at[0] + pose.translation.x) / z,
                        (SIDE - 1) / 2.0 + focal * (at[1] + pose.translation.y) / z};
}

/* Vignetting from its definition; nothing is distorted. */
static double vignetting(const weft_virtual_settings *s, weft_pixel at)
{
    double x = (at.x - (SIDE - 1) / 2.0) / s->rig.focal_length_px,
           y = (at.y - (SIDE - 1) / 2.0) / s->rig.focal_length_px;
    double r2 = x * x + y * y;
    return 1 + r2 * (s->rig.vignetting_r2 + r2 * (s->rig.vignetting_r4 + r2 * s->rig.vignetting_r6));
}

/* What a camera saw of a patch over what the light should have made of it: the same number everywhere. */
static double brightness(const weft_virtual_settings *s, const uint16_t *samples, weft_angles view, weft_vec3 light,
                         weft_rectangle patch)
{
    double x = (patch.x0 + patch.x1) / 2, y = (patch.y0 + patch.y1) / 2, sum = 0;
    weft_pixel at = pixel_of(s, view, x, y);
    for (int i = 0; i < 9; i++)
        sum += samples[3 * ((lround(at.y) - 1 + i / 3) * SIDE + lround(at.x) - 1 + i % 3)] - s->rig.black_level;
    weft_vec3 to_light = weft_subtract(light, weft_vec3_of(x, y, 0));
    double distance = weft_length(to_light), irradiance = to_light.z / pow(distance, 3) * light_mm * light_mm;
    return sum / 9 / (exposure_s * irradiance * vignetting(s, at));
}

static void photograph(weft_rig *rig, weft_angles view, weft_angles light, uint16_t *samples)
{
    bool moved;
    double read_back_s;
    assert_int_equal(rig->stage.move(rig->stage.device, view, light, &moved, NULL), WEFT_OK);
    assert_int_equal(rig->light.power(rig->light.device, true, NULL), WEFT_OK);
    assert_int_equal(rig->camera.expose(rig->camera.device, 1, exposure_s, samples, &read_back_s, NULL), WEFT_OK);
}

/* Root mean square by which the patches of all photographs differ from their mean. */
static double spread(const weft_virtual_settings *s, const weft_virtual_settings *believed)
{
    weft_virtual_rig virtual;
    weft_virtual_request request = {WEFT_ASSETS "/weaves/polyester_lining.wv", SEED, *s};
    uint16_t *samples = malloc((size_t)SIDE * SIDE * 3 * sizeof *samples);
    weft_target target = weft_target_for_opening(s->rig.opening_mm);
    double sum = 0, squares = 0;
    int viewpoint = -1, count = CASES * WEFT_TARGET_REFERENCE_COUNT;
    assert_non_null(samples);
    assert_int_equal(weft_virtual_rig_open(&request, &virtual, NULL), WEFT_OK);
    assert_int_equal(virtual.rig.stage.home(virtual.rig.stage.device, 0, NULL), WEFT_OK);
    for (int i = 0; i < CASES; i++) {
        weft_angles view = degrees(viewpoints[i][0], viewpoints[i][1]),
                    light = degrees(viewpoints[i][2], viewpoints[i][3]);
        viewpoint += i == 0 || viewpoints[i][0] != viewpoints[i - 1][0];
        photograph(&virtual.rig, view, light, samples);
        for (int patch = 0; patch < WEFT_TARGET_REFERENCE_COUNT; patch++) {
            double seen = brightness(s, samples, view, light_on_plate(believed, light, viewpoint),
                                     weft_target_reference(&target, patch));
            sum += seen;
            squares += seen * seen;
        }
    }
    weft_virtual_rig_close(&virtual);
    free(samples);
    return sqrt(fmax(0, squares / count - sum / count * (sum / count))) / (sum / count);
}

static void without_errors_the_light_stands_where_it_is_driven(void **state)
{
    (void)state;
    weft_virtual_settings exact = settings_of(0, 0, 0);
    assert_true(spread(&exact, &exact) < 0.004);
}

static void the_plate_is_turned_and_moved_under_the_light_as_the_settings_say(void **state)
{
    (void)state;
    weft_virtual_settings exact = settings_of(0, 0, 0), askew = settings_of(4, 0, 0), moved = settings_of(0, 8, 0);
    assert_true(spread(&askew, &askew) < 0.004);
    assert_true(spread(&askew, &exact) > 0.03);
    assert_true(spread(&moved, &moved) < 0.004);
    assert_true(spread(&moved, &exact) > 0.006);
}

static void the_arm_of_the_light_errs_as_the_settings_say(void **state)
{
    (void)state;
    weft_virtual_settings exact = settings_of(0, 0, 0), jittery = settings_of(0, 0, 2), all = settings_of(3, 5, 1);
    assert_true(spread(&jittery, &jittery) < 0.004);
    assert_true(spread(&jittery, &exact) > 0.03);
    assert_true(spread(&all, &all) < 0.004);
}

/* The draws themselves: about each axis, one standard deviation in the mean, and new ones for every move. */
static void turns_of_the_arm_are_normal_and_new_for_every_move(void **state)
{
    (void)state;
    enum { MOVES = 4000 };
    weft_virtual_settings s = settings_of(0, 0, 1);
    double squares[3] = {0};
    for (int i = 0; i < MOVES; i++) {
        weft_vec3 own = arm_turn(&s, degrees(i % 75, 0.5 * i), i / 100),
                  other = arm_turn(&s, degrees(i % 75, 0.5 * i), i);
        const double axis[3] = {own.x, own.y, own.z};
        for (int k = 0; k < 3; k++)
            squares[k] += axis[k] * axis[k] / MOVES;
        assert_true(i < 100 || own.x != other.x);
    }
    for (int k = 0; k < 3; k++)
        assert_true(fabs(weft_deg_of_rad(sqrt(squares[k])) - 1) < 0.05);
}

int test_light_arm(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(without_errors_the_light_stands_where_it_is_driven),
        cmocka_unit_test(the_plate_is_turned_and_moved_under_the_light_as_the_settings_say),
        cmocka_unit_test(the_arm_of_the_light_errs_as_the_settings_say),
        cmocka_unit_test(turns_of_the_arm_are_normal_and_new_for_every_move),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
