/* The set of one precision: NUMERICS_SET is its name. */
#include "bench/numerics/take.h"

#include <float.h>

#if defined(WEFT_REAL_IS_FLOAT)
#define NUMERICS_SET numerics_float
#define SET_NAME "float"
#define ROUNDOFF (FLT_EPSILON / 2)
#define IS_SINGLE true
#elif defined(WEFT_REAL_IS_QUAD)
#define NUMERICS_SET numerics_quad
#define SET_NAME "quad"
#define ROUNDOFF 0x1p-113
#define IS_SINGLE false
#else
#define NUMERICS_SET numerics_double
#define SET_NAME "double"
#define ROUNDOFF (DBL_EPSILON / 2)
#define IS_SINGLE false
#endif

__attribute__((visibility("default")))
const numerics_set NUMERICS_SET = {.name = SET_NAME,
                                   .roundoff = (double)ROUNDOFF,
                                   .single = IS_SINGLE,
                                   .begin = numerics_tables_begin,
                                   .function = {[NUMERICS_LOBE_POWER] = numerics_lobe_power,
                                                [NUMERICS_LAFORTUNE] = numerics_lafortune,
                                                [NUMERICS_TABLE_FIT] = numerics_table_fit,
                                                [NUMERICS_INTERPOLATION] = numerics_interpolation,
                                                [NUMERICS_EXTRAPOLATION] = numerics_interpolation,
                                                [NUMERICS_MIP] = numerics_mip,
                                                [NUMERICS_BARD_IN_PLANE] = numerics_bard_in_plane,
                                                [NUMERICS_BARD_PRINTED] = numerics_bard_printed,
                                                [NUMERICS_FRESNEL_REFLECTANCE] = numerics_fresnel_reflectance,
                                                [NUMERICS_FRESNEL_TRANSMITTANCE] = numerics_fresnel_transmittance,
                                                [NUMERICS_THREAD_SCATTERING] = numerics_thread_scattering,
                                                [NUMERICS_THREAD_SHADOWING] = numerics_thread_shadowing,
                                                [NUMERICS_THREAD_PROJECTION] = numerics_thread_projection,
                                                [NUMERICS_CLOTH_BY_AREA] = numerics_cloth_by_area,
                                                [NUMERICS_CLOTH_PRINTED_BRDF] = numerics_cloth_printed_brdf,
                                                [NUMERICS_SPINE_RADIUS] = numerics_spine_radius,
                                                [NUMERICS_PHASE] = numerics_phase,
                                                [NUMERICS_STAPLE_POINT] = numerics_point,
                                                [NUMERICS_FILAMENT_POINT] = numerics_point,
                                                [NUMERICS_STAPLE_TEXTURE] = numerics_texture,
                                                [NUMERICS_FILAMENT_TEXTURE] = numerics_texture,
                                                [NUMERICS_STAPLE_REFLECTANCE] = numerics_reflectance,
                                                [NUMERICS_FILAMENT_REFLECTANCE] = numerics_reflectance,
                                                [NUMERICS_WEAVE_BRDF] = numerics_weave_brdf,
                                                [NUMERICS_WEAVE_MEAN] = numerics_weave_mean,
                                                [NUMERICS_STORED_HALF] = numerics_as_it_is,
                                                [NUMERICS_STORED_8_BITS] = numerics_as_it_is,
                                                [NUMERICS_STORED_6_BITS] = numerics_as_it_is,
                                                [NUMERICS_STORED_4_BITS] = numerics_as_it_is,
                                                [NUMERICS_STORED_NORMAL] = numerics_normal_exactly}};
