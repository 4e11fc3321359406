/* The mean of a weave over its tile, by its kinds of yarn. GLSL twin: reflectance/weave/weave_mean.glsl. */
#include "reflectance/weave/shader_table.h"
#include "reflectance/woven/mirror.h"

#include <stdlib.h>

enum { NODES = 12, STEPS = WEFT_WEAVE_MEAN_STEPS, WIDTH = WEFT_WEAVE_MEAN_WIDTH, HEADER = WIDTH - STEPS };

/* cos w of a place that is seen from the light and from the view is above this but by rounding. */
#define MIN_COSINE 1e-7

/* ---- The table ---- */

/* What a yarn of inclination umax has at u: its radius, and whether it is there, both times its fade. */
static void add_spine(const weft_prepared_segment *prepared, weft_real umax, weft_real u, weft_real sum[2])
{
    if (u > umax)
        return;
    weft_spine spine = weft_segment_spine(&prepared->segment, umax);
    weft_real fade = prepared->filament ? filament_fade(prepared->segment.delta, umax, u) : 1;
    sum[0] += fade * weft_filament_radius(prepared, &spine, u, sin(u), cos(u));
    sum[1] += fade;
}

static void fill_spine(const weft_prepared_segment *prepared, const weft_real *umax, int count, weft_real largest,
                       float (*step)[4])
{
    for (int i = 0; i <= STEPS; i++) {
        weft_real sum[2] = {0};
        for (int k = 0; k < count; k++)
            add_spine(prepared, umax[k], largest * (weft_real)i / STEPS, sum);
        for (int c = 0; c < 2; c++) {
            float mean = (float)(sum[c] / (weft_real)count);
            if (i < STEPS)
                step[i][c] = mean;
            if (i > 0)
                step[i - 1][2 + c] = mean;
        }
    }
}

/* F times a colour, over the yarns that `kind` stands for; kind < 0: over all. */
static void put_colour(const weft_weave *weave, int kind, float texel[4])
{
    weft_rgb sum = {0};
    for (int i = 0; i < weave->yarn_count; i++) {
        const weft_yarn *yarn = &weave->yarn[i];
        weft_real weight =
            yarn->cell_fraction * (kind < 0 ? 1 / (weft_real)WEFT_PI : yarn->area_weight * weave->specular_scale);
        const weft_rgb *colour = kind < 0 ? &yarn->kd : &yarn->ks;
        if (kind >= 0 && yarn->alike != kind)
            continue;
        sum = (weft_rgb){sum.r + weight * colour->r, sum.g + weight * colour->g, sum.b + weight * colour->b};
    }
    texel[0] = (float)sum.r;
    texel[1] = (float)sum.g;
    texel[2] = (float)sum.b;
}

static void put_kind(const weft_weave *weave, int kind, bool noisy, float (*row)[4])
{
    const weft_yarn *yarn = &weave->yarn[kind];
    weft_real umax[WEFT_WEAVE_OFFSETS] = {0}, largest = 0;
    int count = noisy ? WEFT_WEAVE_OFFSETS : 1;
    if (noisy)
        weft_weave_umax_offsets(weave, kind, umax);
    for (int k = 0; k < count; k++) {
        umax[k] = yarn->segment.umax + umax[k];
        largest = fmax(largest, umax[k]);
    }
    const weft_prepared_segment *prepared = &yarn->prepared;
    const weft_spine *spine = &prepared->spine;
    put_colour(weave, kind, row[0]);
    row[0][3] = yarn->warp;
    put_colour(weave, -1, row[1]);
    if (!yarn->admissible)
        return;
    const weft_real value[3][4] = {
        {prepared->segment.alpha, prepared->segment.beta, prepared->phase_scale, prepared->segment.width / 2},
        {prepared->cot_psi, prepared->inverse_sin_psi, spine->shape * fabs(spine->shape), spine->scale},
        {sin(largest), cos(largest), largest}};
    for (int i = 0; i < 12; i++)
        row[2 + i / 4][i % 4] = (float)value[i / 4][i % 4];
    fill_spine(prepared, umax, count, largest, row + HEADER);
}

weft_code weft_weave_means_of(const weft_weave *weave, bool noisy, weft_weave_means *means, weft_error *error)
{
    *means = (weft_weave_means){.noisy = noisy};
    for (int k = 0; k < weave->yarn_count; k++)
        means->kinds += weave->yarn[k].alike == k;
    means->texel = calloc((size_t)means->kinds * WIDTH, sizeof *means->texel);
    if (!means->texel)
        return weft_fail_memory(error, "mean of a weave", (size_t)means->kinds * WIDTH * sizeof *means->texel);
    for (int k = 0, row = 0; k < weave->yarn_count; k++)
        if (weave->yarn[k].alike == k) {
            bool shines = weave->yarn[k].admissible, filament = weave->yarn[k].prepared.filament;
            means->has_staples = means->has_staples || (shines && !filament);
            means->has_filaments = means->has_filaments || (shines && filament);
            put_kind(weave, k, noisy, means->texel + WIDTH * (size_t)row++);
        }
    return WEFT_OK;
}

