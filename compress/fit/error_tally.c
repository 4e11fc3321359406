#include "compress/fit/error_tally.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    MAGNITUDE_BINS = 1 << 13, /* by the exponent and five bits of the mantissa of a float */
    THRESHOLD_BINS = 1 << 9,  /* by the exponent and one bit */
    RELATIVE_BINS = 1 << 9    /* 16 an octave from 2^-24 to 2^8 */
};

struct weft_error_tally {
    uint64_t magnitude[MAGNITUDE_BINS];
    uint32_t relative[THRESHOLD_BINS][RELATIVE_BINS];
    float largest;
};

weft_code weft_error_tally_create(weft_error_tally **result, weft_error *error)
{
    *result = calloc(1, sizeof **result);
    return *result ? WEFT_OK : weft_fail_memory(error, "error histogram", sizeof **result);
}

void weft_error_tally_free(weft_error_tally *tally)
{
    free(tally);
}

static uint32_t bits_of(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static float float_of(uint32_t bits)
{
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static int relative_bin(float relative)
{
    uint32_t lowest = bits_of(0x1p-24f) >> 19;
    uint32_t bin = bits_of(relative) >> 19;
    if (bin < lowest)
        return 0;
    return bin - lowest < RELATIVE_BINS ? (int)(bin - lowest) : RELATIVE_BINS - 1;
}

void weft_error_tally_add(weft_error_tally *tally, float sample, float prediction)
{
    if (!(sample > 0))
        return;
    uint32_t bits = bits_of(sample);
    tally->magnitude[bits >> 18]++;
    tally->relative[bits >> 22][relative_bin(fabsf(prediction - sample) / sample)]++;
    if (sample > tally->largest)
        tally->largest = sample;
}

/* Magnitudes of one bin of the threshold. */
enum { FINE_BINS = MAGNITUDE_BINS / THRESHOLD_BINS };

/* Few of the magnitudes that a float can have occur: the others need not be looked at. */
static bool row_is_empty(const weft_error_tally *tally, int row)
{
    uint64_t any = 0;
    for (int i = row * FINE_BINS; i < (row + 1) * FINE_BINS; i++)
        any |= tally->magnitude[i];
    return any == 0;
}

void weft_error_tally_merge(weft_error_tally *tally, weft_error_tally *other)
{
    for (int row = 0; row < THRESHOLD_BINS; row++) {
        if (row_is_empty(other, row))
            continue;
        for (int i = row * FINE_BINS; i < (row + 1) * FINE_BINS; i++)
            tally->magnitude[i] += other->magnitude[i];
        for (int j = 0; j < RELATIVE_BINS; j++)
            tally->relative[row][j] += other->relative[row][j];
        memset(other->magnitude + row * FINE_BINS, 0, FINE_BINS * sizeof other->magnitude[0]);
        memset(other->relative[row], 0, sizeof other->relative[row]);
    }
    if (other->largest > tally->largest)
        tally->largest = other->largest;
    other->largest = 0;
}

/* ---- In a file ---- */

/* Bins are numbered: the largest sample (its count is its bits), magnitudes, relative errors row by row. */
enum { MAGNITUDE_FROM = 1, RELATIVE_FROM = MAGNITUDE_FROM + MAGNITUDE_BINS };

static size_t put_entry(uint32_t (*entry)[2], size_t at, int bin, uint32_t count)
{
    if (count == 0)
        return at;
    if (entry) {
        entry[at][0] = (uint32_t)bin;
        entry[at][1] = count;
    }
    return at + 1;
}

size_t weft_error_tally_entries(const weft_error_tally *tally, uint32_t (*entry)[2])
{
    size_t n = put_entry(entry, 0, 0, bits_of(tally->largest));
    for (int row = 0; row < THRESHOLD_BINS; row++) {
        if (row_is_empty(tally, row))
            continue;
        for (int i = row * FINE_BINS; i < (row + 1) * FINE_BINS; i++)
            n = put_entry(entry, n, MAGNITUDE_FROM + i, (uint32_t)tally->magnitude[i]);
        for (int j = 0; j < RELATIVE_BINS; j++)
            n = put_entry(entry, n, RELATIVE_FROM + row * RELATIVE_BINS + j, tally->relative[row][j]);
    }
    return n;
}

bool weft_error_tally_add_entries(weft_error_tally *tally, uint32_t (*entry)[2], size_t count)
{
    for (size_t i = 0; i < count; i++) {
        uint32_t bin = entry[i][0], n = entry[i][1];
        if (bin == 0)
            tally->largest = fmaxf(tally->largest, float_of(n));
        else if (bin < RELATIVE_FROM)
            tally->magnitude[bin - MAGNITUDE_FROM] += n;
        else if (bin < RELATIVE_FROM + THRESHOLD_BINS * RELATIVE_BINS)
            tally->relative[(bin - RELATIVE_FROM) / RELATIVE_BINS][(bin - RELATIVE_FROM) % RELATIVE_BINS] += n;
        else
            return false;
    }
    return true;
}

/* The value below which `share` of the counts lie; bin i covers [edge(i), edge(i + 1)), linear inside. */
static double quantile(const uint64_t *count, int bins, double share, double (*edge)(int bin))
{
    double total = 0, below = 0;
    for (int i = 0; i < bins; i++)
        total += (double)count[i];
    for (int i = 0; total > 0 && i < bins; i++) {
        double own = (double)count[i];
        if (own > 0 && below + own >= share * total)
            return edge(i) + (edge(i + 1) - edge(i)) * (share * total - below) / own;
        below += own;
    }
    return 0;
}

static double magnitude_edge(int bin)
{
    return (double)float_of((uint32_t)bin << 18);
}

static double relative_edge(int bin)
{
    return bin == 0 ? 0 : (double)float_of(((bits_of(0x1p-24f) >> 19) + (uint32_t)bin) << 19);
}

weft_error_summary weft_error_tally_summarise(const weft_error_tally *tally, const weft_error_sums *sums)
{
    uint64_t relative[RELATIVE_BINS] = {0};
    for (uint32_t i = bits_of(tally->largest * (float)weft_dim_share) >> 22; i < THRESHOLD_BINS; i++) {
        for (int j = 0; j < RELATIVE_BINS; j++)
            relative[j] += tally->relative[i][j];
    }
    double peak = quantile(tally->magnitude, MAGNITUDE_BINS, weft_peak_share, magnitude_edge);
    return weft_error_summary_make(sums, quantile(relative, RELATIVE_BINS, 0.5, relative_edge),
                                   quantile(relative, RELATIVE_BINS, 0.8, relative_edge),
                                   fmin(peak, (double)tally->largest));
}
