#include "bench/numerics/domain.h"

#include <math.h>
#include <stddef.h>

static const double half_turn = 3.14159265358979323846;

#define DOMAIN(vectors, list)                                                                                          \
    {                                                                                                                  \
        vectors, list, sizeof list / sizeof *list                                                                      \
    }

/* ---- Arguments, in the order in which models_*.c take them ---- */

#define PAIR                                                                                                           \
    {"wi", NUMERICS_DIRECTION, 0, 0, 0},                                                                               \
    {                                                                                                                  \
        "wo", NUMERICS_TIED_DIRECTION, 0, 0, 0                                                                         \
    }

static const numerics_argument lobe_power[] = {{"a", NUMERICS_LOGARITHMIC, 1e-6, 1.01, 0},
                                               {"N", NUMERICS_EXPONENT, 1e-3, 1e4, 0}};
static const numerics_argument lafortune[] = {{"n", NUMERICS_DIRECTION, 0, 0, 0},
                                              {"t", NUMERICS_TANGENT, 0, 0, 0},
                                              {"nlobes", NUMERICS_WHOLE, 0, 2, 0},
                                              {"rho_r", NUMERICS_LINEAR, 0, 1, 0},
                                              {"cx1_r", NUMERICS_LINEAR, -1, 1, 0},
                                              {"cy1_r", NUMERICS_LINEAR, -1, 1, 0},
                                              {"cz1_r", NUMERICS_LINEAR, -1, 1, 0},
                                              {"n1_r", NUMERICS_EXPONENT, 0.1, 1e4, 0},
                                              {"cx2_r", NUMERICS_LINEAR, -1, 1, 0},
                                              {"cy2_r", NUMERICS_LINEAR, -1, 1, 0},
                                              {"cz2_r", NUMERICS_LINEAR, -1, 1, 0},
                                              {"n2_r", NUMERICS_EXPONENT, 0.1, 1e4, 0},
                                              PAIR};
#define LIGHT(name)                                                                                                    \
    {                                                                                                                  \
        name, NUMERICS_EXPONENT, 1e-6, 1, 0                                                                            \
    }
static const numerics_argument table_fit[] = {
    LIGHT("f0"), LIGHT("f1"), LIGHT("f2"), LIGHT("f3"), LIGHT("f4"), LIGHT("f5"), LIGHT("f6"), LIGHT("f7"),
    LIGHT("r0"), LIGHT("r1"), LIGHT("r2"), LIGHT("r3"), LIGHT("r4"), LIGHT("r5"), LIGHT("r6"), LIGHT("r7")};
static const numerics_argument interpolation[] = {{"v", NUMERICS_RING, 0, 75, 0}};
static const numerics_argument extrapolation[] = {{"v", NUMERICS_RING, 75, 90, 0}};
static const numerics_argument mip[] = {
    {"level", NUMERICS_LINEAR, 0, 2, 0}, {"u", NUMERICS_LINEAR, -2, 2, 0}, {"v", NUMERICS_LINEAR, -2, 2, 0}, PAIR};
static const numerics_argument bard[] = {{"rho_d", NUMERICS_LINEAR, 0, 1, 0}, PAIR};
static const numerics_argument fresnel[] = {{"c", NUMERICS_LOGARITHMIC, 1e-7, 1, 0},
                                            {"eta", NUMERICS_LINEAR, 1.001, 1.7, 0}};
static const numerics_argument thread[] = {{"axis", NUMERICS_WHOLE, 0, 1, 0},
                                           {"tilt_deg", NUMERICS_LINEAR, -89, 89, 0},
                                           {"eta", NUMERICS_LINEAR, 1.3, 1.7, 0},
                                           {"gamma_s", NUMERICS_LOGARITHMIC, 1e-3, 10, 0},
                                           {"gamma_v", NUMERICS_LOGARITHMIC, 1e-3, 10, 0},
                                           {"kd", NUMERICS_LINEAR, 0, 1, 0},
                                           {"A", NUMERICS_EXPONENT, 1e-3, 1, 0},
                                           {"sigma", NUMERICS_LOGARITHMIC, 1e-3, 10, 0},
                                           PAIR};
