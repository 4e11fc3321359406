#include "registration/photographs/steps.h"

#include "btf/dataset/dataset.h"
#include "registration/lamp/evidence.h"

#include <math.h>

/* Radius over distance of the largest lamp that is believed, with how far its place may be off; and of a lens. */
static const double lamp_softness = 0.03, eye_softness = 0.01;

/* A body that stands on the sheet: all within `radius` of the upright line from `foot` to `top`. */
typedef struct body {
    weft_vec3 foot;
    double top, radius;
} body;

enum { MOST_BODIES = WEFT_TARGET_BALL_COUNT + 1 };

static int bodies_of(const weft_photographs_settings *settings, body bodies[MOST_BODIES])
{
    int count = 0;
    double place[2], radius = 0.5 * settings->ball_diameter_mm;
    for (int i = 0; i < WEFT_TARGET_BALL_COUNT && radius > 0; i++) {
        weft_target_ball(&settings->target, i, place);
        bodies[count++] = (body){weft_vec3_of(place[0], place[1], radius), radius, radius};
    }
    if (settings->pin_height_mm > 0) {
        weft_target_pin(&settings->target, place);
        bodies[count++] = (body){weft_vec3_of(place[0], place[1], 0),
                                 fmax(0, settings->pin_height_mm - weft_pin_head_radius_mm), weft_pin_head_radius_mm};
    }
    return count;
}

/* Whether the way from a texel to a place above the sheet passes the body so near. Of the way, only the height and the
 * foot of the nearest point matter: the body is upright. */
static bool is_hidden_by(const body *from, weft_vec3 texel, weft_vec3 to, double softness)
{
    weft_vec3 way = weft_subtract(to, texel), aside = weft_subtract(from->foot, texel);
    double flat = way.x * way.x + way.y * way.y, length = weft_length(way);
    double t = flat > 0 ? weft_clamp((way.x * aside.x + way.y * aside.y) / flat, 0, 1) : 0;
    if (texel.z + t * way.z > from->top || texel.z + t * way.z < from->foot.z) {
        /* Beside that height the nearest point of the body is one of its ends. */
        double end = texel.z + t * way.z > from->top ? from->top : from->foot.z;
        weft_vec3 to_end = weft_subtract(weft_vec3_of(from->foot.x, from->foot.y, end), texel);
        t = weft_clamp(weft_dot(way, to_end) / (length * length), 0, 1);
    }
    weft_vec3 at = weft_add(texel, weft_scale(way, t));
    double height = weft_clamp(at.z, from->foot.z, from->top);
    double distance = weft_length(weft_subtract(at, weft_vec3_of(from->foot.x, from->foot.y, height)));
    return distance < from->radius + softness * t * length;
}

void weft_photographs_mask_hidden(const weft_photographs_settings *settings, weft_vec3 lamp, weft_vec3 eye,
                                  uint8_t *mask, long *hidden_texels)
{
    body bodies[MOST_BODIES];
    int count = bodies_of(settings, bodies);
    double side = settings->target.opening_mm;
    *hidden_texels = 0;
    for (int y = 0; y < settings->height; y++) {
        for (int x = 0; x < settings->width; x++) {
            weft_vec3 texel = weft_vec3_of(((x + 0.5) / settings->width - 0.5) * side,
                                           (0.5 - (y + 0.5) / settings->height) * side, 0);
            bool hidden = false;
            for (int i = 0; i < count && !hidden; i++)
                hidden = is_hidden_by(&bodies[i], texel, lamp, lamp_softness) ||
                         is_hidden_by(&bodies[i], texel, eye, eye_softness);
            if (!hidden)
                continue;
            uint8_t *to = &mask[(long)y * settings->width + x];
            *hidden_texels += *to == 0;
            *to |= WEFT_MASK_MISSING;
        }
    }
}
