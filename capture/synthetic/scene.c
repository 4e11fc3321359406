#include "capture/synthetic/scene.h"

static const double ball_radius = 10, pin_height = 30, pin_radius = 0.4, pin_head_radius = 1.5;
static const weft_rgb chrome = {0.66, 0.66, 0.67}, steel = {0.35, 0.35, 0.36}, skin = {0.55, 0.37, 0.28};

static weft_rgb grey(double value)
{
    return (weft_rgb){value, value, value};
}

/* ---- Solids ---- */

static void put(weft_synthetic_scene *scene, weft_synthetic_solid solid)
{
    if (scene->solid_count < WEFT_SYNTHETIC_SOLIDS)
        scene->solid[scene->solid_count++] = solid;
}

void weft_synthetic_scene_put_balls(weft_synthetic_scene *scene)
{
    for (int i = 0; i < WEFT_TARGET_BALL_COUNT; i++) {
        double place[2];
        weft_target_ball(&scene->sheet->target, i, place);
        weft_vec3 middle = {place[0], place[1], ball_radius};
        put(scene, (weft_synthetic_solid){middle, middle, ball_radius, true, chrome});
    }
}

void weft_synthetic_scene_put_pin(weft_synthetic_scene *scene)
{
    double place[2];
    weft_target_pin(&scene->sheet->target, place);
    weft_vec3 foot = {place[0], place[1], 0}, head = {place[0], place[1], pin_height - pin_head_radius};
    put(scene, (weft_synthetic_solid){foot, head, pin_radius, false, steel});
    put(scene, (weft_synthetic_solid){head, head, pin_head_radius, false, {0.6, 0.08, 0.07}});
}

void weft_synthetic_scene_put_hand(weft_synthetic_scene *scene, weft_vec3 middle, weft_vec3 along)
{
    weft_vec3 up = fabs(along.z) < 0.9 ? weft_vec3_of(0, 0, 1) : weft_vec3_of(0, 1, 0);
    weft_vec3 side = weft_unit(weft_cross(along, up));
    static const double finger_length[4] = {62, 72, 68, 52};
    for (int i = 0; i < 4; i++) {
        double across = (i - 1.5) * 19;
        weft_vec3 knuckle = weft_add(middle, weft_add(weft_scale(side, across), weft_scale(along, 38)));
        weft_vec3 tip =
            weft_add(knuckle, weft_add(weft_scale(along, finger_length[i]), weft_scale(side, across * 0.15)));
        weft_vec3 wrist = weft_add(middle, weft_add(weft_scale(side, across * 0.7), weft_scale(along, -45)));
        put(scene, (weft_synthetic_solid){knuckle, tip, 8.5, false, skin});
        put(scene, (weft_synthetic_solid){wrist, knuckle, 14, false, skin});
    }
    weft_vec3 root = weft_add(middle, weft_add(weft_scale(side, 36), weft_scale(along, -25)));
    weft_vec3 thumb = weft_add(root, weft_add(weft_scale(side, 35), weft_scale(along, 45)));
    put(scene, (weft_synthetic_solid){root, thumb, 10, false, skin});
    put(scene, (weft_synthetic_solid){middle, weft_add(middle, weft_scale(along, -260)), 30, false, skin});
}

static bool holds(weft_synthetic_solids solids, int i)
{
    return (solids >> i & 1) != 0;
}

weft_synthetic_solids weft_synthetic_scene_between(const weft_synthetic_scene *scene, weft_vec3 p, double reach,
                                                   weft_vec3 q, double q_reach)
{
    double wider = fmax(reach, q_reach);
    weft_synthetic_solids between = 0;
    for (int i = 0; i < scene->solid_count; i++) {
        if (weft_synthetic_solid_distance(&scene->solid[i], p, q) < scene->solid[i].radius_mm + wider)
            between |= (weft_synthetic_solids)1 << i;
    }
    return between;
}

static bool is_hidden(const weft_synthetic_scene *scene, weft_vec3 p, weft_vec3 q, weft_synthetic_solids by)
{
    for (int i = 0; i < scene->solid_count; i++) {
        if (holds(by, i) && weft_synthetic_solid_hides(&scene->solid[i], p, q))
            return true;
    }
    return false;
}

/* The first solid of `met` on a ray, or -1. */
static int first_solid(const weft_synthetic_scene *scene, weft_synthetic_solids met, weft_vec3 from, weft_vec3 along,
                       double *distance, weft_vec3 *normal)
{
    int first = -1;
    for (int i = 0; i < scene->solid_count; i++) {
        weft_vec3 at_normal;
        double t = holds(met, i) ? weft_synthetic_solid_meet(&scene->solid[i], from, along, &at_normal) : -1;
        if (t > 1e-6 && (first < 0 || t < *distance)) {
            first = i;
            *distance = t;
            *normal = at_normal;
        }
    }
    return first;
}

/* ---- Light ---- */

