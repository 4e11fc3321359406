/* The largest values of lobes over a net of views: see compress/texel/peak.h. A corner or a triangle a lane. */
#include "compress/texel/peak_kernel.h"

#include "base/lanes.h"

WEFT_DECLARE_PEAK_KERNELS(WEFT_INSTRUCTION_SET);

#define NOTHING 1e-30f

WEFT_INLINE lanes log2_of(lanes x)
{
    lanes positive = lanes_max(x, lanes_of(NOTHING)), result;
    lanes_log2_each(1, &positive, &result);
    return result;
}

/* w = M v in polar terms: log2 |w|, and cosine and sine of its angle from the normal. */
typedef struct direction_lanes {
    lanes x, y, z, log_length, cosine, sine;
} direction_lanes;

WEFT_INLINE direction_lanes aim(const weft_peak_net *net, const float (*shape)[3], int at)
{
    lanes v[3], w[3];
    for (int k = 0; k < 3; k++)
        v[k] = lanes_load(net->xyz[k] + at);
    for (int k = 0; k < 3; k++)
        w[k] = shape[k][0] * v[0] + shape[k][1] * v[1] + shape[k][2] * v[2];
    lanes flat = w[0] * w[0] + w[1] * w[1], square = lanes_max(flat + w[2] * w[2], lanes_of(NOTHING));
    lanes length = lanes_sqrt(square);
    return (direction_lanes){w[0], w[1], w[2], 0.5f * log2_of(square), w[2] / length, lanes_sqrt(flat) / length};
}

/* log2 of the largest (l . w)^N cos(theta_light). */
WEFT_INLINE lanes largest_with_cosine(const direction_lanes *w, float exponent)
{
    float n = exponent + 1;
    lanes root = lanes_sqrt(n * n * w->cosine * w->cosine + 4 * exponent * w->sine * w->sine);
    /* The positive root of N sine tan^2 + n cosine tan - sine = 0, either way without a difference of equals. */
    lanes near = 2 * w->sine / lanes_max(root + n * w->cosine, lanes_of(NOTHING));
    lanes far = (root - n * w->cosine) / lanes_max(2 * exponent * w->sine, lanes_of(NOTHING));
    lanes tangent = lanes_min(lanes_select(w->cosine > 0, near, far), lanes_of(1e12f));
    return exponent * w->log_length - 0.5f * n * log2_of(1 + tangent * tangent) +
           log2_of(w->cosine + w->sine * tangent);
}

/* log2 of the largest (l . w)^N over lights above the horizon. */
WEFT_INLINE lanes largest_without(const direction_lanes *w, float exponent)
{
    lanes below = log2_of(w->sine);
    return exponent * (w->log_length + lanes_where(w->cosine < 0, below));
}

WEFT_INLINE float largest_of(lanes x)
{
    float largest = x[0];
    for (int i = 1; i < LANES; i++)
        largest = x[i] > largest ? x[i] : largest;
    return largest;
}

void WEFT_KERNEL(weft_peak_spread)(const weft_peak_lights *lights, float exponent)
{
    for (int aim = 0; aim < WEFT_PEAK_AIMS; aim++) {
        const float *log_cosine = lights->log_cosine + aim * lights->stride;
        lanes r = lanes_of(lights->own_r[aim]), f = lanes_of(lights->own_f[aim]);
        for (int at = 0; at < lights->stride; at += LANES) {
            lanes power = exponent * lanes_load(log_cosine + at);
            r = lanes_max(r, power + lanes_load(lights->log_r + at));
            f = lanes_max(f, power + lanes_load(lights->log_f + at));
        }
        lights->aim_r[aim] = largest_of(r) + exponent * lights->log_length[aim];
        lights->aim_f[aim] = largest_of(f) + exponent * lights->log_length[aim];
    }
}

WEFT_INLINE lanes magnitude(lanes x)
{
    return (lanes)((lane_bits)x & 0x7fffffff);
}

/* The triangle of the folded octahedron that w points into: its corners, their weights, and log2 of the distance of the
 * face from the origin there. Edges of the faces, where |u| + |v| = 1, and the sides of triangles fall together. */
typedef struct aim_lanes {
    lane_bits corner[3];
    lanes weight[3], log_length;
} aim_lanes;