static const numerics_argument cloth[] = {{"sigma", NUMERICS_LOGARITHMIC, 1e-3, 10, 0},
                                          {"eta", NUMERICS_LINEAR, 1.3, 1.7, 0},
                                          {"gamma_s", NUMERICS_LOGARITHMIC, 1e-3, 10, 0},
                                          {"gamma_v", NUMERICS_LOGARITHMIC, 1e-3, 10, 0},
                                          {"kd", NUMERICS_LINEAR, 0, 1, 0},
                                          {"A", NUMERICS_EXPONENT, 1e-3, 1, 0},
                                          {"tilt 1a", NUMERICS_LINEAR, -1.5, 1.5, 0},
                                          {"tilt 1b", NUMERICS_LINEAR, -1.5, 1.5, 0},
                                          {"area 1", NUMERICS_LINEAR, 0, 0.5, 0},
                                          {"tilt 2a", NUMERICS_LINEAR, -1.5, 1.5, 0},
                                          {"tilt 2b", NUMERICS_LINEAR, -1.5, 1.5, 0},
                                          {"area 2", NUMERICS_LINEAR, 0, 0.5, 0},
                                          PAIR};
static const numerics_argument spine[] = {{"umax", NUMERICS_UMAX, 0, 0, 0},
                                          {"kappa", NUMERICS_KAPPA, 0, 0, 0},
                                          {"w", NUMERICS_LOGARITHMIC, 0.1, 10, 0},
                                          {"l", NUMERICS_LENGTH, 0, 0, 0},
                                          {"u", NUMERICS_WITHIN, 0, 1, 0}};
static const numerics_argument phase[] = {{"alpha", NUMERICS_EXPONENT, 1e-3, 1, 0},
                                          {"beta", NUMERICS_SIGNED, 1e-3, 1e3, 0},
                                          {"x", NUMERICS_LINEAR, -1, 1, 0}};

#define FIBRE                                                                                                          \
    {"alpha", NUMERICS_EXPONENT, 1e-3, 1, 0},                                                                          \
    {                                                                                                                  \
        "beta", NUMERICS_EXPONENT, 1e-2, 100, 0                                                                        \
    }
#define STAPLE                                                                                                         \
    FIBRE, {"delta", NUMERICS_ZERO, 0, 0, 0},                                                                          \
    {                                                                                                                  \
        "psi", NUMERICS_TWIST, 0, 0, 0                                                                                 \
    }
#define FILAMENT                                                                                                       \
    FIBRE, {"delta", NUMERICS_LINEAR, 0, 1, 0},                                                                        \
    {                                                                                                                  \
        "psi", NUMERICS_ZERO, 0, 0, 0                                                                                  \
    }
#define SPINE                                                                                                          \
    {"umax", NUMERICS_UMAX, 0, 0, 0}, {"kappa", NUMERICS_KAPPA, 0, 0, 0}, {"w", NUMERICS_LOGARITHMIC, 0.1, 10, 0},     \
    {                                                                                                                  \
        "l", NUMERICS_LENGTH, 0, 0, 4                                                                                  \
    }
#define PLACE                                                                                                          \
    {"hwidth", NUMERICS_LOGARITHMIC, 0.01, 1, 0}, {"x", NUMERICS_WITHIN, 0, 0.5, 6},                                   \
    {                                                                                                                  \
        "y", NUMERICS_WITHIN, 0, 0.5, 7                                                                                \
    }
static const numerics_argument staple_point[] = {STAPLE, SPINE, {"coord", NUMERICS_WITHIN, 0, 1, 4}, PAIR};
static const numerics_argument filament_point[] = {FILAMENT, SPINE, {"coord", NUMERICS_LINEAR, -1.57, 1.57, 0}, PAIR};
static const numerics_argument staple_texture[] = {STAPLE, SPINE, PLACE, PAIR};
static const numerics_argument filament_texture[] = {FILAMENT, SPINE, PLACE, PAIR};
static const numerics_argument staple_reflectance[] = {STAPLE, SPINE, PAIR};
static const numerics_argument filament_reflectance[] = {FILAMENT, SPINE, PAIR};
#define YARN                                                                                                           \
    FIBRE, {"delta", NUMERICS_ZERO, 0, 0, 0}, {"psi", NUMERICS_LINEAR, 0.05, 1.2, 0},                                  \
        {"umax", NUMERICS_LINEAR, 0.1, 1.4, 0}, {"kappa", NUMERICS_LINEAR, -0.9, 1, 0},                                \
        {"w", NUMERICS_LINEAR, 0.5, 1, 0},                                                                             \
    {                                                                                                                  \
        "l", NUMERICS_LINEAR, 1.2, 4, 0                                                                                \
    }
