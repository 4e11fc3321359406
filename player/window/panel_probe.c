#include "player/window/panel.h"

#include "player/window/ui/ui_bridge.h"

#include <math.h>
#include <stdio.h>

void weft_panel_place(weft_vec3 direction, double x, double y, double radius, double *at_x, double *at_y)
{
    double across = hypot((double)direction.x, (double)direction.y);
    double r = radius * sqrt(fmax(0, 1 - fabs((double)direction.z))), scale = across > 0 ? r / across : 0;
    *at_x = x + radius + (double)direction.x * scale;
    *at_y = y + radius - (double)direction.y * scale;
}

static const uint32_t ink = 0xe6e6e3ff, faint = 0xffffff40;

static double inclination_deg(weft_vec3 direction)
{
    return weft_deg_of_rad(acos(weft_clamp((double)direction.z, -1, 1)));
}

/* Reflectance times cosine, and below it half the width of the interval about each channel. */
static void reflectance_rows(const weft_application *a)
{
    const double *r = a->reflectance, *half = a->half_width;
    char text[96], name[32];
    snprintf(text, sizeof text, "%.3f  %.3f  %.3f", r[0], r[1], r[2]);
    weft_ui_value("Reflected", text);
    if (!(a->half_width_probability > 0))
        return;
    snprintf(name, sizeof name, "%g %%", 100 * a->half_width_probability);
    snprintf(text, sizeof text, "\xc2\xb1%.3f \xc2\xb1%.3f \xc2\xb1%.3f", half[0], half[1], half[2]);
    weft_ui_value(name, text);
    if (a->half_width_levels == 0)
        return;
    snprintf(text, sizeof text, "on level%s 0%s%.0d%s", a->half_width_levels > 1 ? "s" : "",
             a->half_width_levels > 1 ? " to " : "", a->half_width_levels - 1,
             a->half_width_is_measured ? "" : "; here wider");
    weft_ui_value("Measured", text);
}

static void place_rows(const weft_probe *probe)
{
    char text[96];
    snprintf(text, sizeof text, "%.4f  %.4f  %.4f", probe->radiance[0], probe->radiance[1], probe->radiance[2]);
    weft_ui_value("Linear", text);
    snprintf(text, sizeof text, "%d, %d of level %d   (%.2f)", probe->texel_x, probe->texel_y, probe->texel_level,
             probe->level);
    weft_ui_value("Texel", text);
    snprintf(text, sizeof text, "light %.1f\xc2\xb0   view %.1f\xc2\xb0", inclination_deg(probe->light),
             inclination_deg(probe->view));
    weft_ui_value("Angles", text);
}

/* ---- Discs ---- */

/* A corner of a disc and its radius, pixels. */
typedef struct plot_disc {
    double x, y, radius, scale;
} plot_disc;

static void mark_direction(const plot_disc *disc, weft_vec3 direction)
{
    double x, y;
    weft_panel_place(direction, disc->x, disc->y, disc->radius, &x, &y);
    weft_ui_ring(x, y, 3.5 * disc->scale, 1.5 * disc->scale, ink);
}

/* Numbers where the lobes peak, on the disc of lights. */
static void mark_lobes(const plot_disc *disc, const weft_texel *texel)
{
    for (int i = 0; i < texel->lobe_count; i++) {
        const char number[] = {(char)('1' + i), 0};
        double x, y;
        if (!((double)texel->shape[i].direction.z > 0))
            continue;
        weft_panel_place(texel->shape[i].direction, disc->x, disc->y, disc->radius, &x, &y);
        weft_ui_disc(x, y, 7 * disc->scale, 0x000000a0);
        weft_ui_label(x - 4 * disc->scale, y - 8 * disc->scale, ink, number);
    }
}

