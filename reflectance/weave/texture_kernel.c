/* weft_prepared_texture for a vector of points: both kinds of yarn are evaluated where the weave has them, and masked.
 */
#include "reflectance/weave/batch_kernels.h"
#include "reflectance/weave/mirror_lanes.h"

/* One evaluation a lane, in the frame of its segment. */
typedef struct lane_segment {
    lanes alpha, beta, delta, kappa, width, length, highlight_width, cot_psi, inverse_sin_psi, phase_scale;
    lanes umax, radius_share, x, y;
    lane_vec3 light, view, half;
} lane_segment;

/* fc for x = -light . view. */
WEFT_INLINE lanes phase(const lane_segment *s)
{
    const float log2_e = 1.44269504f;
    lanes x = lanes_max(lanes_min(-lanes_dot(s->light, s->view), lanes_of(1)), lanes_of(-1));
    lanes exponent = log2_e * (s->beta * x - lanes_abs(s->beta));
    return s->alpha + lanes_exp2(lanes_max(exponent, lanes_of(-126))) * s->phase_scale;
}

/* Whether `x` lies in the band of `width` that shows the highlight at `centre`, kept whole within the rectangle. */
WEFT_INLINE lane_bits inside_band(lanes x, lanes centre, lanes width, lanes rectangle)
{
    lanes limit = 0.5f * (rectangle - width);
    return lanes_abs(x - lanes_max(lanes_min(centre, limit), -limit)) < 0.5f * width;
}

WEFT_INLINE lanes staple_texture(const lane_segment *s)
{
    lane_mirror at;
    lanes u = 2 * s->umax * s->y / s->length;
    at.sin_u = lanes_sin(u);
    at.cos_u = lanes_cos(u);
    lanes along = s->half.y * at.cos_u - s->half.z * at.sin_u, across = s->half.y * at.sin_u + s->half.z * at.cos_u;
    lane_bits lit = lanes_staple_mirror(s->cot_psi, s->half.x, along, across, &at);
    lit &= lanes_faces_both(&at, s->light, s->view);
    lanes centre = s->width * (lanes_atan(at.sin_v, at.cos_v) * (1 / WEFT_LANE_PI));
    lit &= inside_band(s->x, centre, s->highlight_width * s->width, s->width);
    lane_spine spine = lanes_spine(s->kappa, s->width, s->length, s->umax);
    lanes radius = lanes_spine_radius(s->kappa, &spine, s->umax - lanes_abs(u), at.sin_u, at.cos_u);
    lanes integrand =
        lanes_yarn_area(s->width, radius, at.cos_v) * s->inverse_sin_psi * (at.light_share * at.view_share) * phase(s);
    return lanes_where(lit, 2 * s->umax * integrand / s->highlight_width);
}

WEFT_INLINE lanes fade(lanes delta, lanes umax, lanes u)
{
    lanes inside = (umax - lanes_abs(u)) / (delta * umax);
    inside = lanes_max(lanes_min(inside, lanes_of(1)), lanes_of(0));
    return lanes_select(delta > 0.0f, inside * inside * (3 - 2 * inside), lanes_of(1));
}

/* R of a spine that ends at radius_share umax, constant beyond. */
WEFT_INLINE lanes filament_radius(const lane_segment *s, lanes u)
{
    lanes end = lanes_max(s->umax * s->radius_share, lanes_of((float)WEFT_SEGMENT_MIN_UMAX));
    lanes at = lanes_min(lanes_abs(u), end);
    lane_spine spine = lanes_spine(s->kappa, s->width, s->length, end);
    return lanes_spine_radius(s->kappa, &spine, end - at, lanes_sin(at), lanes_cos(at));
}

WEFT_INLINE lanes filament_texture(const lane_segment *s)
{
    lanes across = lanes_sqrt(s->half.y * s->half.y + s->half.z * s->half.z);
    lane_mirror at = {.sin_u = s->half.y / across, .cos_u = s->half.z / across};
    lanes u = lanes_atan(s->half.y, s->half.z);
    lane_bits lit = (across > (float)WEFT_MIN_ACROSS) & (lanes_abs(u) < s->umax);
    lanes centre = s->length * (u / (2 * s->umax));
    lit &= inside_band(s->y, centre, s->highlight_width * s->length, s->length);
    lanes v = WEFT_LANE_PI * (s->x / s->width);
    at.sin_v = lanes_sin(v);
    at.cos_v = lanes_cos(v);
    lit &= lanes_faces_both(&at, s->light, s->view);
    lanes radius = filament_radius(s, u);
    lanes attenuation = at.light_share * at.view_share * at.cosine_sum * fade(s->delta, s->umax, u);
    lanes integrand = lanes_yarn_area(s->width, radius, at.cos_v) / across * attenuation * phase(s);
    return lanes_where(lit, WEFT_LANE_PI * integrand / s->highlight_width);
}