static const numerics_argument weave_brdf[] = {
    YARN, {"U", NUMERICS_LINEAR, -8, 8, 0}, {"V", NUMERICS_LINEAR, -8, 8, 0}, PAIR};
static const numerics_argument weave_mean[] = {YARN, PAIR};
static const numerics_argument half[] = {{"x", NUMERICS_LOGARITHMIC, 1e-8, 6e4, 0}};
static const numerics_argument code[] = {{"T", NUMERICS_EXPONENT, 1e-6, 1, 0}};
static const numerics_argument normal[] = {{"n", NUMERICS_DIRECTION, 0, 0, 0}};

static const numerics_domain domains[NUMERICS_MODELS] = {
    [NUMERICS_LOBE_POWER] = DOMAIN(NULL, lobe_power),
    [NUMERICS_LAFORTUNE] = DOMAIN("lafortune.csv", lafortune),
    [NUMERICS_TABLE_FIT] = DOMAIN("view_table_fit.csv", table_fit),
    [NUMERICS_INTERPOLATION] = DOMAIN("view_table_eval.csv", interpolation),
    [NUMERICS_EXTRAPOLATION] = DOMAIN(NULL, extrapolation),
    [NUMERICS_MIP] = DOMAIN(NULL, mip),
    [NUMERICS_BARD_IN_PLANE] = DOMAIN("bard.csv", bard),
    [NUMERICS_BARD_PRINTED] = DOMAIN("bard.csv", bard),
    [NUMERICS_FRESNEL_REFLECTANCE] = DOMAIN(NULL, fresnel),
    [NUMERICS_FRESNEL_TRANSMITTANCE] = DOMAIN(NULL, fresnel),
    [NUMERICS_THREAD_SCATTERING] = DOMAIN("microcylinder_thread.csv", thread),
    [NUMERICS_THREAD_SHADOWING] = DOMAIN("microcylinder_thread.csv", thread),
    [NUMERICS_THREAD_PROJECTION] = DOMAIN("microcylinder_thread.csv", thread),
    [NUMERICS_CLOTH_BY_AREA] = DOMAIN(NULL, cloth),
    [NUMERICS_CLOTH_PRINTED_BRDF] = DOMAIN(NULL, cloth),
    [NUMERICS_SPINE_RADIUS] = DOMAIN("woven_R.csv", spine),
    [NUMERICS_PHASE] = DOMAIN(NULL, phase),
    [NUMERICS_STAPLE_POINT] = DOMAIN("woven_point.csv", staple_point),
    [NUMERICS_FILAMENT_POINT] = DOMAIN("woven_point.csv", filament_point),
    [NUMERICS_STAPLE_TEXTURE] = DOMAIN("woven_texture.csv", staple_texture),
    [NUMERICS_FILAMENT_TEXTURE] = DOMAIN("woven_texture.csv", filament_texture),
    [NUMERICS_STAPLE_REFLECTANCE] = DOMAIN("woven_reflectance.csv", staple_reflectance),
    [NUMERICS_FILAMENT_REFLECTANCE] = DOMAIN("woven_reflectance.csv", filament_reflectance),
    [NUMERICS_WEAVE_BRDF] = DOMAIN(NULL, weave_brdf),
    [NUMERICS_WEAVE_MEAN] = DOMAIN(NULL, weave_mean),
    [NUMERICS_STORED_HALF] = DOMAIN(NULL, half),
    [NUMERICS_STORED_8_BITS] = DOMAIN(NULL, code),
    [NUMERICS_STORED_6_BITS] = DOMAIN(NULL, code),
    [NUMERICS_STORED_4_BITS] = DOMAIN(NULL, code),
    [NUMERICS_STORED_NORMAL] = DOMAIN(NULL, normal)};

const numerics_domain *numerics_domain_of(numerics_id id)
{
    return &domains[id];
}

/* ---- From the unit cube to arguments ---- */

static double between(double low, double high, double share)
{
    return low + (high - low) * share;
}

static double logarithmic(double low, double high, double share)
{
    return exp(between(log(low), log(high), share));
}

/* A power of ten in 10^-1 .. 10^-most. */
static double tiny(double most, double share)
{
    return pow(10, -between(1, most, share));
}

/* The share of `x` within its part [from, to] of the coordinate. */
static double part(double x, double from, double to)
{
    return (x - from) / (to - from);
}

