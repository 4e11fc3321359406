/* weft_prepared_reflectance within 1e-3: the places of a 15-point Gauss-Kronrod rule are the lanes. The integrals, cuts
 * and substitutions are those of reflectance/woven/integral.c, but for the kinks where the yarn turns away from a
 * direction, which halving finds. */
#include "reflectance/weave/batch_kernels.h"
#include "reflectance/weave/mirror_lanes.h"

enum { NODES = 16, MAX_PANELS = 24, MAX_CUTS = 16 };

/* Error of the Gauss rule, relative to the integral, at which the Kronrod rule is trusted. */
static const float trusted = 3e-4f;

/* From this shape on the vertex of an ellipse is a peak. */
#define WIDE_ELLIPSE 2

/* Of theta / 2: kinks inside such a panel do not matter. */
#define NARROW 2e-3f

#define ALIGNED _Alignas(64) static const float

/* Nodes and weights on [-1, 1] (see quadrature.c); the last place is unused. */
ALIGNED node[NODES] = {
    -0.991455371f, -0.949107912f, -0.864864423f, -0.741531186f, -0.586087235f, -0.405845151f, -0.207784955f, 0,
    0.207784955f,  0.405845151f,  0.586087235f,  0.741531186f,  0.864864423f,  0.949107912f,  0.991455371f,  0};
ALIGNED kronrod_weight[NODES] = {
    0.0229353220f, 0.0630920926f, 0.104790010f, 0.140653260f, 0.169004727f, 0.190350578f,  0.204432940f,  0.209482141f,
    0.204432940f,  0.190350578f,  0.169004727f, 0.140653260f, 0.104790010f, 0.0630920926f, 0.0229353220f, 0};
ALIGNED gauss_weight[NODES] = {0, 0.129484966f, 0, 0.279705391f, 0, 0.381830051f, 0, 0.417959184f,
                               0, 0.381830051f, 0, 0.279705391f, 0, 0.129484966f, 0, 0};

ALIGNED counting[NODES] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};

/* What both kinds of integrand depend on. */
typedef struct integral {
    lane_vec3 light, view;
    lanes kappa, width;
    lane_spine spine;
    /* Staple: t = u - u0 where from_u0, else u; the whole yarn is range_low..range_high in t. */
    lanes cot_psi, half_x, across, u0;
    float range_low, range_high;
    bool from_u0, filament;
    /* Filament: the mirroring inclination. */
    lanes sin_u, cos_u, radius;
} integral;

/* A piece without cuts inside: t = middle - half cos(theta), 0 <= theta <= pi. */
typedef struct piece {
    float low, high;
} piece;

/* sin and cos of x, |x| <= pi. */
WEFT_INLINE void turn(lanes x, lanes *sine, lanes *cosine)
{
    lane_bits far = lanes_abs(x) > WEFT_LANE_HALF_PI;
    lanes near = lanes_select(far, lanes_sign_of(x, WEFT_LANE_PI - lanes_abs(x)), x);
    *sine = lanes_sin(near);
    *cosine = lanes_select(far, -lanes_cos(near), lanes_cos(near));
}

/* `*lit` tells where the yarn faces both directions. */
WEFT_INLINE lanes staple_integrand(const integral *q, const piece *p, lanes t, lanes from_low, lanes to_high,
                                   lane_bits *lit)
{
    lane_mirror at;
    lanes u = q->from_u0 ? q->u0 + t : t, x = q->from_u0 ? t : t - q->u0, sine, cosine;
    u = lanes_max(lanes_min(u, q->spine.umax), -q->spine.umax);
    at.sin_u = lanes_sin(u);
    at.cos_u = lanes_cos(u);
    turn(x, &sine, &cosine);
    *lit = lanes_staple_mirror(q->cot_psi, q->half_x, -q->across * sine, q->across * cosine, &at);
    *lit &= lanes_faces_both(&at, q->light, q->view);
    lanes inside = lanes_min(p->low - q->range_low + from_low, q->range_high - p->high + to_high);
    lanes radius = lanes_spine_radius(q->kappa, &q->spine, inside, at.sin_u, at.cos_u);
    return lanes_yarn_area(q->width, radius, at.cos_v) * (at.light_share * at.view_share);
}

