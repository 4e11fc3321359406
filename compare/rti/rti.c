#include "compare/rti/rti.h"

#include "base/numeric/cholesky.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_ORDER = 3, MOST_FUNCTIONS = (MOST_ORDER + 1) * (MOST_ORDER + 1) };

/* What makes a system that the lamps do not determine solvable, as a share of its diagonal. */
static const double ridge = 1e-11;

/* ---- Functions of the light ---- */

static int polynomial(weft_vec3 light, double value[MOST_FUNCTIONS])
{
    double x = (double)light.x, y = (double)light.y;
    const double term[] = {1, x, y, x * x, x * y, y * y};
    memcpy(value, term, sizeof term);
    return sizeof term / sizeof *term;
}

static int plane(weft_vec3 light, double value[MOST_FUNCTIONS])
{
    polynomial(light, value);
    return 3;
}

/* Without the factors that make them orthonormal, which change no fit: associated Legendre functions of t = 2 z - 1,
 * whose factor sqrt(1 - t^2)^m is multiplied into cos(m phi) and sin(m phi). */
static int harmonics(int order, weft_vec3 light, double value[MOST_FUNCTIONS])
{
    double z = fmin(fmax((double)light.z, 0), 1), t = 2 * z - 1, length = hypot((double)light.x, (double)light.y);
    double radius = 2 * sqrt(z * (1 - z)), x = length > 0 ? radius * (double)light.x / length : 0;
    double y = length > 0 ? radius * (double)light.y / length : 0;
    double cosine = 1, sine = 0, first = 1;
    int count = 0;
    for (int m = 0; m <= order; m++) {
        double before = 0, now = first; /* P_m-1,m and P_mm, without the power of the radius */
        for (int l = m; l <= order; l++) {
            value[count++] = now * cosine;
            if (m > 0)
                value[count++] = now * sine;
            double next = ((2 * l + 1) * t * now - (l + m) * before) / (l + 1 - m);
            before = now;
            now = next;
        }
        double turned = cosine * x - sine * y;
        sine = sine * x + cosine * y;
        cosine = turned;
        first *= 2 * m + 1;
    }
    return count;
}

static int harmonics_2(weft_vec3 light, double value[MOST_FUNCTIONS])
{
    return harmonics(2, light, value);
}

static int harmonics_3(weft_vec3 light, double value[MOST_FUNCTIONS])
{
    return harmonics(3, light, value);
}

/* ---- The kernel of the spline ---- */

static double thin_plate(double x, double y)
{
    double square = x * x + y * y;
    return square > 0 ? 0.5 * square * log(square) : 0;
}

/* A triangle around all lamps, and the linear functions that are 1 at one of its corners and 0 at the others. */
static const double corner[3][2] = {{2, 0}, {-1, 1.7320508075688772}, {-1, -1.7320508075688772}};

static double at_corner(int i, weft_vec3 light)
{
    return (1 + 0.5 * (corner[i][0] * (double)light.x + corner[i][1] * (double)light.y)) / 3;
}

/* Positive definite (Wendland 2005, theorem 10.20): differs from the thin plate by functions that the plane absorbs. */
static double kernel(weft_vec3 a, weft_vec3 b)
{
    double sum = thin_plate((double)(a.x - b.x), (double)(a.y - b.y));
    for (int i = 0; i < 3; i++) {
        const double *c = corner[i];
        sum -= at_corner(i, a) * thin_plate(c[0] - (double)b.x, c[1] - (double)b.y);
        sum -= at_corner(i, b) * thin_plate(c[0] - (double)a.x, c[1] - (double)a.y);
        for (int j = 0; j < 3; j++)
            sum += at_corner(i, a) * at_corner(j, b) * thin_plate(c[0] - corner[j][0], c[1] - corner[j][1]);
    }
    return sum;
}

/* ---- The models ---- */

static const struct {
    const char *name;
    int (*functions)(weft_vec3 light, double value[MOST_FUNCTIONS]);
    int function_count;
    bool is_spline;
} table[WEFT_RTI_MODELS] = {{"PTM", polynomial, 6, false},
                            {"HSH of order 2", harmonics_2, 9, false},
                            {"HSH of order 3", harmonics_3, 16, false},
                            {"RBF", plane, 3, true}};

