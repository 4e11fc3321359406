#include "btf/session/colour.h"

#include "base/text/json_text.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { COLOUR_VERSION = 1, MAX_COLOUR_BYTES = 1 << 20 };

static const double largest_coefficient = 1000, white_tolerance = 1e-6, least_determinant = 1e-6;

static const weft_json_kind kind = {"weft_colour", COLOUR_VERSION, "is no colour file", "is a colour file"};

static const char *const model_name[] = {"linear", "root"};

void weft_colour_terms(int terms, const double rgb[3], double term[WEFT_COLOUR_ROOT_TERMS])
{
    for (int c = 0; c < 3; c++)
        term[c] = rgb[c];
    for (int c = 0; c < 3 && terms == WEFT_COLOUR_ROOT_TERMS; c++)
        term[3 + c] = sqrt(fmax(rgb[c == 2 ? 0 : c], 0) * fmax(rgb[c == 2 ? 2 : c + 1], 0));
}

void weft_colour_apply(const weft_colour *colour, float *rgb, long count)
{
    for (long i = 0; colour->terms > 0 && i < count; i++) {
        double term[WEFT_COLOUR_ROOT_TERMS] = {0},
               camera[3] = {(double)rgb[3 * i], (double)rgb[3 * i + 1], (double)rgb[3 * i + 2]};
        weft_colour_terms(colour->terms, camera, term);
        for (int c = 0; c < 3; c++) {
            double sum = 0;
            for (int k = 0; k < colour->terms; k++)
                sum += colour->matrix[c][k] * term[k];
            rgb[3 * i + c] = (float)sum;
        }
    }
}

/* ---- Writing ---- */

static json_t *pack_matrix(const weft_colour *colour)
{
    json_t *matrix = json_array();
    for (int row = 0; row < 3; row++) {
        json_t *line = json_array();
        for (int k = 0; k < colour->terms; k++)
            weft_json_append(&line, json_real(colour->matrix[row][k]));
        weft_json_append(&matrix, line);
    }
    return matrix;
}

json_t *weft_colour_pack(const weft_colour *colour)
{
    return json_pack("{ss so s{s{sf sf} s{sf sf}}}", "model", model_name[colour->terms == WEFT_COLOUR_ROOT_TERMS],
                     "matrix", pack_matrix(colour), "ciede2000", "fitted", "mean", colour->fitted.mean, "worst",
                     colour->fitted.worst, "left_out", "mean", colour->left_out.mean, "worst", colour->left_out.worst);
}

/* JSON has nothing for what is not finite. */
static weft_code check_numbers(const char *path, const weft_colour *colour, weft_error *error)
{
    double sum = 0;
    for (int i = 0; i < 3 * colour->terms; i++)
        sum += colour->matrix[i / colour->terms][i % colour->terms];
    const char *wrong = !isfinite(sum)                                              ? "matrix"
                        : !isfinite(colour->fitted.mean + colour->fitted.worst)     ? "fitted"
                        : !isfinite(colour->left_out.mean + colour->left_out.worst) ? "left_out"
                                                                                    : NULL;
    return wrong ? weft_fail(error, WEFT_BAD_INPUT, "'%s' was not written: '%s' is not a finite number", path, wrong)
                 : WEFT_OK;
}

weft_code weft_colour_write(const char *path, const weft_colour *colour, json_t *record, weft_error *error)
{
    WEFT_TRY(check_numbers(path, colour, error));
    json_t *root = json_pack("{si}", "weft_colour", COLOUR_VERSION), *packed = weft_colour_pack(colour);
    if (!packed || json_object_update(root, packed) != 0 || json_object_update(root, record) != 0) {
        json_decref(root);
        root = NULL;
    }
    json_decref(packed);
    return weft_json_write(path, root, JSON_INDENT(1) | JSON_REAL_PRECISION(12), error);
}

/* ---- Reading ---- */

