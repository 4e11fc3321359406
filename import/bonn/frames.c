#include "import/bonn/frames.h"

#include <string.h>

static weft_vec3 vector_at(const float *from)
{
    return weft_vec3_of((weft_real)from[0], (weft_real)from[1], (weft_real)from[2]);
}

static void store(weft_vec3 vector, float *to)
{
    to[0] = (float)vector.x;
    to[1] = (float)vector.y;
    to[2] = (float)vector.z;
}

static bool is_frame(weft_vec3 tangent, weft_vec3 bitangent, weft_vec3 normal)
{
    const weft_real tolerance = 1e-3;
    return weft_length(weft_subtract(weft_cross(normal, tangent), bitangent)) < tolerance &&
           fabs(weft_length(normal) - 1) < tolerance && fabs(weft_length(tangent) - 1) < tolerance &&
           fabs(weft_dot(normal, tangent)) < tolerance && normal.z >= 0;
}

/* Adds a frame to a sum. A tangent is an axis: its sign means nothing. */
static bool add_frame(const float from[9], float sum[6])
{
    weft_vec3 tangent = vector_at(from), normal = vector_at(from + 6), before = vector_at(sum + 3);
    if (!is_frame(tangent, vector_at(from + 3), normal))
        return false;
    store(weft_add(vector_at(sum), normal), sum);
    store(weft_add(before, weft_scale(tangent, weft_dot(before, tangent) < 0 ? -1 : 1)), sum + 3);
    return true;
}

static bool make_unit(float sum[6])
{
    const weft_real least = 1e-3;
    weft_vec3 normal = weft_unit(vector_at(sum)), tangent = weft_unit(vector_at(sum + 3));
    weft_vec3 across = weft_subtract(tangent, weft_scale(normal, weft_dot(normal, tangent)));
    store(normal, sum);
    store(weft_unit(across), sum + 3);
    return weft_length(normal) > least && weft_length(across) > least;
}

bool weft_bonn_frames_average(const weft_bonn_file *file, int width, int height, float *frames)
{
    bool good = true;
    memset(frames, 0, 6 * (size_t)width * (size_t)height * sizeof *frames);
    for (int y = 0; good && y < file->height; y++) {
        for (int x = 0; good && x < file->width; x++) {
            size_t column = (size_t)((2 * x + 1L) * width / (2 * file->width));
            size_t row = (size_t)((2 * y + 1L) * height / (2 * file->height));
            good = add_frame(file->frame[(size_t)y * (size_t)file->width + (size_t)x],
                             frames + 6 * (row * (size_t)width + column));
        }
    }
    for (size_t i = 0; good && i < (size_t)width * (size_t)height; i++)
        good = make_unit(frames + 6 * i);
    return good;
}