/* Of the cloth into the frame of a warp or weft segment. */
WEFT_INLINE lane_vec3 in_segment(lane_bits warp, const weft_batch_directions *of, int i)
{
    lanes x = lanes_load(of->x + i), y = lanes_load(of->y + i);
    return (lane_vec3){lanes_select(warp, x, -y), lanes_select(warp, y, x), lanes_load(of->z + i)};
}

WEFT_INLINE lane_segment gather(const weft_woven_table *table, const weft_weave_batch *batch, lane_bits yarn, int i)
{
    float *const *column = table->column;
    lane_bits warp = lanes_gather(column[WEFT_WOVEN_WARP], yarn) > 0.0f;
    lane_segment s = {.alpha = lanes_gather(column[WEFT_WOVEN_ALPHA], yarn),
                      .beta = lanes_gather(column[WEFT_WOVEN_BETA], yarn),
                      .delta = lanes_gather(column[WEFT_WOVEN_DELTA], yarn),
                      .kappa = lanes_gather(column[WEFT_WOVEN_KAPPA], yarn),
                      .width = lanes_gather(column[WEFT_WOVEN_WIDTH], yarn),
                      .length = lanes_gather(column[WEFT_WOVEN_LENGTH], yarn),
                      .highlight_width = lanes_gather(column[WEFT_WOVEN_HIGHLIGHT_WIDTH], yarn),
                      .cot_psi = lanes_gather(column[WEFT_WOVEN_COT_PSI], yarn),
                      .inverse_sin_psi = lanes_gather(column[WEFT_WOVEN_INVERSE_SIN_PSI], yarn),
                      .phase_scale = lanes_gather(column[WEFT_WOVEN_PHASE_SCALE], yarn),
                      .radius_share = lanes_gather(column[WEFT_WOVEN_RADIUS_SHARE], yarn),
                      .light = in_segment(warp, &batch->light, i),
                      .view = in_segment(warp, &batch->view, i)};
    s.x = lanes_load(batch->x + i);
    s.y = lanes_load(batch->y + i);
    s.umax = lanes_gather(column[WEFT_WOVEN_UMAX], yarn) + lanes_load(batch->umax_offset_rad + i);
    s.umax = lanes_min(s.umax, lanes_of(WEFT_LANE_HALF_PI));
    s.half = (lane_vec3){s.light.x + s.view.x, s.light.y + s.view.y, s.light.z + s.view.z};
    return s;
}

WEFT_INLINE lane_bits on_segment(const lane_segment *s)
{
    return (s->light.z > 0.0f) & (s->view.z > 0.0f) & (lanes_dot(s->half, s->half) >= (float)WEFT_MIN_HALF_SQUARED) &
           (lanes_abs(s->x) <= 0.5f * s->width) & (lanes_abs(s->y) <= 0.5f * s->length);
}

void WEFT_KERNEL(weft_woven_texture)(const weft_woven_table *table, weft_weave_batch *batch)
{
    for (int i = 0; i < batch->count; i += LANES) {
        lane_bits yarn = lane_bits_load(batch->yarn + i);
        lane_segment s = gather(table, batch, yarn, i);
        lanes texture = lanes_of(0);
        if (table->any_staple)
            texture += lanes_where(lanes_gather(table->column[WEFT_WOVEN_STAPLE], yarn) > 0.0f, staple_texture(&s));
        if (table->any_filament)
            texture += lanes_where(lanes_gather(table->column[WEFT_WOVEN_FILAMENT], yarn) > 0.0f, filament_texture(&s));
        lanes weight = lanes_gather(table->column[WEFT_WOVEN_AREA_WEIGHT], yarn) * lanes_load(batch->intensity + i);
        lanes_store(batch->specular + i, weight * lanes_where(on_segment(&s), texture));
    }
}