/* Reflectance over lights and over views, with the ring of what is. */
static void discs(const weft_application *a)
{
    double size = a->plots.size;
    weft_ui_area area = weft_ui_here();
    weft_ui_picture(a->plots.shown, 2 * size, size);
    for (int i = 0; i < 2; i++) {
        const plot_disc disc = {area.x + i * size, area.y, size / 2, a->scale};
        weft_ui_ring(disc.x + disc.radius, disc.y + disc.radius, disc.radius, a->scale, faint);
        if (i == 0 && a->probe.mode == WEFT_MODE_COMPRESSED &&
            weft_player_drawn_components(a->player, &a->interaction.scene) == 0)
            mark_lobes(&disc, &a->texel);
        mark_direction(&disc, i == 0 ? a->probe.light : a->probe.view);
    }
    weft_ui_dim_text("pi BRDF over lights               over views");
}

/* ---- The model of the texel ---- */

/* Where it sends light, seen from the signs of Cx and Cy: mirrors have both negative, retro-reflectors positive. */
static const char *kind_of(const weft_lobe *lobe)
{
    if (lobe->cx < 0 && lobe->cy < 0)
        return "mirror";
    if (lobe->cx > 0 && lobe->cy > 0)
        return "retro";
    return lobe->cx > 0 ? "retro x" : "retro y";
}

static void lobe_row(const weft_texel *texel, int lobe)
{
    const weft_lobe_shape *shape = &texel->shape[lobe];
    char name[16], text[128];
    snprintf(name, sizeof name, "Lobe %d", lobe + 1);
    snprintf(text, sizeof text, "%s  %.0f\xc2\xb0, %.0f\xc2\xb0  \xc2\xb1%.0f\xc2\xb0  %.3f",
             kind_of(&texel->lobe[lobe][1]), inclination_deg(shape->direction),
             weft_deg_of_rad(atan2((double)shape->direction.y, (double)shape->direction.x)),
             weft_deg_of_rad(shape->half_width_rad), shape->albedo);
    weft_ui_value(name, text);
}

static void three_row(const char *name, const double value[3])
{
    char text[64];
    snprintf(text, sizeof text, "%.3f  %.3f  %.3f", value[0], value[1], value[2]);
    weft_ui_value(name, text);
}

static void model_rows(const weft_texel *texel)
{
    three_row("Diffuse", texel->diffuse);
    for (int i = 0; i < texel->lobe_count; i++)
        lobe_row(texel, i);
    if (texel->has_view_table)
        three_row("T, this view", texel->view_table);
    if (texel->has_light_table)
        three_row("S, this light", texel->light_table);
    if (texel->lobe_count > 0)
        weft_ui_dim_text("Lobe: peak for this view (from up, around),\nhalf width, albedo with T");
}

/* Cx, Cy, Cz, N of red, green and blue. */
static void parameter_rows(const weft_texel *texel)
{
    static const char *const channel[] = {"red", "green", "blue"};
    for (int i = 0; i < 3 * texel->lobe_count; i++) {
        const weft_lobe *lobe = &texel->lobe[i / 3][i % 3];
        char name[24], text[96];
        snprintf(name, sizeof name, "%d %s", i / 3 + 1, channel[i % 3]);
        snprintf(text, sizeof text, "%+.3f %+.3f %+.3f  %.1f", (double)lobe->cx, (double)lobe->cy, (double)lobe->cz,
                 (double)lobe->n);
        weft_ui_value(name, text);
    }
    weft_ui_dim_text("Cx, Cy, Cz, N in the axes of the texel");
}

void weft_panel_show_probe(const weft_application *a)
{
    if (!a->probe.on_mesh) {
        weft_ui_dim_text("Point at the cloth.");
        return;
    }
    place_rows(&a->probe);
    reflectance_rows(a);
    discs(a);
    if (a->probe.mode != WEFT_MODE_COMPRESSED)
        return;
    int components = weft_player_drawn_components(a->player, &a->interaction.scene);
    if (components > 0) {
        char text[64];
        snprintf(text, sizeof text, "Drawn by %d components.%s", components, a->texel.has_lobes ? " Beside them:" : "");
        weft_ui_dim_text(text);
    }
    if (!a->texel.has_lobes)
        return;
    model_rows(&a->texel);
    if (a->texel.lobe_count > 0 && weft_ui_section("Its parameters", false))
        parameter_rows(&a->texel);
}
