/* Which arguments a model takes and where each of them is looked for: a map from the unit cube, in which a search moves
 * freely, to arguments, extremes over-sampled. */
#ifndef WEFT_BENCH_NUMERICS_DOMAIN_H
#define WEFT_BENCH_NUMERICS_DOMAIN_H

#include "bench/numerics/models.h"

typedef enum numerics_kind {
    NUMERICS_LINEAR,         /* low .. high */
    NUMERICS_LOGARITHMIC,    /* low .. high, both > 0 */
    NUMERICS_SIGNED,         /* +- low .. high, logarithmic, in the outer halves of the coordinate */
    NUMERICS_WHOLE,          /* whole numbers low .. high */
    NUMERICS_ZERO,           /* always 0 */
    NUMERICS_WITHIN,         /* +- high times the argument with the index `of` */
    NUMERICS_NEAR,           /* within some widths of the argument `of`, whose width is the next after it */
    NUMERICS_EXPONENT,       /* logarithmic, and 0 and 1 for one in ten */
    NUMERICS_DIRECTION,      /* a unit vector above the horizon; also grazing, along an axis, near the normal */
    NUMERICS_TIED_DIRECTION, /* the same, or near the mirror image or the opposite of the vector before, or near it */
    NUMERICS_RING,           /* a unit vector between the angles low and high from the normal, deg */
    NUMERICS_TANGENT,        /* a unit vector perpendicular to the one before */
    NUMERICS_UMAX,           /* the steepest inclination of a yarn: also next to 0 and pi/2 */
    NUMERICS_KAPPA,  /* its curvature: also next to -1 and to the parabola of the argument before, which is umax */
    NUMERICS_LENGTH, /* of a yarn whose umax and width have the indices `of` and `of` + 2: also next to the least */
    NUMERICS_TWIST   /* of a fibre: also next to 0 and pi/2 */
} numerics_kind;

typedef struct numerics_argument {
    const char *name; /* the column of the reference vectors; of a direction without x, y or z */
    numerics_kind kind;
    double low, high;
    int of;
} numerics_argument;

typedef struct numerics_domain {
    const char *vectors; /* reference vectors with these arguments; NULL: none */
    const numerics_argument *argument;
    int argument_count;
} numerics_domain;

/* The domain of a model. */
const numerics_domain *numerics_domain_of(numerics_id id);

enum { NUMERICS_MAX_COORDINATES = 32 };

/* Coordinates of the unit cube, and numbers, that a domain has. */
int numerics_coordinate_count(const numerics_domain *domain);
int numerics_number_count(const numerics_domain *domain);

/* Moves a point of the cube to where no argument is next to a limit of its model; coordinates of ties stay. */
void numerics_make_ordinary(const numerics_domain *domain, double *coordinate);

/* The arguments at a point of the unit cube, rounded to single precision on demand. */
void numerics_place(const numerics_domain *domain, const double *coordinate, bool single, double *argument);

/* Numbers that an argument takes: 3 for a vector; and its coordinates of the cube. */
int numerics_width(const numerics_argument *argument);
int numerics_coordinates(const numerics_argument *argument);

#endif
