#include "btf/direction/direction.h"
#include "btf/direction/frame.h"
#include "tests/support/cmocka_all.h"

static weft_vec3 tilted(int theta_deg, int phi_deg)
{
    return weft_direction_of_angles((weft_angles){weft_rad_of_deg(theta_deg), weft_rad_of_deg(phi_deg)});
}

static double angle_between(weft_vec3 a, weft_vec3 b)
{
    return 2 * asin(fmin(1, weft_length(weft_subtract(a, b)) / 2));
}

static void assert_orthonormal(const weft_frame *frame)
{
    assert_true(fabs(weft_length(frame->normal) - 1) < 1e-14 && fabs(weft_length(frame->tangent) - 1) < 1e-14);
    assert_true(fabs(weft_dot(frame->normal, frame->tangent)) < 1e-14);
    weft_vec3 bitangent = weft_cross(frame->normal, frame->tangent);
    assert_true(weft_length(weft_subtract(bitangent, frame->bitangent)) < 1e-14);
}

static void frames_survive_coding_to_a_few_hundredths_of_a_degree(void **state)
{
    (void)state;
    for (int theta = 0; theta <= 80; theta += 5) {
        for (int phi = 0; phi < 360; phi += 15) {
            for (int turn = -180; turn <= 180; turn += 30) {
                weft_frame frame = weft_frame_of_normal(tilted(theta, phi), weft_rad_of_deg(turn));
                int16_t code[3];
                weft_frame_encode(&frame, code);
                weft_frame decoded = weft_frame_decode(code);
                assert_orthonormal(&frame);
                assert_orthonormal(&decoded);
                assert_true(angle_between(frame.normal, decoded.normal) < 2e-4);
                assert_true(angle_between(frame.tangent, decoded.tangent) < 3e-4);
            }
        }
    }
}

static void codes_of_zero_are_the_frame_of_the_surface(void **state)
{
    (void)state;
    weft_frame frame = weft_frame_decode((int16_t[3]){0, 0, 0});
    assert_true(frame.normal.z == 1 && frame.tangent.x == 1 && frame.bitangent.y == 1);
}

static void azimuth_turns_the_tangent_towards_the_bitangent(void **state)
{
    (void)state;
    weft_frame frame = weft_frame_of_normal(weft_vec3_of(0, 0, 1), WEFT_PI / 2);
    assert_true(weft_length(weft_subtract(frame.tangent, weft_vec3_of(0, 1, 0))) < 1e-15);
    assert_true(weft_length(weft_subtract(frame.bitangent, weft_vec3_of(-1, 0, 0))) < 1e-15);
}

static void frames_of_vectors_are_right_handed_and_keep_their_normal(void **state)
{
    (void)state;
    for (int i = 0; i < 44; i++) {
        weft_vec3 normal = tilted(i * 3 % 90, i * 47 % 360), tangent = tilted(90 - i % 60, i * 71 % 360);
        weft_frame frame = weft_frame_of_vectors(weft_scale(normal, 3), tangent);
        assert_orthonormal(&frame);
        assert_true(angle_between(frame.normal, normal) < 1e-7);
        assert_true(weft_dot(frame.tangent, tangent) > 0);
    }
}

static void a_normal_along_x_starts_from_y(void **state)
{
    (void)state;
    weft_frame frame = weft_frame_of_normal(weft_vec3_of(1, 0, 0), 0);
    assert_true(weft_length(weft_subtract(frame.tangent, weft_vec3_of(0, 1, 0))) < 1e-15);
}

static void hostile_codes_give_finite_orthonormal_frames(void **state)
{
    (void)state;
    static const int16_t extreme[5] = {INT16_MIN, -32767, 0, 23170, INT16_MAX};
    for (int i = 0; i < 125; i++) {
        weft_frame frame = weft_frame_decode((int16_t[3]){extreme[i % 5], extreme[i / 5 % 5], extreme[i / 25]});
        assert_orthonormal(&frame);
    }
}

static void an_average_tangent_does_not_know_signs(void **state)
{
    (void)state;
    const weft_frame true_frame = weft_frame_of_normal(tilted(40, 70), 0.4);
    weft_frame_sum sum = {0};
    for (int i = 0; i < 10; i++) {
        double turn_rad = weft_rad_of_deg(8 * (i - 4.5)), sign = i % 3 ? 1 : -1;
        weft_vec3 tangent = weft_add(weft_scale(true_frame.tangent, sign * cos(turn_rad)),
                                     weft_scale(true_frame.bitangent, sign * sin(turn_rad)));
        weft_frame_sum_add(&sum, true_frame.normal, tangent, 0.3);
    }
    weft_frame mean = weft_frame_of_sum(&sum);
    assert_orthonormal(&mean);
    assert_true(angle_between(mean.normal, true_frame.normal) < 1e-12);
    assert_true(fabs(weft_dot(mean.tangent, true_frame.tangent)) > 1 - 1e-12);
}

static void an_average_normal_weighs_and_stays_above_the_horizon(void **state)
{
    (void)state;
    weft_frame_sum one = {0}, sum = {0};
    weft_frame_sum_add(&one, weft_vec3_of(1, 0, 0), weft_vec3_of(0, 1, 0), 6);
    weft_frame_sum_merge(&sum, &one, 0.5);
    weft_frame_sum_add(&sum, weft_vec3_of(0, 0, 1), weft_vec3_of(0, 1, 0), 4);
    weft_frame mean = weft_frame_of_sum(&sum);
    assert_true(weft_length(weft_subtract(mean.normal, weft_vec3_of(0.6, 0, 0.8))) < 1e-15);
    assert_true(fabs(mean.tangent.y) > 1 - 1e-15);
    weft_frame_sum_add(&sum, weft_vec3_of(0, 0, -1), weft_vec3_of(0, 1, 0), 5);
    mean = weft_frame_of_sum(&sum);
    assert_true(weft_length(weft_subtract(mean.normal, weft_vec3_of(1, 0, 0))) < 1e-15);
    mean = weft_frame_of_sum(&(weft_frame_sum){0});
    assert_true(mean.normal.z == 1 && mean.tangent.x == 1);
}

int test_frame(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(frames_survive_coding_to_a_few_hundredths_of_a_degree),
        cmocka_unit_test(codes_of_zero_are_the_frame_of_the_surface),
        cmocka_unit_test(azimuth_turns_the_tangent_towards_the_bitangent),
        cmocka_unit_test(frames_of_vectors_are_right_handed_and_keep_their_normal),
        cmocka_unit_test(a_normal_along_x_starts_from_y),
        cmocka_unit_test(an_average_tangent_does_not_know_signs),
        cmocka_unit_test(an_average_normal_weighs_and_stays_above_the_horizon),
        cmocka_unit_test(hostile_codes_give_finite_orthonormal_frames),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
