#include "compress/texel/peak.h"

#include "base/processor.h"
#include "compress/fit/normal.h"
#include "compress/texel/peak_kernel.h"

#include <math.h>

WEFT_DECLARE_PEAK_KERNELS(baseline);
#if defined(__x86_64__)
WEFT_DECLARE_PEAK_KERNELS(avx2);
WEFT_DECLARE_PEAK_KERNELS(avx512);
#endif

#define SLACK 1.001   /* for rounding in single precision; exponents reach thousands */
#define LIT_SLACK 1.1 /* for lights between those of the grid: up to 5 % was seen */

static void add_lobe(const weft_peak_net *net, const weft_gram_point *point, int lobe, const weft_peak_lights *lights)
{
#if defined(__x86_64__)
    weft_instruction_set set = weft_processor_instruction_set();
    if (set == WEFT_AVX512)
        weft_peak_add_lobe_avx512(net, point, lobe, lights);
    else if (set == WEFT_AVX2)
        weft_peak_add_lobe_avx2(net, point, lobe, lights);
    else
#endif
        weft_peak_add_lobe_baseline(net, point, lobe, lights);
}

static weft_peak largest(const weft_peak_net *net)
{
#if defined(__x86_64__)
    weft_instruction_set set = weft_processor_instruction_set();
    if (set == WEFT_AVX512)
        return weft_peak_largest_avx512(net);
    if (set == WEFT_AVX2)
        return weft_peak_largest_avx2(net);
#endif
    return weft_peak_largest_baseline(net);
}

/* T at every corner, or the largest. */
static void place_table(weft_peak_net *net, const double *table)
{
    double most = table ? 0 : 1;
    for (int view = 0; table && view < net->view_count; view++)
        most = fmax(most, table[view]);
    for (int c = 0; c < net->corner_count; c++) {
        double t = net->follows_table && table ? 0 : most;
        for (int k = 0; net->follows_table && table && k < 3 && net->at[c].index[k] >= 0; k++)
            t += net->at[c].weight[k] * table[net->at[c].index[k]];
        net->table[c] = (float)t;
    }
}

static void spread(weft_peak_lights *lights, float exponent)
{
#if defined(__x86_64__)
    weft_instruction_set set = weft_processor_instruction_set();
    if (set == WEFT_AVX512)
        weft_peak_spread_avx512(lights, exponent);
    else if (set == WEFT_AVX2)
        weft_peak_spread_avx2(lights, exponent);
    else
#endif
        weft_peak_spread_baseline(lights, exponent);
}

weft_peak weft_peak_of_fit(weft_peak_net *net, const weft_fit *fit, const weft_peak_tables *tables)
{
    weft_gram_point point = weft_gram_point_of_fit(fit);
    weft_peak_lights *lights = tables->light;
    double r = lights ? exp2(lights->most_r) : 1, f = lights ? exp2(lights->most_f) : 1;
    place_table(net, tables->view);
    for (int t = 0; t < net->triangle_stride; t++) {
        net->sum_r[t] = (float)(fit->diffuse * r);
        net->sum_f[t] = (float)(fit->diffuse * f);
    }
    for (int i = 0; i < fit->lobe_count; i++) {
        if (!(fit->lobe[i].amplitude > 0))
            continue;
        if (lights)
            spread(lights, point.exponent[i]);
        add_lobe(net, &point, i, lights);
    }
    weft_peak peak = largest(net);
    net->slack = lights ? LIT_SLACK : SLACK;
    return (weft_peak){net->slack * peak.r, net->slack * peak.f};
}

void weft_peak_factors(const weft_peak_net *net, weft_peak most, double *factor)
{
    for (int view = 0; view < net->view_count; view++)
        factor[view] = 1;
    for (int t = 0; t < net->triangle_count; t++) {
        double table = 0;
        for (int k = 0; k < 3; k++)
            table = fmax(table, (double)net->table[net->corner[k][t]]);
        double over = fmax((double)net->sum_r[t] / most.r, (double)net->sum_f[t] / most.f) * table * net->slack;
        if (!(over > 1))
            continue;
        for (int view = 0; !net->follows_table && view < net->view_count; view++)
            factor[view] = fmin(factor[view], 1 / over);
        for (int k = 0; net->follows_table && k < 9; k++) {
            const weft_barycentric *at = &net->at[net->corner[k / 3][t]];
            if (at->index[k % 3] >= 0 && at->weight[k % 3] > 0)
                factor[at->index[k % 3]] = fmin(factor[at->index[k % 3]], 1 / over);
        }
    }
}
