/* How models_*.c read their arguments, one after another, and return their values. */
#ifndef WEFT_BENCH_NUMERICS_TAKE_H
#define WEFT_BENCH_NUMERICS_TAKE_H

#include "base/vector.h"
#include "bench/numerics/models.h"

static inline weft_real take(const double **argument)
{
    return (weft_real) * (*argument)++;
}

static inline weft_vec3 take_direction(const double **argument)
{
    weft_real x = take(argument), y = take(argument), z = take(argument);
    return weft_vec3_of(x, y, z);
}

static inline numerics_value scaled_value(weft_real value, weft_real scale)
{
    double high = (double)value;
    return (numerics_value){high, isfinite(high) ? (double)(value - (weft_real)high) : 0, (double)scale};
}

static inline numerics_value plain_value(weft_real value)
{
    return scaled_value(value, 0);
}

/* The functions of models_tables.c, models_microcylinder.c and models_woven.c. */
bool numerics_tables_begin(void);
numerics_function numerics_lobe_power, numerics_lafortune, numerics_table_fit, numerics_interpolation, numerics_mip,
    numerics_bard_in_plane, numerics_bard_printed, numerics_as_it_is, numerics_normal_exactly;
numerics_function numerics_fresnel_reflectance, numerics_fresnel_transmittance, numerics_thread_scattering,
    numerics_thread_shadowing, numerics_thread_projection, numerics_cloth_by_area, numerics_cloth_printed_brdf;
numerics_function numerics_spine_radius, numerics_phase, numerics_point, numerics_texture, numerics_reflectance,
    numerics_weave_brdf, numerics_weave_mean;

#endif
