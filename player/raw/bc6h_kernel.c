/* Ends and places of LANES blocks at a time. Codes are the 16-bit numbers between which the format interpolates: 64/31
 * of the bit pattern of a half float. */
#include "player/raw/bc6h_kernel.h"

#include "base/lanes.h"

enum { TEXELS = WEFT_BC6H_TEXELS, LAST_PLACE = 15, AXIS_STEPS = 4, REFINEMENTS = 2 };

static const float largest_half = 65504, largest_code = 65535;

typedef struct block {
    lanes code[TEXELS][3];
    lanes weight[TEXELS];
    lanes end[2][3];
} block;

WEFT_INLINE lanes clamped(lanes x, float low, float high)
{
    return lanes_min(lanes_max(x, lanes_of(low)), lanes_of(high));
}

/* ---- Codes ---- */

/* The decoder rounds down: half a bit more is what it should start from. */
WEFT_INLINE lanes code_of(lanes value)
{
    const int32_t exponent_shift = 112 << 23;
    lanes normal = __builtin_convertvector((lane_bits)value - exponent_shift, lanes) * 0x1p-13f;
    lanes half_bits = lanes_select(value < 0x1p-14f, value * 0x1p24f, normal);
    return (half_bits + 0.5f) * (64.0f / 31);
}

WEFT_INLINE void load(const weft_bc6h_batch *batch, int first, block *b)
{
    for (int t = 0; t < TEXELS; t++) {
        b->weight[t] = lanes_of(0x1p-24f);
        for (int c = 0; c < 3; c++) {
            lanes value = lanes_load(&batch->value[t][c][first]);
            value = lanes_min(lanes_where(value > 0, value), lanes_of(largest_half));
            b->code[t][c] = code_of(value);
            b->weight[t] = lanes_max(b->weight[t], value);
        }
    }
}

/* ---- The line ---- */

WEFT_INLINE void find_mean(const block *b, lanes mean[3])
{
    lanes weight = {0};
    mean[0] = mean[1] = mean[2] = weight;
    for (int t = 0; t < TEXELS; t++) {
        weight += b->weight[t];
        for (int c = 0; c < 3; c++)
            mean[c] += b->weight[t] * b->code[t][c];
    }
    for (int c = 0; c < 3; c++)
        mean[c] /= weight;
}

WEFT_INLINE void find_covariance(const block *b, const lanes mean[3], lanes covariance[3][3])
{
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j <= i; j++) {
            lanes sum = {0};
            for (int t = 0; t < TEXELS; t++)
                sum += b->weight[t] * (b->code[t][i] - mean[i]) * (b->code[t][j] - mean[j]);
            covariance[i][j] = covariance[j][i] = sum;
        }
    }
}

/* By powers of the covariance, from its longest column; its largest component is 1. All 0 where all texels are equal.
 */
WEFT_INLINE void find_axis(lanes covariance[3][3], lanes axis[3])
{
    lane_bits green = covariance[1][1] > covariance[0][0];
    lane_bits blue = covariance[2][2] > lanes_max(covariance[0][0], covariance[1][1]);
    for (int c = 0; c < 3; c++)
        axis[c] = lanes_select(blue, covariance[2][c], lanes_select(green, covariance[1][c], covariance[0][c]));
    for (int step = 0; step <= AXIS_STEPS; step++) {
        lanes power[3], largest = lanes_of(0x1p-100f);
        for (int c = 0; c < 3; c++) {
            power[c] = step == 0 ? axis[c]
                                 : covariance[c][0] * axis[0] + covariance[c][1] * axis[1] + covariance[c][2] * axis[2];
            largest = lanes_max(largest, lanes_max(power[c], -power[c]));
        }
        for (int c = 0; c < 3; c++)
            axis[c] = power[c] / largest;
    }
}

WEFT_INLINE void span_texels(block *b)
{
    lanes mean[3], covariance[3][3], axis[3], low = {0}, high = {0};
    find_mean(b, mean);
    find_covariance(b, mean, covariance);
    find_axis(covariance, axis);
    lanes square = axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2];
    for (int t = 0; t < TEXELS; t++) {
        lanes along = {0};
        for (int c = 0; c < 3; c++)
            along += (b->code[t][c] - mean[c]) * axis[c];
        low = lanes_min(low, along);
        high = lanes_max(high, along);
    }
    lanes scale = lanes_where(square > 0, 1 / square);
    for (int c = 0; c < 3; c++) {
        b->end[0][c] = clamped(mean[c] + low * scale * axis[c], 0, largest_code);
        b->end[1][c] = clamped(mean[c] + high * scale * axis[c], 0, largest_code);
    }
}

