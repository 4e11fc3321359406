/* Rows of the reference vectors and their rule of acceptance. */
#ifndef WEFT_TESTS_REFLECTANCE_VECTORS_H
#define WEFT_TESTS_REFLECTANCE_VECTORS_H

#include "base/text/csv.h"
#include "base/vector.h"
#include "tests/support/cmocka_all.h"

typedef struct reference_vectors {
    weft_csv csv;
    int failures;
    double worst;  /* largest error / allowed error over all rows */
    int sensitive; /* outputs accepted by a condition of tests/data/conditions.csv */
} reference_vectors;

/* Opens tests/data/reference/NAME; fails the test where it has not `rows` rows. */
reference_vectors vectors_open(const char *name, int rows);

/* Frees the table, prints the worst ratio and fails the test if any row failed, or if double precision needed a listed
 * condition. */
void vectors_close(reference_vectors *vectors);

double vectors_number(const reference_vectors *vectors, int row, const char *column);
const char *vectors_text(const reference_vectors *vectors, int row, const char *column);

/* Columns PREFIXx, PREFIXy, PREFIXz as a unit vector. */
weft_vec3 vectors_direction(const reference_vectors *vectors, int row, const char *prefix);

/* Compares `actual` with a column: |actual - expected| <= |expected| (1e-6 + 20 cond eps); an expected 0 must be 0.
 * cond is that of the row. It belongs to the main output, and several files have none: for single outputs that need
 * their own, tests/data/conditions.csv lists it, by file, line and column. It is the sum of |x df/dx| / |f| over the
 * numbers that a function is given (components of unit vectors, parameters), from the formulas in 40 digits by a
 * program that shares no code with Weft; of weave_mean.csv, from this library in double. */
void vectors_check(reference_vectors *vectors, int row, const char *column, double actual);

/* The same with a given absolute tolerance. */
void vectors_check_within(reference_vectors *vectors, int row, const char *column, double actual, double tolerance);

/* A pair of directions whose components are changed by a relative `amount`, up or down by the bits of `sample`. */
typedef struct direction_pair {
    weft_vec3 light, view;
} direction_pair;
direction_pair vectors_perturbed(direction_pair pair, unsigned sample, double amount);

enum { VECTORS_SAMPLES = 64 };

#endif
