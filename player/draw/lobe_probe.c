#include "player/draw/probe.h"

#include "base/picture/colour.h"
#include "player/draw/player_parts.h"

#include <math.h>

enum { RINGS = 16, SECTORS = 32 };

/* ---- The shape of a lobe ---- */

/* Mean of l_z above the horizon over directions about d, weighted by (l . d)^N: the quantiles of u = l . d are
 * t^(1 / (N + 1)). */
static double mean_cosine(const weft_frame *about, double n)
{
    double sum = 0;
    for (int ring = 0; ring < RINGS; ring++) {
        double u = pow((ring + 0.5) / RINGS, 1 / (n + 1)), across = sqrt(fmax(0, 1 - u * u));
        for (int sector = 0; sector < SECTORS; sector++) {
            double phi = 2 * WEFT_PI * (sector + 0.5) / SECTORS;
            sum += fmax(0, u * (double)about->normal.z + across * cos(phi) * (double)about->tangent.z +
                               across * sin(phi) * (double)about->bitangent.z);
        }
    }
    return sum / (RINGS * SECTORS);
}

static weft_vec3 in_surface(const weft_frame *frame, weft_vec3 local)
{
    return weft_add(weft_add(weft_scale(frame->tangent, local.x), weft_scale(frame->bitangent, local.y)),
                    weft_scale(frame->normal, local.z));
}

/* Integral of a u^N over the half-space about d: 2 pi a / (N + 1). */
weft_lobe_shape weft_lobe_shape_of(const weft_lobe lobe[3], const weft_frame *frame, weft_vec3 view,
                                   const double table[3])
{
    weft_vec3 local = weft_frame_local(frame, view), sum = {0, 0, 0};
    double n = (double)lobe[1].n;
    float height[3];
    for (int c = 0; c < 3; c++) {
        weft_vec3 peak = {lobe[c].cx * local.x, lobe[c].cy * local.y, lobe[c].cz * local.z};
        double length = sqrt((double)weft_dot(peak, peak));
        height[c] = (float)((double)weft_lobe_power((weft_real)length, lobe[c].n) * table[c]);
        sum = weft_add(sum, peak);
    }
    bool has_direction = weft_dot(sum, sum) > 0;
    weft_vec3 direction = has_direction ? in_surface(frame, weft_unit(sum)) : frame->normal;
    weft_frame about = weft_frame_of_normal(direction, 0);
    return (weft_lobe_shape){
        .direction = direction,
        .half_width_rad = n > 0 ? acos(exp2(-1 / n)) : WEFT_PI / 2,
        .albedo = 2 * (double)weft_luminance(height) / (n + 1) * mean_cosine(&about, n),
    };
}

/* ---- Reading it ---- */

static float half_at(uint32_t word, bool high)
{
    return weft_float_of_half((weft_half)(high ? word >> 16 : word & 0xffff));
}

static weft_real fraction_at(uint32_t word, bool high)
{
    return (weft_real)((int16_t)(high ? word >> 16 : word & 0xffff) / 32767.0);
}

static weft_vec3 rotated(weft_vec3 axis, weft_real w, weft_vec3 direction)
{
    weft_vec3 twice = weft_scale(weft_cross(axis, direction), 2);
    return weft_add(direction, weft_add(weft_scale(twice, w), weft_cross(axis, twice)));
}

static void unpack_base(const uint32_t word[4], weft_texel *texel)
{
    weft_vec3 axis = {fraction_at(word[0], false), fraction_at(word[0], true), fraction_at(word[1], false)};
    weft_real w = fraction_at(word[1], true);
    texel->frame = (weft_frame){rotated(axis, w, (weft_vec3){0, 0, 1}), rotated(axis, w, (weft_vec3){1, 0, 0}),
                                rotated(axis, w, (weft_vec3){0, 1, 0})};
    texel->diffuse[0] = (double)half_at(word[2], false);
    texel->diffuse[1] = (double)half_at(word[2], true);
    texel->diffuse[2] = (double)half_at(word[3], false);
}

