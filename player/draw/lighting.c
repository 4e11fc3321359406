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

/* The i-th light that shadows may come from: a region, or at rest a part of one. Those that follow each other lie
 * beside each other. */
static const weft_distant_light *fill_light(const weft_environment *environment, bool rests, int i)
{
    return rests ? &environment->part[weft_environment_frame_of(i % WEFT_ENVIRONMENT_PARTS)][i / WEFT_ENVIRONMENT_PARTS]
                 : &environment->region[i];
}

/* Those above the horizon that the shares at[count], which increase, of all their brightness fall into. */
static void find_fill(const weft_environment *environment, bool rests, brightness_of *bright, const double *at,
                      int count, weft_vec3 *fill)
{
    int light_count = environment->region_count * (rests ? WEFT_ENVIRONMENT_PARTS : 1);
    double total = 0, passed = 0;
    for (int i = 0; i < light_count; i++)
        total += bright(fill_light(environment, rests, i));
    int found = 0;
    for (int i = 0; i < light_count && found < count; i++) {
        const weft_distant_light *light = fill_light(environment, rests, i);
        passed += bright(light);
        for (; found < count && at[found] * total < passed; found++)
            fill[found] = light->direction;
    }
    for (; found < count; found++)
        fill[found] = weft_vec3_of(0, 0, 1);
}

/* One shadow a frame would leave bands in the penumbra of a picture that has just come to rest. */
static void choose_key(weft_lighting *l, const weft_scene *scene, long frame)
{
    bool is_one = frame < 0 || !(scene->key_size_rad > 0);
    l->key_count = l->scene_count == 0 ? 0 : is_one ? 1 : WEFT_KEY_PLACES;
    for (int i = 0; i < l->key_count; i++)
        l->key[i] = weft_lighting_key_place(scene, is_one ? frame : frame * WEFT_KEY_PLACES + i);
}

/* All of them move on a frame. Lights lie along a curve that fills the sphere, and places on it are even in time. */
static void choose_fill(weft_lighting *l, const weft_scene *scene, const weft_environment *environment, long frame)
{
    double place = fmod(0.5 + (double)(frame < 0 ? 0 : frame) * 0.6180339887498949, 1), at[WEFT_FILL_DIRECTIONS];
    l->fill_count = frame < 0 ? WEFT_FILL_MOVING : WEFT_FILL_DIRECTIONS;
    for (int i = 0; i < l->fill_count; i++)
        at[i] = (i + place) / l->fill_count;
    find_fill(environment, frame >= 0, brightness, at, l->fill_count, l->fill);
    for (int i = 0; i < l->fill_count; i++)
        l->fill[i] = turned(l->fill[i], scene->environment_turn_rad);
}

weft_vec3 weft_lighting_ground_place(const weft_scene *scene, const weft_environment *environment, long number)
{
    const double at = fmod(0.5 + (double)number * 0.6180339887498949, 1);
    weft_vec3 direction;
    find_fill(environment, true, brightness_on_ground, &at, 1, &direction);
    return turned(direction, scene->environment_turn_rad);
}

/* The part of its regions that a frame lights pixels of one kind from. Each kind takes all of them in turn. Of the bits
 * of a part the low ones tell the coarse place within the region, the high ones the fine one: kinds differ in both, so
 * that neighbours complete each other in one frame, and in the mean of sixteen. */
static int part_of(long frame, int kind)
{
    return (int)((frame ^ kind ^ (long)kind << 4) % WEFT_ENVIRONMENT_PARTS);
}

static void add_environment(weft_lighting *l, const weft_scene *scene, const weft_environment *environment, long frame)
{
    int room = (WEFT_MAX_LIGHTS - l->scene_count) / environment->region_count;
    /* Where a light is tinted it has to be the same in neighbouring pixels. */
    l->set_count = frame < 0 || scene->show_extrapolation ? 1 : room < WEFT_LIGHT_SETS ? room : WEFT_LIGHT_SETS;
    for (int i = 0; i < environment->region_count; i++) {
        for (int kind = 0; kind < l->set_count; kind++) {
            const weft_distant_light *light =
                frame < 0 ? &environment->region[i] : &environment->part[part_of(frame, kind)][i];
            double irradiance[3];
            for (int c = 0; c < 3; c++)
                irradiance[c] = scene->environment_strength * (double)light->irradiance[c];
            set(l, l->scene_count + i * l->set_count + kind, turned(light->direction, scene->environment_turn_rad),
                irradiance);
        }
        l->count++;
    }
}

weft_lighting weft_lighting_of(const weft_scene *scene, const weft_environment *environment, long frame)
{
    weft_lighting lighting = {.set_count = 1};
    for (int i = 0; i < scene->light_count; i++)
        add(&lighting,
            i == 0 ? weft_lighting_key_place(scene, frame) : weft_direction_of_angles(scene->light[i].direction),
            scene->light[i].irradiance);
    lighting.scene_count = lighting.count;
    choose_key(&lighting, scene, frame);
    if (environment && scene->environment) {
        add_environment(&lighting, scene, environment, frame);
        choose_fill(&lighting, scene, environment, frame);
    }
    if (lighting.count == 0)
        add(&lighting, weft_vec3_of(0, 0, 1), (const double[3]){0, 0, 0});
    return lighting;
}

void weft_lighting_keep_one_kind(weft_lighting *lighting)
{
    for (int i = lighting->scene_count; i < lighting->count; i++) {
        int kept = lighting->scene_count + (i - lighting->scene_count) * lighting->set_count;
        memcpy(lighting->direction[i], lighting->direction[kept], sizeof lighting->direction[i]);
        memcpy(lighting->irradiance[i], lighting->irradiance[kept], sizeof lighting->irradiance[i]);
    }
    lighting->set_count = 1;
}

int weft_lighting_held(const weft_lighting *lighting)
{
    return lighting->scene_count + (lighting->count - lighting->scene_count) * lighting->set_count;
}

int weft_lighting_count(const weft_scene *scene, const weft_environment *environment)
{
    int count = scene->light_count + (environment && scene->environment ? environment->region_count : 0);
    return count > 0 ? count : 1;
}
