#include "player/draw/lighting.h"

#include <string.h>

static void set(weft_lighting *lighting, int at, weft_vec3 direction, const double irradiance[3])
{
    const double axis[3] = {(double)direction.x, (double)direction.y, (double)direction.z};
    for (int i = 0; i < 3; i++) {
        lighting->direction[at][i] = (float)axis[i];
        lighting->irradiance[at][i] = (float)irradiance[i];
    }
}

static void add(weft_lighting *lighting, weft_vec3 direction, const double irradiance[3])
{
    set(lighting, lighting->count++, direction, irradiance);
}

static weft_vec3 turned(weft_vec3 direction, double angle_rad)
{
    weft_real cosine = (weft_real)cos(angle_rad), sine = (weft_real)sin(angle_rad);
    return weft_vec3_of(cosine * direction.x - sine * direction.y, sine * direction.x + cosine * direction.y,
                        direction.z);
}

/* Of a disc of radius key_size_rad about the light, which successive numbers fill evenly (Roberts' sequence R2). */
weft_vec3 weft_lighting_key_place(const weft_scene *scene, long number)
{
    weft_vec3 middle = weft_direction_of_angles(scene->light[0].direction);
    if (number <= 0 || !(scene->key_size_rad > 0))
        return middle;
    double radius = tan(scene->key_size_rad) * sqrt(fmod((double)number * 0.7548776662466927, 1));
    double angle_rad = 2 * WEFT_PI * fmod((double)number * 0.5698402909980532, 1);
    weft_vec3 aside = fabs((double)middle.z) < 0.9 ? weft_vec3_of(0, 0, 1) : weft_vec3_of(1, 0, 0);
    weft_vec3 x = weft_unit(weft_cross(aside, middle)), y = weft_cross(middle, x);
    weft_vec3 shift = weft_add(weft_scale(x, (weft_real)(radius * cos(angle_rad))),
                               weft_scale(y, (weft_real)(radius * sin(angle_rad))));
    return weft_unit(weft_add(middle, shift));
}

typedef double brightness_of(const weft_distant_light *light);

static double brightness(const weft_distant_light *light)
{
    return (double)light->direction.z > 0 ? (double)(light->irradiance[0] + light->irradiance[1] + light->irradiance[2])
                                          : 0;
}

static double brightness_on_ground(const weft_distant_light *light)
{
    return brightness(light) * (double)light->direction.z;
}

/* The i-th light that shadows may come from: a region, or in a converging picture a stratum of one. Successive ones lie
 * beside each other. */
static const weft_distant_light *sampled_light(const weft_environment *environment, bool converges, int i)
{
    return converges ? &environment->stratum[weft_environment_frame_of_stratum(i % WEFT_ENVIRONMENT_STRATA)]
                                            [i / WEFT_ENVIRONMENT_STRATA]
                     : &environment->region[i];
}

/* Inverts the cumulative brightness of the lights above the horizon at the increasing shares at[count]. */
static void find_samples(const weft_environment *environment, bool converges, brightness_of *bright, const double *at,
                         int count, weft_vec3 *sample)
{
    int light_count = environment->region_count * (converges ? WEFT_ENVIRONMENT_STRATA : 1);
    double total = 0, passed = 0;
    for (int i = 0; i < light_count; i++)
        total += bright(sampled_light(environment, converges, i));
    int found = 0;
    for (int i = 0; i < light_count && found < count; i++) {
        const weft_distant_light *light = sampled_light(environment, converges, i);
        passed += bright(light);
        for (; found < count && at[found] * total < passed; found++)
            sample[found] = light->direction;
    }
    for (; found < count; found++)
        sample[found] = weft_vec3_of(0, 0, 1);
}

/* One place a frame would leave bands in the penumbra after the first frames. */
static void choose_key(weft_lighting *l, const weft_scene *scene, long frame)
{
    bool is_one = frame < 0 || !(scene->key_size_rad > 0);
    l->key_count = l->scene_count == 0 ? 0 : is_one ? 1 : WEFT_KEY_PLACES;
    for (int i = 0; i < l->key_count; i++)
        l->key[i] = weft_lighting_key_place(scene, is_one ? frame : frame * WEFT_KEY_PLACES + i);
}

/* All of them move from frame to frame. The lights lie along a curve that fills the sphere, and the places on it are
 * evenly distributed in time. */
