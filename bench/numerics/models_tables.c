/* Lafortune lobes, tables over directions, materials with their mip levels, and BARD. */
#include "bench/numerics/take.h"
#include "btf/direction/direction.h"
#include "reflectance/bard/bard.h"
#include "reflectance/lafortune/lafortune.h"

#include <string.h>

numerics_value numerics_lobe_power(const double *a)
{
    weft_real base = take(&a), n = take(&a);
    return plain_value(weft_lobe_power(base, n));
}

enum { LOBES = 2 };

static weft_real largest_lobe(const weft_lobe *lobe)
{
    weft_real largest = fmax(fabs(lobe->cx), fmax(fabs(lobe->cy), fabs(lobe->cz)));
    return fmax(weft_lobe_power(largest, lobe->n), 1);
}

numerics_value numerics_lafortune(const double *a)
{
    weft_vec3 normal = take_direction(&a), tangent = take_direction(&a);
    weft_frame frame = weft_frame_of_vectors(normal, tangent);
    int count = (int)take(&a);
    weft_real rho = take(&a), scale = rho;
    weft_lobe lobe[LOBES];
    for (int i = 0; i < LOBES; i++) {
        lobe[i].cx = take(&a);
        lobe[i].cy = take(&a);
        lobe[i].cz = take(&a);
        lobe[i].n = take(&a);
        scale += i < count ? largest_lobe(&lobe[i]) : 0;
    }
    weft_vec3 light = weft_frame_local(&frame, take_direction(&a)), view = weft_frame_local(&frame, take_direction(&a));
    return scaled_value(weft_lafortune(rho, lobe, count, light, view), scale);
}

numerics_value numerics_table_fit(const double *a)
{
    enum { LIGHTS = 8 };
    weft_real f[LIGHTS], r[LIGHTS];
    for (int i = 0; i < LIGHTS; i++)
        f[i] = take(&a);
    for (int i = 0; i < LIGHTS; i++)
        r[i] = take(&a);
    return plain_value(weft_view_table_fit(f, r, LIGHTS));
}

/* ---- Tables over the 81 directions of the measured sets ---- */

enum { DIRECTIONS = WEFT_UBO81_COUNT, SIDE = 4, LEVELS = 3, TEXELS = SIDE * SIDE };

/* What is fixed for all evaluations. */
static struct {
    weft_triangulation *triangulation;
    weft_rgba value[DIRECTIONS];
    weft_vec3 direction[DIRECTIONS];
    weft_material material;
    weft_table_directions tables;
    int16_t frame[LEVELS][TEXELS * 3];
    weft_half diffuse[LEVELS][TEXELS * 4], lobe[LEVELS][3 * TEXELS * 4];
    uint8_t table[LEVELS][DIRECTIONS * TEXELS * 4], light_table[LEVELS][DIRECTIONS * TEXELS * 4];
} fixed;

/* A fixed sequence that looks random: multiplicative congruence modulo a prime. */
static unsigned next_of(unsigned *state)
{
    *state = (unsigned)((unsigned long long)*state * 48271u % 2147483647u);
    return *state;
}

static void fill_codes(uint8_t *code, int count, unsigned *state)
{
    for (int i = 0; i < count; i++)
        code[i] = (uint8_t)(next_of(state) >> 16);
}

static void fill_level(int level, unsigned *state)
{
    int side = SIDE >> level;
    fixed.material.level[level] = (weft_material_level){.width = side,
                                                        .height = side,
                                                        .frame = fixed.frame[level],
                                                        .diffuse = fixed.diffuse[level],
                                                        .lobe = fixed.lobe[level],
                                                        .table = fixed.table[level],
                                                        .light_table = fixed.light_table[level]};
    for (int i = 0; i < TEXELS * 3; i++)
        fixed.frame[level][i] = (int16_t)((int)(next_of(state) % 16384) - 8192);
    for (int i = 0; i < TEXELS * 4; i++)
        fixed.diffuse[level][i] = weft_half_of_float((float)(next_of(state) % 1000) / 1000.0f);
    for (int i = 0; i < 3 * TEXELS * 4; i++)
        fixed.lobe[level][i] = weft_half_of_float(i % 4 == 3 ? (float)(1 + next_of(state) % 60)
                                                             : (float)(next_of(state) % 2000) / 1000.0f - 1.0f);
    fill_codes(fixed.table[level], DIRECTIONS * TEXELS * 4, state);
    fill_codes(fixed.light_table[level], DIRECTIONS * TEXELS * 4, state);
}

