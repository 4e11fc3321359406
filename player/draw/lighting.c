#include "player/draw/lighting.h"

static void add(weft_lighting *lighting, weft_vec3 direction, const double irradiance[3])
{
    const double axis[3] = {(double)direction.x, (double)direction.y, (double)direction.z};
    for (int i = 0; i < 3; i++) {
        lighting->direction[lighting->count][i] = (float)axis[i];
        lighting->irradiance[lighting->count][i] = (float)irradiance[i];
    }
    lighting->count++;
}

static weft_vec3 turned(weft_vec3 direction, double angle_rad)
{
    weft_real cosine = (weft_real)cos(angle_rad), sine = (weft_real)sin(angle_rad);
    return weft_vec3_of(cosine * direction.x - sine * direction.y, sine * direction.x + cosine * direction.y,
                        direction.z);
}

/* Of a disc of radius key_size_rad about the light, which successive numbers fill evenly (Roberts' sequence R2). */
static weft_vec3 place_in_key(const weft_scene *scene, long number)
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

static double brightness(const weft_lighting *l, int light)
{
    const float *irradiance = l->irradiance[light];
    return l->direction[light][2] > 0 ? (double)(irradiance[0] + irradiance[1] + irradiance[2]) : 0;
}

/* The light above the horizon that the share `at` of all their brightness falls into. */
static weft_vec3 fill_at(const weft_lighting *l, double at)
{
    double total = 0;
    int light = l->scene_count;
    for (int i = l->scene_count; i < l->count; i++)
        total += brightness(l, i);
    for (double rest = at * total; light < l->count - 1 && rest >= brightness(l, light); light++)
        rest -= brightness(l, light);
    const float *d = l->direction[light];
    return d[2] > 0 ? weft_vec3_of((weft_real)d[0], (weft_real)d[1], (weft_real)d[2]) : weft_vec3_of(0, 0, 1);
}

/* One shadow a frame would leave bands in the penumbra of a picture that has just come to rest. */
static void choose_key(weft_lighting *l, const weft_scene *scene, long frame)
{
    bool is_one = frame < 0 || !(scene->key_size_rad > 0);
    l->key_count = l->scene_count == 0 ? 0 : is_one ? 1 : WEFT_KEY_PLACES;
    for (int i = 0; i < l->key_count; i++)
        l->key[i] = place_in_key(scene, is_one ? frame : frame * WEFT_KEY_PLACES + i);
}

/* All of them move on a frame. */
static void choose_fill(weft_lighting *l, long frame)
{
    int wanted = frame < 0 ? WEFT_FILL_DIRECTIONS / 2 : WEFT_FILL_DIRECTIONS;
    double place = fmod(0.5 + (double)(frame < 0 ? 0 : frame) * 0.6180339887498949, 1);
    l->fill_count = l->count > l->scene_count ? wanted : 0;
    for (int i = 0; i < l->fill_count; i++)
        l->fill[i] = fill_at(l, (i + place) / l->fill_count);
}

weft_lighting weft_lighting_of(const weft_scene *scene, const weft_environment *environment, long frame)
{
    weft_lighting lighting = {0};
    for (int i = 0; i < scene->light_count; i++)
        add(&lighting, i == 0 ? place_in_key(scene, frame) : weft_direction_of_angles(scene->light[i].direction),
            scene->light[i].irradiance);
    lighting.scene_count = lighting.count;
    choose_key(&lighting, scene, frame);
    for (int i = 0; environment && scene->environment && i < environment->region_count; i++) {
        const weft_distant_light *light =
            frame < 0 ? &environment->region[i] : &environment->part[frame % WEFT_ENVIRONMENT_PARTS][i];
        double irradiance[3];
        for (int c = 0; c < 3; c++)
            irradiance[c] = scene->environment_strength * (double)light->irradiance[c];
        add(&lighting, turned(light->direction, scene->environment_turn_rad), irradiance);
    }
    choose_fill(&lighting, frame);
    if (lighting.count == 0)
        add(&lighting, weft_vec3_of(0, 0, 1), (const double[3]){0, 0, 0});
    return lighting;
}

int weft_lighting_count(const weft_scene *scene, const weft_environment *environment)
{
    int count = scene->light_count + (environment && scene->environment ? environment->region_count : 0);
    return count > 0 ? count : 1;
}