static void choose_samples(weft_lighting *l, const weft_scene *scene, const weft_environment *environment, long frame)
{
    double place = fmod(0.5 + (double)(frame < 0 ? 0 : frame) * 0.6180339887498949, 1), at[WEFT_ENVIRONMENT_SAMPLES];
    l->sample_count = frame < 0 ? WEFT_INTERACTIVE_SAMPLES : WEFT_ENVIRONMENT_SAMPLES;
    for (int i = 0; i < l->sample_count; i++)
        at[i] = (i + place) / l->sample_count;
    find_samples(environment, frame >= 0, brightness, at, l->sample_count, l->sample);
    for (int i = 0; i < l->sample_count; i++)
        l->sample[i] = turned(l->sample[i], scene->environment_turn_rad);
}

weft_vec3 weft_lighting_ground_place(const weft_scene *scene, const weft_environment *environment, long number)
{
    const double at = fmod(0.5 + (double)number * 0.6180339887498949, 1);
    weft_vec3 direction;
    find_samples(environment, true, brightness_on_ground, &at, 1, &direction);
    return turned(direction, scene->environment_turn_rad);
}

/* The stratum that lights pixels of one index in a frame. Each index takes all strata in turn. The low bits of a
 * stratum are the coarse place within the region, the high bits the fine one. Indices differ in both, so that
 * neighbours complete each other in one frame, and in the mean of sixteen. */
static int stratum_of(long frame, int index)
{
    return (int)((frame ^ index ^ (long)index << 4) % WEFT_ENVIRONMENT_STRATA);
}

static void add_environment(weft_lighting *l, const weft_scene *scene, const weft_environment *environment, long frame)
{
    int room = (WEFT_MAX_LIGHTS - l->scene_count) / environment->region_count;
    /* A tint must not change from pixel to pixel. */
    l->interleave_count = frame < 0 || scene->show_extrapolation ? 1
                          : room < WEFT_INTERLEAVED_LIGHTS       ? room
                                                                 : WEFT_INTERLEAVED_LIGHTS;
    for (int i = 0; i < environment->region_count; i++) {
        for (int index = 0; index < l->interleave_count; index++) {
            const weft_distant_light *light =
                frame < 0 ? &environment->region[i] : &environment->stratum[stratum_of(frame, index)][i];
            double irradiance[3];
            for (int c = 0; c < 3; c++)
                irradiance[c] = scene->environment_strength * (double)light->irradiance[c];
            set(l, l->scene_count + i * l->interleave_count + index,
                turned(light->direction, scene->environment_turn_rad), irradiance);
        }
        l->count++;
    }
}

weft_lighting weft_lighting_of(const weft_scene *scene, const weft_environment *environment, long frame)
{
    weft_lighting lighting = {.interleave_count = 1};
    for (int i = 0; i < scene->light_count; i++)
        add(&lighting,
            i == 0 ? weft_lighting_key_place(scene, frame) : weft_direction_of_angles(scene->light[i].direction),
            scene->light[i].irradiance);
    lighting.scene_count = lighting.count;
    choose_key(&lighting, scene, frame);
    if (environment && scene->environment) {
        add_environment(&lighting, scene, environment, frame);
        choose_samples(&lighting, scene, environment, frame);
    }
    if (lighting.count == 0)
        add(&lighting, weft_vec3_of(0, 0, 1), (const double[3]){0, 0, 0});
    return lighting;
}

void weft_lighting_without_interleaving(weft_lighting *lighting)
{
    for (int i = lighting->scene_count; i < lighting->count; i++) {
        int kept = lighting->scene_count + (i - lighting->scene_count) * lighting->interleave_count;
        memcpy(lighting->direction[i], lighting->direction[kept], sizeof lighting->direction[i]);
        memcpy(lighting->irradiance[i], lighting->irradiance[kept], sizeof lighting->irradiance[i]);
    }
    lighting->interleave_count = 1;
}

int weft_lighting_stored(const weft_lighting *lighting)
{
    return lighting->scene_count + (lighting->count - lighting->scene_count) * lighting->interleave_count;
}

int weft_lighting_count(const weft_scene *scene, const weft_environment *environment)
{
    int count = scene->light_count + (environment && scene->environment ? environment->region_count : 0);
    return count > 0 ? count : 1;
}