WEFT_INLINE lanes filament_integrand(const integral *q, lanes v, lane_bits *lit)
{
    lane_mirror at = {.sin_u = q->sin_u, .cos_u = q->cos_u, .sin_v = lanes_sin(v), .cos_v = lanes_cos(v)};
    *lit = lanes_faces_both(&at, q->light, q->view);
    return lanes_yarn_area(q->width, q->radius, at.cos_v) * (at.light_share * at.view_share * at.cosine_sum);
}

/* The integrand times dt / (2 length d(theta / 2)) at values of theta / 2. */
WEFT_INLINE lanes integrand(const integral *q, const piece *p, lanes angle, lane_bits *lit)
{
    lanes sine = lanes_sin(angle), cosine = lanes_cos(angle);
    lanes from_low = (p->high - p->low) * sine * sine, to_high = (p->high - p->low) * cosine * cosine;
    lanes t = lanes_select(sine < cosine, p->low + from_low, p->high - to_high);
    lanes value = q->filament ? filament_integrand(q, t, lit) : staple_integrand(q, p, t, from_low, to_high, lit);
    return lanes_where(*lit, value * sine * cosine);
}

/* A part of a piece, between two values of theta / 2. */
typedef struct panel {
    float low, high;
} panel;

typedef struct estimate {
    float value, error;
    int change; /* number of the place from which on the yarn faces otherwise than before, 0 = nowhere */
} estimate;

/* The first place whose `lit` differs from that of the place before, 0 where there is none. */
WEFT_INLINE int first_change(const int32_t lit[NODES], int count)
{
    int change = 1;
    while (change < count && lit[change] == lit[change - 1])
        change++;
    return change < count ? change : 0;
}

WEFT_INLINE estimate estimate_panel(const integral *q, const piece *p, panel of)
{
    _Alignas(64) int32_t lit[NODES];
    lanes kronrod = lanes_of(0), gauss = lanes_of(0);
    float centre = 0.5f * (of.low + of.high), radius = 0.5f * (of.high - of.low);
    for (int i = 0; i < NODES; i += LANES) {
        lanes value = integrand(q, p, centre + radius * lanes_load(node + i), (lane_bits *)(lit + i));
        kronrod += lanes_load(kronrod_weight + i) * value;
        gauss += lanes_load(gauss_weight + i) * value;
    }
    float scale = 2 * (p->high - p->low) * radius;
    return (estimate){scale * lanes_sum(kronrod), scale * fabsf(lanes_sum(kronrod - gauss)),
                      first_change(lit, NODES - 1)};
}

/* Where between two values of theta / 2 the yarn turns away: the integrand has a kink there, which no rule sees. */
WEFT_INLINE float find_change(const integral *q, const piece *p, float low, float high)
{
    enum { ROUNDS = 2 };
    for (int round = 0; round < ROUNDS; round++) {
        _Alignas(64) int32_t lit[NODES];
        float step = (high - low) / (NODES - 1);
        for (int i = 0; i < NODES; i += LANES)
            integrand(q, p, low + step * lanes_load(counting + i), (lane_bits *)(lit + i));
        int change = first_change(lit, NODES);
        if (change == 0)
            break;
        low += step * (float)(change - 1);
        high = low + step;
    }
    return 0.5f * (low + high);
}

/* Where to cut a panel whose estimate does not do. */
WEFT_INLINE float cut_of(const integral *q, const piece *p, panel of, const estimate *e)
{
    float centre = 0.5f * (of.low + of.high), radius = 0.5f * (of.high - of.low);
    if (e->change == 0)
        return centre;
    return find_change(q, p, centre + radius * node[e->change - 1], centre + radius * node[e->change]);
}

