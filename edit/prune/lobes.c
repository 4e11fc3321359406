#include "edit/prune/steps.h"

#include <string.h>

/* l' . diag(C) . v' in the frame of the texel is l . M . v in that of the surface, with M = sum_k C_k axis_k axis_k^T.
 */
static double largest_argument(const weft_visibility *visibility, const weft_frame *frame, const double c[4])
{
    const weft_vec3 axis[3] = {frame->tangent, frame->bitangent, frame->normal};
    double m[3][3] = {{0}}, sum = 0;
    for (int k = 0; k < 3; k++) {
        const double a[3] = {axis[k].x, axis[k].y, axis[k].z};
        for (int i = 0; i < 9; i++)
            m[i / 3][i % 3] += c[k] * a[i / 3] * a[i % 3];
    }
    for (int i = 0; i < 9; i++) {
        const double *range = visibility->product[i / 3][i % 3];
        sum += fmax(m[i / 3][i % 3] * range[0], m[i / 3][i % 3] * range[1]);
    }
    /* No two unit vectors make more of it than its largest coefficient. */
    return fmin(sum, fmax(fabs(c[0]), fmax(fabs(c[1]), fabs(c[2]))));
}

double weft_lobe_bound(const weft_visibility *visibility, const weft_frame *frame, const double c[4])
{
    double argument = largest_argument(visibility, frame, c);
    return c[3] > 0 ? pow(fmax(argument, 0), c[3]) : argument < 0 ? 0 : 1;
}

static weft_half *lobe_at(const weft_material_level *level, int lobe, int channel, size_t texel)
{
    size_t count = (size_t)level->width * (size_t)level->height;
    return level->lobe + 4 * ((size_t)(3 * lobe + channel) * count + texel);
}

static bool is_there(const weft_half *code)
{
    return (code[0] | code[1] | code[2]) != 0;
}

static double bound_of_texel(const weft_visibility *visibility, const weft_material_level *level, int lobe,
                             size_t texel)
{
    weft_frame frame = weft_frame_decode(level->frame + 3 * texel);
    double most = 0;
    for (int channel = 0; channel < 3; channel++) {
        const weft_half *code = lobe_at(level, lobe, channel, texel);
        double c[4];
        for (int i = 0; i < 4; i++)
            c[i] = (double)weft_float_of_half(code[i]);
        most = fmax(most, weft_lobe_bound(visibility, &frame, c));
    }
    return most;
}

static void take_away(const weft_material_level *level, int lobe, size_t texel)
{
    static const weft_half none[4] = {0, 0, 0, 0x3c00};
    for (int channel = 0; channel < 3; channel++)
        memcpy(lobe_at(level, lobe, channel, texel), none, sizeof none);
}

/* *some: a texel still has the lobe. */
static void prune_lobe(const weft_visibility *visibility, double least, const weft_material *material, int lobe,
                       long *count, bool *some)
{
    for (int k = 0; k < material->level_count; k++) {
        const weft_material_level *level = &material->level[k];
        size_t texels = (size_t)level->width * (size_t)level->height;
        for (size_t i = 0; i < texels; i++) {
            bool had = is_there(lobe_at(level, lobe, 0, i)) || is_there(lobe_at(level, lobe, 1, i)) ||
                       is_there(lobe_at(level, lobe, 2, i));
            if (had && bound_of_texel(visibility, level, lobe, i) <= least) {
                take_away(level, lobe, i);
                ++*count;
                had = false;
            }
            *some = *some || had;
        }
    }
}

void weft_prune_lobes(const weft_visibility *visibility, double least, weft_material *material, long *count)
{
    bool is_last = true;
    *count = 0;
    for (int lobe = material->lobe_count - 1; lobe >= 0; lobe--) {
        bool some = false;
        prune_lobe(visibility, least, material, lobe, count, &some);
        is_last = is_last && !some;
        if (is_last)
            material->lobe_count = lobe;
    }
}