void weft_weave_means_free(weft_weave_means *means)
{
    free(means->texel);
    *means = (weft_weave_means){0};
}

/* ---- The integrals ---- */

/* What the yarns of a row have in common. */
typedef struct yarn_kind {
    const float (*row)[4];
    bool noisy;
    weft_real umax, alpha, beta, phase_scale, radius, cot_psi, inverse_sin_psi, shape_squared, scale, sin_umax,
        cos_umax;
} yarn_kind;

static yarn_kind kind_of(const weft_weave_means *means, int index)
{
    const float(*row)[4] = (const float(*)[4])(means->texel + WIDTH * (size_t)index);
    return (yarn_kind){row,
                       means->noisy,
                       (weft_real)row[4][2],
                       (weft_real)row[2][0],
                       (weft_real)row[2][1],
                       (weft_real)row[2][2],
                       (weft_real)row[2][3],
                       (weft_real)row[3][0],
                       (weft_real)row[3][1],
                       (weft_real)row[3][2],
                       (weft_real)row[3][3],
                       (weft_real)row[4][0],
                       (weft_real)row[4][1]};
}

typedef struct mean_spine {
    weft_real radius, share;
} mean_spine;

static mean_spine spine_at(const yarn_kind *kind, weft_real u)
{
    weft_real at = fmin(fabs(u) / kind->umax, 1) * STEPS;
    int step = at < STEPS ? (int)at : STEPS - 1;
    const float *ends = kind->row[HEADER + step];
    weft_real part = at - (weft_real)step;
    return (mean_spine){(weft_real)ends[0] + part * (weft_real)(ends[2] - ends[0]),
                        (weft_real)ends[1] + part * (weft_real)(ends[3] - ends[1])};
}

static mean_spine staple_spine(const yarn_kind *kind, weft_real sine, weft_real cosine)
{
    if (kind->noisy)
        return spine_at(kind, atan2(sine, cosine));
    weft_real e = fmax(cosine * cosine + kind->shape_squared * sine * sine, (weft_real)MIN_COSINE);
    return (mean_spine){kind->scale / (e * sqrt(e)), 1};
}

/* Of umax + u, and 1 from a right angle on; |u| is below one. */
static weft_real sine_up_to_1(const yarn_kind *kind, weft_real sin_u, weft_real cos_u)
{
    bool acute = kind->cos_umax * cos_u > kind->sin_umax * sin_u;
    return acute ? kind->sin_umax * cos_u + kind->cos_umax * sin_u : 1;
}

/* Along the yarn, by the sine of x = u - u0, where H lies across at u0. The midpoint rule in theta, sin x = middle -
 * half cos(theta), from one end of the highlight to the other: the integrand begins like a square root there. */
static weft_real staple_mean(const yarn_kind *kind, weft_vec3 half, weft_vec3 light, weft_vec3 view)
{
    weft_real across = sqrt(half.y * half.y + half.z * half.z), sum = 0;
    weft_real reach = fmin(weft_length(half) / (kind->inverse_sin_psi * across), 1);
    weft_real sin_u0 = half.y / across, cos_u0 = half.z / across;
    weft_real low = fmax(-reach, -sine_up_to_1(kind, sin_u0, cos_u0));
    weft_real high = fmin(reach, sine_up_to_1(kind, -sin_u0, cos_u0));
    for (int i = 0; low < high && i < NODES; i++) {
        weft_real theta = ((weft_real)i + (weft_real)0.5) * (weft_real)(WEFT_PI / NODES);
        weft_real sin_x = (low + high) / 2 - (high - low) / 2 * cos(theta);
        weft_real cos_x = sqrt(fmax(1 - sin_x * sin_x, (weft_real)MIN_COSINE));
        weft_mirror at = {.sin_u = sin_u0 * cos_x + cos_u0 * sin_x, .cos_u = cos_u0 * cos_x - sin_u0 * sin_x};
        if (!staple_mirror(kind->cot_psi, half.x, -across * sin_x, across * cos_x, &at) ||
            !faces_both(&at, light, view))
            continue;
        mean_spine spine = staple_spine(kind, at.sin_u, at.cos_u);
        sum += sin(theta) / cos_x * (spine.radius + kind->radius * spine.share * at.cos_v) *
               (at.light_share * at.view_share);
    }
    return sum * (weft_real)(WEFT_PI / NODES) * (high - low) / 2 * kind->radius * kind->inverse_sin_psi;
}

/* An angle round the yarn, from its normal. */
typedef struct round_angle {
    weft_real sine, cosine;
} round_angle;

static round_angle sum_of(round_angle a, round_angle b)
{
    return (round_angle){a.sine * b.cosine + a.cosine * b.sine, a.cosine * b.cosine - a.sine * b.sine};
}

static round_angle difference_of(round_angle a, round_angle b)
{
    return sum_of(a, (round_angle){-b.sine, b.cosine});
}