/* The nearest of the places between the ends. */
WEFT_INLINE void find_places(const block *b, lane_bits place[TEXELS])
{
    lanes step[3], square = {0};
    for (int c = 0; c < 3; c++) {
        step[c] = b->end[1][c] - b->end[0][c];
        square += step[c] * step[c];
    }
    lanes scale = lanes_where(square > 0, LAST_PLACE / square);
    for (int t = 0; t < TEXELS; t++) {
        lanes along = {0};
        for (int c = 0; c < 3; c++)
            along += (b->code[t][c] - b->end[0][c]) * step[c];
        place[t] = __builtin_convertvector(clamped(along * scale, 0, LAST_PLACE) + 0.5f, lane_bits);
    }
}

/* Ends of least squares for these places; as they are where all texels have one place. */
WEFT_INLINE void fit_ends(block *b, const lane_bits place[TEXELS])
{
    lanes near_near = {0}, near_far = {0}, far_far = {0}, near_code[3] = {0}, far_code[3] = {0};
    for (int t = 0; t < TEXELS; t++) {
        lanes far = __builtin_convertvector(place[t], lanes) * (1.0f / LAST_PLACE), near = 1 - far;
        near_near += b->weight[t] * near * near;
        near_far += b->weight[t] * near * far;
        far_far += b->weight[t] * far * far;
        for (int c = 0; c < 3; c++) {
            near_code[c] += b->weight[t] * near * b->code[t][c];
            far_code[c] += b->weight[t] * far * b->code[t][c];
        }
    }
    lanes determinant = near_near * far_far - near_far * near_far;
    lane_bits solvable = determinant > 1e-4f * near_near * far_far;
    lanes scale = lanes_where(solvable, 1 / determinant);
    for (int c = 0; c < 3; c++) {
        lanes end[2] = {(near_code[c] * far_far - far_code[c] * near_far) * scale,
                        (far_code[c] * near_near - near_code[c] * near_far) * scale};
        for (int i = 0; i < 2; i++)
            b->end[i][c] = lanes_select(solvable, clamped(end[i], 0, largest_code), b->end[i][c]);
    }
}

/* ---- Bits ---- */

/* The finest mode that reaches from one end to the other; the ends become what the decoder will make of them. */
WEFT_INLINE lane_bits quantise(block *b, lane_bits end[2][3])
{
    lane_bits shift = {0};
    for (int mode = 0; mode < WEFT_BC6H_MODES; mode++) {
        lane_bits fits = ~(lane_bits){0}, bits = shift * 0 + weft_bc6h_shift[mode];
        for (int c = 0; c < 3; c++) {
            lane_bits difference = (__builtin_convertvector(b->end[1][c] + 0.5f, lane_bits) >> bits) -
                                   (__builtin_convertvector(b->end[0][c] + 0.5f, lane_bits) >> bits);
            fits &= (difference <= weft_bc6h_reach[mode]) & (difference >= -weft_bc6h_reach[mode]);
        }
        shift = lane_bits_select(fits, bits, shift);
    }
    for (int i = 0; i < 2; i++) {
        for (int c = 0; c < 3; c++) {
            lane_bits bits = __builtin_convertvector(b->end[i][c] + 0.5f, lane_bits) >> shift;
            lane_bits decoded = (bits << shift) + ((1 << shift) >> 1);
            decoded = lane_bits_select(bits == 0, bits, decoded);
            decoded = lane_bits_select(bits == 0xffff >> shift, shift * 0 + 0xffff, decoded);
            b->end[i][c] = __builtin_convertvector(decoded, lanes);
            end[i][c] = bits;
        }
    }
    return shift;
}

WEFT_INLINE void store(int32_t *to, lane_bits x)
{
    *(lane_bits *)__builtin_assume_aligned(to, 4 * LANES) = x;
}

/* The first place has no bit for its upper half: where it lies there, the ends change places. */
WEFT_INLINE void put(weft_bc6h_batch *batch, int first, lane_bits shift, lane_bits end[2][3], lane_bits place[TEXELS])
{
    lane_bits turned = place[0] > LAST_PLACE / 2;
    store(&batch->shift[first], shift);
    for (int c = 0; c < 3; c++) {
        store(&batch->end[0][c][first], lane_bits_select(turned, end[1][c], end[0][c]));
        store(&batch->end[1][c][first], lane_bits_select(turned, end[0][c], end[1][c]));
    }
    for (int t = 0; t < TEXELS; t++)
        store(&batch->place[t][first], lane_bits_select(turned, LAST_PLACE - place[t], place[t]));
}

void WEFT_KERNEL(weft_bc6h_fit)(weft_bc6h_batch *batch)
{
    for (int first = 0; first < WEFT_BC6H_BATCH; first += LANES) {
        block b;
        lane_bits place[TEXELS], end[2][3];
        load(batch, first, &b);
        span_texels(&b);
        for (int i = 0; i < REFINEMENTS; i++) {
            find_places(&b, place);
            fit_ends(&b, place);
        }
        lane_bits shift = quantise(&b, end);
        find_places(&b, place);
        put(batch, first, shift, end, place);
    }
}