/* The window is far: it is one direction, and its illuminance follows from its solid angle. */
static double window_across(const weft_synthetic_scene *scene, weft_vec3 point, weft_vec3 *toward)
{
    const weft_synthetic_window *w = &scene->window;
    weft_vec3 d = weft_subtract(w->middle, point);
    double squared = weft_dot(d, d);
    *toward = weft_unit(d);
    double seen = fmax(-weft_dot(*toward, w->normal), 0);
    return w->luminance * 4 * w->half_width_mm * w->half_height_mm * seen / squared;
}

/* A mirror ball sends light of a far lamp to all sides alike: intensity = illuminance radius^2 / 4. */
static double mirrored_illuminance(const weft_synthetic_scene *scene, weft_vec3 point)
{
    double total = 0;
    for (int i = 0; i < scene->solid_count; i++) {
        const weft_synthetic_solid *s = &scene->solid[i];
        if (!s->is_mirror)
            continue;
        weft_vec3 to_lamp = weft_subtract(scene->lamp.at, s->a), d = weft_subtract(s->a, point);
        double at_ball = weft_synthetic_lamp_toward(&scene->lamp, s->a) / (weft_dot(to_lamp, to_lamp) * 1e-6);
        double squared = fmax(weft_dot(d, d), s->radius_mm * s->radius_mm);
        total +=
            s->reflectance.g * at_ball * s->radius_mm * s->radius_mm / 4 * fmax(d.z, 0) / (squared * sqrt(squared));
    }
    return total;
}

weft_rgb weft_synthetic_scene_illuminance(const weft_synthetic_scene *scene, weft_vec3 point)
{
    weft_vec3 toward;
    double lamp = weft_synthetic_lamp_illuminance(&scene->lamp, point) + mirrored_illuminance(scene, point);
    double window = window_across(scene, point, &toward);
    return weft_rgb_add(weft_rgb_scale(scene->lamp.colour, lamp), grey(window * fmax(toward.z, 0)));
}

/* 1 where the place on the lamp that chance chose sees the point past the solids of `shading`. */
static double lamp_seen(const weft_synthetic_scene *scene, weft_vec3 point, const weft_synthetic_chance *chance,
                        weft_synthetic_solids shading)
{
    double disc[2];
    if (shading == 0)
        return 1;
    weft_synthetic_disc(chance->lamp[0], chance->lamp[1], disc);
    return is_hidden(scene, point, weft_synthetic_lamp_place(&scene->lamp, point, disc), shading) ? 0 : 1;
}

static weft_rgb shade_content(const weft_synthetic_scene *scene, weft_vec3 point, weft_vec3 toward_eye,
                              const weft_synthetic_chance *chance, double seen)
{
    weft_rgb shade[2];
    double disc[2];
    weft_synthetic_disc(chance->lamp[0], chance->lamp[1], disc);
    weft_vec3 place = weft_synthetic_lamp_place(&scene->lamp, point, disc), d = weft_subtract(scene->lamp.at, point);
    weft_vec3 toward[2] = {weft_unit(weft_subtract(place, point))};
    double window = window_across(scene, point, &toward[1]);
    int lights = window > 0 && toward[1].z > 0 ? 2 : 1;
    weft_virtual_sample_shade(scene->content, point.x, point.y, toward, lights, toward_eye, chance->key, chance->index,
                              shade);
    double across = weft_synthetic_lamp_toward(&scene->lamp, point) / (weft_dot(d, d) * 1e-6);
    weft_rgb light = weft_rgb_multiply(shade[0], weft_rgb_scale(scene->lamp.colour, seen * across / WEFT_PI));
    return lights == 2 ? weft_rgb_add(light, weft_rgb_scale(shade[1], window / WEFT_PI)) : light;
}

/* The highlight of Ward (1992), isotropic, of slope 0.25: what office paper shows against the light. */
static double print_highlight(const weft_synthetic_scene *scene, weft_vec3 point, weft_vec3 toward_eye)
{
    const double slope = 0.25;
    weft_vec3 light = weft_unit(weft_subtract(scene->lamp.at, point)), half = weft_unit(weft_add(light, toward_eye));
    double cosines = light.z * toward_eye.z, tangent2 = 1 / (half.z * half.z) - 1;
    if (!(scene->gloss > 0 && light.z > 0 && toward_eye.z > 0))
        return 0;
    return scene->gloss * exp(-tangent2 / (slope * slope)) / (4 * slope * slope * sqrt(cosines));
}

static weft_rgb shade_sheet(const weft_synthetic_scene *scene, weft_vec3 point, weft_vec3 toward_eye,
                            double reflectance, double seen)
{
    weft_vec3 toward;
    double lamp = weft_synthetic_lamp_illuminance(&scene->lamp, point) * seen;
    double diffuse = reflectance * (lamp + mirrored_illuminance(scene, point));
    double shine = lamp * print_highlight(scene, point, toward_eye);
    double window = window_across(scene, point, &toward) * reflectance * fmax(toward.z, 0);
    return weft_rgb_scale(weft_rgb_add(weft_rgb_scale(scene->lamp.colour, diffuse + shine), grey(window)), 1 / WEFT_PI);
}