static weft_code unpack_row(json_t *row, const char *path, int number, weft_colour *colour, weft_error *error)
{
    double sum = 0;
    for (int k = 0; k < colour->terms; k++) {
        json_t *value = json_array_get(row, (size_t)k);
        colour->matrix[number][k] = json_number_value(value);
        if (!json_is_number(value) || !(fabs(colour->matrix[number][k]) <= largest_coefficient))
            return weft_fail(error, WEFT_BAD_INPUT, "'%s': row %d of the colour matrix has no number up to %g", path,
                             number + 1, largest_coefficient);
        sum += colour->matrix[number][k];
    }
    if (json_array_size(row) != (size_t)colour->terms || !(fabs(sum - 1) <= white_tolerance))
        return weft_fail(error, WEFT_BAD_INPUT,
                         "'%s': row %d of the colour matrix has %zu numbers with the sum %g, not %d with the sum 1",
                         path, number + 1, json_array_size(row), sum, colour->terms);
    return WEFT_OK;
}

/* The determinant of the derivative at white, where sqrt(rg) grows half as fast as r and as g. */
static double determinant_at_white(const weft_colour *colour)
{
    double m[3][3];
    for (int i = 0; i < 3; i++) {
        const double *a = colour->matrix[i];
        bool roots = colour->terms == WEFT_COLOUR_ROOT_TERMS;
        m[i][0] = a[0] + (roots ? (a[3] + a[5]) / 2 : 0);
        m[i][1] = a[1] + (roots ? (a[3] + a[4]) / 2 : 0);
        m[i][2] = a[2] + (roots ? (a[4] + a[5]) / 2 : 0);
    }
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

static weft_code unpack_matrix(json_t *matrix, const char *path, weft_colour *colour, weft_error *error)
{
    if (json_array_size(matrix) != 3)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s': the colour matrix has %zu rows, not 3", path,
                         json_array_size(matrix));
    for (int row = 0; row < 3; row++)
        WEFT_TRY(unpack_row(json_array_get(matrix, (size_t)row), path, row, colour, error));
    if (!(fabs(determinant_at_white(colour)) >= least_determinant))
        return weft_fail(error, WEFT_BAD_INPUT, "'%s': the colour matrix is singular: it maps colours onto one another",
                         path);
    return WEFT_OK;
}

static weft_code name_terms(const char *model, const char *path, int *terms, weft_error *error)
{
    *terms = strcmp(model, model_name[0]) == 0   ? WEFT_COLOUR_LINEAR_TERMS
             : strcmp(model, model_name[1]) == 0 ? WEFT_COLOUR_ROOT_TERMS
                                                 : 0;
    return *terms ? WEFT_OK
                  : weft_fail(error, WEFT_BAD_INPUT, "'%s': the colour model is '%.40s', not 'linear' or 'root'", path,
                              model);
}

weft_code weft_colour_unpack(json_t *json, const char *path, weft_colour *colour, weft_error *error)
{
    const char *model = "";
    json_t *matrix = NULL;
    json_error_t cause;
    *colour = (weft_colour){0};
    errno = 0;
    if (json_unpack_ex(json, &cause, 0, "{ss so s{s{sF sF} s{sF sF}}}", "model", &model, "matrix", &matrix, "ciede2000",
                       "fitted", "mean", &colour->fitted.mean, "worst", &colour->fitted.worst, "left_out", "mean",
                       &colour->left_out.mean, "worst", &colour->left_out.worst) != 0)
        return weft_json_fail(error, WEFT_BAD_INPUT, "'%s' lacks a field of its colour, or one has the wrong type: %s",
                              path, cause.text);
    WEFT_TRY(name_terms(model, path, &colour->terms, error));
    return unpack_matrix(matrix, path, colour, error);
}

weft_code weft_colour_read(const char *path, weft_colour *colour, weft_error *error)
{
    json_t *root = NULL;
    *colour = (weft_colour){0};
    WEFT_TRY(weft_json_read_kind(path, MAX_COLOUR_BYTES, &kind, &root, error));
    weft_code code = weft_colour_unpack(root, path, colour, error);
    json_decref(root);
    return code;
}