static weft_lobe unpacked_lobe(const uint32_t word[2])
{
    return (weft_lobe){(weft_real)half_at(word[0], false), (weft_real)half_at(word[0], true),
                       (weft_real)half_at(word[1], false), (weft_real)half_at(word[1], true)};
}

static void attach(GLuint texture, int layer)
{
    glFramebufferTextureLayer(GL_READ_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, texture, 0, layer);
    glReadBuffer(GL_COLOR_ATTACHMENT0);
}

static void read_texel(const weft_material_texture *t, int x, int y, weft_texel *texel)
{
    uint32_t word[4];
    attach(t->texel, 0);
    glReadPixels(x, y, 1, 1, GL_RGBA_INTEGER, GL_UNSIGNED_INT, word);
    unpack_base(word, texel);
    texel->lobe_count = t->lobe_count;
    for (int i = 0; i < 3 * t->lobe_count; i++) {
        attach(t->texel, 1 + i / 2);
        if (i % 2 == 0)
            glReadPixels(x, y, 1, 1, GL_RGBA_INTEGER, GL_UNSIGNED_INT, word);
        texel->lobe[i / 3][i % 3] = unpacked_lobe(word + i % 2 * 2);
    }
}

/* T or S between the three directions around one. */
static void read_table(const weft_table_texture *table, const weft_mip_layout *layout,
                       const weft_triangulation *directions, weft_vec3 direction, int x, int y, double value[3])
{
    weft_barycentric at = weft_triangulation_lookup(directions, direction);
    value[0] = value[1] = value[2] = 0;
    for (int i = 0; i < 3; i++) {
        uint8_t code[4] = {0};
        if (at.index[i] < 0)
            continue;
        attach(table->name, at.index[i] / table->columns);
        glReadPixels(x + at.index[i] % table->columns * layout->width, y, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, code);
        for (int c = 0; c < 3; c++)
            value[c] += (double)at.weight[i] * (code[c] / 255.0) * (code[c] / 255.0);
    }
}

static weft_code read_all(const weft_player *p, int x, int y, weft_vec3 light, weft_vec3 view, weft_texel *texel,
                          weft_error *error)
{
    const weft_material_texture *t = &p->material;
    GLuint buffer;
    glGenFramebuffers(1, &buffer);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, buffer);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    if (texel->has_lobes)
        read_texel(t, x, y, texel);
    if (p->directions.views)
        read_table(&t->table, &t->layout, p->directions.views, view, x, y, texel->view_table);
    if (p->directions.lights)
        read_table(&t->light_table, &t->layout, p->directions.lights, light, x, y, texel->light_table);
    glDeleteFramebuffers(1, &buffer);
    return weft_gl_check("reading a texel", error);
}

weft_code weft_texel_read(const weft_player *p, int level, int x, int y, weft_vec3 light, weft_vec3 view,
                          weft_texel *texel, weft_error *error)
{
    const weft_mip_layout *layout = &p->material.layout;
    if (!p->has[WEFT_MODE_COMPRESSED])
        return weft_fail(error, WEFT_BAD_USAGE, "no compressed material is shown");
    if (level < 0 || level >= layout->level_count || x < 0 || y < 0 || x >= layout->area[level].width ||
        y >= layout->area[level].height)
        return weft_fail(error, WEFT_BAD_USAGE, "the material has no texel (%d, %d) of level %d", x, y, level);
    const weft_mip_area *area = &layout->area[level];
    *texel = (weft_texel){.width = area->width,
                          .height = area->height,
                          .has_lobes = p->material.texel != 0,
                          .has_view_table = p->directions.views != NULL,
                          .has_light_table = p->directions.lights != NULL,
                          .view_table = {1, 1, 1},
                          .light_table = {1, 1, 1}};
    WEFT_TRY(read_all(p, area->x + x, area->y + y, light, view, texel, error));
    for (int i = 0; i < texel->lobe_count; i++)
        texel->shape[i] = weft_lobe_shape_of(texel->lobe[i], &texel->frame, view, texel->view_table);
    return WEFT_OK;
}
