/* No extreme input makes Lafortune lobes or BARD give NaN, infinity, a negative value or one above its bound. The
 * number of cases is the argument. Built twice: in double, and in single precision. */
#include "btf/direction/direction.h"
#include "reflectance/lafortune/lafortune.h"
#include "tests/reflectance/bard_fixture.h"
#include "tests/reflectance/extremes.h"

static long cases;

enum { LOBES = 3 };

/* a is at most the largest |C|, light and view being unit; the library ends a^n at 1e30. */
static double lobe_bound(const weft_lobe *lobe)
{
    double a = fmax(fabs((double)lobe->cx), fmax(fabs((double)lobe->cy), fabs((double)lobe->cz))) * EXTREMES_SLACK;
    return a <= 1 ? 1 : fmin(pow(a, lobe->n), 1.0001e30);
}

static weft_lobe extreme_lobe(uint64_t *random)
{
    return (weft_lobe){.cx = EXTREMES_PICK(random, -2, -1, -0.99999, 0, 1e-30, 0.5, 1, 1e4),
                       .cy = EXTREMES_PICK(random, -2, -1, -0.99999, 0, 1e-30, 0.5, 1, 1e4),
                       .cz = EXTREMES_PICK(random, -1, 0, 1e-9, 0.99999, 1, 1.00001, 2, 1e4),
                       .n = random_bits(random) & 1 ? EXTREMES_PICK(random, 0, 1e-30, 1e-6, 1, 10, 1e4, 1e5)
                                                    : extremes_logarithmic(random, -3, 5)};
}

/* In the frame of a texel directions may point anywhere. */
static bool lobe_case(uint64_t *random, long *lit)
{
    weft_lobe lobe[LOBES];
    weft_real rho = EXTREMES_PICK(random, 0, 1e-30, 0.3, 1e4);
    double bound = rho;
    for (int i = 0; i < LOBES; i++) {
        lobe[i] = extreme_lobe(random);
        bound += lobe_bound(&lobe[i]);
    }
    weft_vec3 light = extremes_direction(random, weft_vec3_of(0, 0, 1)), view = extremes_direction(random, light);
    weft_real value = weft_lafortune(rho, lobe, LOBES, light, view);
    *lit += value > 0;
    return extremes_within(value, bound);
}

static void no_lobe_leaves_its_bounds(void **state)
{
    (void)state;
    extremes_run(lobe_case, cases);
}

static bard_table table;

/* 1 / cos^2 ends at 87 degrees. */
static bool bard_case(uint64_t *random, long *lit)
{
    weft_bard_grid grid = bard_table_grid(&table);
    double largest = 0;
    for (int i = 0; i < BARD_TABLE_THETAS * BARD_TABLE_PHIS; i++)
        largest = fmax(largest, table.value[i]);
    weft_vec3 light = bard_extreme_direction(random, weft_vec3_of(1, 0, 0));
    weft_vec3 view = bard_extreme_direction(random, light);
    weft_bard_map map = random_bits(random) % 8 == 0 ? WEFT_BARD_PRINTED : WEFT_BARD_IN_PLANE;
    weft_real f = weft_bard_brdf(map, 1, weft_bard_grid_lookup, &grid, light, view);
    if (!(f > 0))
        return f == 0;
    ++*lit;
    weft_bard_point point = weft_bard_locate(map, light, view);
    double cosine = fmax(light.z, cos((double)weft_rad_of_deg(87)));
    return extremes_within(f, (1 / (double)WEFT_PI + largest / (cosine * cosine)) * 1.0001) &&
           bard_is_direction(point.direction) && (map == WEFT_BARD_PRINTED || point.direction.z >= 0);
}

static void no_satin_leaves_its_bounds(void **state)
{
    (void)state;
    bard_table_read(&table);
    extremes_run(bard_case, cases);
}

int test_extremes_tables(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_lobe_leaves_its_bounds),
        cmocka_unit_test(no_satin_leaves_its_bounds),
    };
    cases = extremes_count();
    return cmocka_run_group_tests_name("extremes of lobes and tables", tests, NULL, NULL);
}
