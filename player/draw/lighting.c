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

weft_lighting weft_lighting_of(const weft_scene *scene, const weft_environment *environment, long frame)
{
    weft_lighting lighting = {0};
    for (int i = 0; i < scene->light_count; i++)
        add(&lighting, weft_direction_of_angles(scene->light[i].direction), scene->light[i].irradiance);
    for (int i = 0; environment && scene->environment && i < WEFT_ENVIRONMENT_REGIONS; i++) {
        const weft_distant_light *light =
            frame < 0 ? &environment->region[i] : &environment->part[frame % WEFT_ENVIRONMENT_PARTS][i];
        double irradiance[3];
        for (int c = 0; c < 3; c++)
            irradiance[c] = scene->environment_strength * (double)light->irradiance[c];
        add(&lighting, turned(light->direction, scene->environment_turn_rad), irradiance);
    }
    if (lighting.count == 0)
        add(&lighting, weft_vec3_of(0, 0, 1), (const double[3]){0, 0, 0});
    return lighting;
}

int weft_lighting_count(const weft_scene *scene, const weft_environment *environment)
{
    int count = scene->light_count + (environment && scene->environment ? WEFT_ENVIRONMENT_REGIONS : 0);
    return count > 0 ? count : 1;
}