/* Adds the integral over a piece; false where it does not settle. */
WEFT_INLINE bool add_piece(const integral *q, piece p, float *sum)
{
    panel stack[MAX_PANELS + 2] = {{0, WEFT_LANE_HALF_PI}};
    int depth = 1;
    for (int panels = 0; depth > 0; panels++) {
        panel at = stack[--depth];
        estimate e = estimate_panel(q, &p, at);
        if (e.error <= trusted * (*sum + e.value) && (e.change == 0 || at.high - at.low < NARROW)) {
            *sum += e.value;
            continue;
        }
        if (panels >= MAX_PANELS)
            return false;
        float cut = cut_of(q, &p, at, &e);
        stack[depth++] = (panel){cut, at.high};
        stack[depth++] = (panel){at.low, cut};
    }
    return true;
}

WEFT_INLINE void insert(float *cuts, int *count, double t, double low, double high)
{
    if (!(t > low && t < high))
        return;
    int i = (*count)++;
    for (; i > 0 && cuts[i - 1] > (float)t; i--)
        cuts[i] = cuts[i - 1];
    cuts[i] = (float)t;
}

WEFT_INLINE lane_vec3 broadcast(weft_vec3 d)
{
    return lane_vec3_of((float)d.x, (float)d.y, (float)d.z);
}

/* Where the integrand begins, ends, jumps or has a kink in the spine: see staple_breaks in
 * reflectance/woven/integral.c. */
WEFT_INLINE int staple_cuts(const weft_prepared_segment *prepared, double u0, double origin, double reach,
                            float cuts[MAX_CUTS])
{
    double umax = prepared->spine.umax, low = -umax - origin, high = umax - origin, middle = u0 - origin;
    const double edge[2] = {reach < 1 ? asin(reach) : WEFT_PI / 2, fabs(prepared->segment.psi)};
    int count = 1;
    cuts[0] = (float)low;
    if (prepared->spine.shape < 0 || prepared->spine.shape > WIDE_ELLIPSE)
        insert(cuts, &count, -origin, low, high);
    for (int i = 0; i < 2; i++) {
        for (int half_turn = -1; half_turn <= 1; half_turn++) {
            insert(cuts, &count, middle + half_turn * WEFT_PI + edge[i], low, high);
            insert(cuts, &count, middle + half_turn * WEFT_PI - edge[i], low, high);
        }
    }
    cuts[count++] = (float)high;
    return count;
}

/* False where the integral does not settle. */
WEFT_INLINE bool staple_integral(const weft_prepared_segment *prepared, integral *q, weft_vec3 half, float *result)
{
    double across = sqrt(half.y * half.y + half.z * half.z), length = sqrt(across * across + half.x * half.x);
    double u0 = atan2(half.y, half.z), reach = length / (prepared->inverse_sin_psi * across);
    float cuts[MAX_CUTS], sum = 0;
    q->from_u0 = reach < prepared->spine.sin_umax;
    q->u0 = lanes_of((float)u0);
    q->half_x = lanes_of((float)(half.x / length));
    q->across = lanes_of((float)(across / length));
    double origin = q->from_u0 ? u0 : 0;
    int count = staple_cuts(prepared, u0, origin, reach, cuts);
    q->range_low = cuts[0];
    q->range_high = cuts[count - 1];
    for (int i = 0; i + 1 < count; i++) {
        double x = (cuts[i] + cuts[i + 1]) / 2 + (origin - u0);
        if (fabs(sin(x)) < reach && !add_piece(q, (piece){cuts[i], cuts[i + 1]}, &sum))
            return false;
    }
    *result = sum * (float)prepared->inverse_sin_psi;
    return true;
}

