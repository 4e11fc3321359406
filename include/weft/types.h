/* Numbers, directions and colours.
 *
 * Frame of every direction in Weft: right-handed, x along the weft (u), y along the warp (v), z the surface normal.
 * `light` points to the light and `view` to the camera; both point away from the surface. */
#ifndef WEFT_TYPES_H
#define WEFT_TYPES_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A program that uses the library leaves this as it is; its own tests compile the models for other types, too. */
#ifndef WEFT_REAL
#define WEFT_REAL double
#endif
__extension__ typedef WEFT_REAL weft_real;

/* IEEE 754 binary16 ("half float"), as bits: the storage type of samples. */
typedef uint16_t weft_half;

/* A direction, or a position in mm. */
typedef struct weft_vec3 {
    weft_real x, y, z;
} weft_vec3;

/* Linear RGB with the primaries of sRGB. */
typedef struct weft_rgb {
    weft_real r, g, b;
} weft_rgb;

/* A value for a $NAME in a weave or a cloth of microcylinders; where one number is expected, it is value.r. */
typedef struct weft_parameter {
    const char *name; /* without the $ */
    weft_rgb value;
} weft_parameter;

#ifdef __cplusplus
}
#endif
#endif
