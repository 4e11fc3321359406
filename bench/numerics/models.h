/* The models of reflectance as functions of plain numbers, so that one and the same list of numbers can be put to every
 * precision: models_*.c are compiled once for each (base/real.h) and call the sources of reflectance/ themselves. The
 * formula is shared, and what differs between two sets is rounding. */
#ifndef WEFT_BENCH_NUMERICS_MODELS_H
#define WEFT_BENCH_NUMERICS_MODELS_H

#include <stdbool.h>

/* In the order of the page. */
typedef enum numerics_id {
    NUMERICS_LOBE_POWER,
    NUMERICS_LAFORTUNE,
    NUMERICS_TABLE_FIT,
    NUMERICS_INTERPOLATION,
    NUMERICS_EXTRAPOLATION,
    NUMERICS_MIP,
    NUMERICS_BARD_IN_PLANE,
    NUMERICS_BARD_PRINTED,
    NUMERICS_FRESNEL_REFLECTANCE,
    NUMERICS_FRESNEL_TRANSMITTANCE,
    NUMERICS_THREAD_SCATTERING,
    NUMERICS_THREAD_SHADOWING,
    NUMERICS_THREAD_PROJECTION,
    NUMERICS_CLOTH_BY_AREA,
    NUMERICS_CLOTH_PRINTED_BRDF,
    NUMERICS_SPINE_RADIUS,
    NUMERICS_PHASE,
    NUMERICS_STAPLE_POINT,
    NUMERICS_FILAMENT_POINT,
    NUMERICS_STAPLE_TEXTURE,
    NUMERICS_FILAMENT_TEXTURE,
    NUMERICS_STAPLE_REFLECTANCE,
    NUMERICS_FILAMENT_REFLECTANCE,
    NUMERICS_WEAVE_BRDF,
    NUMERICS_WEAVE_MEAN,
    /* What a file rounds: the exact value in quad, what is read back in the set `stored`. */
    NUMERICS_STORED_HALF,
    NUMERICS_STORED_8_BITS,
    NUMERICS_STORED_6_BITS,
    NUMERICS_STORED_4_BITS,
    NUMERICS_STORED_NORMAL,
    NUMERICS_MODELS
} numerics_id;

enum { NUMERICS_MAX_ARGUMENTS = 32 };

/* A value as the sum of two doubles, which holds twice the digits of one; and the size that values of this model have
 * for these parameters (0: none is known), below a thousandth of which an error is no longer measured relative to the
 * value itself. */
typedef struct numerics_value {
    double high, low;
    double scale;
} numerics_value;

typedef numerics_value numerics_function(const double *argument);

/* All models in one precision. A function is NULL where the set does not have the model. */
typedef struct numerics_set {
    const char *name;
    double roundoff;     /* half a unit in the last place of 1 */
    bool single;         /* takes arguments in single precision */
    bool (*begin)(void); /* once, before any function; false: no memory */
    numerics_function *function[NUMERICS_MODELS];
} numerics_set;

/* A number rounded to single precision. Through memory: GCC 12 leaves out the two conversions of (double)(float)x where
 * it handles two neighbours at once. */
static inline double numerics_single(double x)
{
    volatile float rounded = (float)x;
    return (double)rounded;
}

extern const numerics_set numerics_float, numerics_double, numerics_quad;

/* Textures and integrals of woven cloth in vectors of floats. */
extern const numerics_set numerics_lanes;

/* Values as a material stores them: arguments and result in double, storage in between. */
extern const numerics_set numerics_stored;

/* ---- Numbers that several sets share ---- */

/* The table of views that stand for a satin under light along the normal: a peak, and a flank that turns with phi. */
enum { NUMERICS_SATIN_THETAS = 19, NUMERICS_SATIN_PHIS = 24 };
static inline double numerics_satin(int theta, int phi)
{
    return numerics_single(0.0625 + 3.0 / (1 + theta * theta) + theta * (phi % 12) / 1024.0);
}

#endif