weft_rgb weft_synthetic_scene_shade(const weft_synthetic_scene *scene, weft_vec3 point, weft_vec3 toward_eye,
                                    const weft_synthetic_chance *chance, weft_synthetic_solids shading)
{
    double seen = lamp_seen(scene, point, chance, shading);
    double reflectance = weft_synthetic_sheet_reflectance(scene->sheet, point.x, point.y);
    if (reflectance < 0)
        return shade_content(scene, point, toward_eye, chance, seen);
    return shade_sheet(scene, point, toward_eye, reflectance, seen);
}

static weft_rgb shade_solid(const weft_synthetic_scene *scene, const weft_synthetic_solid *solid, weft_vec3 point,
                            weft_vec3 normal, const weft_synthetic_chance *chance)
{
    weft_vec3 above = weft_add(point, weft_scale(normal, 1e-3)), d = weft_subtract(scene->lamp.at, point);
    double squared = weft_dot(d, d), cosine = fmax(weft_dot(normal, d), 0) / sqrt(squared);
    double lamp = cosine > 0 ? weft_synthetic_lamp_toward(&scene->lamp, point) * cosine / (squared * 1e-6) : 0;
    if (lamp > 0)
        lamp *= lamp_seen(scene, above, chance, WEFT_SYNTHETIC_ALL_SOLIDS);
    weft_rgb light = weft_rgb_scale(scene->lamp.colour, lamp);
    /* What the sheet below sends up. */
    weft_rgb below = weft_rgb_scale(weft_synthetic_scene_illuminance(scene, weft_vec3_of(point.x, point.y, 0)),
                                    0.4 * (1 - normal.z));
    return weft_rgb_scale(weft_rgb_multiply(solid->reflectance, weft_rgb_add(light, below)), 1 / WEFT_PI);
}

static weft_rgb look_at_room(const weft_synthetic_scene *scene, weft_vec3 from, weft_vec3 along)
{
    const weft_synthetic_window *w = &scene->window;
    double toward = weft_dot(along, w->normal);
    if (toward < 0) {
        double t = weft_dot(weft_subtract(w->middle, from), w->normal) / toward;
        weft_vec3 at = weft_subtract(weft_add(from, weft_scale(along, t)), w->middle);
        double x = fabs(weft_dot(at, w->across)), y = fabs(at.z);
        bool on_bar = x < 25 || fabs(y - w->half_height_mm / 3) < 25;
        if (t > 0 && x < w->half_width_mm && y < w->half_height_mm && !on_bar)
            return grey(w->luminance);
    }
    return grey(scene->wall_luminance);
}

static weft_rgb look(const weft_synthetic_scene *scene, weft_vec3 from, weft_vec3 along,
                     const weft_synthetic_chance *chance, weft_synthetic_solids may_meet, weft_synthetic_solids shading,
                     int mirrors)
{
    double distance = INFINITY, to_plane = along.z < 0 ? -from.z / along.z : INFINITY;
    weft_vec3 normal = {0, 0, 1};
    int solid = first_solid(scene, may_meet, from, along, &distance, &normal);
    double to_lamp = weft_synthetic_lamp_meet(&scene->lamp, from, along);
    if (to_lamp > 0 && to_lamp < to_plane && (solid < 0 || to_lamp < distance))
        return weft_rgb_scale(scene->lamp.colour, weft_synthetic_lamp_luminance(&scene->lamp));
    if (solid < 0 || distance > to_plane) {
        if (!isfinite(to_plane))
            return look_at_room(scene, from, along);
        weft_vec3 point = weft_add(from, weft_scale(along, to_plane));
        return weft_synthetic_scene_shade(scene, weft_vec3_of(point.x, point.y, 0), weft_scale(along, -1), chance,
                                          shading);
    }
    weft_vec3 at = weft_add(from, weft_scale(along, distance));
    const weft_synthetic_solid *met = &scene->solid[solid];
    if (!met->is_mirror)
        return shade_solid(scene, met, at, normal, chance);
    if (mirrors == 0)
        return grey(scene->wall_luminance);
    weft_vec3 mirrored = weft_subtract(along, weft_scale(normal, 2 * weft_dot(along, normal)));
    return weft_rgb_multiply(met->reflectance, look(scene, at, mirrored, chance, WEFT_SYNTHETIC_ALL_SOLIDS,
                                                    WEFT_SYNTHETIC_ALL_SOLIDS, mirrors - 1));
}

weft_rgb weft_synthetic_scene_look(const weft_synthetic_scene *scene, weft_vec3 from, weft_vec3 along,
                                   const weft_synthetic_chance *chance, weft_synthetic_solids met,
                                   weft_synthetic_solids shading)
{
    return look(scene, from, along, chance, met, shading, 3);
}