WEFT_INLINE aim_lanes find_aim(const direction_lanes *w)
{
    lanes one = lanes_of(1), sum = lanes_max(magnitude(w->x) + magnitude(w->y) + magnitude(w->z), lanes_of(NOTHING));
    lanes u = w->x / sum, v = w->y / sum, folded_u = one - magnitude(v), folded_v = one - magnitude(u);
    lane_bits below = w->z < 0;
    u = lanes_select(below, lanes_select(w->x < 0, -folded_u, folded_u), u);
    v = lanes_select(below, lanes_select(w->y < 0, -folded_v, folded_v), v);
    lane_bits rises = (u < 0) ^ (v < 0); /* here the edges run up to the right */
    lanes low = lanes_of(0), high = lanes_of(WEFT_PEAK_CELLS - 0.001f);
    lanes x = lanes_min(lanes_max(0.5f * WEFT_PEAK_CELLS * (u + 1), low), high);
    lanes y = lanes_min(lanes_max(0.5f * WEFT_PEAK_CELLS * (v + 1), low), high);
    lane_bits column = __builtin_convertvector(x, lane_bits), row = __builtin_convertvector(y, lane_bits);
    lanes p = x - __builtin_convertvector(column, lanes), q = y - __builtin_convertvector(row, lanes);
    lane_bits step = lane_bits_select(rises, (lane_bits){0} - 1, (lane_bits){0} + 1);
    column = lane_bits_select(rises, column + 1, column); /* mirrored, so that the sides run down to the right */
    p = lanes_select(rises, one - p, p);
    lane_bits first = row * (WEFT_PEAK_CELLS + 1) + column, far = p + q > 1.0f;
    aim_lanes aim;
    aim.corner[0] = lane_bits_select(far, first + step + (WEFT_PEAK_CELLS + 1), first);
    aim.corner[1] = first + step;
    aim.corner[2] = first + (WEFT_PEAK_CELLS + 1);
    aim.weight[1] = lanes_select(far, one - q, p);
    aim.weight[2] = lanes_select(far, one - p, q);
    aim.weight[0] = one - aim.weight[1] - aim.weight[2];
    aim.log_length = w->log_length - log2_of(sum);
    return aim;
}

/* log2 of the mean of the corners' values, for a w of length 1. */
WEFT_INLINE lanes at_aim(const float *value, const aim_lanes *aim, float exponent)
{
    lanes own[3];
    for (int k = 0; k < 3; k++)
        own[k] = lanes_gather(value, aim->corner[k]);
    lanes most = lanes_max(own[0], lanes_max(own[1], own[2])), sum = {0};
    for (int k = 0; k < 3; k++)
        sum += lanes_max(aim->weight[k], lanes_of(0)) * lanes_exp2(lanes_max(own[k] - most, lanes_of(-120)));
    return most + log2_of(sum) - exponent * aim->log_length;
}

WEFT_INLINE lanes at_corners(const weft_peak_net *net, const float *value, int at)
{
    lanes largest = lanes_gather(value, lane_bits_load(net->corner[0] + at));
    for (int k = 1; k < 3; k++)
        largest = lanes_max(largest, lanes_gather(value, lane_bits_load(net->corner[k] + at)));
    return largest;
}

void WEFT_KERNEL(weft_peak_add_lobe)(const weft_peak_net *net, const weft_gram_point *point, int lobe,
                                     const weft_peak_lights *lights)
{
    float exponent = point->exponent[lobe], most_r = 0, most_f = 0;
    if (lights) {
        most_r = (float)lights->most_r;
        most_f = (float)lights->most_f;
    }
    for (int at = 0; at < net->corner_stride; at += LANES) {
        direction_lanes w = aim(net, point->shape[lobe], at);
        lanes r, f;
        if (lights) {
            aim_lanes towards = find_aim(&w);
            r = lanes_min(at_aim(lights->aim_r, &towards, exponent), lanes_of(most_r)) + exponent * w.log_length;
            f = lanes_min(at_aim(lights->aim_f, &towards, exponent), lanes_of(most_f)) + exponent * w.log_length;
        } else {
            r = largest_with_cosine(&w, exponent);
            f = largest_without(&w, exponent);
        }
        lanes_store(net->log_r + at, r);
        lanes_store(net->log_f + at, f);
    }
    for (int at = 0; at < net->triangle_stride; at += LANES) {
        lanes growth = exponent * lanes_load(net->log_growth + at);
        lanes r = lanes_min(growth + at_corners(net, net->log_r, at), lanes_of(most_r));
        lanes f = lanes_min(growth + at_corners(net, net->log_f, at), lanes_of(most_f));
        r = lanes_exp2(lanes_max(r, lanes_of(-120)));
        f = lanes_exp2(lanes_max(f, lanes_of(-120)));
        lanes_store(net->sum_r + at, lanes_load(net->sum_r + at) + point->amplitude[lobe] * r);
        lanes_store(net->sum_f + at, lanes_load(net->sum_f + at) + point->amplitude[lobe] * f);
    }
}

weft_peak WEFT_KERNEL(weft_peak_largest)(const weft_peak_net *net)
{
    lanes r = {0}, f = {0};
    for (int at = 0; at < net->triangle_stride; at += LANES) {
        lanes t = at_corners(net, net->table, at);
        r = lanes_max(r, t * lanes_load(net->sum_r + at));
        f = lanes_max(f, t * lanes_load(net->sum_f + at));
    }
    weft_peak peak = {0, 0};
    for (int i = 0; i < LANES; i++) {
        peak.r = fmax(peak.r, (double)r[i]);
        peak.f = fmax(peak.f, (double)f[i]);
    }
    return peak;
}
