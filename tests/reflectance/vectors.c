#include "tests/reflectance/vectors.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

reference_vectors vectors_open(const char *name, int rows)
{
    char path[512];
    reference_vectors vectors = {0};
    weft_error error = {0};
    snprintf(path, sizeof path, "%s/reference/%s", WEFT_TEST_DATA, name);
    if (weft_csv_read(path, true, &vectors.csv, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    assert_int_equal(vectors.csv.row_count, rows);
    return vectors;
}

void vectors_close(reference_vectors *vectors)
{
    print_message("%s: %d rows, %d failed, worst error %.3g of the allowed, %d outputs by their own condition\n",
                  vectors->csv.path, vectors->csv.row_count, vectors->failures, vectors->worst, vectors->sensitive);
    int failures = vectors->failures;
    weft_csv_free(&vectors->csv);
    assert_true(vectors->sensitive == 0 || WEFT_REAL_EPSILON > 1e-9);
    assert_int_equal(failures, 0);
}

static int column_of(const reference_vectors *vectors, const char *column)
{
    int index = weft_csv_column(&vectors->csv, column);
    if (index < 0)
        fail_msg("%s has no column %s", vectors->csv.path, column);
    return index;
}

double vectors_number(const reference_vectors *vectors, int row, const char *column)
{
    double value = 0;
    weft_error error = {0};
    if (weft_csv_number(&vectors->csv, row, column_of(vectors, column), &value, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    return value;
}

const char *vectors_text(const reference_vectors *vectors, int row, const char *column)
{
    return weft_csv_text(&vectors->csv, row, column_of(vectors, column));
}

weft_vec3 vectors_direction(const reference_vectors *vectors, int row, const char *prefix)
{
    double value[3];
    for (int i = 0; i < 3; i++) {
        char column[16];
        snprintf(column, sizeof column, "%s%c", prefix, "xyz"[i]);
        value[i] = vectors_number(vectors, row, column);
    }
    double length = sqrt(value[0] * value[0] + value[1] * value[1] + value[2] * value[2]);
    return weft_vec3_of((weft_real)(value[0] / length), (weft_real)(value[1] / length), (weft_real)(value[2] / length));
}

/* 1, that of a product, where the file has no such column. */
static double condition(const reference_vectors *vectors, int row)
{
    return weft_csv_column(&vectors->csv, "cond") < 0 ? 1 : vectors_number(vectors, row, "cond");
}

static double relative_tolerance(const reference_vectors *vectors, int row)
{
    return 1e-6 + 20 * condition(vectors, row) * (double)WEFT_REAL_EPSILON;
}

void vectors_check_within(reference_vectors *vectors, int row, const char *column, double actual, double tolerance)
{
    double expected = vectors_number(vectors, row, column), error = fabs(actual - expected);
    if (error > 0 && !(error / tolerance <= vectors->worst))
        vectors->worst = error / tolerance;
    if (error <= tolerance)
        return;
    vectors->failures++;
    print_error("%s:%d: %s is %.9g, expected %.9g +- %.3g\n", vectors->csv.path, vectors->csv.line[row], column, actual,
                expected, tolerance);
}

/* Of this output by tests/data/conditions.csv; 0 where it is not listed. */
static double listed_condition(const reference_vectors *vectors, int row, const char *column)
{
    weft_csv list;
    weft_error error = {0};
    if (weft_csv_read(WEFT_TEST_DATA "/conditions.csv", true, &list, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    const char *file = strrchr(vectors->csv.path, '/') + 1;
    double condition = 0;
    for (int i = 0; i < list.row_count; i++)
        if (strcmp(weft_csv_text(&list, i, 0), file) == 0 && strcmp(weft_csv_text(&list, i, 2), column) == 0 &&
            atoi(weft_csv_text(&list, i, 1)) == vectors->csv.line[row])
            condition = atof(weft_csv_text(&list, i, 3));
    weft_csv_free(&list);
    return condition;
}

void vectors_check(reference_vectors *vectors, int row, const char *column, double actual)
{
    double expected = vectors_number(vectors, row, column), tolerance = relative_tolerance(vectors, row);
    if (expected != 0 && !(fabs(actual - expected) <= tolerance * fabs(expected))) {
        double condition = listed_condition(vectors, row, column);
        vectors->sensitive += condition > 0;
        tolerance = fmax(tolerance, 1e-6 + 20 * condition * (double)WEFT_REAL_EPSILON);
    }
    vectors_check_within(vectors, row, column, actual, tolerance * fabs(expected));
}

static weft_vec3 perturbed(weft_vec3 d, unsigned sample, double amount)
{
    const double factor[2] = {1 - amount, 1 + amount};
    return weft_vec3_of((weft_real)(d.x * factor[sample & 1]), (weft_real)(d.y * factor[sample >> 1 & 1]),
                        (weft_real)(d.z * factor[sample >> 2 & 1]));
}

direction_pair vectors_perturbed(direction_pair pair, unsigned sample, double amount)
{
    return (direction_pair){perturbed(pair.light, sample, amount), perturbed(pair.view, sample >> 3, amount)};
}