/* An azimuth; one in five is within a power of ten of an axis. */
static double azimuth_of(double x)
{
    if (x < 0.8)
        return 2 * half_turn * part(x, 0, 0.8);
    double quarters = 8 * part(x, 0.8, 1), which = floor(quarters), share = quarters - which;
    return half_turn / 2 * which + (share < 0.2 ? 0 : tiny(9, part(share, 0.2, 1))) * (fmod(which, 2) < 1 ? 1 : -1);
}

static void set_direction(double theta_sine, double cosine, double azimuth, double *d)
{
    double length = hypot(theta_sine, cosine);
    d[0] = theta_sine * cos(azimuth) / length;
    d[1] = theta_sine * sin(azimuth) / length;
    d[2] = cosine / length;
}

static void place_direction(const double *x, double *d)
{
    double cosine = part(x[0], 0, 0.6), sine;
    if (x[0] < 0.6) {
        sine = sqrt(fmax(1 - cosine * cosine, 0));
    } else if (x[0] < 0.8) {
        cosine = tiny(9, part(x[0], 0.6, 0.8));
        sine = sqrt(1 - cosine * cosine);
    } else {
        sine = tiny(9, part(x[0], 0.8, 1));
        cosine = sqrt(1 - sine * sine);
    }
    set_direction(sine, cosine, azimuth_of(x[1]), d);
}

/* Half of the coordinate leaves the direction free; the rest ties it to the one before at a distance. */
static void place_tied_direction(const double *x, double *d)
{
    place_direction(x + 1, d);
    if (x[0] < 0.5)
        return;
    const double *before = d - 3;
    double choice = 3 * part(x[0], 0.5, 1), which = floor(fmin(choice, 2.999)), distance = tiny(9, choice - which);
    double sign = which < 2 ? -1 : 1, length = 0;
    double up = which == 1 ? distance : before[2];
    const double tied[3] = {sign * before[0], sign * before[1], up};
    for (int i = 0; i < 3; i++) {
        d[i] = tied[i] + distance * d[i];
        length += d[i] * d[i];
    }
    for (int i = 0; i < 3; i++)
        d[i] /= sqrt(length);
}

static double place_umax(double x)
{
    if (x < 0.6)
        return between(0.05, 1.5, part(x, 0, 0.6));
    return x < 0.8 ? half_turn / 2 - tiny(7, part(x, 0.6, 0.8)) : tiny(6, part(x, 0.8, 1));
}

static double place_kappa(double x, double umax)
{
    double parabola = -1 / (1 + 1 / tan(umax));
    if (x < 0.4)
        return between(-0.95, 1, part(x, 0, 0.4));
    if (x < 0.7)
        return parabola * (1 + tiny(9, fabs(2 * part(x, 0.4, 0.7) - 1)) * (x < 0.55 ? 1 : -1));
    return x < 0.9 ? -1 + tiny(7, part(x, 0.7, 0.9)) : logarithmic(1, 1e3, part(x, 0.9, 1));
}

static double place_length(double x, double shortest)
{
    return x < 0.6 ? shortest * between(1.05, 10, part(x, 0, 0.6)) : shortest * (1 + tiny(5, part(x, 0.6, 1)));
}

static double place_twist(double x)
{
    if (x < 0.6)
        return between(0.05, 1.5, part(x, 0, 0.6));
    return x < 0.8 ? tiny(8, part(x, 0.6, 0.8)) : half_turn / 2 - tiny(6, part(x, 0.8, 1));
}

static double place_exponent(const numerics_argument *argument, double x)
{
    if (x < 0.05)
        return 0;
    return x < 0.1 ? 1 : logarithmic(argument->low, argument->high, part(x, 0.1, 1));
}

static double place_signed(const numerics_argument *argument, double x)
{
    return x < 0.5 ? -logarithmic(argument->low, argument->high, 1 - 2 * x)
                   : logarithmic(argument->low, argument->high, 2 * x - 1);
}

/* One number. `all` are the arguments from the first. */
static double place_number(const numerics_argument *argument, double x, const double *all, int index)
{
    switch (argument->kind) {
    case NUMERICS_LOGARITHMIC:
        return logarithmic(argument->low, argument->high, x);
    case NUMERICS_SIGNED:
        return place_signed(argument, x);
    case NUMERICS_NEAR:
        return all[argument->of] + place_signed(argument, x) * all[argument->of + 1];
    case NUMERICS_WHOLE:
        return fmin(floor(between(argument->low, argument->high + 1, x)), argument->high);
    case NUMERICS_ZERO:
        return 0;
    case NUMERICS_WITHIN:
        return (2 * x - 1) * argument->high * all[argument->of];
    case NUMERICS_EXPONENT:
        return place_exponent(argument, x);
    case NUMERICS_UMAX:
        return place_umax(x);
    case NUMERICS_KAPPA:
        return place_kappa(x, all[index - 1]);
    case NUMERICS_LENGTH:
        return place_length(x, all[argument->of + 2] * sin(all[argument->of]));
    case NUMERICS_TWIST:
        return place_twist(x);
    default:
        return between(argument->low, argument->high, x);
    }
}

