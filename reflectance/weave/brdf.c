#include "reflectance/weave/weave.h"

/* A direction of the cloth in the frame of a segment. */
static weft_vec3 in_segment(const weft_yarn *yarn, weft_vec3 d)
{
    return yarn->warp ? d : weft_vec3_of(-d.y, d.x, d.z);
}

static bool above_horizon(weft_vec3 light, weft_vec3 view)
{
    return light.z > 0 && view.z > 0;
}

weft_rgb weft_weave_shade(const weft_weave *weave, const weft_yarn *yarn, weft_real specular)
{
    const weft_real diffuse = 1 / (weft_real)WEFT_PI, scale = weave->specular_scale * specular;
    return (weft_rgb){yarn->kd.r * diffuse + yarn->ks.r * scale, yarn->kd.g * diffuse + yarn->ks.g * scale,
                      yarn->kd.b * diffuse + yarn->ks.b * scale};
}

weft_real weft_weave_specular(const weft_weave *weave, const weft_weave_point *point, weft_vec3 light, weft_vec3 view)
{
    const weft_yarn *yarn = &weave->yarn[point->yarn];
    weft_real umax = yarn->segment.umax + point->umax_offset_rad;
    weft_real texture = weft_prepared_texture(&yarn->prepared, umax, point->x, point->y, in_segment(yarn, light),
                                              in_segment(yarn, view));
    return point->intensity * yarn->area_weight * texture;
}

weft_rgb weft_weave_brdf(const weft_weave *weave, const weft_weave_point *point, weft_vec3 light, weft_vec3 view)
{
    if (!above_horizon(light, view))
        return (weft_rgb){0};
    return weft_weave_shade(weave, &weave->yarn[point->yarn], weft_weave_specular(weave, point, light, view));
}

enum { RECENT = 8 };

/* aw f_s of the kinds of yarn met last. */
typedef struct recent_values {
    int kind[RECENT];
    weft_real value[RECENT];
    int next;
} recent_values;

static recent_values no_values(void)
{
    return (recent_values){.kind = {-1, -1, -1, -1, -1, -1, -1, -1}};
}

static weft_real mean_specular_of(const weft_weave *weave, int index, recent_values *recent, weft_vec3 light,
                                  weft_vec3 view)
{
    const weft_yarn *yarn = &weave->yarn[index];
    if (!(yarn->area_weight * yarn->cell_fraction > 0))
        return 0;
    for (int i = 0; i < RECENT; i++)
        if (recent->kind[i] == yarn->alike)
            return recent->value[i];
    weft_real value =
        yarn->area_weight * weft_prepared_reflectance(&yarn->prepared, in_segment(yarn, light), in_segment(yarn, view));
    recent->kind[recent->next] = yarn->alike;
    recent->value[recent->next] = value;
    recent->next = (recent->next + 1) % RECENT;
    return value;
}

weft_real weft_weave_mean_specular(const weft_weave *weave, weft_vec3 light, weft_vec3 view)
{
    weft_real sum = 0;
    recent_values recent = no_values();
    for (int i = 0; i < weave->yarn_count; i++)
        sum += weave->yarn[i].cell_fraction * mean_specular_of(weave, i, &recent, light, view);
    return sum;
}

weft_rgb weft_weave_mean_brdf(const weft_weave *weave, weft_vec3 light, weft_vec3 view)
{
    weft_rgb sum = {0};
    recent_values recent = no_values();
    if (!above_horizon(light, view))
        return sum;
    for (int i = 0; i < weave->yarn_count; i++) {
        const weft_yarn *yarn = &weave->yarn[i];
        weft_rgb value = weft_weave_shade(weave, yarn, mean_specular_of(weave, i, &recent, light, view));
        sum.r += yarn->cell_fraction * value.r;
        sum.g += yarn->cell_fraction * value.g;
        sum.b += yarn->cell_fraction * value.b;
    }
    return sum;
}