const char *weft_rti_name(weft_rti_model model)
{
    return table[model].name;
}

int weft_rti_coefficients(weft_rti_model model, int photographs)
{
    return table[model].is_spline ? photographs : table[model].function_count;
}

int weft_rti_least_photographs(weft_rti_model model)
{
    return table[model].function_count;
}

/* ---- Weights ---- */

typedef struct weighing {
    weft_rti_model model;
    const weft_vec3 *light;
    int count, functions;
    double *root;                                  /* [count][count] of A, of a spline */
    double *function, *solved;                     /* [functions][count] P', P' A^-1 */
    double normal[MOST_FUNCTIONS][MOST_FUNCTIONS]; /* the root of P' A^-1 P */
} weighing;

static double dot(const double *a, const double *b, int count)
{
    double sum = 0;
    for (int i = 0; i < count; i++)
        sum += a[i] * b[i];
    return sum;
}

static bool factor(double *matrix, int size, int stride)
{
    for (int i = 0; i < size; i++)
        matrix[i * stride + i] *= 1 + ridge;
    return weft_cholesky_factor(size, stride, matrix);
}

static void solve_kernel(const weighing *s, double *x)
{
    if (table[s->model].is_spline)
        weft_cholesky_solve(s->count, s->count, s->root, x);
}

/* False for lights that are no numbers. */
static bool prepare(weighing *s)
{
    size_t count = (size_t)s->count;
    for (int i = 0; i < s->count; i++) {
        double value[MOST_FUNCTIONS];
        table[s->model].functions(s->light[i], value);
        for (int f = 0; f < s->functions; f++)
            s->function[f * s->count + i] = value[f];
        for (int j = 0; table[s->model].is_spline && j <= i; j++)
            s->root[i * s->count + j] = kernel(s->light[i], s->light[j]);
    }
    if (table[s->model].is_spline && !factor(s->root, s->count, s->count))
        return false;
    memcpy(s->solved, s->function, (size_t)s->functions * count * sizeof *s->solved);
    for (int f = 0; f < s->functions; f++) {
        solve_kernel(s, s->solved + f * s->count);
        for (int g = 0; g <= f; g++)
            s->normal[f][g] = dot(s->solved + f * s->count, s->function + g * s->count, s->count);
    }
    return factor(&s->normal[0][0], s->functions, MOST_FUNCTIONS);
}

static void weigh(const weighing *s, weft_vec3 asked, double *weight)
{
    double rest[MOST_FUNCTIONS];
    table[s->model].functions(asked, rest);
    for (int i = 0; i < s->count; i++)
        weight[i] = table[s->model].is_spline ? kernel(asked, s->light[i]) : 0;
    for (int f = 0; f < s->functions; f++)
        rest[f] -= dot(s->solved + f * s->count, weight, s->count);
    solve_kernel(s, weight);
    weft_cholesky_solve(s->functions, MOST_FUNCTIONS, &s->normal[0][0], rest);
    for (int f = 0; f < s->functions; f++)
        for (int i = 0; i < s->count; i++)
            weight[i] += rest[f] * s->solved[f * s->count + i];
}

weft_code weft_rti_weights(weft_rti_model model, const weft_vec3 *light, int count, const weft_vec3 *asked,
                           int asked_count, double *weight, weft_error *error)
{
    weighing s = {.model = model, .light = light, .count = count, .functions = table[model].function_count};
    size_t root = (size_t)count * (size_t)count, functions = (size_t)count * (size_t)s.functions;
    double *memory = malloc((root + 2 * functions + 1) * sizeof *memory);
    if (!memory)
        return weft_fail_memory(error, "weights of photographs", (root + 2 * functions) * sizeof *memory);
    s.root = memory;
    s.function = memory + root;
    s.solved = s.function + functions;
    bool is_solvable = prepare(&s);
    for (int i = 0; is_solvable && i < asked_count; i++)
        weigh(&s, asked[i], weight + (size_t)i * (size_t)count);
    free(memory);
    return is_solvable ? WEFT_OK
                       : weft_fail(error, WEFT_BAD_INPUT, "%d lights do not determine %s", count, table[model].name);
}
