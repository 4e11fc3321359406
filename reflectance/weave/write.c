#include "reflectance/weave/weave.h"

#include "base/atomic_file.h"
#include "btf/direction/direction.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

static void write_number(FILE *out, const char *indent, const char *key, weft_real value)
{
    fprintf(out, "%s%s = %.17g,\n", indent, key, (double)value);
}

static void write_rgb(FILE *out, const char *key, weft_rgb value, const char *end)
{
    fprintf(out, "    %s = {%.17g, %.17g, %.17g}%s\n", key, (double)value.r, (double)value.g, (double)value.b, end);
}

/* Degrees that come back as the same angle. */
static double degrees(weft_real angle_rad)
{
    return (double)weft_deg_of_rad(angle_rad);
}

/* A double, not the single precision of the model: two corners of a large material lie far apart. */
static void write_layout(FILE *out, const weft_weave_layout *layout)
{
    fprintf(out, "  tilesU = %.17g,\n  tilesV = %.17g,\n  cornerU = %.17g,\n  cornerV = %.17g,\n", layout->tiles_u,
            layout->tiles_v, layout->corner_u, layout->corner_v);
}

static void write_head(FILE *out, const weft_weave *weave)
{
    const weft_segment *fibre = &weave->yarn[0].segment;
    static const char *const noise[4] = {"dWarpUmaxOverDWarp", "dWarpUmaxOverDWeft", "dWeftUmaxOverDWarp",
                                         "dWeftUmaxOverDWeft"};
    fprintf(out, "weave {\n  name = \"%s\",\n  tileWidth = %d,\n  tileHeight = %d,\n", weave->name, weave->tile_width,
            weave->tile_height);
    write_number(out, "  ", "alpha", fibre->alpha);
    write_number(out, "  ", "beta", fibre->beta);
    write_number(out, "  ", "ss", fibre->delta);
    write_number(out, "  ", "hWidth", fibre->highlight_width);
    if (fibre->frozen_radius)
        write_number(out, "  ", "frozenRadius", 1);
    write_number(out, "  ", "warpArea", weave->warp_area);
    write_number(out, "  ", "weftArea", weave->weft_area);
    write_number(out, "  ", "fineness", weave->fineness);
    write_number(out, "  ", "period", weave->period);
    for (int i = 0; i < 4; i++)
        write_number(out, "  ", noise[i], weave->inclination_noise_deg[i]);
    if (weave->cell_pitch_mm > 0)
        fprintf(out, "  cellPitch = %.17g,\n", weave->cell_pitch_mm);
    if (weave->layout.tiles_u > 0)
        write_layout(out, &weave->layout);
}

static void write_pattern(FILE *out, const weft_weave *weave)
{
    fprintf(out, "\n  pattern {");
    for (int row = 0; row < weave->tile_height; row++) {
        for (int column = 0; column < weave->tile_width; column++) {
            int last = row == weave->tile_height - 1 && column == weave->tile_width - 1;
            fprintf(out, "%s%d%s", column ? " " : "\n    ", weave->pattern[row * weave->tile_width + column] + 1,
                    last ? "" : ",");
        }
    }
    fprintf(out, "\n  }");
}

static void write_yarn(FILE *out, const weft_yarn *yarn)
{
    const weft_segment *segment = &yarn->segment;
    fprintf(out, ",\n\n  yarn {\n    type = %s,\n", yarn->warp ? "warp" : "weft");
    write_number(out, "    ", "psi", (weft_real)degrees(segment->psi));
    write_number(out, "    ", "umax", (weft_real)degrees(segment->umax));
    write_number(out, "    ", "kappa", segment->kappa);
    write_number(out, "    ", "width", segment->width);
    write_number(out, "    ", "length", segment->length);
    write_number(out, "    ", "centerU", yarn->center_u);
    write_number(out, "    ", "centerV", yarn->center_v);
    write_rgb(out, "kd", yarn->kd, ",");
    write_rgb(out, "ks", yarn->ks, "");
    fprintf(out, "  }");
}

weft_code weft_weave_write(const char *path, const weft_weave *weave, const char *comment, weft_error *error)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    if (!out)
        return weft_fail_memory(error, path, 4096);
    if (comment)
        fprintf(out, "/* %s */\n\n", comment);
    write_head(out, weave);
    write_pattern(out, weave);
    for (int i = 0; i < weave->yarn_count; i++)
        write_yarn(out, &weave->yarn[i]);
    fprintf(out, "\n}\n");
    weft_code code = fclose(out) == 0 ? weft_write_file(path, text, size, error) : weft_fail_memory(error, path, size);
    free(text);
    return code;
}