/* A direction of the measured sets as a file has it: rounded to single precision, from the same numbers in every
 * precision. */
static weft_vec3 stored_direction(int index)
{
    weft_angles angles = weft_ubo81_angles(index);
    double degree = atan(1.0) / 45;
    double theta = round((double)weft_deg_of_rad(angles.theta_rad)) * degree;
    double phi = round((double)weft_deg_of_rad(angles.phi_rad)) * degree;
    return weft_vec3_of((weft_real)numerics_single(sin(theta) * cos(phi)),
                        (weft_real)numerics_single(sin(theta) * sin(phi)), (weft_real)numerics_single(cos(theta)));
}

bool numerics_tables_begin(void)
{
    unsigned state = 1;
    weft_error error;
    for (int i = 0; i < DIRECTIONS; i++) {
        fixed.direction[i] = stored_direction(i);
        weft_real code = (weft_real)(next_of(&state) >> 16 & 255) / 255;
        fixed.value[i].r = code * code;
    }
    fixed.material = (weft_material){.has_lobes = true,
                                     .lobe_count = 1,
                                     .level_count = LEVELS,
                                     .view_count = DIRECTIONS,
                                     .light_count = DIRECTIONS,
                                     .view = fixed.direction,
                                     .light = fixed.direction};
    for (int level = 0; level < LEVELS; level++)
        fill_level(level, &state);
    return weft_triangulation_build(fixed.direction, DIRECTIONS, &fixed.triangulation, &error) == WEFT_OK &&
           weft_table_directions_create(&fixed.material, &fixed.tables, &error) == WEFT_OK;
}

numerics_value numerics_interpolation(const double *a)
{
    weft_barycentric at = weft_triangulation_lookup(fixed.triangulation, take_direction(&a));
    return scaled_value(weft_view_table_interpolate(fixed.value, &at).r, 1);
}

numerics_value numerics_mip(const double *a)
{
    weft_real level = take(&a), u = take(&a), v = take(&a);
    weft_vec3 light = take_direction(&a), view = take_direction(&a);
    return scaled_value(weft_material_sample(&fixed.material, &fixed.tables, level, u, v, light, view).r, 1);
}

/* ---- BARD ---- */

static weft_bard_grid satin(weft_real value[NUMERICS_SATIN_THETAS * NUMERICS_SATIN_PHIS])
{
    for (int i = 0; i < NUMERICS_SATIN_THETAS; i++)
        for (int j = 0; j < NUMERICS_SATIN_PHIS; j++)
            value[i * NUMERICS_SATIN_PHIS + j] = (weft_real)numerics_satin(i, j);
    return (weft_bard_grid){NUMERICS_SATIN_THETAS, NUMERICS_SATIN_PHIS, value};
}

static numerics_value bard(weft_bard_map map, const double *a)
{
    weft_real value[NUMERICS_SATIN_THETAS * NUMERICS_SATIN_PHIS];
    weft_bard_grid grid = satin(value);
    weft_real rho_d = take(&a);
    weft_vec3 light = take_direction(&a), view = take_direction(&a);
    return plain_value(weft_bard_brdf(map, rho_d, weft_bard_grid_lookup, &grid, light, view));
}

numerics_value numerics_bard_in_plane(const double *a)
{
    return bard(WEFT_BARD_IN_PLANE, a);
}

numerics_value numerics_bard_printed(const double *a)
{
    return bard(WEFT_BARD_PRINTED, a);
}

/* ---- What a file rounds, exactly ---- */

numerics_value numerics_as_it_is(const double *a)
{
    return scaled_value(take(&a), 1);
}

numerics_value numerics_normal_exactly(const double *a)
{
    return scaled_value(take_direction(&a).z, 1);
}
