#include "btf/dataset/measured.h"

#include <errno.h>
#include <math.h>

static const double tolerance_rad = WEFT_PI / 360;

/* Where the half vector lies this close to the normal, gloss hides the colours. */
static const double glare_rad = 15 * WEFT_PI / 180;

typedef struct image_directions {
    weft_vec3 light, view;
} image_directions;

static image_directions directions_of(const weft_dataset_layout *layout, int image)
{
    return (image_directions){weft_unit(layout->light[image]), weft_unit(layout->view[layout->view_of_image[image]])};
}

static void widen(weft_cone *cone, weft_vec3 direction)
{
    cone->angle_rad = fmax(cone->angle_rad, acos(weft_clamp(weft_dot(cone->axis, direction), -1, 1)));
}

/* From the corners a near light or camera stands elsewhere than from the middle. */
static void widen_to_corners(const weft_dataset_layout *layout, int image, weft_measured *measured)
{
    for (int corner = 0; corner < 4; corner++) {
        int x = corner % 2 ? layout->width - 1 : 0, y = corner / 2 ? layout->height - 1 : 0;
        widen(&measured->light, weft_dataset_light_direction(layout, image, x, y));
        widen(&measured->view, weft_dataset_view_direction(layout, layout->view_of_image[image], x, y));
    }
}

/* The image whose light and view are nearest the means; one that glares only where all do. */
static void choose_first(const weft_dataset_layout *layout, weft_measured *measured)
{
    double best = -INFINITY;
    for (int i = 0; i < layout->image_count; i++) {
        image_directions d = directions_of(layout, i);
        bool glares = weft_unit(weft_add(d.light, d.view)).z > cos(glare_rad);
        double near = weft_dot(d.light, measured->light.axis) + weft_dot(d.view, measured->view.axis) - 4 * glares;
        if (!(near > best))
            continue;
        best = near;
        measured->first_light = d.light;
        measured->first_view = d.view;
    }
}

weft_measured weft_measured_of(const weft_dataset_layout *layout)
{
    weft_measured measured = {0};
    for (int i = 0; i < layout->image_count; i++) {
        image_directions d = directions_of(layout, i);
        measured.light.axis = weft_add(measured.light.axis, d.light);
        measured.view.axis = weft_add(measured.view.axis, d.view);
    }
    measured.light.axis = weft_unit(measured.light.axis);
    measured.view.axis = weft_unit(measured.view.axis);
    for (int i = 0; i < layout->image_count; i++)
        widen_to_corners(layout, i, &measured);
    choose_first(layout, &measured);
    return measured;
}

bool weft_cone_holds(const weft_cone *cone, weft_vec3 direction)
{
    return weft_dot(cone->axis, weft_unit(direction)) >= cos(fmin(WEFT_PI, cone->angle_rad + tolerance_rad));
}

json_t *weft_measured_pack(const weft_measured *m)
{
    return json_pack("{s:[ffff], s:[ffff], s:[fff], s:[fff]}", "view", m->view.axis.x, m->view.axis.y, m->view.axis.z,
                     m->view.angle_rad * 180 / WEFT_PI, "light", m->light.axis.x, m->light.axis.y, m->light.axis.z,
                     m->light.angle_rad * 180 / WEFT_PI, "first_view", m->first_view.x, m->first_view.y,
                     m->first_view.z, "first_light", m->first_light.x, m->first_light.y, m->first_light.z);
}

static bool is_direction(weft_vec3 direction)
{
    return fabs(weft_length(direction) - 1) < 1e-3 && direction.z >= 0;
}

weft_code weft_measured_parse(const char *metadata, bool *known, weft_measured *measured, weft_error *error)
{
    weft_measured m = {0};
    *known = false;
    errno = 0;
    json_t *object = metadata ? json_loads(metadata, 0, NULL) : NULL, *own = json_object_get(object, "measured");
    bool is_short = metadata && !object && errno == ENOMEM;
    errno = 0; /* jansson allocates to unpack, too */
    bool says =
        own && json_unpack(own, "{s:[FFFF], s:[FFFF], s:[FFF], s:[FFF]}", "view", &m.view.axis.x, &m.view.axis.y,
                           &m.view.axis.z, &m.view.angle_rad, "light", &m.light.axis.x, &m.light.axis.y,
                           &m.light.axis.z, &m.light.angle_rad, "first_view", &m.first_view.x, &m.first_view.y,
                           &m.first_view.z, "first_light", &m.first_light.x, &m.first_light.y, &m.first_light.z) == 0;
    is_short = is_short || (own && !says && errno == ENOMEM);
    json_decref(object);
    if (is_short)
        return weft_fail_memory(error, "metadata", strlen(metadata));
    m.view.angle_rad *= WEFT_PI / 180;
    m.light.angle_rad *= WEFT_PI / 180;
    *measured = m;
    *known = says && is_direction(m.view.axis) && is_direction(m.light.axis) && is_direction(m.first_view) &&
             is_direction(m.first_light);
    return WEFT_OK;
}