/* Turned about the unit vector before it, from an axis that is not near that. */
static void place_tangent(double angle, double *d)
{
    const double *n = d - 3;
    const double axis[3] = {fabs(n[0]) < 0.7, fabs(n[0]) >= 0.7, 0};
    double along = n[0] * axis[0] + n[1] * axis[1], t[3], length = 0;
    for (int i = 0; i < 3; i++) {
        t[i] = axis[i] - along * n[i];
        length += t[i] * t[i];
    }
    const double b[3] = {n[1] * t[2] - n[2] * t[1], n[2] * t[0] - n[0] * t[2], n[0] * t[1] - n[1] * t[0]};
    for (int i = 0; i < 3; i++)
        d[i] = (cos(angle) * t[i] + sin(angle) * b[i]) / sqrt(length);
}

static void place_vector(const numerics_argument *argument, const double *x, double *d)
{
    if (argument->kind == NUMERICS_DIRECTION) {
        place_direction(x, d);
    } else if (argument->kind == NUMERICS_TIED_DIRECTION) {
        place_tied_direction(x, d);
    } else if (argument->kind == NUMERICS_RING) {
        double theta = between(argument->low, argument->high, x[0]) * half_turn / 180;
        set_direction(sin(theta), cos(theta), azimuth_of(x[1]), d);
    } else {
        place_tangent(2 * half_turn * x[0], d);
    }
}

static bool is_vector(const numerics_argument *argument)
{
    return argument->kind >= NUMERICS_DIRECTION && argument->kind <= NUMERICS_TANGENT;
}

int numerics_width(const numerics_argument *argument)
{
    return is_vector(argument) ? 3 : 1;
}

int numerics_coordinates(const numerics_argument *argument)
{
    if (argument->kind == NUMERICS_TIED_DIRECTION)
        return 3;
    if (argument->kind == NUMERICS_TANGENT)
        return 1;
    return is_vector(argument) ? 2 : argument->kind != NUMERICS_ZERO;
}

int numerics_coordinate_count(const numerics_domain *domain)
{
    int count = 0;
    for (int i = 0; i < domain->argument_count; i++)
        count += numerics_coordinates(&domain->argument[i]);
    return count;
}

int numerics_number_count(const numerics_domain *domain)
{
    int count = 0;
    for (int i = 0; i < domain->argument_count; i++)
        count += numerics_width(&domain->argument[i]);
    return count;
}

/* The share of a coordinate that leaves an argument away from limits. */
static double ordinary_share(numerics_kind kind)
{
    switch (kind) {
    case NUMERICS_DIRECTION:
    case NUMERICS_UMAX:
    case NUMERICS_LENGTH:
    case NUMERICS_TWIST:
        return 0.6;
    case NUMERICS_KAPPA:
        return 0.4;
    default:
        return 1;
    }
}

void numerics_make_ordinary(const numerics_domain *domain, double *coordinate)
{
    for (int i = 0; i < domain->argument_count; i++) {
        const numerics_argument *a = &domain->argument[i];
        if (a->kind == NUMERICS_TIED_DIRECTION)
            coordinate[1] *= ordinary_share(NUMERICS_DIRECTION);
        else if (numerics_coordinates(a) > 0)
            coordinate[0] *= ordinary_share(a->kind);
        coordinate += numerics_coordinates(a);
    }
}

void numerics_place(const numerics_domain *domain, const double *coordinate, bool single, double *argument)
{
    int at = 0;
    for (int i = 0; i < domain->argument_count; i++) {
        const numerics_argument *a = &domain->argument[i];
        if (is_vector(a))
            place_vector(a, coordinate, argument + at);
        else
            argument[at] = place_number(a, *coordinate, argument, at);
        at += numerics_width(a);
        coordinate += numerics_coordinates(a);
    }
    for (int i = 0; i < at && single; i++)
        argument[i] = numerics_single(argument[i]);
}
