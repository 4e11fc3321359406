#include "player/application_parts.h"

#include "player/ui_bridge.h"

#include <math.h>
#include <stdio.h>

static const uint32_t ink = 0xe6e6e3ff, faint = 0xffffff40;

static void probe_rows(const weft_probe *probe)
{
    char text[96];
    snprintf(text, sizeof text, "%.4f  %.4f  %.4f", probe->radiance[0], probe->radiance[1], probe->radiance[2]);
    weft_ui_value("Linear", text);
    snprintf(text, sizeof text, "%d, %d of level %d   (%.2f)", probe->texel_x, probe->texel_y, probe->texel_level,
             probe->level);
    weft_ui_value("Texel", text);
    snprintf(text, sizeof text, "light %.1f\xc2\xb0   view %.1f\xc2\xb0",
             weft_deg_of_rad(acos(weft_clamp(probe->light.z, -1, 1))),
             weft_deg_of_rad(acos(weft_clamp(probe->view.z, -1, 1))));
    weft_ui_value("Angles", text);
}

/* Where a direction lies in a disc of the plots. */
static void mark_direction(weft_vec3 direction, double x, double y, double radius, double scale)
{
    double at_x, at_y;
    weft_application_place(direction, x, y, radius, &at_x, &at_y);
    weft_ui_ring(at_x, at_y, 3.5 * scale, 1.5 * scale, ink);
}

/* Reflectance over lights and over views, with the ring of what is. */
static void probe_plots(const weft_application *a)
{
    double size = a->plots.size, radius = size / 2;
    weft_ui_area area = weft_ui_here();
    weft_ui_picture(a->plots.shown, 2 * size, size);
    for (int disc = 0; disc < 2; disc++) {
        double x = area.x + disc * size;
        weft_ui_ring(x + radius, area.y + radius, radius, a->scale, faint);
        mark_direction(disc == 0 ? a->probe.light : a->probe.view, x, area.y, radius, a->scale);
    }
    weft_ui_dim_text("pi BRDF over lights               over views");
}

void weft_application_show_probe(const weft_application *a)
{
    if (!a->probe.on_mesh) {
        weft_ui_dim_text("Point at the cloth.");
        return;
    }
    probe_rows(&a->probe);
    probe_plots(a);
}
