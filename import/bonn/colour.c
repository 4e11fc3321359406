#include "import/bonn/colour.h"

#include <math.h>

/* Logarithms are taken of values raised by this, so that black has one. */
static const float offset = 1e-5f;

static const char *name_of(int model)
{
    switch (model) {
    case WEFT_BONN_LAB:
        return " (CIE Lab)";
    case WEFT_BONN_MEAN:
        return " (linear spectral)";
    default:
        return "";
    }
}

static bool is_read(int model)
{
    switch (model) {
    case WEFT_BONN_RGB:
    case WEFT_BONN_YUV:
    case WEFT_BONN_PCA:
    case WEFT_BONN_YCOCG:
    case WEFT_BONN_SUM:
    case WEFT_BONN_LOG_Y:
    case WEFT_BONN_LOG_YUV:
    case WEFT_BONN_LOG_Y_RATIO:
    case WEFT_BONN_LOG_RGB:
        return true;
    default:
        return false;
    }
}

weft_code weft_bonn_colour_check(const weft_bonn_colour *colour, const char *path, weft_error *error)
{
    if (!is_read(colour->model))
        return weft_fail(error, WEFT_NOT_SUPPORTED, "'%s': its colour model %d%s is not supported", path, colour->model,
                         name_of(colour->model));
    if (colour->model != WEFT_BONN_PCA)
        return WEFT_OK;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            if (!isfinite(colour->axis[i][j]) || !isfinite(colour->mean[j]))
                return weft_fail(error, WEFT_BAD_INPUT, "'%s': the axes of its colours are no numbers", path);
        }
    }
    return WEFT_OK;
}

/* Channels of a run of texels: they become red, green and blue in place. */
typedef struct run {
    float *a, *b, *c;
    size_t count;
} run;

static void rgb_of_yuv(run r)
{
    for (size_t i = 0; i < r.count; i++) {
        float y = r.a[i], u = r.b[i], v = r.c[i];
        r.a[i] = y + 1.13983f * v;
        r.b[i] = y - 0.39465f * u - 0.5806f * v;
        r.c[i] = y + 2.03211f * u;
    }
}

static void rgb_of_axes(const weft_bonn_colour *model, run r)
{
    const float(*axis)[3] = model->axis;
    for (size_t i = 0; i < r.count; i++) {
        float a = r.a[i], b = r.b[i], c = r.c[i];
        r.a[i] = model->mean[0] + a * axis[0][0] + b * axis[1][0] + c * axis[2][0];
        r.b[i] = model->mean[1] + a * axis[0][1] + b * axis[1][1] + c * axis[2][1];
        r.c[i] = model->mean[2] + a * axis[0][2] + b * axis[1][2] + c * axis[2][2];
    }
}

static void rgb_of_ycocg(run r)
{
    for (size_t i = 0; i < r.count; i++) {
        float y = r.a[i], orange = r.b[i], green = r.c[i];
        r.a[i] = y + orange - green;
        r.b[i] = y + green;
        r.c[i] = y - orange - green;
    }
}

static void rgb_of_sum(run r)
{
    for (size_t i = 0; i < r.count; i++) {
        float sum = r.a[i], green = r.b[i], blue = r.c[i];
        r.a[i] = sum * (1 - green - blue);
        r.b[i] = sum * green;
        r.c[i] = sum * blue;
    }
}

static void without_log(float *value, size_t count)
{
    for (size_t i = 0; i < count; i++)
        value[i] = expf(value[i]) - offset;
}

/* A logarithm on either side of 0: what is nearer to 0 than the offset cannot be told from it. */
static void without_signed_log(float *value, size_t count)
{
    for (size_t i = 0; i < count; i++)
        value[i] = value[i] == 0 ? 0 : copysignf(offset * expf(fabsf(value[i])), value[i]);
}

/* The ratios are to Y with the offset, as the logarithm is of it. */
static void yuv_of_ratios(run r)
{
    for (size_t i = 0; i < r.count; i++) {
        float raised = expf(r.a[i]);
        r.a[i] = raised - offset;
        r.b[i] *= raised;
        r.c[i] *= raised;
    }
}

void weft_bonn_colour_restore(const weft_bonn_colour *colour, float *channels, size_t stride, size_t count)
{
    run r = {channels, channels + stride, channels + 2 * stride, count};
    switch (colour->model) {
    case WEFT_BONN_YUV:
        rgb_of_yuv(r);
        break;
    case WEFT_BONN_PCA:
        rgb_of_axes(colour, r);
        break;
    case WEFT_BONN_YCOCG:
        rgb_of_ycocg(r);
        break;
    case WEFT_BONN_SUM:
        rgb_of_sum(r);
        break;
    case WEFT_BONN_LOG_Y:
        without_log(r.a, count);
        rgb_of_yuv(r);
        break;
    case WEFT_BONN_LOG_YUV:
        without_log(r.a, count);
        without_signed_log(r.b, count);
        without_signed_log(r.c, count);
        rgb_of_yuv(r);
        break;
    case WEFT_BONN_LOG_Y_RATIO:
        yuv_of_ratios(r);
        rgb_of_yuv(r);
        break;
    case WEFT_BONN_LOG_RGB:
        without_log(r.a, count);
        without_log(r.b, count);
        without_log(r.c, count);
        break;
    default:
        break;
    }
}
