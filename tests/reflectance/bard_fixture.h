/* What tests of BARD share: the table of normal-incidence values of the reference vectors, and extreme directions. */
#ifndef WEFT_TESTS_REFLECTANCE_BARD_FIXTURE_H
#define WEFT_TESTS_REFLECTANCE_BARD_FIXTURE_H

#include "reflectance/bard/bard.h"
#include "tests/reflectance/random.h"
#include "tests/reflectance/vectors.h"

enum { BARD_TABLE_THETAS = 19, BARD_TABLE_PHIS = 24 };

typedef struct bard_table {
    weft_real value[BARD_TABLE_THETAS * BARD_TABLE_PHIS];
} bard_table;

/* Reads tests/data/reference/bard_table.csv. A failure ends the test. */
static inline void bard_table_read(bard_table *table)
{
    reference_vectors v = vectors_open("bard_table.csv", BARD_TABLE_THETAS * BARD_TABLE_PHIS);
    for (int row = 0; row < v.csv.row_count; row++) {
        int theta = (int)vectors_number(&v, row, "theta_deg") / 5, phi = (int)vectors_number(&v, row, "phi_deg") / 15;
        table->value[theta * BARD_TABLE_PHIS + phi] = (weft_real)vectors_number(&v, row, "rho_o");
    }
    vectors_close(&v);
}

static inline weft_bard_grid bard_table_grid(const bard_table *table)
{
    return (weft_bard_grid){BARD_TABLE_THETAS, BARD_TABLE_PHIS, table->value};
}
static inline bool bard_is_direction(weft_vec3 d)
{
    return fabs((double)weft_length(d) - 1) < 64 * (double)WEFT_REAL_EPSILON;
}

/* Near the horizon, near the normal, near the mirror direction of the light, near its projection or opposite to it. */
static inline weft_vec3 bard_extreme_direction(uint64_t *random, weft_vec3 light)
{
    const double tiny[] = {0, 1e-36, 1e-20, 1e-12, 1e-9, 1e-7, 1e-4};
    weft_vec3 d = random_direction(random);
    weft_real small = (weft_real)tiny[random_bits(random) % 7];
    const weft_vec3 choice[] = {{d.x, d.y, small},
                                {small * d.x, small * d.y, 1},
                                {-light.x + small, -light.y, light.z},
                                {-light.x, small - light.y, small},
                                {light.x, light.y, small * light.z}};
    weft_vec3 chosen = weft_unit(choice[random_bits(random) % 5]);
    return bard_is_direction(chosen) && random_bits(random) % 6 ? chosen : d;
}

#endif
