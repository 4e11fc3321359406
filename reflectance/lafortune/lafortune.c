#include "reflectance/lafortune/lafortune.h"

/* log of the largest lobe value: 1e30 fits single precision with room for a product. */
#define MAX_EXPONENT 69.07755278982137

weft_real weft_lobe_power(weft_real a, weft_real n)
{
    if (a > 0)
        return exp(fmin(n * log(a), (weft_real)MAX_EXPONENT));
    return a == 0 && n == 0 ? 1 : 0;
}

static weft_real lobe_value(const weft_lobe *lobe, weft_vec3 light, weft_vec3 view)
{
    weft_real a = lobe->cx * light.x * view.x + lobe->cy * light.y * view.y + lobe->cz * light.z * view.z;
    return weft_lobe_power(a, lobe->n);
}

weft_real weft_lafortune(weft_real rho, const weft_lobe *lobes, int lobe_count, weft_vec3 light, weft_vec3 view)
{
    for (int i = 0; i < lobe_count; i++)
        rho += lobe_value(&lobes[i], light, view);
    return rho;
}

weft_real weft_view_table_fit(const weft_real *f, const weft_real *r, int count)
{
    double product = 0, square = 0;
    for (int i = 0; i < count; i++) {
        product += (double)f[i] * r[i];
        square += (double)f[i] * f[i];
    }
    return square > 0 ? (weft_real)(product / square) : 1;
}

weft_rgba weft_under_ceiling(weft_rgba value, weft_real ceiling)
{
    weft_real largest = fmax(value.r, fmax(value.g, value.b));
    if (!(ceiling > 0 && largest > ceiling))
        return value;
    weft_real scale = ceiling / largest;
    return (weft_rgba){fmin(scale * value.r, ceiling), fmin(scale * value.g, ceiling), fmin(scale * value.b, ceiling),
                       value.a};
}

weft_rgba weft_view_table_interpolate(const weft_rgba *values, const weft_barycentric *at)
{
    weft_rgba sum = {0};
    for (int i = 0; i < 3 && at->index[i] >= 0; i++) {
        const weft_rgba *value = &values[at->index[i]];
        weft_real weight = at->weight[i];
        sum.r += weight * value->r;
        sum.g += weight * value->g;
        sum.b += weight * value->b;
        sum.a += weight * value->a;
    }
    return sum;
}
