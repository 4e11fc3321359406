/* The reference vectors of microcylinder threads and cloth. Built twice: in double, and in single precision. */
#include "tests/reflectance/microcylinder/microcylinder_cloths.h"
#include "tests/reflectance/representable.h"

#include <string.h>

enum { OUTPUTS = 10, THREAD_ROWS = 300, CLOTH_ROWS = 224 };

static const char *const output_column[OUTPUTS] = {"fs",      "M",       "P",     "frs",   "frv",
                                                   "theta_i", "theta_o", "phi_d", "psi_d", "cos_theta_d"};

static weft_real real_at(const reference_vectors *v, int row, const char *column)
{
    return (weft_real)vectors_number(v, row, column);
}

typedef struct thread_row {
    weft_thread_tangent tangent;
    weft_thread_optics optics;
    weft_real sigma;
} thread_row;

static thread_row thread_row_at(const reference_vectors *v, int row)
{
    weft_thread_axis axis = strcmp(vectors_text(v, row, "axis"), "x") == 0 ? WEFT_AXIS_X : WEFT_AXIS_Y;
    double tilt_rad = vectors_number(v, row, "tilt_deg") * (double)WEFT_PI / 180;
    weft_real albedo = real_at(v, row, "A");
    return (thread_row){.tangent = weft_thread_tangent_of(axis, (weft_real)tilt_rad),
                        .optics = {.eta = real_at(v, row, "eta"),
                                   .gamma_s = real_at(v, row, "gamma_s"),
                                   .gamma_v = real_at(v, row, "gamma_v"),
                                   .kd = real_at(v, row, "kd"),
                                   .albedo = {albedo, albedo, albedo}},
                        .sigma = real_at(v, row, "sigma")};
}

static void thread_outputs(const thread_row *thread, direction_pair at, double out[OUTPUTS])
{
    weft_thread_angles angles = weft_thread_angles_of(&thread->tangent, at.light, at.view);
    const double value[OUTPUTS] = {weft_thread_scattering(&thread->optics, &angles).r,
                                   weft_thread_shadowing(&angles, thread->sigma),
                                   weft_thread_projection(thread->tangent.axis, thread->sigma, at.light, at.view),
                                   weft_thread_surface(&thread->optics, &angles),
                                   weft_thread_volume(&thread->optics, &angles) * thread->optics.albedo.r,
                                   angles.theta_light,
                                   angles.theta_view,
                                   angles.phi_difference,
                                   weft_thread_psi_difference(thread->tangent.axis, at.light, at.view),
                                   angles.cos_theta_difference};
    memcpy(out, value, sizeof value);
}

static void check_thread(reference_vectors *v, int row)
{
    direction_pair at = {vectors_direction(v, row, "wi"), vectors_direction(v, row, "wo")};
    thread_row thread = thread_row_at(v, row);
    double out[OUTPUTS];
    thread_outputs(&thread, at, out);
    for (int i = 0; i < OUTPUTS; i++)
        check_representable(v, row, output_column[i], out[i]);
}

static void one_tangent_matches_every_row(void **state)
{
    (void)state;
    reference_vectors v = vectors_open("microcylinder_thread.csv", THREAD_ROWS);
    for (int row = 0; row < THREAD_ROWS; row++)
        check_thread(&v, row);
    vectors_close(&v);
}

enum { CLOTH_OUTPUTS = 9 };

static const char *const cloth_column[CLOTH_OUTPUTS] = {"K_r", "K_g",    "K_b",    "f_r",   "f_g",
                                                        "f_b", "Kavg_r", "Kavg_g", "Kavg_b"};

static void cloth_outputs(const weft_prepared_cloth *cloth, direction_pair at, double out[CLOTH_OUTPUTS])
{
    const weft_rgb value[] = {weft_microcylinder_scattering(cloth, WEFT_CLOTH_AS_PRINTED, at.light, at.view),
                              weft_microcylinder_brdf(cloth, WEFT_CLOTH_AS_PRINTED, at.light, at.view),
                              weft_microcylinder_scattering(cloth, WEFT_CLOTH_BY_AREA, at.light, at.view)};
    for (int i = 0; i < CLOTH_OUTPUTS / 3; i++) {
        out[3 * i] = value[i].r;
        out[3 * i + 1] = value[i].g;
        out[3 * i + 2] = value[i].b;
    }
}

static void cloth_matches_every_row(void **state)
{
    (void)state;
    static reference_cloth cloths[REFERENCE_CLOTHS];
    reference_cloths_read(cloths);
    reference_vectors v = vectors_open("microcylinder_cloth.csv", CLOTH_ROWS);
    for (int row = 0; row < CLOTH_ROWS; row++) {
        const weft_prepared_cloth *cloth = reference_cloth_named(cloths, vectors_text(&v, row, "cloth"));
        direction_pair at = {vectors_direction(&v, row, "wi"), vectors_direction(&v, row, "wo")};
        double out[CLOTH_OUTPUTS];
        cloth_outputs(cloth, at, out);
        for (int i = 0; i < CLOTH_OUTPUTS; i++)
            vectors_check(&v, row, cloth_column[i], out[i]);
    }
    vectors_close(&v);
}

int test_microcylinder_vectors(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_tangent_matches_every_row),
        cmocka_unit_test(cloth_matches_every_row),
    };
    return cmocka_run_group_tests_name("microcylinder vectors", tests, NULL, NULL);
}
