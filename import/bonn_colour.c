#include "import/bonn_colour.h"

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
        return weft_fail(error, WEFT_BAD_INPUT, "'%s': its colours are of model %d%s, which is not read", path,
                         colour->model, name_of(colour->model));
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

static void rgb_of_yuv(float colour[3])
{
    float y = colour[0], u = colour[1], v = colour[2];
    colour[0] = y + 1.13983f * v;
    colour[1] = y - 0.39465f * u - 0.5806f * v;
    colour[2] = y + 2.03211f * u;
}

static void rgb_of_axes(const weft_bonn_colour *model, float colour[3])
{
    float along[3] = {colour[0], colour[1], colour[2]};
    for (int c = 0; c < 3; c++)
        colour[c] =
            model->mean[c] + along[0] * model->axis[0][c] + along[1] * model->axis[1][c] + along[2] * model->axis[2][c];
}

static void rgb_of_ycocg(float colour[3])
{
    float y = colour[0], orange = colour[1], green = colour[2];
    colour[0] = y + orange - green;
    colour[1] = y + green;
    colour[2] = y - orange - green;
}

static void rgb_of_sum(float colour[3])
{
    float sum = colour[0], green = colour[1], blue = colour[2];
    colour[0] = sum * (1 - green - blue);
    colour[1] = sum * green;
    colour[2] = sum * blue;
}

/* A logarithm on either side of 0: what is nearer to 0 than the offset cannot be told from it. */
static float without_signed_log(float value)
{
    return value == 0 ? 0 : copysignf(offset * expf(fabsf(value)), value);
}

static void restore(const weft_bonn_colour *model, float colour[3])
{
    switch (model->model) {
    case WEFT_BONN_YUV:
        rgb_of_yuv(colour);
        break;
    case WEFT_BONN_PCA:
        rgb_of_axes(model, colour);
        break;
    case WEFT_BONN_YCOCG:
        rgb_of_ycocg(colour);
        break;
    case WEFT_BONN_SUM:
        rgb_of_sum(colour);
        break;
    case WEFT_BONN_LOG_Y:
        colour[0] = expf(colour[0]) - offset;
        rgb_of_yuv(colour);
        break;
    case WEFT_BONN_LOG_YUV:
        colour[0] = expf(colour[0]) - offset;
        colour[1] = without_signed_log(colour[1]);
        colour[2] = without_signed_log(colour[2]);
        rgb_of_yuv(colour);
        break;
    case WEFT_BONN_LOG_Y_RATIO: {
        float raised = expf(colour[0]);
        colour[0] = raised - offset;
        colour[1] *= raised;
        colour[2] *= raised;
        rgb_of_yuv(colour);
        break;
    }
    case WEFT_BONN_LOG_RGB:
        for (int c = 0; c < 3; c++)
            colour[c] = expf(colour[c]) - offset;
        break;
    default:
        break;
    }
}

void weft_bonn_colour_restore(const weft_bonn_colour *colour, float *channels, size_t stride, size_t count)
{
    for (size_t i = 0; colour->model != WEFT_BONN_RGB && i < count; i++) {
        float rgb[3] = {channels[i], channels[stride + i], channels[2 * stride + i]};
        restore(colour, rgb);
        for (size_t c = 0; c < 3; c++)
            channels[c * stride + i] = rgb[c];
    }
}
