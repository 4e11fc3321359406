#include "btf/direction.h"
#include "btf/material.h"
#include "tests/btf/cmocka_all.h"

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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(frames_survive_coding_to_a_few_hundredths_of_a_degree),
        cmocka_unit_test(codes_of_zero_are_the_frame_of_the_surface),
        cmocka_unit_test(azimuth_turns_the_tangent_towards_the_bitangent),
        cmocka_unit_test(a_normal_along_x_starts_from_y),
        cmocka_unit_test(hostile_codes_give_finite_orthonormal_frames),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
