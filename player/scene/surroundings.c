#include "player/scene/surroundings.h"

#include <math.h>
#include <string.h>

enum { WIDTH = 256, HEIGHT = 128 };

const char *const weft_surroundings_names[] = {"studio", "overcast", "sky", NULL};

/* ---- Studio ---- */

/* A round soft box: full within one angle, none beyond another. */
typedef struct soft_box {
    double theta_deg, phi_deg, full_deg, none_deg;
    double radiance[3];
} soft_box;

/* A cool window behind the cloth, a broad reflector beside the camera, a strip light above. */
static const soft_box boxes[] = {
    {66, 75, 12, 26, {2.6, 2.9, 3.4}}, {62, -10, 16, 44, {0.9, 0.88, 0.84}}, {12, 160, 8, 22, {1.6, 1.6, 1.6}}};
static const double wall[3] = {0.15, 0.15, 0.16}, floor_bounce[3] = {0.12, 0.117, 0.114};

static double smooth_step(double from, double to, double x)
{
    double t = weft_clamp((x - from) / (to - from), 0, 1);
    return t * t * (3 - 2 * t);
}

static weft_vec3 direction_deg(double theta_deg, double phi_deg)
{
    return weft_direction_of_angles((weft_angles){weft_rad_of_deg(theta_deg), weft_rad_of_deg(phi_deg)});
}

static double angle_between_rad(weft_vec3 a, weft_vec3 b)
{
    return acos(weft_clamp((double)weft_dot(a, b), -1, 1));
}

static void studio(weft_vec3 d, double radiance[3])
{
    for (int c = 0; c < 3; c++)
        radiance[c] = d.z > 0 ? wall[c] * (0.4 + 0.6 * (double)d.z) : floor_bounce[c];
    for (size_t i = 0; i < sizeof boxes / sizeof *boxes; i++) {
        const soft_box *box = &boxes[i];
        double angle_deg = weft_deg_of_rad(angle_between_rad(d, direction_deg(box->theta_deg, box->phi_deg)));
        for (int c = 0; c < 3; c++)
            radiance[c] += box->radiance[c] * (1 - smooth_step(box->full_deg, box->none_deg, angle_deg));
    }
}

/* ---- Skies ---- */

/* Parameters of a standard sky and its luminance relative to the zenith: f(chi) phi(Z) / (f(Zs) phi(0)), chi the angle
 * from the sun, Z and Zs those of the point and of the sun from the zenith. */
typedef struct standard_sky {
    double a, b, c, d, e;
} standard_sky;

/* Types 1 (overcast, as Moon and Spencer 1942 have it) and 12 (clear, Kittler 1967). */
static const standard_sky overcast_sky = {4, -0.7, 0, -1, 0}, clear_sky = {-1, -0.32, 10, -3, 0.45};

static double gradation(const standard_sky *s, double cosine)
{
    return 1 + s->a * exp(s->b / fmax(cosine, 0.01));
}

static double indicatrix(const standard_sky *s, double chi_rad)
{
    return 1 + s->c * (exp(s->d * chi_rad) - exp(s->d * WEFT_PI / 2)) + s->e * cos(chi_rad) * cos(chi_rad);
}

static double luminance(const standard_sky *s, weft_vec3 d, weft_vec3 sun)
{
    return gradation(s, (double)d.z) * indicatrix(s, angle_between_rad(d, sun)) /
           (gradation(s, 1) * indicatrix(s, acos((double)sun.z)));
}

static const weft_angles sun_angles = {45 * WEFT_PI / 180, -125 * WEFT_PI / 180};

/* The ground below the horizon reflects a fifth of what falls on it. */
static void overcast(weft_vec3 d, double radiance[3])
{
    static const double colour[3] = {1.0, 1.01, 1.04};
    /* The irradiance over pi of a type 1 sky of zenith luminance 1 is about 7/9. */
    double value = d.z > 0 ? 1.1 * luminance(&overcast_sky, d, weft_vec3_of(0, 0, 1)) : 0.2 * 1.1 * 7 / 9;
    for (int c = 0; c < 3; c++)
        radiance[c] = colour[c] * value;
}

/* Bluer away from the sun and up, whiter at the horizon; under a sun of irradiance pi on what faces it. */
static void sky(weft_vec3 d, double radiance[3])
{
    static const double zenith[3] = {0.085, 0.14, 0.28}, horizon[3] = {0.15, 0.16, 0.17}, lawn[3] = {0.15, 0.15, 0.14};
    weft_vec3 sun = weft_direction_of_angles(sun_angles);
    double high = sqrt(weft_clamp((double)d.z, 0, 1));
    double value = d.z > 0 ? fmin(luminance(&clear_sky, d, sun), 8) : 1;
    for (int c = 0; c < 3; c++)
        radiance[c] = d.z > 0 ? value * (horizon[c] + high * (zenith[c] - horizon[c])) : lawn[c];
}

/* ---- All of them ---- */

typedef struct surroundings {
    void (*radiance)(weft_vec3 direction, double radiance[3]);
    weft_light key; /* irradiance 0: none */
    double key_size_deg;
} surroundings;

static surroundings find(const char *name)
{
    if (strcmp(name, "studio") == 0)
        return (surroundings){studio, {{weft_rad_of_deg(48), weft_rad_of_deg(-128)}, {1.05, 1.0, 0.94}}, 9};
    if (strcmp(name, "overcast") == 0)
        return (surroundings){overcast, {{0, 0}, {0, 0, 0}}, 0};
    /* The sun's disc, and the bright sky around it. */
    if (strcmp(name, "sky") == 0)
        return (surroundings){sky, {sun_angles, {1.05, 1.0, 0.9}}, 0.6};
    return (surroundings){0};
}

bool weft_surroundings_are(const char *name)
{
    return find(name).radiance != NULL;
}

weft_code weft_surroundings_map(const char *name, weft_image *map, weft_error *error)
{
    surroundings s = find(name);
    if (!s.radiance)
        return weft_fail(error, WEFT_BAD_USAGE, "there is no environment '%s'", name);
    WEFT_TRY(weft_image_create(WIDTH, HEIGHT, map, error));
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        double theta_rad = WEFT_PI * (i / WIDTH + 0.5) / HEIGHT,
               phi_rad = 2 * WEFT_PI * (0.75 - (i % WIDTH + 0.5) / WIDTH);
        double radiance[3];
        s.radiance(weft_direction_of_angles((weft_angles){theta_rad, phi_rad}), radiance);
        for (int c = 0; c < 3; c++)
            map->pixels[3 * (size_t)i + (size_t)c] = (float)radiance[c];
    }
    return WEFT_OK;
}

void weft_surroundings_light(const char *name, weft_scene *scene)
{
    surroundings s = find(name);
    scene->environment = true;
    scene->light_count = s.key.irradiance[0] > 0;
    scene->light[0] = s.key;
    scene->key_size_rad = weft_rad_of_deg(s.key_size_deg);
}