/* Keeps the v from which `direction` is seen: within pi/2 of its azimuth round the yarn. */
WEFT_INLINE void keep_visible(piece *p, double sin_u, double cos_u, weft_vec3 direction)
{
    double azimuth = atan2(direction.x, direction.y * sin_u + direction.z * cos_u);
    p->low = fmaxf(p->low, (float)(azimuth - WEFT_PI / 2));
    p->high = fminf(p->high, (float)(azimuth + WEFT_PI / 2));
}

WEFT_INLINE bool filament_integral(const weft_prepared_segment *prepared, integral *q, weft_vec3 half, weft_vec3 light,
                                   weft_vec3 view, float *result)
{
    weft_mirror at;
    double across = filament_mirror(half, &at), u = atan2(half.y, half.z), umax = prepared->spine.umax;
    *result = 0;
    if (!(across > 0 && fabs(u) < umax))
        return true;
    double radius = weft_filament_radius(prepared, &prepared->spine, u, at.sin_u, at.cos_u);
    q->sin_u = lanes_of((float)at.sin_u);
    q->cos_u = lanes_of((float)at.cos_u);
    q->radius = lanes_of((float)radius);
    piece p = {-WEFT_LANE_HALF_PI, WEFT_LANE_HALF_PI};
    keep_visible(&p, at.sin_u, at.cos_u, light);
    keep_visible(&p, at.sin_u, at.cos_u, view);
    if (!(p.low < p.high))
        return true;
    bool settled = add_piece(q, p, result);
    *result *= (float)(filament_fade(prepared->segment.delta, umax, u) / across);
    return settled;
}

WEFT_INLINE integral integral_of(const weft_prepared_segment *prepared)
{
    const weft_segment *segment = &prepared->segment;
    const weft_spine *spine = &prepared->spine;
    return (integral){.kappa = lanes_of((float)segment->kappa),
                      .width = lanes_of((float)segment->width),
                      .cot_psi = lanes_of((float)prepared->cot_psi),
                      .filament = prepared->filament,
                      .spine = {.umax = lanes_of((float)spine->umax),
                                .sin_umax = lanes_of((float)spine->sin_umax),
                                .cos_umax = lanes_of((float)spine->cos_umax),
                                .shape = lanes_of((float)spine->shape),
                                .scale = lanes_of((float)spine->scale)}};
}

WEFT_INLINE weft_real reflectance(const weft_prepared_segment *prepared, integral *q, weft_vec3 light, weft_vec3 view)
{
    weft_vec3 half;
    float value;
    if (!half_vector(light, view, &half))
        return 0;
    q->light = broadcast(light);
    q->view = broadcast(view);
    bool settled = prepared->filament ? filament_integral(prepared, q, half, light, view, &value)
                                      : staple_integral(prepared, q, half, &value);
    if (!settled || !isfinite(value))
        return weft_prepared_reflectance(prepared, light, view);
    return (weft_real)value * prepared_phase(prepared, light, view);
}

/* Spines with a spike, e(umax) far from 1, and fibres that run round the yarn: one rule may miss a part of them. */
WEFT_INLINE bool is_hard(const weft_prepared_segment *prepared)
{
    const weft_segment *segment = &prepared->segment;
    const weft_spine *spine = &prepared->spine;
    double half_length = (segment->length - segment->width * spine->sin_umax) / 2;
    double root = spine->scale * spine->sin_umax / half_length, end = root * root;
    return !prepared->filament && (end < 0.02 || end > 1000 || fabs(segment->psi) > 1.4);
}

void WEFT_KERNEL(weft_woven_reflectance)(const weft_prepared_segment *prepared, int count, const weft_vec3 *light,
                                         const weft_vec3 *view, weft_real *value)
{
    bool in_vectors = prepared->admissible && !is_hard(prepared);
    integral q = integral_of(prepared);
    for (int i = 0; i < count; i++)
        value[i] = in_vectors ? reflectance(prepared, &q, light[i], view[i])
                              : weft_prepared_reflectance(prepared, light[i], view[i]);
}