static round_angle angle_of(weft_real x, weft_real z, weft_real *length)
{
    *length = fmax(sqrt(x * x + z * z), (weft_real)WEFT_MIN_ACROSS);
    return (round_angle){x / *length, z / *length};
}

/* tan(pi/4 + w/2), whose logarithm is the integral of 1 / cos w. */
static weft_real secant_growth(round_angle w)
{
    weft_real cosine = fmax(w.cosine, (weft_real)MIN_COSINE);
    return w.sine >= 0 ? (1 + w.sine) / cosine : cosine / (1 - w.sine);
}

/* The antiderivatives but for their terms in w and its logarithms. */
static void add_end(round_angle w, round_angle turn, round_angle middle, weft_real sign, weft_real sum[2])
{
    round_angle once = sum_of(w, turn), twice = sum_of(sum_of(w, w), sum_of(middle, turn));
    sum[0] += sign * once.sine;
    sum[1] += sign * twice.sine / 4;
}

/* Integrals round the yarn of c1 c2 / (c1 + c2) and of that times cos v, over the v that face both directions, but for
 * the lengths of l, m and h. With w = v - h, a = h - l, b = h - m it is c1 = cos(w + a), c2 = cos(w + b), c1 + c2 = cos
 * w, and c1 c2 / (c1 + c2) = cos(w + a + b) + sin a sin b / cos w. */
static void integrate_round(round_angle l, round_angle m, round_angle h, weft_real sum[2])
{
    bool l_is_less = difference_of(l, m).sine <= 0;
    round_angle least = l_is_less ? l : m, greatest = l_is_less ? m : l;
    round_angle high = least.sine >= 0 ? (round_angle){1, 0} : (round_angle){least.cosine, -least.sine};
    round_angle low = greatest.sine <= 0 ? (round_angle){-1, 0} : (round_angle){-greatest.cosine, greatest.sine};
    round_angle range = difference_of(high, low), a = difference_of(h, l), b = difference_of(h, m), turn = sum_of(a, b);
    sum[0] = sum[1] = 0;
    if (!(range.sine >= 0))
        return;
    weft_real width = atan2(range.sine, range.cosine), both = a.sine * b.sine;
    round_angle first = difference_of(low, h), last = difference_of(high, h);
    add_end(last, turn, h, 1, sum);
    add_end(first, turn, h, -1, sum);
    weft_real ratio = fmax(last.cosine, (weft_real)MIN_COSINE) / fmax(first.cosine, (weft_real)MIN_COSINE);
    sum[0] += both * log(secant_growth(last) / secant_growth(first));
    sum[1] += width * (difference_of(h, turn).cosine / 2 + both * h.cosine) + both * h.sine * log(ratio);
}

static weft_real filament_mean(const yarn_kind *kind, weft_vec3 half, weft_vec3 light, weft_vec3 view)
{
    weft_mirror at = {0};
    weft_real across = filament_mirror(half, &at), u = atan2(half.y, half.z), length[3], sum[2];
    if (!(across > 0 && fabs(u) < kind->umax))
        return 0;
    round_angle l = angle_of(light.x, light.y * at.sin_u + light.z * at.cos_u, &length[0]);
    round_angle m = angle_of(view.x, view.y * at.sin_u + view.z * at.cos_u, &length[1]);
    round_angle h = angle_of(half.x, across, &length[2]);
    integrate_round(l, m, h, sum);
    mean_spine spine = spine_at(kind, u);
    weft_real value = kind->radius * (spine.radius * sum[0] + kind->radius * spine.share * sum[1]);
    return fmax(value * length[0] * length[1] / (length[2] * across), 0);
}

static weft_real phase_of(const yarn_kind *kind, weft_vec3 light, weft_vec3 view)
{
    weft_real x = weft_clamp(-weft_dot(light, view), -1, 1);
    return kind->alpha + exp(kind->beta * x - fabs(kind->beta)) * kind->phase_scale;
}

weft_rgb weft_weave_tabulated_mean(const weft_weave_means *means, weft_vec3 light, weft_vec3 view)
{
    weft_vec3 half;
    if (!half_vector(light, view, &half))
        return (weft_rgb){0};
    const float *diffuse = means->texel[1];
    weft_rgb sum = {(weft_real)diffuse[0], (weft_real)diffuse[1], (weft_real)diffuse[2]};
    for (int k = 0; k < means->kinds; k++) {
        const yarn_kind kind = kind_of(means, k);
        const float *colour = kind.row[0];
        if (!(kind.umax > 0))
            continue;
        weft_vec3 d[3] = {half, light, view};
        for (int i = 0; i < 3 && !(colour[3] > 0); i++)
            d[i] = weft_vec3_of(-d[i].y, d[i].x, d[i].z);
        weft_real value =
            kind.inverse_sin_psi == 0 ? filament_mean(&kind, d[0], d[1], d[2]) : staple_mean(&kind, d[0], d[1], d[2]);
        value *= phase_of(&kind, light, view);
        sum.r += (weft_real)colour[0] * value;
        sum.g += (weft_real)colour[1] * value;
        sum.b += (weft_real)colour[2] * value;
    }
    return sum;
}
